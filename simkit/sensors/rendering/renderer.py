"""Pictures of a simulation, in one pass each: colour and depth are read together."""

from __future__ import annotations

import contextlib
import weakref
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from simkit.compiler.groups import DRAWN_COLLISION, VISUAL
from simkit.errors import RenderError
from simkit.pose import Vector
from simkit.sensors.rendering import gl
from simkit.sensors.rendering.view import Colours, Depths, Film, Shot, aim

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_EXTRA_GEOMS = 2000
_ALL = int(mujoco.mjtCatBit.mjCAT_ALL)
_MOST_SCENES = 4  # kept to be filled again
_QUALITIES = {"fast": (0, 0), "gazebo": (4, 2048), "high": (8, 4096)}
"""Samples per pixel and size of the shadow map."""


class Composition:
    """What is drawn of one state of a simulation: the engine's list of shapes and lights, and where the sensor is."""

    __slots__ = ("model", "position", "rotation", "scene")

    def __init__(self, model: Any, scene: Any, position: Vector, rotation: Vector) -> None:
        self.model, self.scene, self.position, self.rotation = model, scene, position, rotation

    def pose_of(self, shot: Shot) -> tuple[Vector, Vector]:
        """Position (3,) [m] and rotation (3, 3) of a shot in the world."""
        position = self.position if shot.position is None else self.position + self.rotation @ shot.position
        return position, self.rotation if shot.rotation is None else self.rotation @ shot.rotation


