"""Colours of an image: light, shadows, textures, fog, background and transparent shapes."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from simkit.scene import Surroundings
from simkit.scene.world import Fog
from simkit.sensors.cameras.rendering.software.background import draw_sky
from simkit.sensors.cameras.rendering.software.frame import Frame, reciprocals_of
from simkit.sensors.cameras.rendering.software.lamps import CornerLight, Lamp
from simkit.sensors.cameras.rendering.software.rasteriser import draw_values, fill_pinholes, nearer
from simkit.sensors.cameras.rendering.software.shadow_maps import Shadow
from simkit.sensors.cameras.rendering.software.shape_meshes import PLANE
from simkit.sensors.cameras.rendering.software.shape_table import ShapeTable
from simkit.sensors.cameras.rendering.software.smoothing import smooth
from simkit.sensors.cameras.rendering.software.textures import TexturedShapes
from simkit.sensors.cameras.rendering.software.triangles import Triangles, VisibleShapes
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, Integers
from simkit.sensors.cameras.rendering.software.visibility import Visibility

_LARGEST_EXPONENT: Final = 16.0  # of the fog's table; exp(-16) is below one step of a colour
_FOG_STEPS: Final = 4096


class ColourImage:
    """Colours of the shapes of one view.

    Args:
        shapes: shapes of the scene.
        table: their properties.
        lamps: lights of the scene.
        textures: textures of the shapes.
        surroundings: background, sky and fog.
        quads: divisions of an edge of a box with uneven light.
        opaque: rows of the opaque shapes.
        glassy: rows of the transparent shapes.
        shadows: shadows of the lamps with shadows, in their order.
    """

    def __init__(
        self,
        shapes: VisibleShapes,
        table: ShapeTable,
        lamps: list[Lamp],
        textures: TexturedShapes,
        surroundings: Surroundings,
        quads: int,
        opaque: Array,
        glassy: Array,
        shadows: Sequence[Shadow],
    ) -> None:
        self._shapes, self._table, self._lamps, self._quads = shapes, table, lamps, quads
        self._textures, self._surroundings, self._shadows = textures, surroundings, shadows
        frame = shapes.frame
        corners = shapes.in_view(shapes.corners(opaque, lamps, quads))
        self._light = CornerLight(table, lamps, frame.eye)
        layers = shapes.lit(corners, self._light)
        self._layers = len(layers)
        layers += [shadow.coordinates(corners.points, corners.normals) for shadow in shadows]
        if textures:
            layers.append(textures.coordinates(corners, frame))
        self.triangles = shapes.triangles(corners, layers)
        order = np.lexsort((-shapes.distances[glassy], table.kinds[glassy] != PLANE))
        self._glassy = glassy[order]

    def draw(self, samples: int) -> tuple[Floats, Floats]:
        """Draw the colours.

        Args:
            samples: samples per pixel for smooth edges; 0 or 1 for none.

        Returns:
            Colours (height, width, 3), and keys of the opaque shapes (height, width).
        """
        frame, triangles = self._shapes.frame, self.triangles
        view, surroundings = frame.view, self._surroundings
        image = np.empty((view.height, view.width, 3), np.float32)
        image[:] = np.array(surroundings.background[:3], np.float32)
        visibility: Visibility | None = None
        if samples > 1 or self._shadows:
            visibility = Visibility(frame, triangles)
            keys = visibility.keys
            draw_values(frame, triangles.points, visibility.faces, triangles.values[0], image, nearer(keys))
            self._add_shadowed_lamps(frame, visibility.faces, image, keys)
        else:
            keys = frame.empty_keys()
            draw_values(frame, triangles.points, triangles.faces, triangles.values[0], image, keys)
        if self._textures:
            self._textures.apply(frame, triangles, triangles.values[-1], image, keys)
        if surroundings.fog is not None:
            _add_fog(surroundings.fog, frame, image, keys)
        if surroundings.sky:
            draw_sky(frame, image, keys)
        fill_pinholes(keys, [image])
        if visibility is not None and samples > 1:
            smooth(visibility, triangles, triangles.values[: self._layers], image, samples)
        for row in self._glassy.tolist():
            self._add_glass(frame, row, image, keys)
        return image, keys

    def _add_shadowed_lamps(self, frame: Frame, faces: Integers, image: Floats, keys: Floats) -> None:
        """Add the light of the lamps with shadows where it reaches the surface."""
        points, values = self.triangles.points, self.triangles.values
        for number, shadow in enumerate(self._shadows):
            light = np.zeros_like(image)
            draw_values(frame, points, faces, values[1 + number], light, nearer(keys))
            where = np.zeros_like(image)
            draw_values(frame, points, faces, values[self._layers + number], where, nearer(keys))
            pixels = np.flatnonzero((light[..., 0] > 0.0) | (light[..., 1] > 0.0) | (light[..., 2] > 0.0))
            share = shadow.shares(where.reshape(-1, 3).take(pixels, axis=0))
            image.reshape(-1, 3)[pixels] += share[:, None] * light.reshape(-1, 3).take(pixels, axis=0)

    def _add_glass(self, frame: Frame, row: int, image: Floats, keys: Floats) -> None:
        """Blend one transparent shape over the image; a nearer opaque shape hides it."""
        shapes = self._shapes
        corners = shapes.corners(np.array([row]), self._lamps, self._quads)
        layers = shapes.lit(corners, self._light)
        total = layers[0]
        for layer in layers[1:]:  # a transparent shape receives no shadows
            total += layer
        values = [np.minimum(total, np.float32(1.0))]
        if self._textures:
            values.append(self._textures.coordinates(corners, shapes.frame))
        triangles = shapes.triangles(corners, values)
        window = _window(frame, triangles)
        if window is None:
            return
        rows, columns = window
        part, behind = frame.part(columns, rows), keys[rows, columns]
        own_keys = behind.copy()
        shape_colours = np.zeros((*own_keys.shape, 3), np.float32)
        draw_values(part, triangles.points, triangles.faces, triangles.values[0], shape_colours, own_keys)
        is_drawn = own_keys < behind
        if self._textures.numbers[row] >= 0:
            self._textures.apply(part, triangles, triangles.values[1], shape_colours, own_keys)
        if self._surroundings.fog is not None:
            _add_fog(self._surroundings.fog, part, shape_colours, own_keys)
        opacity = self._table.colours[row, 3]
        target = image[rows, columns]
        np.minimum(target, np.float32(1.0), out=target)
        pixels = np.nonzero(is_drawn)
        target[pixels] += opacity * (shape_colours[pixels] - target[pixels])


def _window(frame: Frame, triangles: Triangles) -> tuple[slice, slice] | None:
    """Return the rows and columns of the image that triangles may cover; None for no pixel."""
    if not len(triangles.faces):
        return None
    right, up, ahead = frame.in_camera(triangles.points[np.unique(triangles.faces)])
    view = frame.view
    depth = np.maximum(ahead, view.near)
    spans = []
    for tangents, low, high, count in (
        (right / depth, view.left, view.right, view.width),
        (-up / depth, -view.top, -view.bottom, view.height),
    ):
        scale = count / (high - low)
        first = max(0, int(np.floor((float(tangents.min()) - low) * scale)) - 1)
        last = min(count, int(np.ceil((float(tangents.max()) - low) * scale)) + 1)
        if first >= last:
            return None
        spans.append(slice(first, last))
    return spans[1], spans[0]


# ------------------------------------------------------------------ fog


def _add_fog(fog: Fog, frame: Frame, image: Floats, keys: Floats) -> None:
    """Mix the colours of drawn pixels with the fog, in place; pixels without a shape have no fog.

    The fog grows with the depth, as in OpenGL.
    """
    pixels = np.flatnonzero(keys.ravel() < frame.far_key)
    if not len(pixels):
        return
    depths = (1.0 / reciprocals_of(keys.ravel()[pixels])).astype(np.float32)
    if fog.type == "linear":
        end = max(fog.end, fog.start + 1e-3)
        clear = np.clip((np.float32(end) - depths) / np.float32(end - fog.start), 0.0, 1.0)
    else:
        power = np.float32(fog.density) * depths
        clear = _decay(power * power if fog.type == "exp2" else power)
    flat = image.reshape(-1, 3)
    colour = np.array(fog.colour[:3], np.float32)
    seen = np.minimum(flat[pixels], np.float32(1.0))
    flat[pixels] = colour + clear[:, None] * (seen - colour)


def _decay(exponents: Floats) -> Floats:
    """Return exp(-x) from a table with linear interpolation, because NumPy's has other bits on other processors."""
    table = _decay_table()
    place = np.minimum(np.maximum(exponents, np.float32(0.0)), np.float32(_LARGEST_EXPONENT)) * np.float32(
        _FOG_STEPS / _LARGEST_EXPONENT
    )
    step = np.minimum(place.astype(np.int32), _FOG_STEPS - 1)
    low = table.take(step)
    transmittance: Floats = low + (place - step.astype(np.float32)) * (table.take(step + 1) - low)
    return transmittance


@functools.cache
def _decay_table() -> Floats:
    return np.array([math.exp(-_LARGEST_EXPONENT * step / _FOG_STEPS) for step in range(_FOG_STEPS + 1)], np.float32)
