"""Background of an image: a colour, or a sky of coloured rings at infinity as OpenGL's renderer draws it."""

from __future__ import annotations

import functools
import itertools
import math
from typing import Final

import numpy as np

from simkit.sensors.cameras.rendering.sky_and_fog import SKY_ELEVATIONS, SKY_SIDES, sky_colour
from simkit.sensors.cameras.rendering.software.clipping import clip
from simkit.sensors.cameras.rendering.software.frame import Frame
from simkit.sensors.cameras.rendering.software.rasteriser import draw_values
from simkit.sensors.cameras.rendering.software.vectors import Floats, Integers

_RADIUS: Final = 1e7
"""Radius [m] of the drawn sky: its directions keep seven digits, and each shape is nearer."""
_BEYOND: Final = np.float32(4.0)  # a key farther than all depths


def draw_sky(frame: Frame, image: Floats, keys: Floats) -> None:
    """Draw the sky into the pixels without a shape."""
    directions, colours, faces = _rings()
    points = (directions * _RADIUS + frame.eye).astype(np.float32)
    uncut_faces, new_points, new_colours, _ = clip(frame, points, colours, faces)
    new_faces = (len(points) + np.arange(len(new_points), dtype=np.int32)).reshape(-1, 3)
    behind = np.where(keys == frame.far_key, _BEYOND, keys)
    draw_values(
        frame,
        np.concatenate((points, new_points)),
        np.concatenate((uncut_faces, new_faces)),
        np.concatenate((colours, new_colours)),
        image,
        behind,
    )


@functools.cache
def _rings() -> tuple[Floats, Floats, Integers]:
    """Return directions (n, 3), colours (n, 3) and faces of the sky, visible from inside."""
    directions: list[tuple[float, float, float]] = []
    colours: list[tuple[float, float, float]] = []
    faces: list[tuple[int, int, int]] = []
    for low, high in itertools.pairwise(SKY_ELEVATIONS):
        start = len(directions)
        for side in range(SKY_SIDES + 1):
            turn = 2.0 * math.pi * (side % SKY_SIDES) / SKY_SIDES
            for elevation in (low, high):
                angle = math.radians(elevation)
                flat = math.cos(angle)
                directions.append((flat * math.cos(turn), flat * math.sin(turn), math.sin(angle)))
                colours.append(sky_colour(elevation))
        for first in range(start, start + 2 * SKY_SIDES, 2):
            faces += [(first, first + 1, first + 2), (first + 1, first + 3, first + 2)]
    return (
        np.array(directions, np.float32),
        np.array(colours, np.float32),
        np.array(faces, np.int32),
    )
