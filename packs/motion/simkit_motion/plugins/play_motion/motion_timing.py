"""Timing of a motion: a smooth course through its points, within the velocity limits of its joints.

Between two points, every joint follows the cubic polynomial that has the positions and velocities of both points, as in
joint_trajectory_controller. For a motion without velocities, they are computed by a monotone interpolation (Fritsch and
Butland, "A method for constructing local monotone piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 5, 1984).
The velocity of a joint is zero at both ends and where the joint reverses, so that no joint leaves the range between two
points.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from simkit.extend import Vector

SHORTEST_INTERVAL: Final = 1e-3  # [s], shortest time between two points
LARGEST_STRETCH: Final = 3.0
"""Largest ratio of peak speed to average speed between two points of a smooth course. With the weights of
`smooth_velocities`, the speed at a point is at most three times the average speed before and after the point."""
_ROUNDS: Final = 100
_EXACT: Final = 1e-6


@dataclass(frozen=True, eq=False)
class Course:
    """Course of joints through points; the first point is their present position.

    Attributes:
        times: Time of each point [s], increasing from 0, shape (points,).
        positions: Joint positions [rad or m], shape (points, joints).
        velocities: Joint velocities [rad/s or m/s], shape (points, joints).
        stretched: Ratio of the duration to the duration in the file, both without the approach. The ratio is above 1 if
            a joint would otherwise exceed its speed limit.
    """

    times: Vector
    positions: Vector
    velocities: Vector
    stretched: float = 1.0

    @property
    def duration(self) -> float:
        """Time of the last point [s]."""
        return float(self.times[-1])

    def samples(self, step: Vector) -> Iterator[tuple[float, Vector]]:
        """Yield times and positions along the course.

        Args:
            step: Largest distance that each joint moves between two samples [rad or m].
        """
        yield 0.0, self.positions[0]
        for k in range(len(self.times) - 1):
            h = self.times[k + 1] - self.times[k]
            peak = _peak_speeds(self.positions[k : k + 2], self.velocities[k : k + 2], np.array([h]))[0]
            count = max(1, int(np.ceil(np.max(peak * h / step))))
            for s in np.arange(1, count + 1) / count:
                yield float(self.times[k] + s * h), self._at(k, float(s), float(h))

    def _at(self, k: int, s: float, h: float) -> Vector:
        """Return the joint positions between the points k and k + 1.

        Args:
            k: Index of the point before.
            s: Fraction of the time interval, 0 to 1.
            h: Duration of the time interval [s].
        """
        p0, p1, v0, v1 = self.positions[k], self.positions[k + 1], self.velocities[k] * h, self.velocities[k + 1] * h
        positions: Vector = p0 + s * (v0 + s * ((3 * (p1 - p0) - 2 * v0 - v1) + s * (v0 + v1 - 2 * (p1 - p0))))
        return positions


def time_course(points: Vector, times: Vector, given: Vector | None, limits: Vector, approach: int = 1) -> Course:
    """Return a course through points; an interval gets longer if a joint would exceed its speed limit.

    Args:
        points: Present positions, then the points of the motion, shape (points, joints).
        times: Time of each point [s], increasing from 0, shape (points,).
        given: Velocities at the points of the motion; None to compute them with `smooth_velocities`.
        limits: Speed limit of each joint [rad/s or m/s].
        approach: Index of the first point of the motion; the earlier points belong to the approach.
    """
    gaps = np.maximum(np.diff(times), SHORTEST_INTERVAL)
    if given is not None:
        return _course_with_velocities(points, gaps, given, limits, approach)
    planned = float(gaps[approach:].sum())
    for _ in range(_ROUNDS):
        velocities = smooth_velocities(points, gaps)
        ratio = np.max(_peak_speeds(points, velocities, gaps) / limits, axis=1)
        if np.all(ratio <= 1 + _EXACT):
            break
        gaps = gaps * np.maximum(ratio, 1.0)
    else:
        gaps = gaps * max(1.0, float(ratio.max()))
        velocities = smooth_velocities(points, gaps)
    stretched = float(gaps[approach:].sum()) / planned if planned else 1.0
    return Course(np.concatenate([[0.0], np.cumsum(gaps)]), points, velocities, stretched)


def _course_with_velocities(points: Vector, gaps: Vector, given: Vector, limits: Vector, approach: int) -> Course:
    """Return the course through points with these velocities; if any joint is too fast, the whole motion is slower."""
    velocities = np.zeros_like(points)
    velocities[approach:] = given
    inside = (
        _peak_speeds(points[approach:], velocities[approach:], gaps[approach:]) if len(points) > approach + 1 else None
    )
    factor = max(1.0, float(np.max(inside / limits)) if inside is not None else 1.0, float(np.max(abs(given) / limits)))
    gaps, velocities = np.where(np.arange(len(gaps)) >= approach, gaps * factor, gaps), velocities / factor
    for _ in range(_ROUNDS):
        ratio = float(
            np.max(_peak_speeds(points[: approach + 1], velocities[: approach + 1], gaps[:approach]) / limits)
        )
        if ratio <= 1 + _EXACT:
            break
        gaps[:approach] *= max(ratio, 1.05)
    return Course(np.concatenate([[0.0], np.cumsum(gaps)]), points, velocities, factor)


def smooth_velocities(points: Vector, gaps: Vector) -> Vector:
    """Return velocities at the points, shape (points, joints), with which no joint overshoots a point."""
    velocities = np.zeros_like(points)
    if len(points) < 3:
        return velocities
    slopes = np.diff(points, axis=0) / gaps[:, None]
    before, after = slopes[:-1], slopes[1:]
    w0 = (2 * gaps[1:] + gaps[:-1])[:, None]
    w1 = (gaps[1:] + 2 * gaps[:-1])[:, None]
    goes_on = before * after > 0
    safe_before, safe_after = np.where(goes_on, before, 1.0), np.where(goes_on, after, 1.0)
    with np.errstate(over="ignore"):  # beside a slope near 0, the velocity is 0
        velocities[1:-1] = np.where(goes_on, (w0 + w1) / (w0 / safe_before + w1 / safe_after), 0.0)
    return velocities


def _peak_speeds(points: Vector, velocities: Vector, gaps: Vector) -> Vector:
    """Return the largest speed of each joint between successive points [rad/s or m/s], shape (points - 1, joints)."""
    slopes = np.diff(points, axis=0) / gaps[:, None]
    v0, v1 = velocities[:-1], velocities[1:]
    # v(s) = v0 + b s + c s², s from 0 to 1
    b, c = 6 * slopes - 4 * v0 - 2 * v1, 3 * (v0 + v1) - 6 * slopes
    flat = np.abs(c) < 1e-12
    s = np.clip(-b / np.where(flat, 1.0, 2 * c), 0.0, 1.0)
    between = np.where(flat, 0.0, np.abs(v0 + s * (b + s * c)))
    peaks: Vector = np.maximum(np.maximum(np.abs(v0), np.abs(v1)), between)
    return peaks


def approach_time(start: Vector, first: Vector, speed: float, shortest: float) -> float:
    """Return the duration of the approach to the first point [s].

    Args:
        start: Present position of each joint [rad or m].
        first: Position of each joint at the first point [rad or m].
        speed: Average speed of the joint with the longest way [rad/s or m/s].
        shortest: Shortest duration [s].
    """
    return max(float(np.max(np.abs(first - start))) / speed, shortest, SHORTEST_INTERVAL)
