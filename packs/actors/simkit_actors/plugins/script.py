"""Poses of an actor over time, computed from its script with Gazebo's splines through the waypoints.

Positions follow cubic Hermite splines. The tangent at a waypoint is (1 − tension) · half the vector from the previous
waypoint to the next one. The spline parameter is linear in time within each segment. The speed at a waypoint is
therefore continuous only if the times of the waypoints are evenly spaced. Orientations follow the spherical spline
(squad) through the quaternions. `PoseAnimation` in `gz::common`, `Spline` and `RotationSpline` in `gz::math` and Gazebo
Classic have the same rules.
"""

from __future__ import annotations

import bisect
from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Pose
from simkit.elementary_functions import arccos, arctan2
from simkit.linear_algebra import matmul, norm
from simkit.scene import SceneActor, Trajectory

Floats = npt.NDArray[np.float64]

_GRID: Final = 0.02
"""Time between two rows of a track [s]; the error of a linear interpolation between them is below 1 mm."""

_MOST_ROWS: Final = 20_000
_TINY: Final = 1e-12


class Track:
    """Trajectory as a table of poses at equally spaced times.

    Args:
        way: trajectory; None for an actor that does not move.
        base: world pose that the waypoints are relative to.
        length: duration [s] if the actor does not move.

    Attributes:
        type: name of the animation that plays during this trajectory.
        length: duration [s].
        times: time of each row [s], shape (n,).
        poses: x, y, z [m] and quaternion w, x, y, z in the world, shape (n, 7).
        speed, distance: speed [m/s] and distance travelled since the start [m], shape (n,) each.
    """

    def __init__(self, way: Trajectory | None, base: Pose, length: float = 0.0) -> None:
        points = [(p.time, base @ p.pose) for p in way.waypoints] if way is not None else []
        self.type = "" if way is None else way.type
        times = np.array([t for t, _ in points] or [length])
        self.length = max(0.0, float(times[-1]))
        rows = min(_MOST_ROWS, max(2, round(self.length / _GRID) + 1))
        self.times = np.linspace(0.0, self.length, rows)
        self._per_second = (rows - 1) / self.length if self.length > 0.0 else 0.0
        if len(points) < 2:
            only = points[0][1] if points else base
            self.poses = np.tile(np.concatenate([only.position, only.quaternion]), (rows, 1))
        else:
            self.poses = _poses([p for _, p in points], times, self.times, way.tension if way is not None else 0.0)
        steps = np.linalg.norm(np.diff(self.poses[:, :3], axis=0), axis=1)
        self.distance = np.concatenate([[0.0], np.cumsum(steps)])
        self.speed = np.gradient(self.distance, self.times) if self.length > 0.0 else np.zeros(rows)
        self.moves = bool(self.distance[-1] > 0.0 or np.ptp(self.poses[:, 3:], axis=0).max() > _TINY)

    def row(self, time: float) -> tuple[int, float]:
        """Return the last row before a time [s], and the fraction of the interval to the next row, 0 to 1."""
        row = min(max(time, 0.0), self.length) * self._per_second
        before = min(int(row), len(self.times) - 2)
        return before, row - before


class Stride(Track):
    """Track of an actor that a plugin moves: the origin stays at zero, and only the links move.

    Args:
        kind: name of the animation that plays.
        distance: distance travelled at each row [m], shape (n,).
        speed: walking speed [m/s].
        seconds: duration of the animation for one metre [s/m].
    """

    def __init__(self, kind: str, distance: Floats, speed: float, seconds: float) -> None:
        rows = len(distance)
        self.type, self.length, self.moves = kind, 0.0, True
        self.poses = np.tile((0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0), (rows, 1))
        self.times, self.distance, self.speed = distance * seconds, distance, np.full(rows, speed)


class Script:
    """Sequence of the trajectories of an actor.

    Args:
        actor: actor with its trajectories. As in gz, the waypoints are relative to the actor's `<pose>`.
        in_place: duration of the animation [s] of an actor without a trajectory.

    Attributes:
        tracks: trajectories of the actor, in the order of playing.
        length: duration of all tracks together [s].
        starts_by_itself: whether the script starts at the start of the simulation.
    """

    def __init__(self, actor: SceneActor, in_place: float = 0.0) -> None:
        self._delay, self._loop = actor.delay_start, actor.loop
        self.starts_by_itself = actor.auto_start
        ways = [way for way in actor.trajectories if way.waypoints]
        self.tracks = [Track(way, actor.pose_world) for way in ways] or [Track(None, actor.pose_world, in_place)]
        self._ends = [float(t) for t in np.cumsum([track.length for track in self.tracks])]
        self.length = self._ends[-1]

    @property
    def moves(self) -> bool:
        """True if the script changes the actor's pose at any time."""
        return any(track.moves for track in self.tracks)

    def at(self, time: float) -> tuple[int, float, bool]:
        """Return the state at a time [s] after the start: index of the track, time in the track [s], and a flag.

        The flag is true if the actor rests, before the delayed start or after the end of the script.
        """
        since, total = max(0.0, time - self._delay), self.length
        is_over = since >= total
        if is_over:
            since = since % total if self._loop and total > 0.0 else total
        number = min(bisect.bisect_right(self._ends, since), len(self._ends) - 1)
        inside = since - (self._ends[number] - self.tracks[number].length)
        return number, inside, time < self._delay or (is_over and not self._loop)

    def pose(self, time: float) -> Pose:
        """Return the actor's pose in the world at a time [s] after the start."""
        number, inside, _ = self.at(time)
        track = self.tracks[number]
        row, part = track.row(inside)
        pose = track.poses[row] * (1.0 - part) + track.poses[row + 1] * part
        return Pose(pose[:3], pose[3:] / norm(pose[3:]))


