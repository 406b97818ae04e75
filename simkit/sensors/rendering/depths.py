"""Depths in metres, of what the graphics library gives.

The engine draws with the depth reversed: 1 at the near plane, 0 at the far plane, in 32 bits. So depths would be as
exact far away as close by, if the library did not keep (far + near)/(far - near), a number just above 1, in 32 bits as
well: what is cut off there is a shift of 1e-8 of all raw depths, 1.6 mm at 50 m. What is cut off is known, and put back
(`_line`): depths are exact to 2e-7 of themselves, however near the near plane is.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from simkit.sensors.rendering.view import Depths

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


def limit_of(highest: float, reach: float, stretch: Depths) -> Depths:
    """From which depth on [m] there is nothing, for each pixel; for `metres` and `clip_depths`.

    Args:
        highest: the farthest depth along the optical axis that there is [m].
        reach: at this distance from the camera, and farther, there is nothing [m].
        stretch: distance over depth of each pixel, shape (h, w).
    """
    after = np.nextafter(np.float32(highest), np.float32(np.inf))
    limit: Depths = np.minimum(np.float32(reach * (1 - _ROUNDING)) / stretch, after)
    return limit


def metres(
    raw: Depths,
    near: float,
    far: float,
    lowest: float = 0.0,
    limit: Depths | None = None,
    out: Depths | None = None,
    *,
    least: float = 0.0,
) -> Depths:
    """Distances along the optical axis [m] of raw depths.

    Args:
        raw: shape (h, w), of a picture; 0 is nothing.
        near, far: clip planes of the picture [m].
        lowest: what is nearer becomes -inf [m].
        limit: what is as far or farther becomes +inf [m], shape (h, w); None is all that there is.
        out: contiguous, shape (h, w), to be written to.
        least: the smallest of `limit`, where it is known.
    """
    import cv2

    if out is None:
        out = np.empty(raw.shape, np.float32)
    slope, offset = _line(near, far)
    infinite = _filled(raw.shape[1], np.inf)
    with np.errstate(divide="ignore"):
        for first in range(0, len(raw), _ROWS):
            rows = slice(first, first + _ROWS)
            part = out[rows]
            np.add(raw[rows], offset, out=part)
            np.divide(slope, part, out=part)
            if limit is not None:
                _bound(part, lowest, limit[rows], least)
            else:
                cv2.copyTo(infinite[: len(part)], cv2.compare(np.ascontiguousarray(raw[rows]), 0.0, cv2.CMP_EQ), part)
    return out


def clip_depths(depths: Depths, lowest: float, limit: Depths, *, least: float = 0.0) -> Depths:
    """+inf from `limit` on, whose smallest value is `least`, -inf nearer than `lowest` [m], in place; shapes (h, w)."""
    for first in range(0, len(depths), _ROWS):
        rows = slice(first, first + _ROWS)
        _bound(depths[rows], lowest, limit[rows], least)
    return depths


def _bound(part: Depths, lowest: float, limit: Depths, least: float) -> None:
    """The same for a few rows."""
    import cv2

    if np.maximum.reduce(part, axis=None) >= least:  # else the limit itself need not be fetched from memory
        cv2.copyTo(_filled(part.shape[1], np.inf)[: len(part)], cv2.compare(part, limit, cv2.CMP_GE), part)
    nearest = np.float32(lowest)
    if lowest > 0 and np.minimum.reduce(part, axis=None) < nearest:
        too_near = cv2.compare(part, float(nearest), cv2.CMP_LT)
        cv2.copyTo(_filled(part.shape[1], -np.inf)[: len(part)], too_near, part)


def _line(near: float, far: float) -> tuple[np.float32, np.float32]:
    """z = slope/(raw + offset), as the graphics library has it.

    Its matrix is that of `glFrustum`, moved and scaled by ½ (mjr_render): raw = slope/z - offset with slope =
    near·far/(far - near) and offset = ½·((far + near)/(far - near) - 1), where the quotient has 32 bits.
    """
    near, far = float(np.float32(near)), float(np.float32(far))
    quotient = float(np.float32((far + near) / (far - near)))
    return np.float32(near * far / (far - near)), np.float32(0.5 * (quotient - 1.0))


@functools.lru_cache(maxsize=8)
def _filled(width: int, value: float) -> Depths:
    return np.full((_ROWS, width), value, dtype=np.float32)
