"""Points of a joint trajectory: the active point at a time, and the interpolation between two points."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, TypeVar

from simkit.plugins.one_time_warnings import are_usable
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.msgs import Duration, JointTrajectory, Time

Values = TypeVar("Values", float, Vector)
Interpolation = Literal["none", "linear", "cubic", "quintic"]
INTERPOLATIONS: Final = ("none", "linear", "cubic", "quintic")
SECOND: Final = 1_000_000_000


@dataclass(frozen=True, slots=True)
class JointTarget:
    """Target of one joint: position [rad or m], velocity [per s] and acceleration [per s²]."""

    position: float
    velocity: float = 0.0
    acceleration: float = 0.0


@dataclass(frozen=True, slots=True)
class TrajectoryPoint:
    """Point of a trajectory; each list may be shorter than the list of joint names, or empty.

    Attributes:
        time: Time from the start [ns].
        positions, velocities, accelerations, efforts: Values in the order of the joint names.
    """

    time: int
    positions: tuple[float, ...] = ()
    velocities: tuple[float, ...] = ()
    accelerations: tuple[float, ...] = ()
    efforts: tuple[float, ...] = ()


def read_points(message: JointTrajectory) -> list[TrajectoryPoint]:
    """Return the points of a `trajectory_msgs/msg/JointTrajectory`."""
    return [
        TrajectoryPoint(
            nanoseconds(p.time_from_start),
            *(tuple(float(v) for v in values) for values in (p.positions, p.velocities, p.accelerations, p.effort)),
        )
        for p in message.points
    ]


def nanoseconds(stamp: Duration | Time) -> int:
    """Convert a time or duration message to [ns]."""
    return int(stamp.sec) * SECOND + int(stamp.nanosec)


def trajectory_faults(names: list[str], points: list[TrajectoryPoint]) -> str:
    """Check a trajectory for NaN or infinite numbers, decreasing times and surplus numbers.

    Args:
        names: Joint names.
        points: Points of the trajectory.

    Returns:
        A description of the first fault, or an empty text.
    """
    before = 0
    for i, point in enumerate(points):
        fields = point.positions, point.velocities, point.accelerations, point.efforts
        if not all(are_usable(*values) for values in fields):
            return f"point {i} has a NaN or infinite number"
        if point.time < before:
            return f"point {i} is at {point.time / SECOND:g} s, but the point before it is at {before / SECOND:g} s"
        before = point.time
        most = max(map(len, fields))
        if most > len(names):
            return f"point {i} has {most} numbers for {len(names)} joint names"
    return ""


def active_point(times: list[int], now: int) -> int:
    """Return the index of the first point whose time [ns] is not before `now`; the last index after the end."""
    return min(bisect_left(times, now), len(times) - 1)


@dataclass(frozen=True, slots=True)
class JointPath:
    """Interpolated target of one joint over time.

    Attributes:
        times: Boundaries between the pieces, from the start [ns]; the first is 0.
        pieces: Polynomial of each piece: coefficients of rising powers of the seconds since the start of the piece.
        last: Target after the end.
    """

    times: tuple[int, ...]
    pieces: tuple[tuple[float, ...], ...]
    last: JointTarget

    @classmethod
    def through(
        cls, start: JointTarget, points: list[TrajectoryPoint], joint: int, rule: Interpolation
    ) -> JointPath | None:
        """Return the path of a joint through the points that have a position for it, or None if no point has one.

        - linear: straight line from point to point.
        - cubic: also matches the velocities of the points. A point without a velocity gets the mean of the slopes
          before and after the point, or zero if these slopes differ in sign; the last point gets zero.
        - quintic: also matches the velocities and the accelerations; a missing acceleration is 0.

        Args:
            start: State of the joint at the start; used if no point has time 0.
            points: Points of the trajectory.
            joint: Index of the joint among the names.
            rule: "linear", "cubic" or "quintic".
        """
        via_points = [p for p in points if joint < len(p.positions)]
        if not via_points:
            return None
        if via_points[0].time > 0:
            first = TrajectoryPoint(0, (start.position,) * (joint + 1), (start.velocity,) * (joint + 1))
            via_points = [first, *via_points]
        spline = {"linear": _linear, "cubic": _cubic, "quintic": _quintic}[rule]
        times, pieces = [via_points[0].time], []
        for i in range(1, len(via_points)):
            a, b = via_points[i - 1], via_points[i]
            if b.time <= times[-1]:
                continue
            ends = a.positions[joint], b.positions[joint]
            velocities = _velocity(via_points, joint, i - 1), _velocity(via_points, joint, i)
            accelerations = _value_of_joint(a.accelerations, joint), _value_of_joint(b.accelerations, joint)
            pieces.append(spline(ends, velocities, accelerations, (b.time - a.time) / SECOND))
            times.append(b.time)
        last = JointTarget(via_points[-1].positions[joint], _value_of_joint(via_points[-1].velocities, joint))
        return cls(tuple(times), tuple(pieces), last)

    def at(self, now: int) -> JointTarget:
        """Return the target at `now` [ns] after the start."""
        if now >= self.times[-1]:
            return self.last
        i = max(bisect_right(self.times, now) - 1, 0)
        return _polynomial(self.pieces[i], max(now - self.times[i], 0) / SECOND)


def _value_of_joint(values: tuple[float, ...], joint: int) -> float:
    return values[joint] if joint < len(values) else 0.0


def _velocity(points: list[TrajectoryPoint], joint: int, i: int) -> float:
    """Return the velocity of the joint at a point, from the point or else from the positions of its neighbours."""
    if joint < len(points[i].velocities):
        return points[i].velocities[joint]
    if i == 0 or i == len(points) - 1:
        return 0.0
    before, after = (
        (points[k + 1].positions[joint] - points[k].positions[joint])
        * SECOND
        / max(points[k + 1].time - points[k].time, 1)
        for k in (i - 1, i)
    )
    return (before + after) / 2.0 if before * after > 0.0 else 0.0


Pair = tuple[float, float]


def _linear(ends: Pair, _: Pair, __: Pair, t: float) -> tuple[float, ...]:
    return ends[0], (ends[1] - ends[0]) / t


def _cubic(ends: Pair, velocities: Pair, _: Pair, t: float) -> tuple[float, ...]:
    return cubic(*ends, *velocities, t)


def _quintic(ends: Pair, velocities: Pair, accelerations: Pair, t: float) -> tuple[float, ...]:
    return quintic(*ends, *velocities, *accelerations, t)


def cubic(p0: Values, p1: Values, v0: Values, v1: Values, t: float) -> tuple[Values, ...]:
    """Return the coefficients of rising powers of the Hermite cubic between two points, `t` [s] apart.

    The positions p0 and p1 [rad or m] and the velocities v0 and v1 [per s] are of one joint or of several.
    """
    rise = p1 - p0
    return p0, v0, (3.0 * rise / t - 2.0 * v0 - v1) / t, (-2.0 * rise / t + v0 + v1) / t**2


def quintic(p0: Values, p1: Values, v0: Values, v1: Values, a0: Values, a1: Values, t: float) -> tuple[Values, ...]:
    """Return the coefficients of rising powers of the quintic between two points; see `cubic`.

    It also has the accelerations a0 and a1 [per s²] at the points.
    """
    rise = p1 - p0
    return (
        p0,
        v0,
        a0 / 2.0,
        (20.0 * rise - (8.0 * v1 + 12.0 * v0) * t - (3.0 * a0 - a1) * t**2) / (2.0 * t**3),
        (-30.0 * rise + (14.0 * v1 + 16.0 * v0) * t + (3.0 * a0 - 2.0 * a1) * t**2) / (2.0 * t**4),
        (12.0 * rise - 6.0 * (v1 + v0) * t + (a1 - a0) * t**2) / (2.0 * t**5),
    )


def _polynomial(coefficients: tuple[float, ...], t: float) -> JointTarget:
    position = velocity = acceleration = 0.0
    for c in reversed(coefficients):
        acceleration = acceleration * t + 2.0 * velocity
        velocity = velocity * t + position
        position = position * t + c
    return JointTarget(position, velocity, acceleration)
