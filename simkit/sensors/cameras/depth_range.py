"""Range of a camera's depths: from raw depths of the frame buffer to metres, infinite outside the range."""

from __future__ import annotations

import functools
import math

import numpy as np

from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.rendering.view import Depths, View

_ROWS = 32  # at once: so many fit into a processor's cache, and what is done to them costs no more memory traffic
_NEARER = 0.1  # of the near plane: where it is drawn from; Gazebo takes 0.9, and what houses a lens is not to blind it
_STEP = 2.0**-24  # of raw depths: half of the last bit of a number just above 1
_ROUNDING = 2.0**-21  # of a depth, in 32 bits


def clip_planes(near: float, far: float) -> tuple[float, float]:
    """Clip planes to be drawn with, so that what is nearer than `near` is seen and depths are exact.

    The near plane is a power of two and the far plane has few digits, so that their sum and difference have no rounding
    error and every graphics library gets the same quotient. The far plane is moved away by what the quotient may lose
    (0.6 % for 0.1 and 100 m).

    Args:
        near, far: what is to be seen [m].
    """
    drawn = 2.0 ** math.floor(math.log2(near * _NEARER))
    reciprocal = 1.0 / far - _STEP / drawn
    if reciprocal <= _STEP / drawn:
        return drawn, drawn * 2.0**30  # what is a far plane here is nowhere for 32 bits
    mantissa, exponent = math.frexp(1.0 / reciprocal)
    return drawn, math.ldexp(math.ceil(mantissa * 2.0**12), exponent - 12)


class DepthRange:
    """The range of depths of one camera.

    What is as far from the camera as `<clip><far>`, in a straight line, has depth +inf; so has what is farther along
    the axis than the depths' own range. What is nearer along the axis than both ranges begin has -inf
    (gz-rendering, depth_camera_fs.glsl; gz-sensors, RgbdCameraSensor.cc).

    Args:
        model: the camera.
        near, far: the depths' own range [m].
    """

    def __init__(self, model: CameraModel, near: float, far: float) -> None:
        self._lowest = max(model.near, near)
        left, up = model.rays()
        squares = left * left + (up if up.ndim == 2 else up[:, None]) ** 2
        stretch: Depths = np.sqrt(1 + squares, dtype=np.float32)  # distance over depth of each pixel
        stretch[np.isnan(stretch)] = np.inf  # where a lens shows nothing
        after = np.nextafter(np.float32(min(far, model.far)), np.float32(np.inf))
        # from which depth on there is nothing, for each pixel
        self._limit: Depths = np.minimum(np.float32(model.far * (1 - _ROUNDING)) / stretch, after)
        self._least = float(self._limit.min())

    def metres(self, raw: Depths, view: View, out: Depths) -> Depths:
        """Depths along the optical axis [m] of raw ones, shape (h, w).

        Args:
            raw: drawn through `view`, and bent where the camera's lens bends; 0 is nothing.
            out: contiguous, to be written to.
        """
        slope, offset = _depth_line(view.near, view.far)
        with np.errstate(divide="ignore"):
            for first in range(0, len(raw), _ROWS):
                rows = slice(first, first + _ROWS)
                part = out[rows]
                np.add(raw[rows], offset, out=part)
                np.divide(slope, part, out=part)
                self._clip_rows(part, self._limit[rows])
        return out

    def clip(self, depths: Depths) -> Depths:
        """The same rule again in place, for depths [m] that noise was added to."""
        for first in range(0, len(depths), _ROWS):
            rows = slice(first, first + _ROWS)
            self._clip_rows(depths[rows], self._limit[rows])
        return depths

    def _clip_rows(self, part: Depths, limit: Depths) -> None:
        """The same for a few rows."""
        import cv2

        if np.maximum.reduce(part, axis=None) >= self._least:  # else the limit itself need not be fetched from memory
            cv2.copyTo(_constant_row(part.shape[1], np.inf)[: len(part)], cv2.compare(part, limit, cv2.CMP_GE), part)
        nearest = np.float32(self._lowest)
        if self._lowest > 0 and np.minimum.reduce(part, axis=None) < nearest:
            too_near = cv2.compare(part, float(nearest), cv2.CMP_LT)
            cv2.copyTo(_constant_row(part.shape[1], -np.inf)[: len(part)], too_near, part)


def _depth_line(near: float, far: float) -> tuple[np.float32, np.float32]:
    """z = slope/(raw + offset), as the graphics library has it.

    Its matrix is that of `glFrustum`, moved and scaled by ½ (mjr_render): raw = slope/z - offset with slope =
    near·far/(far - near) and offset = ½·((far + near)/(far - near) - 1), where the quotient has 32 bits.
    """
    near, far = float(np.float32(near)), float(np.float32(far))
    quotient = float(np.float32((far + near) / (far - near)))
    return np.float32(near * far / (far - near)), np.float32(0.5 * (quotient - 1.0))


@functools.lru_cache(maxsize=8)
def _constant_row(width: int, value: float) -> Depths:
    return np.full((_ROWS, width), value, dtype=np.float32)
