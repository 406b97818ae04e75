"""Frame of one image: the camera's pose and frustum as the matrix and the depths that OpenCV's rasteriser needs.

`triangleRasterize` knows only symmetric frusta and stores A - B/depth in single precision. The matrix here shears and
scales any frustum into a symmetric one of 90 degrees. Its planes are at 2^30 and 2^31, far behind the scene. The stored
value is then 2 - 2^31/depth, which keeps seven digits of the depth at every distance. It is called the key of a pixel.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from simkit.sensors.cameras.rendering.software.vectors import Array, Floats
from simkit.sensors.cameras.rendering.view import Depths, View, depth_line

NEAR: Final = 2.0**30
FAR: Final = 2.0**31
_SHIFT: Final = (1.9e-5, 1.3e-5)
"""Shift of the image [px] in x and y. Edges would else pass exactly through centres of pixels if the camera is parallel
to an axis, and the rasteriser may then draw neither of two neighbours."""


class Frame:
    """Pose and frustum of one image.

    Args:
        view: image size and frustum.
        position: position of the camera in the world [m], shape (3,).
        rotation: rotation matrix of the camera (x forward, y left, z up), shape (3, 3).
        origin: point of the world near the camera [m], shape (3,).
        shift: factor of a tiny shift of the image that keeps edges off the centres of pixels.

    Attributes:
        view: image size and frustum.
        eye: position of the camera relative to `origin` [m], shape (3,).
        origin: point of the world [m] to which all drawn points are relative, so that single precision suffices.
        half: half width and half height of the frustum at the distance 1.
        ahead, right, up: axes of the camera in the world, shape (3,).
        matrix: matrix for OpenCV, shape (4, 4).
        far_key: key of the far plane; the key of a pixel without a shape.
    """

    def __init__(self, view: View, position: Array, rotation: Array, origin: Array, shift: float = 1.0) -> None:
        self.view, self.origin, self._shift = view, origin, shift
        self._position, self._rotation = position, rotation
        self.eye = np.asarray(position, np.float64) - origin
        self.ahead, self.right, self.up = rotation[:, 0].copy(), -rotation[:, 1], rotation[:, 2].copy()
        self.half = (view.right - view.left) / 2.0, (view.top - view.bottom) / 2.0
        middle_x = (view.right + view.left) / 2.0 - shift * _SHIFT[0] * 2.0 * self.half[0] / view.width
        middle_y = (view.top + view.bottom) / 2.0 - shift * _SHIFT[1] * 2.0 * self.half[1] / view.height
        wide, high = self.half[0] * view.height / view.width, self.half[1]
        rows = (self.right - middle_x * self.ahead) / wide, (self.up - middle_y * self.ahead) / high, -self.ahead
        self.matrix = np.eye(4)
        for number, row in enumerate(rows):
            self.matrix[number, :3] = row
            x, y, z = row * self.eye
            self.matrix[number, 3] = -float(x + y + z)
        self.far_key = np.float32(2.0 - FAR / view.far)
        self.pixels_per_tangent = max(view.width / (2.0 * self.half[0]), view.height / (2.0 * self.half[1]))

    def moved(self, columns: float, rows: float) -> Frame:
        """Return the frame of an image that is moved by a part of a pixel, to the right and downwards."""
        view = self.view
        x, y = columns * 2.0 * self.half[0] / view.width, -rows * 2.0 * self.half[1] / view.height
        moved = replace(view, left=view.left + x, right=view.right + x, bottom=view.bottom + y, top=view.top + y)
        return Frame(moved, self._position, self._rotation, self.origin, self._shift)

    def part(self, columns: slice, rows: slice) -> Frame:
        """Return the frame of a part of the image."""
        view = self.view
        across, down = 2.0 * self.half[0] / view.width, 2.0 * self.half[1] / view.height
        cut = replace(
            view,
            width=columns.stop - columns.start,
            height=rows.stop - rows.start,
            left=view.left + columns.start * across,
            right=view.left + columns.stop * across,
            top=view.top - rows.start * down,
            bottom=view.top - rows.stop * down,
        )
        return Frame(cut, self._position, self._rotation, self.origin, self._shift)

    def in_camera(self, points: Array) -> tuple[Array, Array, Array]:
        """Return the coordinates of points to the right, up and ahead of the camera [m], each of shape (n,)."""
        away = points.astype(np.float64) - self.eye
        x, y, z = away[:, 0], away[:, 1], away[:, 2]
        right, up, ahead = (x * axis[0] + y * axis[1] + z * axis[2] for axis in (self.right, self.up, self.ahead))
        return right, up, ahead

    def from_camera(self, right: Array, up: Array, ahead: Array) -> Floats:
        """Return the points at coordinates of the camera, shape (n, 3)."""
        points = np.empty((len(right), 3), np.float32)
        for axis in range(3):
            points[:, axis] = self.eye[axis] + right * self.right[axis] + up * self.up[axis] + ahead * self.ahead[axis]
        return points

    def empty_keys(self) -> Floats:
        """Return the keys of an image without shapes, shape (height, width)."""
        return np.full((self.view.height, self.view.width), self.far_key, np.float32)

    def columns(self) -> Array:
        """Return the tangents of the columns' centres to the right, shape (width,)."""
        step = 2.0 * self.half[0] / self.view.width
        tangents: Array = self.view.left + (np.arange(self.view.width) + 0.5) * step
        return tangents

    def rows(self) -> Array:
        """Return the tangents of the rows' centres upwards, first the top row, shape (height,)."""
        step = 2.0 * self.half[1] / self.view.height
        tangents: Array = self.view.top - (np.arange(self.view.height) + 0.5) * step
        return tangents

    def raw_depths(self, keys: Floats) -> Depths:
        """Return raw depths of keys, which `depth_line` converts to metres: 1 at the near plane, 0 without a shape."""
        slope, offset = (float(number) for number in depth_line(self.view.near, self.view.far))
        depths: Depths = np.subtract(self.far_key, keys)
        depths *= np.float32(slope / FAR)
        # the difference is that to the far plane, without cancellation; its raw depth is not exactly 0
        depths += np.float32(slope / self.view.far - offset)
        depths[keys >= self.far_key] = 0.0
        return depths

    def raw_of(self, reciprocals: Array) -> Array:
        """Return raw depths of reciprocal depths [1/m]."""
        slope, offset = (float(number) for number in depth_line(self.view.near, self.view.far))
        raw: Array = reciprocals * slope - offset
        return raw


def reciprocals_of(keys: Floats) -> Array:
    """Return the reciprocal depths [1/m] of keys."""
    reciprocals: Array = (2.0 - keys.astype(np.float64)) / FAR
    return reciprocals
