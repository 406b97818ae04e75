"""Trajectories of several joints: points with times, and the splines between them.

The rules are those of ros2_controllers' joint_trajectory_controller. Two points are connected by a straight line. If
both points have velocities, a cubic polynomial connects them; if both have accelerations too, a quintic polynomial
does.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from simkit.extend import Vector
from simkit.plugins.joints.joint_trajectory import SECOND, cubic, quintic
from simkit.plugins.not_deep_copied import ImmutableValue

_TURN: Final = 2.0 * np.pi
_LOOK_AHEAD: Final = 32
"""Number of setpoints computed at once, because computing 32 setpoints takes as long as computing one."""


@dataclass(frozen=True, slots=True, eq=False)
class TrajectoryPoint:
    """One point of a trajectory; a field that is empty in the message is None.

    Attributes:
        time: time from the start [ns].
        positions, velocities, accelerations: shape (n,), in the order of the controller's joints [rad or m, per s,
            per s²].
        efforts: shape (n,), in the same order [N·m or N].
    """

    time: int
    positions: Vector | None = None
    velocities: Vector | None = None
    accelerations: Vector | None = None
    efforts: Vector | None = None


class Setpoint(NamedTuple):
    """Targets of the joints at one time.

    Attributes:
        motion: shape (3, n): positions, velocities, accelerations.
        efforts: shape (n,); None if the points have none.
    """

    motion: Vector
    efforts: Vector | None = None


class Spline(ImmutableValue):
    """Targets of all joints as a function of time.

    Attributes:
        times: start and end times of the pieces [ns], counted from the start of the trajectory; increasing.
        last: setpoint after the last piece.
    """

    def __init__(self, times: Sequence[int], pieces: Sequence[Vector], last: Setpoint) -> None:
        """Initialise a spline; use `through`, `held` or `stop` to create one.

        Args:
            times: start and end times of the pieces [ns]; one more than there are pieces.
            pieces: coefficients (6, n) of increasing powers of the seconds since the beginning of the piece.
            last: setpoint after the last piece.
        """
        self.times, self.last = tuple(times), last
        self._begins = np.array(self.times[:-1], np.int64)
        self._table = _with_derivatives(pieces)
        self._ahead: dict[int, Vector] = {}
        self._efforts: tuple[tuple[Vector, Vector], ...] = ()
        self._setpoints: tuple[Vector, ...] = ()  # only in a spline without interpolation

    @property
    def end(self) -> int:
        """End time of the spline [ns], counted from the start of the trajectory."""
        return self.times[-1]

    def at(self, now: int, step: int = 0) -> Setpoint:
        """Return the targets of the joints at a time.

        Args:
            now: time since the start of the trajectory [ns].
            step: expected time until the next call [ns]; 0 if unknown. With a step, further setpoints are computed
                ahead, which does not change the results.
        """
        motion = self._ahead.get(now)
        if motion is not None and not self._efforts:
            return Setpoint(motion)
        if now >= self.times[-1]:
            return self.last
        if self._efforts or self._setpoints:
            return self._with_effort(now)
        if step <= 0:
            return Setpoint(self._motions(np.array([now]))[0])
        times = np.arange(now, min(now + _LOOK_AHEAD * step, self.times[-1]), step)
        self._ahead = dict(zip(times.tolist(), self._motions(times), strict=True))
        return Setpoint(self._ahead[now])

    def _motions(self, times: npt.NDArray[np.int64]) -> Vector:
        """Return motions, shape (times, 3, n); each result is bit-identical to a call with this time alone."""
        pieces = np.maximum(np.searchsorted(self._begins, times, "right") - 1, 0)
        t = (np.maximum(times - self._begins[pieces], 0) / SECOND)[:, None]
        table = self._table[:, pieces]
        motions: Vector = table[-1]
        for coefficients in table[-2::-1]:
            motions = motions * t + coefficients
        return motions.reshape(len(times), 3, -1)

    def _with_effort(self, now: int) -> Setpoint:
        """Return the setpoint at a time, for a spline that has efforts or is not interpolated."""
        i = max(bisect_right(self.times, now) - 1, 0)
        if self._setpoints:
            return Setpoint(self._setpoints[i], self._effort(i, 1.0))
        t = max(now - self.times[i], 0) / SECOND
        effort = self._effort(i, t * SECOND / (self.times[i + 1] - self.times[i]))
        return Setpoint(self._motions(np.array([now]))[0], effort)

    def _effort(self, i: int, share: float) -> Vector | None:
        if not self._efforts:
            return None
        a, b = self._efforts[i]
        effort: Vector = a + (b - a) * share
        return effort

    @classmethod
    def held(cls, positions: Vector, velocities: Vector | None = None) -> Spline:
        """Create a spline that holds positions for ever, and velocities for joints commanded by velocity."""
        rest = np.zeros_like(positions)
        motion = np.stack([positions, rest if velocities is None else velocities, rest])
        return cls((0,), (), Setpoint(motion))

    @classmethod
    def through(cls, start: TrajectoryPoint, points: Sequence[TrajectoryPoint], *, steps: bool = False) -> Spline:
        """Create a spline from a state of the joints through points.

        If the first point is at or before the time of `start`, the spline begins at that point, and `start` is unused.

        Args:
            start: state of the joints when the trajectory begins, with its time since the trajectory's start [ns].
            points: points with positions and increasing times.
            steps: true for no interpolation: between two points, the target is the later point.
        """
        count = len(_zero_if_missing(points[0].positions))
        ends = list(points)
        if points[0].time > start.time:
            ends.insert(0, _match_first_point(start, points[0]))
        times = [point.time for point in ends]
        pairs = list(pairwise(ends))
        pieces = [] if steps else [_hermite_piece(a, b) for a, b in pairs]
        spline = cls(times, pieces, Setpoint(_point_rows(ends[-1], count), ends[-1].efforts))
        if steps:
            starts_earlier = ends[0] is not points[0]
            spline._setpoints = tuple(
                _point_rows(a if starts_earlier and k == 0 else b, count) for k, (a, b) in enumerate(pairs)
            )
        if any(point.efforts is not None for point in points):
            rest = np.zeros(count)
            spline._efforts = tuple(
                (rest if a.efforts is None else a.efforts, rest if b.efforts is None else b.efforts) for a, b in pairs
            )
            if spline.last.efforts is None:
                spline.last = Setpoint(spline.last.motion, rest)
        return spline

    @classmethod
    def stop(cls, positions: Vector, velocities: Vector, decelerations: Vector) -> Spline:
        """Create a spline that brings each joint to rest with its own deceleration [rad/s² or m/s²]."""
        can_slow = decelerations > 0.0  # joints without deceleration stop at once
        velocities = np.where(can_slow, velocities, 0.0)
        slope = -np.sign(velocities) * decelerations
        durations = np.abs(velocities) / np.where(can_slow, decelerations, 1.0)
        ends = sorted({round(float(d) * SECOND) for d in durations if d > 0.0})
        times = [0, *ends] if ends else [0]
        pieces = []
        for begin in times[:-1]:
            t = np.minimum(begin / SECOND, durations)
            piece = np.zeros((6, len(positions)))
            piece[0] = positions + velocities * t + slope * t**2 / 2.0
            is_moving = begin / SECOND < durations - 1e-9
            piece[1] = np.where(is_moving, velocities + slope * t, 0.0)
            piece[2] = np.where(is_moving, slope / 2.0, 0.0)
            pieces.append(piece)
        rest = np.zeros_like(positions)
        final = positions + velocities * durations + slope * durations**2 / 2.0
        return cls(times, pieces, Setpoint(np.stack([final, rest, rest])))


def integrate_points(start: TrajectoryPoint, points: Sequence[TrajectoryPoint]) -> list[TrajectoryPoint]:
    """Add positions to points that have only velocities, or only accelerations, by integration.

    The mean of two successive values is integrated over the time between them, as in ros2_controllers.
    """
    integrated: list[TrajectoryPoint] = []
    previous = start
    for point in points:
        if point.positions is None:
            t = (point.time - previous.time) / SECOND
            positions = _zero_if_missing(previous.positions)
            rest = np.zeros(len(positions))
            v0, v1 = previous.velocities if previous.velocities is not None else rest, point.velocities
            if v1 is None:
                a0 = previous.accelerations if previous.accelerations is not None else rest
                v1 = v0 + (a0 + _zero_if_missing(point.accelerations)) * 0.5 * t
            point = replace(point, positions=positions + (v0 + v1) * 0.5 * t, velocities=v1)
        integrated.append(point)
        previous = point
    return integrated


def whole_turn_offset(current: Vector, first: Vector, turning: Vector) -> Vector:
    """Return full turns to add to a trajectory, so that continuous joints reach its first point the shortest way.

    Args:
        current: current positions [rad].
        first: positions of the first point [rad].
        turning: mask of the joints that rotate without limits.

    Returns:
        Multiples of 2π [rad], shape (n,); 0 for joints with limits.
    """
    turns: Vector = np.where(turning, np.round((current - first) / _TURN) * _TURN, 0.0)
    return turns


def shortest_differences(errors: Vector, turning: Vector) -> Vector:
    """Wrap the angle differences [rad] of joints that rotate without limits to -π … π."""
    wrapped: Vector = np.where(turning, errors - np.round(errors / _TURN) * _TURN, errors)
    return wrapped


def _zero_if_missing(values: Vector | None) -> Vector:
    assert values is not None
    return values


def _match_first_point(start: TrajectoryPoint, first: TrajectoryPoint) -> TrajectoryPoint:
    """Return the start state, with zeros for velocities or accelerations that only the first point has."""
    rest = np.zeros(len(_zero_if_missing(first.positions)))
    velocities = rest if start.velocities is None and first.velocities is not None else start.velocities
    accelerations = rest if start.accelerations is None and first.accelerations is not None else start.accelerations
    return replace(start, velocities=velocities, accelerations=accelerations)


def _point_rows(point: TrajectoryPoint, count: int) -> Vector:
    rest = np.zeros(count)
    fields = (_zero_if_missing(point.positions), point.velocities, point.accelerations)
    return np.stack([rest if values is None else values for values in fields])


def _hermite_piece(a: TrajectoryPoint, b: TrajectoryPoint) -> Vector:
    """Return the polynomial between two points: coefficients (6, n) of increasing powers; its degree is 1, 3 or 5."""
    p0, p1 = _zero_if_missing(a.positions), _zero_if_missing(b.positions)
    t = (b.time - a.time) / SECOND
    piece = np.zeros((6, len(p0)))
    if a.velocities is None or b.velocities is None:
        piece[:2] = p0, (p1 - p0) / t
    elif a.accelerations is None or b.accelerations is None:
        piece[:4] = cubic(p0, p1, a.velocities, b.velocities, t)
    else:
        piece[:] = quintic(p0, p1, a.velocities, b.velocities, a.accelerations, b.accelerations, t)
    return piece


def _with_derivatives(pieces: Sequence[Vector]) -> Vector:
    """Return the coefficients of pieces (6, n) and of their first two derivatives, shape (powers, pieces, 3 n)."""
    if not len(pieces):
        return np.zeros((1, 0, 0))
    stacked, degrees = np.stack(pieces, 1), np.arange(6.0)[:, None, None]
    table = np.zeros((6, len(pieces), 3, stacked.shape[2]))
    table[:, :, 0] = stacked
    table[:5, :, 1] = (degrees * stacked)[1:]
    table[:4, :, 2] = (degrees * (degrees - 1.0) * stacked)[2:]
    used = np.flatnonzero(stacked.any(axis=(1, 2)))
    highest = int(used[-1]) if len(used) else 0
    return table[: highest + 1].reshape(highest + 1, len(pieces), -1)
