"""Depths in metres, of what the graphics library gives."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

from simkit.sensors.rendering.view import Depths

_ROWS = 32  # at once: so many fit into a processor's cache, and what is done to them costs no more memory traffic


def metres(
    raw: Depths, near: float, far: float, lowest: float = 0.0, highest: float = np.inf, out: Depths | None = None
) -> Depths:
    """Distances along the optical axis [m] of raw depths.

    Args:
        raw: shape (h, w), of a picture.
        near, far: clip planes of the picture [m].
        lowest, highest: what is nearer becomes -inf, what is farther +inf, as does what has nothing up to `far` [m].
        out: contiguous, shape (h, w), to be written to.
    """
    import cv2

    if out is None:
        out = np.empty(raw.shape, np.float32)
    scale, least = np.float32((far - near) / (near * far)), np.float32(1.0 / far)
    one, infinite = np.float32(1.0), _filled(raw.shape[1], np.inf)
    ends_before = highest < far
    bound, nearest = float(np.float32(highest)), np.float32(lowest)
    for first in range(0, len(raw), _ROWS):
        part = out[first : first + _ROWS]
        np.copyto(part, raw[first : first + _ROWS])
        beyond: Any = None if ends_before else cv2.compare(part, 0.0, cv2.CMP_EQ)
        np.multiply(part, scale, out=part)
        np.add(part, least, out=part)
        np.divide(one, part, out=part)
        if ends_before:
            beyond = cv2.compare(part, bound, cv2.CMP_GT)
        cv2.copyTo(infinite[: len(part)], beyond, part)
        if lowest > 0 and np.minimum.reduce(part, axis=None) < nearest:
            np.copyto(part, np.float32(-np.inf), where=part < nearest)
    return out


@functools.lru_cache(maxsize=8)
def _filled(width: int, value: float) -> Depths:
    return np.full((_ROWS, width), value, dtype=np.float32)


def clip_depths(depths: Depths, near: float, far: float) -> Depths:
    """+inf beyond `far`, -inf nearer than `near` [m], in place."""
    if far < np.inf:
        np.copyto(depths, np.float32(np.inf), where=depths > np.float32(far))
    if depths.min() < near:
        np.copyto(depths, np.float32(-np.inf), where=depths < np.float32(near))
    return depths
