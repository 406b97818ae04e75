"""Software renderer: images of a simulation without OpenGL, drawn with OpenCV's triangle rasteriser."""

from __future__ import annotations

import functools
import os
import threading
import weakref
from collections.abc import Generator, Sequence
from typing import Final

import mujoco
import numpy as np

from simkit.interrupts import defer_interrupts
from simkit.sensors.cameras.rendering.appearance import Appearance
from simkit.sensors.cameras.rendering.lights_and_shadows import suns_of
from simkit.sensors.cameras.rendering.scene_composition import SOLID, Composer, Composition
from simkit.sensors.cameras.rendering.software.colour_image import ColourImage
from simkit.sensors.cameras.rendering.software.exact_surfaces import exact_depths
from simkit.sensors.cameras.rendering.software.frame import Frame
from simkit.sensors.cameras.rendering.software.lamps import Lamp, lamps_of
from simkit.sensors.cameras.rendering.software.rasteriser import draw_keys, draw_numbers, fill_pinholes
from simkit.sensors.cameras.rendering.software.shadow_maps import Shadow, ShadowMap, ShadowMaps, SoftShadow
from simkit.sensors.cameras.rendering.software.shape_meshes import PLANE
from simkit.sensors.cameras.rendering.software.shape_store import ShapeStore
from simkit.sensors.cameras.rendering.software.shape_table import ShapeTable
from simkit.sensors.cameras.rendering.software.textures import Texture, TexturedShapes
from simkit.sensors.cameras.rendering.software.triangles import Triangles, VisibleShapes
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, dot, rotate
from simkit.sensors.cameras.rendering.view import Colours, Depths, DrawnView, Shot
from simkit.sensors.environment.illumination import LEAST_OPACITY

_FLAGS = mujoco.mjtRndFlag
_SOFT_SAMPLES: Final = 8  # samples per pixel of an image with soft shadows
_BLOCK: Final = 64.0
"""Grid [m] of the points to which drawn positions are relative, so that single precision suffices far away."""


@functools.cache
def describe_renderer() -> str:
    """Return a text such as `software (simkit, OpenCV 5.0.0)`."""
    import cv2

    return f"software (simkit, OpenCV {cv2.__version__})"


_renderers: weakref.WeakSet[SoftwareRenderer] = weakref.WeakSet()


def _after_fork() -> None:
    """Replace the locks in a forked child, because a thread that does not exist there may hold them."""
    for renderer in list(_renderers):
        renderer.replace_lock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)


class MemoryReservation:
    """Counterpart of the graphics memory of the OpenGL renderer; the software renderer reserves nothing."""

    def reserve(self, width: int, height: int) -> None:
        """Accept the size of later images [px]."""

    def contexts(self) -> list[mujoco.MjrContext]:
        """Return no context, because no graphics memory is used."""
        return []

    def free(self) -> None:
        """Free nothing."""


