"""Pictures of a simulation, in one pass each: colour and depth are read together."""

from __future__ import annotations

import contextlib
import functools
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.groups import DRAWN_COLLISION, VISUAL
from simkit.errors import RenderError
from simkit.pose import Vector
from simkit.sensors import gl

if TYPE_CHECKING:
    from simkit.runtime import Simulation

Colours = npt.NDArray[np.uint8]
Depths = npt.NDArray[np.float32]

_EXTRA_GEOMS = 2000
_ALL = int(mujoco.mjtCatBit.mjCAT_ALL)
_ROWS = 32  # at once: so many fit into a processor's cache, and what is done to them costs no more memory traffic
_QUALITIES = {"fast": (0, 0), "gazebo": (4, 2048), "high": (8, 4096)}
"""Samples per pixel and size of the shadow map."""


@dataclass(frozen=True, slots=True)
class View:
    """What a camera looks through: image size [px] and the frustum's edges at a distance of 1.

    Attributes:
        left, right, bottom, top: edges on the plane at distance 1 in front of the camera.
        near, far: clip planes [m].
    """

    width: int
    height: int
    left: float
    right: float
    bottom: float
    top: float
    near: float
    far: float


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
        self._scene: Any = None
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

    def render(
        self,
        model: Any,
        data: Any,
        position: Vector,
        rotation: Vector,
        view: View,
        *,
        depth: bool,
        decorate: Any = None,
    ) -> tuple[Colours, Depths | None]:
        """One picture, rows from the top.

        Args:
            model, data: with everything computed.
            position: of the camera in the world, shape (3,).
            rotation: of the camera frame (x forward, y left, z up), shape (3, 3).
            view: size and frustum.
            depth: whether depth is read too.
            decorate: called with the `MjvScene` before it is drawn, to add geoms.

        Returns:
            Colours (height, width, 3), and raw depths (height, width): 0 is the far plane or nothing, 1 the near
            plane; `metres` converts. Both are views of buffers that the next picture overwrites.

        Raises:
            RenderError: there is no renderer, or it failed.
        """
        rectangle, (colours, depths) = self._buffer(view.width, view.height)
        with gl.current():
            try:
                self.reserve(view.width, view.height)
                self._follow(model)
                # another simulation may have drawn, or have taken its buffers with it when it was closed
                mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
                scene = self._scene
                mujoco.mjv_updateScene(model, data, self._option, None, self._aside, _ALL, scene)
                if self._shadow_size:
                    _bring_suns_near(scene, model)
                if decorate is not None:
                    decorate(scene)
                aim(scene, position, rotation, view)
                mujoco.mjr_render(rectangle, scene, self._context)
                masked = depth and not self._samples and self._shade is not None
                if not masked:
                    _call_list(self._backdrop)
                mujoco.mjr_readPixels(colours, depths if depth else None, rectangle, self._context)
                if masked:
                    self._paint_background(colours, depths)
                elif depth:
                    self._learn_shade(colours, depths)
            except mujoco.FatalError as error:
                raise RenderError(f"drawing a picture failed: {error}", "SK-RENDER-002") from error
        return colours[::-1], depths[::-1] if depth else None

    def free(self) -> None:
        """Gives the graphics memory back; a later picture takes it anew."""
        context, self._context, self._model, self._scene = self._context, None, None, None
        if context is not None and gl.is_open():
            with gl.current():
                context.free()

    # ------------------------------------------------------------------ within

    def _follow(self, model: Any) -> None:
        """Uploads a model that is not the last one."""
        if model is self._model:
            return
        self.free()
        quality = model.vis.quality
        kept = quality.offsamples, quality.shadowsize
        quality.offsamples, quality.shadowsize = self._samples, self._shadow_size
        try:
            self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        finally:
            quality.offsamples, quality.shadowsize = kept
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self._context.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
        self._resize()
        self._scene = mujoco.MjvScene(model, model.ngeom + _EXTRA_GEOMS)
        flags = self._scene.flags
        flags[:] = 0
        flags[mujoco.mjtRndFlag.mjRND_CULL_FACE] = 1
        flags[mujoco.mjtRndFlag.mjRND_SHADOW] = int(self._shadow_size > 0)
        self._model = model
        if not self._backdrop:
            self._backdrop = _backdrop(self._background)

    def _resize(self) -> None:
        mujoco.mjr_resizeOffscreen(self._width, self._height, self._context)

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


