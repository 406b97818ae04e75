"""Calls of OpenCV's triangle rasteriser."""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.sensors.cameras.rendering.software.frame import FAR, NEAR, Frame
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, Integers

if TYPE_CHECKING:
    import cv2


_ANGLE: Final = math.pi / 2  # [rad] opening angle of OpenCV's camera; the matrix of the frame does the rest


def draw_values(frame: Frame, points: Floats, faces: Integers, values: Floats, image: Floats, keys: Floats) -> None:
    """Draw values of corners, interpolated in perspective, where a triangle is nearer than the keys; update both.

    Args:
        frame: pose and frustum.
        points: positions relative to the frame's origin [m], shape (n, 3).
        faces: corners of triangles, counter-clockwise from the visible side, shape (m, 3).
        values: three values per corner, shape (n, 3).
        image: values at the pixels, shape (height, width, 3).
        keys: keys of the pixels, shape (height, width).
    """
    _rasterize(frame, points, faces, values, image, keys, _settings(False))


def nearer(keys: Floats) -> Floats:
    """Return keys that only the same surface passes: a triangle that is drawn again has the same key as before."""
    return np.nextafter(keys, np.float32(np.inf))


def draw_numbers(frame: Frame, points: Floats, faces: Integers, numbers: Integers, image: Floats, keys: Floats) -> None:
    """Draw the number of each triangle's first corner into the first channel; numbers below 2^24 are exact."""
    values = np.zeros((len(points), 3), np.float32)
    values[:, 0] = numbers
    draw_flat(frame, points, faces, values, image, keys)


def draw_flat(frame: Frame, points: Floats, faces: Integers, values: Floats, image: Floats, keys: Floats) -> None:
    """Draw the three values of each triangle's first corner; see `draw_values`."""
    _rasterize(frame, points, faces, values, image, keys, _settings(True))


def _rasterize(
    frame: Frame,
    points: Floats,
    faces: Integers,
    values: Floats,
    image: Floats,
    keys: Floats,
    settings: cv2.TriangleRasterizeSettings,
) -> None:
    import cv2

    if len(faces):
        cv2.triangleRasterize(
            points[None], faces[None], values[None], image, keys, frame.matrix, _ANGLE, NEAR, FAR, settings
        )


def draw_keys(matrix: Array, points: Floats, faces: Integers, keys: Floats, both_sides: bool = False) -> None:
    """Draw only the keys of triangles, with a matrix for OpenCV of shape (4, 4)."""
    import cv2

    if len(faces):
        cv2.triangleRasterizeDepth(
            points[None], faces[None], keys, matrix, _ANGLE, NEAR, FAR, _settings(True, both_sides)
        )


@functools.lru_cache(maxsize=4)
def _settings(is_flat: bool, both_sides: bool = False) -> cv2.TriangleRasterizeSettings:
    import cv2

    settings = cv2.TriangleRasterizeSettings()
    settings.setShadingType(cv2.RASTERIZE_SHADING_FLAT if is_flat else cv2.RASTERIZE_SHADING_SHADED)
    settings.setCullingMode(cv2.RASTERIZE_CULLING_NONE if both_sides else cv2.RASTERIZE_CULLING_CW)
    settings.setGlCompatibleMode(cv2.RASTERIZE_COMPAT_INVDEPTH)
    return settings


def fill_pinholes(keys: Floats, images: list[Array]) -> None:
    """Give pixels that lie clearly behind all their eight neighbours the values of a neighbour, in place.

    Rounding may leave a pixel open on the common edge of two large triangles.
    """
    import cv2

    around = cv2.dilate(keys, _ring(), borderType=cv2.BORDER_REPLICATE)
    around *= np.float32(0.98)  # keys are negative, so this is 2 % farther
    holes = np.flatnonzero(cv2.compare(keys, around, cv2.CMP_GT))
    if not len(holes):
        return
    width = keys.shape[1]
    sources = np.where(holes % width > 0, holes - 1, holes + 1)
    for image in (keys, *images):
        flat = image.reshape(keys.size, -1)
        flat[holes] = flat[sources]


@functools.cache
def _ring() -> Array:
    ring = np.ones((3, 3), np.uint8)
    ring[1, 1] = 0
    return ring
