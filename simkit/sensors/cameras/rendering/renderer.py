"""Images of a simulation, drawn in one pass each: colours and depths together, or the geom at each pixel."""

from __future__ import annotations

from collections.abc import Generator, Sequence

import mujoco
import numpy as np

from simkit.errors import RenderError
from simkit.sensors.cameras.rendering import frame_buffer, gl_context
from simkit.sensors.cameras.rendering.appearance import Appearance, Quality
from simkit.sensors.cameras.rendering.lights_and_shadows import fit_shadow_maps, place_directional_lights
from simkit.sensors.cameras.rendering.scene_composition import (
    Composer,
    Composition,
    draw_plain_colours,
    hide_shapes,
    make_transparent,
    shapes_out_of_sight,
    transparent_shapes,
)
from simkit.sensors.cameras.rendering.sky_and_fog import Background, enable_fog
from simkit.sensors.cameras.rendering.transparency import draw_transparent
from simkit.sensors.cameras.rendering.view import Colours, Depths, DrawnView, Ids, Shot, aim
from simkit.sensors.environment.illumination import LEAST_OPACITY


class GpuModel:
    """Graphics memory of the newest model, with one context for smoothed edges and one without multisampling.

    All methods except `reserve` and `contexts` need a current OpenGL context. Each of the two contexts is made at its
    first use.
    """

    def __init__(self, quality: Quality) -> None:
        self._quality = quality
        self._model: mujoco.MjModel | None = None
        self._contexts: dict[bool, mujoco.MjrContext] = {}
        self._width = self._height = 16

    def reserve(self, width: int, height: int) -> None:
        """Enlarge the buffers for images of this size [px]."""
        if width > self._width or height > self._height:
            self._width, self._height = max(width, self._width), max(height, self._height)
            if self._contexts:
                with gl_context.current():
                    for context in self._contexts.values():
                        mujoco.mjr_resizeOffscreen(self._width, self._height, context)

    def context_of(self, model: mujoco.MjModel, smooth: bool) -> mujoco.MjrContext:
        """Return the engine's context of the model; a model that differs from the last one is uploaded first."""
        if model is not self._model:
            self.free()
            self._model = model
        smooth = smooth and self._quality.samples > 0
        if smooth not in self._contexts:
            context = _upload(model, self._quality, smooth)
            mujoco.mjr_resizeOffscreen(self._width, self._height, context)
            self._contexts[smooth] = context
        return self._contexts[smooth]

    def contexts(self) -> list[mujoco.MjrContext]:
        """Return the existing contexts of the engine; no OpenGL context is needed."""
        return list(self._contexts.values())

    def free(self) -> None:
        """Free the graphics memory."""
        contexts, self._contexts, self._model = list(self._contexts.values()), {}, None
        for context in contexts:
            context.free()