def metres(
    raw: Depths, near: float, far: float, lowest: float = 0.0, highest: float = np.inf, out: Depths | None = None
) -> Depths:
    """Distances along the optical axis [m] of raw depths.

    Args:
        raw: shape (h, w), of a picture.
        near, far: clip planes of the picture [m].
        lowest, highest: what is nearer becomes -inf, what is farther +inf, as does what has nothing up to `far` [m].
        out: contiguous, shape (h, w), to be written to.
    """
    import cv2

    if out is None:
        out = np.empty(raw.shape, np.float32)
    scale, least = np.float32((far - near) / (near * far)), np.float32(1.0 / far)
    one, infinite = np.float32(1.0), _filled(raw.shape[1], np.inf)
    ends_before = highest < far
    bound, nearest = float(np.float32(highest)), np.float32(lowest)
    for first in range(0, len(raw), _ROWS):
        part = out[first : first + _ROWS]
        np.copyto(part, raw[first : first + _ROWS])
        beyond: Any = None if ends_before else cv2.compare(part, 0.0, cv2.CMP_EQ)
        np.multiply(part, scale, out=part)
        np.add(part, least, out=part)
        np.divide(one, part, out=part)
        if ends_before:
            beyond = cv2.compare(part, bound, cv2.CMP_GT)
        cv2.copyTo(infinite[: len(part)], beyond, part)
        if lowest > 0 and np.minimum.reduce(part, axis=None) < nearest:
            np.copyto(part, np.float32(-np.inf), where=part < nearest)
    return out


@functools.lru_cache(maxsize=8)
def _filled(width: int, value: float) -> Depths:
    return np.full((_ROWS, width), value, dtype=np.float32)


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


def render_view(
    sim: Simulation,
    width: int,
    height: int,
    *,
    eye: Vector | None = None,
    target: Vector | None = None,
    vertical_fov: float = 0.8,
    decorate: Callable[[Any], None] | None = None,
) -> Colours:
    """A picture of the simulation as it is now.

    Args:
        width, height: [px].
        eye: where it is seen from, in the world [m]; by default from the side and above, so that all is in view.
        target: point in the middle of the picture [m]; by default the middle of the scene.
        vertical_fov: opening angle [rad].
        decorate: called with the `MjvScene`, to add geoms.

    Returns:
        Colours, rows from the top, shape (height, width, 3).

    Raises:
        RenderError: there is no renderer.
    """
    model = sim.mj_model
    extent = float(model.stat.extent)
    middle = np.array(model.stat.center if target is None else target, dtype=np.float64)
    place = middle + extent * np.array((-1.1, -1.4, 1.1)) if eye is None else np.asarray(eye, dtype=np.float64)
    half = np.tan(vertical_fov / 2)
    wide = half * width / height
    distance = max(float(np.linalg.norm(middle - place)), 1e-6)
    view = View(width, height, -wide, wide, -half, half, min(0.01 * extent, 0.1 * distance), distance + 50.0 * extent)
    is_dark = model.nlight == 0

    def prepare(scene: Any) -> None:
        if is_dark:
            _light_from_eye(scene)
        if decorate is not None:
            decorate(scene)

    colours, _ = renderer_of(sim).render(
        model, sim.fresh_data(), place, look_at(place, middle), view, depth=False, decorate=prepare
    )
    return colours.copy()


def _light_from_eye(scene: Any) -> None:
    """A bare model has no sun: without one, all of its sides look the same."""
    for light in scene.lights[: scene.nlight]:
        if light.headlight and not light.diffuse.any():
            light.diffuse = (0.6, 0.6, 0.6)


def look_at(eye: Vector, target: Vector) -> Vector:
    """Rotation (3, 3) of a camera frame (x forward, y left, z up) at `eye` that looks at `target`, upright."""
    forward = np.asarray(target, dtype=np.float64) - eye
    forward /= max(float(np.linalg.norm(forward)), 1e-12)
    up = np.array((0.0, 0.0, 1.0)) if abs(forward[2]) < 0.999 else np.array((1.0, 0.0, 0.0))
    left = np.cross(up, forward)
    left /= np.linalg.norm(left)
    return np.stack((forward, left, np.cross(forward, left)), axis=1)


def aim(scene: Any, position: Vector, rotation: Vector, view: View) -> None:
    """Sets both eyes of the scene's camera; their mean is what is drawn."""
    near = view.near
    for camera in scene.camera:
        camera.pos = position
        camera.forward = rotation[:, 0]
        camera.up = rotation[:, 2]
        camera.orthographic = 0
        camera.frustum_near, camera.frustum_far = near, view.far
        camera.frustum_bottom, camera.frustum_top = view.bottom * near, view.top * near
        camera.frustum_center = (view.left + view.right) / 2 * near
        camera.frustum_width = (view.right - view.left) / 2 * near


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