def _poses(points: Sequence[Pose], times: Floats, grid: Floats, tension: float) -> Floats:
    """Return the poses at the times of the grid.

    Successive quaternions have the same sign, so that they can be interpolated.
    """
    places = np.array([p.position for p in points], dtype=np.float64)
    turns = np.array([p.quaternion for p in points], dtype=np.float64)
    stretch = np.clip(np.searchsorted(times, grid, side="right") - 1, 0, len(points) - 2)
    spans = np.diff(times)[stretch]
    part = np.where(spans > 0.0, (grid - times[stretch]) / np.where(spans > 0.0, spans, 1.0), 1.0)
    part = np.clip(part, 0.0, 1.0)
    turn = _rotation_spline(turns, stretch, part)
    flips = np.cumprod(np.where(np.sum(turn[1:] * turn[:-1], axis=1) < 0.0, -1.0, 1.0))
    turn[1:] *= flips[:, None]
    return np.hstack([_spline(places, tension, stretch, part), turn])


def _spline(points: Floats, tension: float, stretch: npt.NDArray[np.intp], part: Floats) -> Floats:
    tangents = np.empty_like(points)
    tangents[1:-1] = points[2:] - points[:-2]
    closed = np.allclose(points[0], points[-1])
    tangents[0] = points[1] - (points[-2] if closed else points[0])
    tangents[-1] = (points[1] if closed else points[-1]) - points[-2]
    tangents *= 0.5 * (1.0 - tension)
    t = part[:, None]
    square = t * t
    cube = square * t
    a, b, c, d = points[stretch], points[stretch + 1], tangents[stretch], tangents[stretch + 1]
    return np.asarray(
        (2 * cube - 3 * square + 1) * a
        + (3 * square - 2 * cube) * b
        + (cube - 2 * square + t) * c
        + (cube - square) * d
    )


def _rotation_spline(turns: Floats, stretch: npt.NDArray[np.intp], part: Floats) -> Floats:
    turns = turns.copy()
    for i in range(1, len(turns)):
        if matmul(turns[i], turns[i - 1]) < 0.0:
            turns[i] = -turns[i]
    closed = abs(matmul(turns[0], turns[-1])) > 1.0 - 1e-9
    count = len(turns)
    before = [i - 1 if i else (count - 2 if closed else 0) for i in range(count)]
    after = [i + 1 if i < count - 1 else (1 if closed else i) for i in range(count)]
    back = turns * (1.0, -1.0, -1.0, -1.0)
    lean = _log(_times(back, turns[after])) + _log(_times(back, turns[before]))
    tangents = _times(turns, _exp(-0.25 * lean))
    t = part[:, None]
    direct = _slerp(turns[stretch], turns[stretch + 1], t)
    round_about = _slerp(tangents[stretch], tangents[stretch + 1], t)
    return _slerp(direct, round_about, 2.0 * t * (1.0 - t))


def _times(a: Floats, b: Floats) -> Floats:
    w1, x1, y1, z1 = a.T
    w2, x2, y2, z2 = b.T
    return np.stack(
        [
            w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2,
            w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2,
            w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2,
            w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2,
        ],
        axis=1,
    )


def _log(q: Floats) -> Floats:
    """Return the logarithms of quaternions, shape (n, 3): q or −q is exp(v), with the smaller angle."""
    q = np.where(q[:, :1] < 0.0, -q, q)
    size = np.linalg.norm(q[:, 1:], axis=1, keepdims=True)
    angle = arctan2(size, q[:, :1])
    return np.asarray(q[:, 1:] * np.where(size > _TINY, angle / np.where(size > _TINY, size, 1.0), 1.0))


def _exp(v: Floats) -> Floats:
    angle = np.linalg.norm(v, axis=1, keepdims=True)
    return np.hstack([np.cos(angle), v * np.sinc(angle / np.pi)])


def _slerp(a: Floats, b: Floats, t: Floats) -> Floats:
    cos = np.sum(a * b, axis=1, keepdims=True)
    b = np.where(cos < 0.0, -b, b)
    angle = arccos(np.clip(np.abs(cos), -1.0, 1.0))
    sin = np.sin(angle)
    wide = sin > 1e-6
    safe = np.where(wide, sin, 1.0)
    first = np.where(wide, np.sin((1.0 - t) * angle) / safe, 1.0 - t)
    second = np.where(wide, np.sin(t * angle) / safe, t)
    between = first * a + second * b
    return np.asarray(between / np.linalg.norm(between, axis=1, keepdims=True))
