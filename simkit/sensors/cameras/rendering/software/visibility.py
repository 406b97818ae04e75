"""Visible triangles of an image, so that further drawings need only these."""

from __future__ import annotations

from typing import Final

import numpy as np

from simkit.sensors.cameras.rendering.software.frame import FAR, Frame
from simkit.sensors.cameras.rendering.software.rasteriser import draw_flat, draw_numbers
from simkit.sensors.cameras.rendering.software.triangles import Triangles
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, Integers

_SMALL: Final = 4.0  # area [px²] of a triangle that may be visible between the middles of pixels
_THIN: Final = 1.5  # height [px] of such a triangle
_SHORT: Final = 4.0  # length [px] up to which a triangle is compared with the depths around its middle


class Visibility:
    """Triangle at each pixel of an image.

    Args:
        frame: frame of the image.
        triangles: triangles of the image.

    Attributes:
        keys: keys of the pixels, shape (height, width).
        numbers: number of the face at each pixel plus 1, 0 without a shape, shape (height, width).
        faces: visible faces, shape (m, 3).
    """

    def __init__(self, frame: Frame, triangles: Triangles) -> None:
        self._triangles, self._frame = triangles, frame
        faces = triangles.faces
        # a flat triangle has the value of its first corner, so triangles may not share corners here
        self._points = triangles.points[faces.ravel()]
        self._faces: Integers = np.arange(3 * len(faces), dtype=np.int32).reshape(-1, 3)
        self.keys = frame.empty_keys()
        image = np.zeros((*self.keys.shape, 3), np.float32)
        numbers = np.repeat(np.arange(1, len(faces) + 1, dtype=np.int32), 3)
        draw_numbers(frame, self._points, self._faces, numbers, image, self.keys)
        self.numbers: Integers = image[..., 0].astype(np.int32)
        counts = np.bincount(self.numbers.ravel(), minlength=len(faces) + 1)
        self._is_seen = counts[1:] > 0
        self.faces: Integers = faces[self._is_seen]

    def draw_samples(self, values: Floats, places: tuple[tuple[float, float], ...]) -> list[Floats]:
        """Draw values of faces at other places of the pixels.

        Args:
            values: two values for each face, shape (m, 2).
            places: places in a pixel relative to its middle [px], to the right and downwards.

        Returns:
            Values at the pixels for each place, 0 without a shape, shape (height, width, 2) each.
        """
        chosen = np.flatnonzero(self._is_seen | self._may_hide())
        points = np.ascontiguousarray(self._points.reshape(-1, 3, 3)[chosen]).reshape(-1, 3)
        faces = self._faces[: len(chosen)]
        of_corners = np.zeros((len(points), 3), np.float32)
        of_corners[:, :2] = np.repeat(values[chosen], 3, axis=0)
        drawn = []
        for place in places:
            image = np.zeros((*self.keys.shape, 3), np.float32)
            draw_flat(self._frame.moved(*place), points, faces, of_corners, image, self._frame.empty_keys())
            drawn.append(image[..., :2])
        return drawn

    def _may_hide(self) -> Array:
        """Return True for each face that may lie between the middles of pixels: small or thin, and not covered."""
        import cv2

        frame, faces = self._frame, self._triangles.faces
        view = frame.view
        right, up, ahead = frame.in_camera(self._triangles.points)
        depth = np.maximum(ahead, 0.5 * view.near)
        x = ((right / depth - view.left) * (view.width / (view.right - view.left)))[faces]
        y = ((view.top - up / depth) * (view.height / (view.top - view.bottom)))[faces]
        sides = [(x[:, k] - x[:, k - 1], y[:, k] - y[:, k - 1]) for k in range(3)]
        area = sides[0][1] * sides[1][0] - sides[0][0] * sides[1][1]  # positive for a front, because y is downwards
        longest = np.sqrt(np.max([dx * dx + dy * dy for dx, dy in sides], axis=0))
        column, row = np.floor(x.mean(axis=1)), np.floor(y.mean(axis=1))
        may_hide: Array = (area > 0.0) & ((0.5 * area < _SMALL) | (area < _THIN * longest))
        short = longest < _SHORT
        inside = (column >= 0) & (row >= 0) & (column < view.width) & (row < view.height)
        may_hide &= inside | ~short
        checked = np.flatnonzero(may_hide & short)
        farthest = cv2.dilate(self.keys, np.ones((5, 5), np.uint8))
        around = farthest[row[checked].astype(np.intp), column[checked].astype(np.intp)]
        may_hide[checked] = 2.0 - FAR / depth[faces[checked]].mean(axis=1) <= around
        return may_hide
