"""Range of a camera's depths: conversion of raw depths of the frame buffer to metres, infinite outside the range."""

from __future__ import annotations

import functools
import math

import numpy as np

from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.rendering.view import Depths, View, depth_line

_ROWS = 32  # number of rows processed at once; so few stay in the processor's cache for all operations
# ratio of the drawn near plane to `near`; Gazebo uses 0.9, but then the housing of the lens may hide the image
_NEARER = 0.1
_STEP = 2.0**-24  # step of raw depths: half of the last bit of a float just above 1
_ROUNDING = 2.0**-21  # relative rounding of a 32-bit depth


def clip_planes(near: float, far: float) -> tuple[float, float]:
    """Return clip planes for drawing, so that objects nearer than `near` are visible and depths are exact.

    The near plane is a power of two and the far plane has few digits. Their sum and difference then have no rounding
    error, and every graphics library computes the same quotient. The far plane is moved away by the possible error of
    the quotient (0.6 % for 0.1 and 100 m).

    Args:
        near: start of the visible range [m].
        far: end of the visible range [m].
    """
    drawn = 2.0 ** math.floor(math.log2(near * _NEARER))
    reciprocal = 1.0 / far - _STEP / drawn
    if reciprocal <= _STEP / drawn:
        return drawn, drawn * 2.0**30  # a far plane at this distance has no effect with 32-bit depths
    mantissa, exponent = math.frexp(1.0 / reciprocal)
    return drawn, math.ldexp(math.ceil(mantissa * 2.0**12), exponent - 12)


class DepthRange:
    """Range of depths of one camera.

    A depth is +inf if the straight distance to the camera is `<clip><far>` or more, or if the distance along the axis
    exceeds `far`. A depth is -inf if the distance along the axis is below both `<clip><near>` and `near`
    (gz-rendering, depth_camera_fs.glsl; gz-sensors, RgbdCameraSensor.cc).

    Args:
        model: model of the camera.
        near, far: range of the depths [m].
    """

    def __init__(self, model: CameraModel, near: float, far: float) -> None:
        self._lowest = max(model.near, near)
        left, up = model.rays()
        squares = left * left + (up if up.ndim == 2 else up[:, None]) ** 2
        stretch: Depths = np.sqrt(1 + squares, dtype=np.float32)  # ratio of distance to depth at each pixel
        stretch[np.isnan(stretch)] = np.inf  # the lens shows nothing there
        after = np.nextafter(np.float32(min(far, model.far)), np.float32(np.inf))
        # smallest depth at each pixel that becomes infinite
        self._limit: Depths = np.minimum(np.float32(model.far * (1 - _ROUNDING)) / stretch, after)
        self._least = float(self._limit.min())

    def metres(self, raw: Depths, view: View, out: Depths) -> Depths:
        """Convert raw depths, shape (h, w), to depths along the optical axis [m].

        Args:
            raw: depths drawn through `view`, and distorted if the camera's lens distorts; 0 means no object.
            view: view that the raw depths were drawn through.
            out: contiguous output array.
        """
        slope, offset = depth_line(view.near, view.far)
        with np.errstate(divide="ignore"):
            for first in range(0, len(raw), _ROWS):
                rows = slice(first, first + _ROWS)
                part = out[rows]
                np.add(raw[rows], offset, out=part)
                np.divide(slope, part, out=part)
                self._clip_rows(part, self._limit[rows])
        return out

    def clip(self, depths: Depths) -> Depths:
        """Apply the range again in place to depths [m] with noise."""
        for first in range(0, len(depths), _ROWS):
            rows = slice(first, first + _ROWS)
            self._clip_rows(depths[rows], self._limit[rows])
        return depths

    def _clip_rows(self, part: Depths, limit: Depths) -> None:
        """Apply the range to a few rows."""
        import cv2

        if np.maximum.reduce(part, axis=None) >= self._least:  # the check avoids reading the limits from memory
            cv2.copyTo(_constant_row(part.shape[1], np.inf)[: len(part)], cv2.compare(part, limit, cv2.CMP_GE), part)
        nearest = np.float32(self._lowest)
        if self._lowest > 0 and np.minimum.reduce(part, axis=None) < nearest:
            too_near = cv2.compare(part, float(nearest), cv2.CMP_LT)
            cv2.copyTo(_constant_row(part.shape[1], -np.inf)[: len(part)], too_near, part)


@functools.lru_cache(maxsize=8)
def _constant_row(width: int, value: float) -> Depths:
    return np.full((_ROWS, width), value, dtype=np.float32)