def _upload(model: mujoco.MjModel, quality: Quality, smooth: bool) -> mujoco.MjrContext:
    settings = model.vis.quality
    original = settings.offsamples, settings.shadowsize, settings.numslices, settings.numstacks
    settings.offsamples, settings.shadowsize = quality.samples if smooth else 0, quality.shadow_map
    # sides decide the shape; each row of them costs as much, and matters to highlights and spheres only
    settings.numslices, settings.numstacks = max(original[2], quality.slices), max(original[3], quality.slices // 4)
    try:
        context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
    finally:
        settings.offsamples, settings.shadowsize, settings.numslices, settings.numstacks = original
    context.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
    context.shadowScale = 1.0  # the map covers the whole cone of a spot light
    return context


def draw_ids(
    scene: mujoco.MjvScene,
    context: mujoco.MjrContext,
    shot: Shot,
    rectangle: mujoco.MjrRect,
    colours: Colours,
    depths: Depths,
) -> DrawnView:
    """Draw the geom id at each pixel.

    Ids must not be blended at edges, so the context must have no multisampling.
    """
    with draw_plain_colours(scene):
        mujoco.mjr_render(rectangle, scene, context)
        mujoco.mjr_readPixels(colours, depths if shot.depth else None, rectangle, context)
    # the engine draws each shape in a colour that is the shape's index in the list plus 1
    geom_by_colour = np.full(scene.ngeom + 1, -1, np.int32)
    for geom in scene.geoms[: scene.ngeom]:
        if geom.objtype == mujoco.mjtObj.mjOBJ_GEOM and 0 <= geom.segid < scene.ngeom:
            geom_by_colour[geom.segid + 1] = geom.objid
    ids = geom_by_colour.take(_colours_to_numbers(colours), mode="clip")
    return DrawnView(shot.view, None, depths[::-1] if shot.depth else None, ids[::-1])


def _colours_to_numbers(colours: Colours) -> Ids:
    """Return each colour as one number with red as its lowest byte; ten times as fast as a matrix product."""
    import cv2

    numbers: Ids = cv2.cvtColor(colours, cv2.COLOR_RGB2RGBA).view(np.int32)[..., 0]
    np.bitwise_and(numbers, 0xFFFFFF, out=numbers)
    return numbers


_FLAGS = mujoco.mjtRndFlag


class Renderer:
    """Renderer of the visuals of one simulation, including new models after a change of structure.

    One thread may compose a scene, and another thread may draw it.

    Args:
        appearance: appearance of the images.

    Attributes:
        composer: composer of the scenes.
        uploads: graphics memory of the model.
    """

    def __init__(self, appearance: Appearance) -> None:
        self._appearance = appearance
        flags = [_FLAGS.mjRND_CULL_FACE]
        if appearance.quality.shadow_map:
            flags.append(_FLAGS.mjRND_SHADOW)
        self.composer = Composer(flags)
        self.uploads = GpuModel(appearance.quality)
        self._backdrop = Background(appearance.surroundings)
        self._buffers: dict[tuple[int, int], tuple[mujoco.MjrRect, Colours, Depths]] = {}
        self._background_colour: Colours | None = None
        self._is_logged = False
        gl_context.hold_memory(self)

    def draw_all(self, composition: Composition, shots: Sequence[Shot]) -> Generator[DrawnView, None, None]:
        """Draw the shots of a composition one by one; each result is valid until the next one is requested.

        At the end of the generator, the composition is returned to the composer.

        Raises:
            RenderError: there is no renderer, or it failed.
        """
        try:
            for shot in shots:
                yield self.draw(composition, shot)
        finally:
            self.composer.give_back(composition)

    def draw(self, composition: Composition, shot: Shot) -> DrawnView:
        """Draw one image.

        Raises:
            RenderError: there is no renderer, or it failed.
        """
        view, scene = shot.view, composition.scene
        with gl_context.current():
            try:
                # inside the lock, because another thread may draw for the same simulation
                rectangle, colours, depths = self._buffer(view.width, view.height)
                self.uploads.reserve(view.width, view.height)
                smooth = composition.smooth and not (shot.ids or shot.sharp)
                context = self.uploads.context_of(composition.model, smooth)
                # another simulation may have selected or freed a buffer since
                mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, context)
                position, rotation = composition.pose_of(shot)
                aim(scene, position, rotation, view)
                hidden = shapes_out_of_sight(composition, position, rotation, view)
                if shot.ids:
                    with hide_shapes(scene, hidden):
                        return draw_ids(scene, context, shot, rectangle, colours, depths)
                self._log_renderer()
                glassy = [i for i in transparent_shapes(composition) if i not in hidden]
                if shot.sharp:
                    with hide_shapes(scene, [*hidden, *glassy]), draw_plain_colours(scene):
                        mujoco.mjr_render(rectangle, scene, context)
                        mujoco.mjr_readPixels(None, depths, rectangle, context)
                    return DrawnView(view, None, depths[::-1])
                if self._appearance.quality.shadow_map:
                    place_directional_lights(
                        scene, context, composition.model, position, rotation[:, 0], view.far, composition.lit
                    )
                    fit_shadow_maps(context)
                self._render(scene, context, rectangle, hidden, glassy)
                is_masked = not glassy and self._can_paint_background(composition.model)
                # a transparent shape changes the colour of empty pixels but not their depth, so their colour is not
                # the background's
                saves_colour = not (is_masked or glassy) and self._backdrop.is_plain and self._background_colour is None
                if not is_masked:
                    self._backdrop.draw()
                if glassy:
                    draw_transparent(scene, context, glassy, position)
                background = self._background_colour if is_masked else None
                frame_buffer.read(
                    colours, depths if shot.depth or saves_colour else None, rectangle, context, background
                )
                if saves_colour:
                    self._save_background_colour(colours, depths)
            except mujoco.FatalError as error:
                raise RenderError("SK-RENDER-002", f"drawing an image failed: {error}") from error
        return DrawnView(view, colours[::-1], depths[::-1] if shot.depth else None)

    def uploaded(self) -> list[mujoco.MjrContext]:
        """Return the contexts in graphics memory."""
        return self.uploads.contexts()

    def free(self) -> None:
        """Free the graphics memory; a later image allocates it again."""
        if gl_context.is_open():
            with gl_context.current():
                self.uploads.free()
                self._backdrop.free()

    # ------------------------------------------------------------------ helpers

    def _render(
        self,
        scene: mujoco.MjvScene,
        context: mujoco.MjrContext,
        rectangle: mujoco.MjrRect,
        hidden: list[int],
        glassy: list[int],
    ) -> None:
        """Draw the opaque shapes, without those at the indices `hidden`, and only the shadows of those at `glassy`."""
        if self._appearance.surroundings.fog is not None:
            enable_fog(self._appearance.surroundings.fog, scene, context)
        # shapes with more than half opacity cast shadows, so they are drawn with an opacity of 0
        shadows = bool(scene.flags[_FLAGS.mjRND_SHADOW])
        dark = [i for i in glassy if shadows and scene.geoms[i].rgba[3] >= LEAST_OPACITY]
        with hide_shapes(scene, [*hidden, *(i for i in glassy if i not in dark)]), make_transparent(scene, dark):
            mujoco.mjr_render(rectangle, scene, context)

    def _can_paint_background(self, model: mujoco.MjModel) -> bool:
        """Check whether the background can be filled in while the image is read.

        This takes a fifth of the time that a software renderer needs. The background must have one colour, and the
        image must mark its empty pixels, so there must be no blended edges and no textures with transparency.
        """
        is_plain = (
            self._backdrop.is_plain and not self._appearance.quality.samples and self._background_colour is not None
        )
        return is_plain and not (model.tex_nchannel == 4).any()

    def _save_background_colour(self, colours: Colours, depths: Depths) -> None:
        """Save the background's colour as rounded by the driver."""
        empty = int(depths.argmin())
        if depths.flat[empty] == 0:
            self._background_colour = colours.reshape(-1, 3)[empty].copy()

    def _buffer(self, width: int, height: int) -> tuple[mujoco.MjrRect, Colours, Depths]:
        size = (width, height)
        if size not in self._buffers:
            colours, depths = np.empty((height, width, 3), np.uint8), np.empty((height, width), np.float32)
            self._buffers[size] = mujoco.MjrRect(0, 0, width, height), colours, depths
        return self._buffers[size]

    def _log_renderer(self) -> None:
        """Log the renderer and the missing features, once per simulation."""
        if self._is_logged:
            return
        self._is_logged = True
        self._appearance.quality.log_use(gl_context.describe_renderer())