class Renderer:
    """Draws the visuals of one simulation; follows it to a new model after a change of structure.

    Args:
        background: red, green, blue from 0 to 1.
        quality: fast (no shadows, no multisampling), gazebo or high.
    """

    def __init__(self, background: tuple[float, float, float], quality: str = "fast") -> None:
        self._background = background
        self._samples, self._shadow_size = _QUALITIES.get(quality, _QUALITIES["fast"])
        self._model: Any = None
        self._context: Any = None
        self._sharp_context: Any = None  # for shots of ids
        self._scenes: list[Any] = []
        self._scenes_model: Any = None
        self._width = self._height = 16
        self._option = _visuals_only()
        self._aside = mujoco.MjvCamera()
        self._rectangles: dict[tuple[int, int], Any] = {}
        self._buffers: dict[tuple[int, int], tuple[Colours, Depths]] = {}
        self._backdrop = 0
        self._shade: Colours | None = None
        self._shades: dict[tuple[int, int], Colours] = {}
        _living.add(self)

    def reserve(self, width: int, height: int) -> None:
        """Makes room for pictures of this size [px]."""
        if width > self._width or height > self._height:
            self._width, self._height = max(width, self._width), max(height, self._height)
            if self._context is not None:
                with gl.current():
                    self._resize()

    def compose(
        self, model: Any, data: Any, position: Vector, rotation: Vector, decorate: Callable[[Any], None] | None = None
    ) -> Composition:
        """Takes what is to be drawn of a state; touches no OpenGL, and what it gives needs `data` no more.

        Args:
            model, data: with everything computed.
            position: of the sensor in the world [m], shape (3,).
            rotation: of the sensor's frame (x forward, y left, z up), shape (3, 3).
            decorate: called with the `MjvScene`, to add geoms.
        """
        scene = self._spare_scene(model)
        mujoco.mjv_updateScene(model, data, self._option, None, self._aside, _ALL, scene)
        if self._shadow_size:
            _bring_suns_near(scene, model)
        if decorate is not None:
            decorate(scene)
        return Composition(model, scene, np.array(position, dtype=np.float64), np.array(rotation, dtype=np.float64))

    def films(self, composition: Composition, shots: Sequence[Shot]) -> Iterator[Film]:
        """Draws the shots of a composition in turn; each film is good until the next is asked for.

        Raises:
            RenderError: there is no renderer, or it failed.
        """
        for shot in shots:
            yield self.draw(composition, shot)
        self.give_back(composition)

    def draw(self, composition: Composition, shot: Shot) -> Film:
        """One picture.

        Raises:
            RenderError: there is no renderer, or it failed.
        """
        view = shot.view
        rectangle, (colours, depths) = self._buffer(view.width, view.height)
        with gl.current():
            try:
                self.reserve(view.width, view.height)
                self._follow(composition.model)
                scene = composition.scene
                aim(scene, *composition.pose_of(shot), view)
                if shot.ids:
                    return self._draw_ids(scene, shot, rectangle, colours, depths)
                # another simulation may have drawn, or have taken its buffers with it when it was closed
                mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
                mujoco.mjr_render(rectangle, scene, self._context)
                masked = shot.depth and not self._samples and self._shade is not None
                if not masked:
                    _call_list(self._backdrop)
                mujoco.mjr_readPixels(colours, depths if shot.depth else None, rectangle, self._context)
                if masked:
                    self._paint_background(colours, depths)
                elif shot.depth:
                    self._learn_shade(colours, depths)
            except mujoco.FatalError as error:
                raise RenderError(f"drawing a picture failed: {error}", "SK-RENDER-002") from error
        return Film(view, colours[::-1], depths[::-1] if shot.depth else None)

    def give_back(self, composition: Composition) -> None:
        """Says that nothing more is drawn of it."""
        if composition.model is self._scenes_model and len(self._scenes) < _MOST_SCENES:
            self._scenes.append(composition.scene)

    def free(self) -> None:
        """Gives the graphics memory back; a later picture takes it anew."""
        contexts = self._context, self._sharp_context
        self._context = self._sharp_context = self._model = None
        if gl.is_open():
            with gl.current():
                for context in contexts:
                    if context is not None:
                        context.free()

    # ------------------------------------------------------------------ within

    def _follow(self, model: Any) -> None:
        """Uploads a model that is not the last one."""
        if model is self._model:
            return
        self.free()
        self._context = _upload(model, self._samples, self._shadow_size)
        self._resize()
        self._model = model
        if not self._backdrop:
            self._backdrop = _backdrop(self._background)

    def _resize(self) -> None:
        for context in (self._context, self._sharp_context):
            if context is not None:
                mujoco.mjr_resizeOffscreen(self._width, self._height, context)

    def _spare_scene(self, model: Any) -> Any:
        """A list of shapes to be filled."""
        if model is not self._scenes_model:
            self._scenes, self._scenes_model = [], model
        if self._scenes:
            return self._scenes.pop()
        scene = mujoco.MjvScene(model, model.ngeom + _EXTRA_GEOMS)
        scene.flags[:] = 0
        scene.flags[mujoco.mjtRndFlag.mjRND_CULL_FACE] = 1
        scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = int(self._shadow_size > 0)
        return scene

    def _draw_ids(self, scene: Any, shot: Shot, rectangle: Any, colours: Colours, depths: Depths) -> Film:
        """Which geom is seen at each pixel: edges must not be blended, so there is a context without multisampling."""
        context = self._context
        if self._samples:
            if self._sharp_context is None:
                self._sharp_context = _upload(self._model, 0, 0)
                self._resize()
            context = self._sharp_context
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, context)
        kept = scene.flags.copy()
        scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
        scene.flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = scene.flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = 1
        mujoco.mjr_render(rectangle, scene, context)
        mujoco.mjr_readPixels(colours, depths if shot.depth else None, rectangle, context)
        scene.flags[:] = kept
        geoms = scene.geoms[: scene.ngeom]
        names = np.full(scene.ngeom + 1, -1, np.int32)  # the engine draws a shape's number in the list, from 1
        for geom in geoms:
            if geom.objtype == mujoco.mjtObj.mjOBJ_GEOM and 0 <= geom.segid < scene.ngeom:
                names[geom.segid + 1] = geom.objid
        numbers = colours.astype(np.int32) @ np.array((1, 1 << 8, 1 << 16), np.int32)
        ids = names[np.minimum(numbers, scene.ngeom)]
        return Film(shot.view, None, depths[::-1] if shot.depth else None, ids[::-1])

    def _learn_shade(self, colours: Colours, depths: Depths) -> None:
        """Remembers how the driver rounds the background's colour."""
        empty = int(depths.argmin())
        if depths.flat[empty] == 0:
            self._shade = colours.reshape(-1, 3)[empty].copy()

    def _paint_background(self, colours: Colours, depths: Depths) -> None:
        """What the backdrop does where there are no edges to blend, of the depths that were read anyway: five times as
        fast as a renderer in software."""
        import cv2

        size = colours.shape[:2]
        if size not in self._shades:
            assert self._shade is not None
            self._shades[size] = np.tile(self._shade, (*size, 1))
        cv2.copyTo(self._shades[size], cv2.compare(depths, 0.0, cv2.CMP_EQ), colours)

    def _buffer(self, width: int, height: int) -> tuple[Any, tuple[Colours, Depths]]:
        size = (width, height)
        if size not in self._buffers:
            self._rectangles[size] = mujoco.MjrRect(0, 0, width, height)
            self._buffers[size] = np.empty((height, width, 3), np.uint8), np.empty((height, width), np.float32)
        return self._rectangles[size], self._buffers[size]


