"""Smooth edges: the mean of several samples per pixel, shaded once per pixel as graphics cards do it.

For each sample, the rasteriser draws only which side of which shape it shows. A sample that shows the same side as the
middle of its pixel has the pixel's colour. Another sample has the colour of the neighbouring pixel that shows its side.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from simkit.sensors.cameras.rendering.software.triangles import Triangles
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, Integers, cross
from simkit.sensors.cameras.rendering.software.visibility import Visibility

_FOUR: Final = ((-0.125, -0.375), (0.375, -0.125), (-0.375, 0.125), (0.125, 0.375))
"""Places of four samples in a pixel [px], to the right and downwards, as graphics libraries choose them."""
_EIGHT: Final = (
    (0.0625, -0.1875), (-0.0625, 0.1875), (0.3125, 0.0625), (-0.1875, -0.3125),
    (-0.3125, 0.3125), (-0.4375, -0.0625), (0.1875, 0.4375), (0.4375, -0.4375),
)  # fmt: skip
_SIDES: Final = 6  # sides of one shape: main directions of a normal


def smooth(visibility: Visibility, triangles: Triangles, layers: list[Floats], image: Floats, count: int) -> None:
    """Smooth the edges in an image, in place.

    Args:
        visibility: triangles at the middles of the pixels.
        triangles: triangles of the image.
        layers: layers of light at the corners of `triangles`, each of shape (n, 3).
        image: colours at the middle of each pixel, shape (height, width, 3).
        count: number of samples per pixel.
    """
    np.clip(image, 0.0, 1.0, out=image)
    places = _FOUR if count <= len(_FOUR) else _EIGHT
    values = _side_values(triangles, layers)
    middle = np.append(np.float32(0.0), values[:, 0])[visibility.numbers]
    width = middle.shape[1]
    padded = np.pad(middle, 1, constant_values=-1.0)
    colours = image.reshape(-1, 3)
    change = np.zeros_like(colours)
    for place, drawn in zip(places, visibility.draw_samples(values, places), strict=True):
        pixels = np.flatnonzero(drawn[..., 0] != middle)
        wanted, packed = (drawn[..., k].ravel()[pixels] for k in (0, 1))
        sample_colours = _unpack(packed)
        at = pixels + 2 * (pixels // width) + width + 3  # places in the padded array
        is_open = np.ones(len(pixels), bool)
        for across, down in _neighbours(*place):
            rows = np.flatnonzero(is_open & (padded.ravel()[at + down * (width + 2) + across] == wanted))
            sample_colours[rows] = colours[pixels[rows] + down * width + across]
            is_open[rows] = False
        # a sample of the background that no neighbour shows keeps the colour of its pixel
        lost = is_open & (wanted == 0.0)
        sample_colours[lost] = colours[pixels[lost]]
        change[pixels] += sample_colours - colours[pixels]
    change *= np.float32(1.0 / len(places))
    colours += change


def _side_values(triangles: Triangles, layers: list[Floats]) -> Floats:
    """Return for each face the number of its side, from 1, and its colour as one number, shape (m, 2)."""
    first = triangles.faces[:, 0]
    a, b, c = (triangles.points[triangles.faces[:, k]] for k in range(3))
    sides = _directions(cross(b - a, c - a))
    values = np.empty((len(first), 2), np.float32)
    values[:, 0] = triangles.owners[first] * np.int32(_SIDES) + sides + np.int32(1)
    total = layers[0][first]
    for layer in layers[1:]:
        total += layer[first]
    steps = np.rint(np.clip(total, 0.0, 1.0) * np.float32(255.0))
    values[:, 1] = (steps[:, 0] * np.float32(256.0) + steps[:, 1]) * np.float32(256.0) + steps[:, 2]
    return values


def _neighbours(right: float, down: float) -> list[tuple[int, int]]:
    """Return the eight neighbours of a pixel (columns, rows), first those on the side of a sample."""
    steps = [(x, y) for y in (-1, 0, 1) for x in (-1, 0, 1) if x or y]
    return sorted(steps, key=lambda step: (step[0] - right) ** 2 + (step[1] - down) ** 2)


def _directions(normals: Floats) -> Integers:
    """Return the main direction of each normal, 0 to 5."""
    axis = np.abs(normals).argmax(axis=1)
    main = np.take_along_axis(normals, axis[:, None], 1)[:, 0]
    directions: Integers = (2 * axis + (main < 0.0)).astype(np.int32)
    return directions


def _unpack(packed: Array) -> Floats:
    """Return colours from 24-bit numbers, shape (n, 3)."""
    numbers = packed.astype(np.int32)
    bytes_ = np.stack((numbers >> 16, (numbers >> 8) & 255, numbers & 255), axis=-1)
    colours: Floats = bytes_.astype(np.float32) * np.float32(1.0 / 255.0)
    return colours
