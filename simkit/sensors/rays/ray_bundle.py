"""Rays from one point, and what they hit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit.pose import Vector


@dataclass(slots=True)  # not frozen: that would cost a microsecond for each cast
class RayBundle:
    """Rays from one point.

    Attributes:
        origin: in the world, shape (3,) [m].
        directions: in the world, unit vectors, shape (n, 3).
        start: how far from the origin they begin [m].
        reach: what is farther does not count [m].
        limit: its bits (see `finite_limit_bits`).
        axis: unit vector in the world, shape (3,).
        lowest, highest: angles between which the rays leave the plane across the axis [rad].
    """

    origin: Vector
    directions: Vector
    start: float
    reach: float
    limit: npt.NDArray[np.uint64]
    axis: Vector
    lowest: float
    highest: float


RayHits = tuple[Vector, npt.NDArray[np.int32], npt.NDArray[np.bool_]]
"""Distances [m], infinite where nothing is hit; geoms, -1 for nothing; and where the distances are infinite."""


def reaches_plane(rays: RayBundle, point: Sequence[float], normal: Sequence[float]) -> bool:
    """Whether a ray may come down on a plane through a point within the reach; never wrongly False."""
    (x, y, z), (ax, ay, az), (nx, ny, nz) = rays.origin.tolist(), rays.axis.tolist(), normal
    height = nx * (x - point[0]) + ny * (y - point[1]) + nz * (z - point[2])
    steepest = max(abs(rays.lowest), abs(rays.highest))
    tilt = math.acos(min(1.0, abs(nx * ax + ny * ay + nz * az))) + steepest
    fall = rays.reach * math.sin(tilt) if tilt < math.pi / 2 else rays.reach
    return bool(0.0 <= height <= fall * (1 + 1e-9) + 1e-9)


def finite_limit_bits(reach: float) -> npt.NDArray[np.uint64]:
    """The bits of the longest finite distance that counts, for comparing many at once."""
    return np.array(min(reach, float(np.finfo(np.float64).max))).view(np.uint64)
