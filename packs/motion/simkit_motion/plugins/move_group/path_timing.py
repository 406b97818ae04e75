"""Timing of a path: rounded corners, and the speeds that the limits of velocity and acceleration allow.

T. Kunz, M. Stilman: "Time-optimal trajectory generation for path following with bounded acceleration and velocity", RSS
2012, is the method of MoveIt. Here the path is sampled, a part of the acceleration limit is reserved for the curvature,
and one pass forwards and one backwards along the samples find the speeds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from simkit.extend import Vector
from simkit.linear_algebra import norm

SAMPLE_TIME: Final = 0.05  # [s] between two points of a trajectory
_FOR_CURVES: Final = 0.5  # part of the acceleration limit that a curve may use
_SAMPLES: Final = 64  # samples of each corner and of each line
_SAFETY: Final = 1.001


@dataclass(frozen=True, eq=False)
class TimedPath:
    """Course of the joints over time; all velocities are zero at both ends.

    Attributes:
        times: Time of each point [s], from 0, shape (points,).
        positions: Positions [rad or m], shape (points, joints).
        velocities: Velocities [rad/s or m/s], shape (points, joints).
    """

    times: Vector
    positions: Vector
    velocities: Vector

    @property
    def duration(self) -> float:
        """Time of the last point [s]."""
        return float(self.times[-1])


def round_corners(path: Sequence[Vector], deviation: Vector) -> Vector:
    """Return samples of a path whose corners are replaced by parabolas, shape (samples, joints).

    Args:
        path: Points that are connected by straight lines.
        deviation: Largest distance of each joint from the straight lines [rad or m].
    """
    points = [np.array(path[0])]
    for point in path[1:]:  # equal points have no direction
        if np.abs(point - points[-1]).max() > 1e-9:
            points.append(np.array(point))
    if len(points) == 1:
        return np.array(points)
    cut = [0.0] * len(points)
    for k in range(1, len(points) - 1):
        before, after = points[k] - points[k - 1], points[k + 1] - points[k]
        bend = np.abs(after / _length(after) - before / _length(before)).max()
        cut[k] = min(_length(before) / 2, _length(after) / 2, 4 * float(np.min(deviation)) / max(bend, 1e-9))
    samples = [points[0][None]]
    for k in range(len(points) - 1):
        direction = (points[k + 1] - points[k]) / _length(points[k + 1] - points[k])
        begin, end = points[k] + direction * cut[k], points[k + 1] - direction * cut[k + 1]
        share = np.linspace(0.0, 1.0, _SAMPLES + 1)[1:, None]
        if _length(end - begin) > 1e-9:
            samples.append(begin + (end - begin) * share)
        if k + 2 < len(points) and cut[k + 1] > 0.0:
            onwards = (points[k + 2] - points[k + 1]) / _length(points[k + 2] - points[k + 1])
            last = points[k + 1] + onwards * cut[k + 1]
            samples.append((1 - share) ** 2 * end + 2 * share * (1 - share) * points[k + 1] + share**2 * last)
    return np.vstack(samples)


def time_path(samples: Vector, speeds: Vector, accelerations: Vector) -> TimedPath:
    """Return the course along a sampled path within the limits of velocity and acceleration.

    Args:
        samples: Positions along the path, shape (samples, joints).
        speeds: Largest speed of each joint [rad/s or m/s].
        accelerations: Largest acceleration of each joint [rad/s² or m/s²].
    """
    differs = np.abs(np.diff(samples, axis=0)).max(axis=1, initial=0.0) > 1e-12
    samples = samples[np.concatenate([[True], differs])]  # equal samples have no direction
    if len(samples) < 2:
        return TimedPath(np.zeros(1), samples[:1], np.zeros_like(samples[:1]))
    steps = np.linalg.norm(np.diff(samples, axis=0), axis=1)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    slopes = np.diff(samples, axis=0) / steps[:, None]
    middle = (way[1:] + way[:-1]) / 2
    tangents = np.vstack([slopes[:1], (slopes[1:] + slopes[:-1]) / 2, slopes[-1:]])
    curves = np.zeros_like(tangents)
    curves[1:-1] = np.diff(slopes, axis=0) / np.diff(middle)[:, None]
    with np.errstate(divide="ignore"):
        by_speed = np.min(speeds / np.maximum(np.abs(tangents), 1e-12), axis=1) ** 2
        by_curve = np.min(_FOR_CURVES * accelerations / np.maximum(np.abs(curves), 1e-12), axis=1)
    most = np.minimum(by_speed, by_curve)  # the square of the speed along the path
    left = accelerations - np.abs(curves) * most[:, None]
    gain = np.min(left / np.maximum(np.abs(tangents), 1e-12), axis=1)
    gain = np.minimum(gain[1:], gain[:-1])  # acceleration along each step
    squares = most.copy()
    squares[0] = squares[-1] = 0.0
    for k in range(len(steps)):
        squares[k + 1] = min(squares[k + 1], squares[k] + 2 * gain[k] * steps[k])
    for k in range(len(steps) - 1, -1, -1):
        squares[k] = min(squares[k], squares[k + 1] + 2 * gain[k] * steps[k])
    rates = np.sqrt(squares)
    at = np.concatenate([[0.0], np.cumsum(2 * steps / np.maximum(rates[1:] + rates[:-1], 1e-9))])
    count = max(2, int(np.ceil(at[-1] / SAMPLE_TIME)) + 1)
    times = np.linspace(0.0, at[-1], count)
    along = _way_at(times, at, way, rates)
    rate = np.interp(times, at, rates)
    positions = np.stack([np.interp(along, way, column) for column in samples.T], axis=1)
    positions[0], positions[-1] = samples[0], samples[-1]
    velocities = np.stack([np.interp(along, way, column) for column in tangents.T], axis=1) * rate[:, None]
    velocities[0] = velocities[-1] = 0.0
    return _within_limits(times, positions, velocities, speeds, accelerations)


def _way_at(times: Vector, at: Vector, way: Vector, rates: Vector) -> Vector:
    """Return the length along the path at each time; the speed along the path changes linearly between samples."""
    k = np.clip(np.searchsorted(at, times, side="right") - 1, 0, len(at) - 2)
    since, period = times - at[k], np.maximum(at[k + 1] - at[k], 1e-12)
    travelled: Vector = way[k] + rates[k] * since + (rates[k + 1] - rates[k]) * since**2 / (2 * period)
    return np.clip(travelled, 0.0, way[-1])


def _within_limits(times: Vector, positions: Vector, velocities: Vector, speeds: Vector, most: Vector) -> TimedPath:
    """Return the course, slower where the cubic polynomials between the points exceed a limit."""
    gaps = np.diff(times)[:, None]
    slopes = np.diff(positions, axis=0) / gaps
    v0, v1 = velocities[:-1], velocities[1:]
    begins, ends = (6 * slopes - 4 * v0 - 2 * v1) / gaps, (2 * v0 + 4 * v1 - 6 * slopes) / gaps
    peaks = np.maximum(np.abs(v0), np.abs(v1))
    bend = np.where(np.abs(begins - ends) < 1e-12, 1.0, begins - ends)
    turn = np.clip(begins / bend, 0.0, 1.0)
    peaks = np.maximum(peaks, np.abs(v0 + gaps * (begins * turn + (ends - begins) * turn**2 / 2)))
    by_speed = float(np.max(peaks / speeds))
    by_acceleration = float(np.sqrt(np.max(np.maximum(np.abs(begins), np.abs(ends)) / most)))
    factor = max(1.0, by_speed, by_acceleration) * _SAFETY
    return TimedPath(times * factor, positions, velocities / factor)


def _length(vector: Vector) -> float:
    return norm(vector)