class SoftwareRenderer:
    """Renderer of the visuals of one simulation without OpenGL, with the interface of `Renderer`.

    One thread may compose a scene, and another thread may draw it.

    Args:
        appearance: appearance of the images.

    Attributes:
        composer: composer of the scenes.
        uploads: reservation of memory, which does nothing.
    """

    def __init__(self, appearance: Appearance) -> None:
        self._appearance = appearance
        flags = [_FLAGS.mjRND_CULL_FACE]
        if appearance.quality.shadow_map:
            flags.append(_FLAGS.mjRND_SHADOW)
        self.composer = Composer(flags)
        self.uploads = MemoryReservation()
        self._store = ShapeStore()
        self._textures: dict[int, Texture] = {}
        width = appearance.quality.shadow_map
        self._shadows = ShadowMaps(width) if width else None
        self._lock = threading.RLock()
        _renderers.add(self)
        self._is_logged = False

    def draw_all(self, composition: Composition, shots: Sequence[Shot]) -> Generator[DrawnView, None, None]:
        """Draw the shots of a composition one by one; each result is valid until the next one is requested.

        At the end of the generator, the composition is returned to the composer.
        """
        try:
            for shot in shots:
                yield self.draw(composition, shot)
        finally:
            self.composer.give_back(composition)

    def draw(self, composition: Composition, shot: Shot) -> DrawnView:
        """Draw one image."""
        with defer_interrupts(), self._lock:
            if self._store.use_model(composition.model):
                self._forget_pictures()
            return self._draw(composition, shot)

    def draw_soft(self, composition: Composition, shot: Shot, directions: Sequence[Sequence[Array]]) -> DrawnView:
        """Draw one image of colours with smooth edges and soft shadows.

        Args:
            composition: composition to draw.
            shot: size and frustum; colours with or without depths.
            directions: directions of all directional lights for each of several shadows, the last ones at the edge of
                the disc of each light.
        """
        with defer_interrupts(), self._lock:
            if self._store.use_model(composition.model):
                self._forget_pictures()
            return self._draw(composition, shot, directions)

    def replace_lock(self) -> None:
        """Replace the lock of the renderer, in a process that was forked while another thread was drawing."""
        self._lock = threading.RLock()

    def uploaded(self) -> list[mujoco.MjrContext]:
        """Return no context, because no graphics memory is used."""
        return []

    def free(self) -> None:
        """Forget the triangles of the model; a later image makes them again."""
        with self._lock:
            self._store.clear()
            self._forget_pictures()

    # ------------------------------------------------------------------ helpers

    def _forget_pictures(self) -> None:
        self._textures.clear()
        if self._shadows is not None:
            self._shadows.clear()

    def _draw(
        self, composition: Composition, shot: Shot, directions: Sequence[Sequence[Array]] | None = None
    ) -> DrawnView:
        table = ShapeTable(composition.scene)
        position, rotation = _pose(composition, shot)
        frame = Frame(shot.view, position, rotation, np.rint(position / _BLOCK) * _BLOCK)
        shapes = VisibleShapes(composition.scene, table, self._store, frame, _from_behind(table, position))
        if shot.ids:
            return _draw_ids(shapes, table, shot)
        solid = np.flatnonzero(shapes.is_visible & (table.colours[:, 3] >= SOLID))
        if shot.sharp:
            return _draw_depths(shapes, table, shot, solid)
        self._log_renderer()
        shadows, lamps = self._lights(composition, table, shapes, position, directions)
        picture = ColourImage(
            shapes,
            table,
            lamps,
            TexturedShapes(composition.model, table, self._textures),
            self._appearance.surroundings,
            int(composition.model.vis.quality.numquads),
            solid,
            np.flatnonzero(shapes.is_visible & (table.colours[:, 3] < SOLID)),
            shadows,
        )
        samples = self._appearance.quality.samples if composition.smooth else 0
        image, keys = picture.draw(_SOFT_SAMPLES if directions else samples)
        depths = _raw_depths(frame, table, picture.triangles, keys) if shot.depth else None
        return DrawnView(shot.view, _to_bytes(image), depths)

    def _lights(
        self,
        composition: Composition,
        table: ShapeTable,
        shapes: VisibleShapes,
        position: Array,
        directions: Sequence[Sequence[Array]] | None,
    ) -> tuple[Sequence[Shadow], list[Lamp]]:
        """Return the shadows of the lamps with shadows, and all lamps."""
        scene, model, frame = composition.scene, composition.model, shapes.frame
        shadow_maps = self._shadows
        if shadow_maps is None:
            return (), lamps_of(scene, frame.origin, False)

        def place(maps: ShadowMaps) -> tuple[float, list[Lamp], list[Lamp]]:
            reach = maps.place_lights(scene, model, position, frame, composition.lit)
            lamps = lamps_of(scene, frame.origin, True)
            return reach, lamps, [lamp for lamp in lamps if lamp.has_shadow and not lamp.is_ambient]

        reach, lamps, shadowed = place(shadow_maps)
        if not shadowed:
            return (), lamps
        is_endless = (table.kinds == PLANE) & (table.sizes[:, :2] <= 0.0).any(axis=1)
        casters = np.flatnonzero(table.casts_shadow & (table.colours[:, 3] >= LEAST_OPACITY) & ~is_endless)
        far = frame.view.far
        hard = shadow_maps.draw(shadowed, model, table, shapes, casters, reach, far)
        if directions is None:
            return hard, lamps
        soft_maps = ShadowMaps(self._appearance.quality.shadow_map // 2)
        suns = suns_of(scene)
        middle = [np.array(sun.dir) for sun in suns]
        moved = []
        for moment in directions:
            for sun, direction in zip(suns, moment, strict=True):
                sun.dir = direction
            moved.append(place(soft_maps))
        for sun, direction in zip(suns, middle, strict=True):
            sun.dir = direction

        def draw(lamp: int, number: int) -> ShadowMap:
            reach, _, lamps = moved[number]
            return soft_maps.draw_once(lamps[lamp], table, shapes, casters, reach, far)

        soft: list[Shadow] = [
            SoftShadow(shadow_map, functools.partial(draw, number), len(moved))
            if shadowed[number].is_parallel
            else shadow_map
            for number, shadow_map in enumerate(hard)
        ]
        return soft, lamps

    def _log_renderer(self) -> None:
        """Log the renderer and the missing features, once per simulation."""
        if self._is_logged:
            return
        self._is_logged = True
        self._appearance.quality.log_use(describe_renderer())


def _draw_ids(shapes: VisibleShapes, table: ShapeTable, shot: Shot) -> DrawnView:
    """Draw the geom id at each pixel; transparent shapes are drawn as solid ones."""
    frame = shapes.frame
    keys = frame.empty_keys()
    rows = np.flatnonzero(shapes.is_visible & (table.segments >= 0))
    triangles = shapes.triangles(shapes.corners(rows, (), 1), [])
    image = np.zeros((*keys.shape, 3), np.float32)
    geoms = table.geoms + np.int32(1)
    draw_numbers(frame, triangles.points, triangles.faces, geoms[triangles.owners], image, keys)
    fill_pinholes(keys, [image])
    ids = image[..., 0].astype(np.int32)
    ids -= 1
    return DrawnView(shot.view, None, _raw_depths(frame, table, triangles, keys) if shot.depth else None, ids)


def _draw_depths(shapes: VisibleShapes, table: ShapeTable, shot: Shot, solid: Array) -> DrawnView:
    """Draw only the depths of opaque shapes."""
    frame = shapes.frame
    keys = frame.empty_keys()
    triangles = shapes.triangles(shapes.corners(solid, (), 1), [])
    draw_keys(frame.matrix, triangles.points, triangles.faces, keys)
    fill_pinholes(keys, [])
    return DrawnView(shot.view, None, _raw_depths(frame, table, triangles, keys))


def _raw_depths(frame: Frame, table: ShapeTable, triangles: Triangles, keys: Floats) -> Depths:
    """Return the raw depths of an image, with the exact surfaces of round shapes."""
    raw = frame.raw_depths(keys)
    pixels, exact = exact_depths(frame, table, triangles, keys)
    raw.ravel()[pixels] = frame.raw_of(exact)
    return raw


def _to_bytes(image: Floats) -> Colours:
    import cv2

    colours: Colours = cv2.convertScaleAbs(image, alpha=255.0)
    return colours


def _pose(composition: Composition, shot: Shot) -> tuple[Array, Array]:
    """Return the position (3,) [m] and rotation (3, 3) of a shot in the world, without BLAS."""
    position, rotation = composition.position, composition.rotation
    if shot.position is not None:
        position = position + rotate(np.asarray(shot.position, np.float64)[None], rotation)[0]
    if shot.rotation is not None:
        rotation = rotate(np.asarray(shot.rotation, np.float64).T, rotation).T
    return position, rotation


def _from_behind(table: ShapeTable, eye: Array) -> list[int]:
    """Return the rows of planes seen from behind, where they are invisible."""
    planes = np.flatnonzero(table.kinds == PLANE)
    away = eye - table.positions[planes].astype(np.float64)
    height = dot(away, table.rotations[planes][:, :, 2].astype(np.float64))
    behind: list[int] = planes[height < 0.0].tolist()
    return behind