def _upload(model: Any, samples: int, shadow_size: int) -> Any:
    quality = model.vis.quality
    kept = quality.offsamples, quality.shadowsize
    quality.offsamples, quality.shadowsize = samples, shadow_size
    try:
        context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
    finally:
        quality.offsamples, quality.shadowsize = kept
    context.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
    return context


def renderer_of(sim: Simulation) -> Renderer:
    """The one renderer of a simulation, for all its cameras."""
    found = _of_simulation.get(sim)
    if found is None:
        surroundings = sim.world.surroundings
        found = _of_simulation[sim] = Renderer(surroundings.background[:3], sim.world.quality)
        weakref.finalize(sim, _free_quietly, found).atexit = False
    return found


def _free_quietly(renderer: Renderer) -> None:
    with contextlib.suppress(RenderError, RuntimeError):
        renderer.free()


def free_renderer(sim: Simulation) -> None:
    """When a simulation closes."""
    found = _of_simulation.pop(sim, None)
    if found is not None:
        _free_quietly(found)


def free_all() -> None:
    """At exit, while the context is still there."""
    for found in list(_living):
        found.free()


_living: weakref.WeakSet[Renderer] = weakref.WeakSet()
_of_simulation: weakref.WeakKeyDictionary[Simulation, Renderer] = weakref.WeakKeyDictionary()


def _bring_suns_near(scene: Any, model: Any) -> None:
    """Puts directional lights at the edge of the scene: from farther away their shadow maps have no depth left."""
    for light in scene.lights[: scene.nlight]:
        if light.type == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL and not light.headlight:
            light.pos = model.stat.center - model.stat.extent * np.asarray(light.dir)


def _visuals_only() -> Any:
    option = mujoco.MjvOption()
    option.flags[:] = 0
    for flag in (mujoco.mjtVisFlag.mjVIS_TEXTURE, mujoco.mjtVisFlag.mjVIS_STATIC):
        option.flags[flag] = 1
    for groups in (option.geomgroup, option.sitegroup, option.jointgroup, option.tendongroup, option.actuatorgroup):
        groups[:] = 0
    option.flexgroup[:] = option.skingroup[:] = 0
    option.geomgroup[[DRAWN_COLLISION, VISUAL]] = 1
    return option


def _call_list(number: int) -> None:
    from OpenGL import GL

    GL.glCallList(number)


def _backdrop(colour: tuple[float, float, float]) -> int:
    """A display list that colours whatever is still empty.

    The engine clears to black, and painting the empty pixels on the processor costs as much as the picture.
    """
    from OpenGL import GL

    number = int(GL.glGenLists(1))
    GL.glNewList(number, GL.GL_COMPILE)
    for switch in (GL.GL_LIGHTING, GL.GL_TEXTURE_2D, GL.GL_CULL_FACE, GL.GL_BLEND, GL.GL_FOG):
        GL.glDisable(switch)
    GL.glEnable(GL.GL_DEPTH_TEST)
    GL.glDepthFunc(GL.GL_GEQUAL)
    GL.glDepthMask(GL.GL_FALSE)
    for matrix in (GL.GL_PROJECTION, GL.GL_MODELVIEW):
        GL.glMatrixMode(matrix)
        GL.glLoadIdentity()
    GL.glColor3f(*colour)
    GL.glBegin(GL.GL_TRIANGLES)
    for x, y in ((-1.0, -1.0), (3.0, -1.0), (-1.0, 3.0)):
        GL.glVertex3f(x, y, 0.0)
    GL.glEnd()
    GL.glDepthMask(GL.GL_TRUE)
    GL.glEndList()
    return number
