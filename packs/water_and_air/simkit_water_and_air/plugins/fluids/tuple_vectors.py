"""Vectors as tuples of three Python floats, which are several times faster than arrays for single vectors."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

Triple = tuple[float, float, float]
ZERO: Final[Triple] = (0.0, 0.0, 0.0)
"""Zero vector."""


def unit(v: Triple) -> Triple:
    """Return the vector scaled to length 1; a zero vector stays zero."""
    largest = max(abs(v[0]), abs(v[1]), abs(v[2]))
    if largest == 0.0:
        return ZERO
    scaled = (v[0] / largest, v[1] / largest, v[2] / largest)
    length = math.sqrt(dot(scaled, scaled))
    return scaled[0] / length, scaled[1] / length, scaled[2] / length


def perpendicular(v: Triple) -> Triple:
    """Return a unit vector at a right angle to `v`."""
    axis = min(range(3), key=lambda i: abs(v[i]))
    return unit(cross(v, (float(axis == 0), float(axis == 1), float(axis == 2))))


def dot(a: Sequence[float], b: Sequence[float]) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Sequence[float], b: Sequence[float]) -> Triple:
    """Return the vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def scaled(v: Triple, by: float) -> Triple:
    """Return the vector times a number."""
    return v[0] * by, v[1] * by, v[2] * by


def to_world_axes(axes: Sequence[float], v: Triple) -> Triple:
    """Rotate a vector from the link's frame into the world; the matrix is row-major."""
    x, y, z = v
    return (
        axes[0] * x + axes[1] * y + axes[2] * z,
        axes[3] * x + axes[4] * y + axes[5] * z,
        axes[6] * x + axes[7] * y + axes[8] * z,
    )


def to_link_axes(axes: Sequence[float], v: Triple) -> Triple:
    """Rotate a vector from the world into the link's frame; the matrix is that of the link, row-major."""
    x, y, z = v
    return (
        axes[0] * x + axes[3] * y + axes[6] * z,
        axes[1] * x + axes[4] * y + axes[7] * z,
        axes[2] * x + axes[5] * y + axes[8] * z,
    )
