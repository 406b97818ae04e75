"""Poses of bodies at the times of the rays of a scan, interpolated between the ticks.

Positions are interpolated linearly, and orientations along the shortest rotation (slerp). For a free body this is the
motion that the engine's integrators assume within a step.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from simkit.elementary_functions import arcsin, each
from simkit.pose import Vector
from simkit.runtime.engine.pose_history import PoseRows
from simkit.sensors.rays.geom_types import Ids

_SMALL_CHORD = 0.04
"""Square of the distance between two unit quaternions up to which the series below are exact to 1e-12."""


class Poses(NamedTuple):
    """Positions and orientations, as columns.

    Attributes:
        positions: positions in the world [m], shape (3, n).
        quaternions: unit quaternions (w, x, y, z) in the world, shape (4, n).
    """

    positions: Vector
    quaternions: Vector


class SweepPoses:
    """Poses of all bodies during a scan.

    Args:
        rows: poses at the ticks of the scan.
        start: tick of the scan's stamp.
        timestep: length of a step [s].
    """

    def __init__(self, rows: PoseRows, start: int, timestep: float) -> None:
        self._rows, self._timestep = rows, timestep
        self._lag = start - rows.first
        self.positions, self.quaternions = rows.arrays()
        self._last, self._bodies = len(self.positions) - 1, self.positions.shape[1]
        self._times: Vector | None = None
        self._rows_of_times: tuple[Ids, Ids, Vector] = (np.empty(0, np.intp), np.empty(0, np.intp), np.empty(0))

    def positions_at(self, bodies: Ids, times: Vector) -> Vector:
        """Return the positions [m] of m bodies at n times, shape (3, m, n)."""
        positions = np.ascontiguousarray(self.positions[:, bodies].transpose(2, 1, 0))
        before, after, share = self._ticks(times)
        first, moved = positions.take(before, 2), positions.take(after, 2)
        moved -= first
        moved *= share
        moved += first
        return moved

    def _ticks(self, times: Vector) -> tuple[Ids, Ids, Vector]:
        """Return the rows before and after some times, and the share of the step between them.

        The rows are kept for the next call with the same array, because all bodies need those of the same columns.
        """
        if times is self._times:
            return self._rows_of_times
        ticks = times / self._timestep
        ticks += self._lag
        np.maximum(ticks, 0.0, out=ticks)
        np.minimum(ticks, self._last, out=ticks)
        before = ticks.astype(np.intp)
        ticks -= before
        self._times, self._rows_of_times = times, (before, np.minimum(before + 1, self._last), ticks)
        return self._rows_of_times

    def at(self, bodies: int | Ids, times: Vector, which: Ids | None = None) -> Poses:
        """Return the poses of a body at some times, or of one body at each time.

        Args:
            bodies: MuJoCo's body, or bodies, shape (n,).
            times: times after the scan's stamp [s], shape (n,) or, if `which` is given, any shape.
            which: indices in `times`, shape (n,); None for all.
        """
        before, after, share = self._ticks(times)
        if which is not None:
            before, after, share = before.take(which), after.take(which), share.take(which)
        if isinstance(bodies, int):
            positions, quaternions = self.positions[:, bodies].T, self.quaternions[:, bodies].T
            first, second = positions.take(before, 1), positions.take(after, 1)
            begin, end = quaternions.take(before, 1), quaternions.take(after, 1)
        else:
            places, turns = self.positions.reshape(-1, 3), self.quaternions.reshape(-1, 4)
            begin_rows, end_rows = before * self._bodies + bodies, after * self._bodies + bodies
            first, second = places.take(begin_rows, 0).T, places.take(end_rows, 0).T
            begin, end = turns.take(begin_rows, 0).T, turns.take(end_rows, 0).T
        second = second - first
        second *= share
        second += first
        return Poses(second, slerp(begin, end, share))


def slerp(begin: Vector, end: Vector, share: Vector) -> Vector:
    """Return the rotations at shares (0 to 1) of the ways between unit quaternions; columns, shape (4, n)."""
    change = end - begin
    square = _square(change)
    if square.size and np.maximum.reduce(square) > 2.0:  # q and -q are the same rotation
        change = np.where(square > 2.0, -end, end) - begin
        square = _square(change)
    if not square.size or np.maximum.reduce(square) <= _SMALL_CHORD:
        # sin(share·a) / sin(a) for the angle a between the quaternions
        angle = square * (1.0 + square * (1 / 12 + square * (1 / 90 + square * (1 / 560 + square / 3150))))
        whole, rest = _sinc(angle), 1.0 - share
        weight = share * (_sinc(angle * (share * share)) / whole)
        first = rest * (_sinc(angle * (rest * rest)) / whole)
    else:
        angle = 2.0 * np.asarray(arcsin(np.minimum(0.5 * np.sqrt(square), 1.0)))
        sine = np.maximum(each(math.sin, angle), 1e-300)
        tiny = angle < 1e-6
        weight = np.where(tiny, share, each(math.sin, angle * share) / sine)
        first = np.where(tiny, 1.0 - share, each(math.sin, angle * (1.0 - share)) / sine)
    turned: Vector = begin * (first + weight)
    turned += weight * change
    return turned


def _square(columns: Vector) -> Vector:
    w, x, y, z = columns
    total: Vector = w * w
    total += x * x
    total += y * y
    total += z * z
    return total


def _sinc(square: Vector) -> Vector:
    """Return sin(a)/a for the square of a small angle a."""
    series: Vector = 1.0 - square * (1 / 6 - square * (1 / 120 - square * (1 / 5040 - square / 362880)))
    return series


def matrices_of(quaternions: Vector) -> tuple[tuple[Vector, Vector, Vector], ...]:
    """Return the rows of the rotation matrices of unit quaternions; columns, shape (4, ...)."""
    w, x, y, z = quaternions
    a, b, c = x + x, y + y, z + z
    xx, yy, zz, xy, xz, yz = x * a, y * b, z * c, x * b, x * c, y * c
    wx, wy, wz = w * a, w * b, w * c
    return (
        (1.0 - yy - zz, xy - wz, xz + wy),
        (xy + wz, 1.0 - xx - zz, yz - wx),
        (xz - wy, yz + wx, 1.0 - xx - yy),
    )


def rotate(quaternions: Vector, vectors: Vector) -> Vector:
    """Return vectors rotated by unit quaternions; columns, shapes (4, ...) and (3, ...) that broadcast."""
    w, x, y, z = quaternions
    a, b, c = vectors
    p, q, r = y * c - z * b, z * a - x * c, x * b - y * a
    p, q, r = p + p, q + q, r + r
    return np.stack((a + w * p + (y * r - z * q), b + w * q + (z * p - x * r), c + w * r + (x * q - y * p)))


def rotate_back(quaternions: Vector, vectors: Vector) -> Vector:
    """Return vectors rotated by the inverses of unit quaternions; columns that broadcast."""
    w, x, y, z = quaternions
    return rotate((-w, x, y, z), vectors)  # type: ignore[arg-type]
