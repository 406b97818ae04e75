"""Checks of incoming trajectories, and tolerances of their joints, as ros2_control has them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.msgs import stamp_ns
from simkit.params import LARGEST
from simkit.plugins.ros2_control.trajectory import SECOND, TrajectoryPoint
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.msgs import FollowJointTrajectory_Goal, JointTolerance, JointTrajectory, JointTrajectoryPoint

_FIELDS: Final = ("positions", "velocities", "accelerations")
_REST_VELOCITY: Final = 1.1920929e-07  # the smallest step of a 32-bit float at 1, which ros2_controllers compares with


@dataclass(frozen=True, slots=True)
class TrajectoryRules:
    """Rules for the trajectories that a controller accepts.

    Attributes:
        joints: the controller's.
        allow_partial: whether a trajectory may be for some of them only.
        allow_integration: whether velocities or accelerations do without positions.
        allow_velocity_at_end: whether the last point may have a velocity.
    """

    joints: tuple[str, ...]
    allow_partial: bool = False
    allow_integration: bool = False
    allow_velocity_at_end: bool = False

    def fault(self, message: JointTrajectory, now: int) -> str:
        """Why a `trajectory_msgs/msg/JointTrajectory` cannot be followed, in ros2_control's words; empty if it can.

        Args:
            message: the trajectory.
            now: simulated time [ns].
        """
        names = [str(name) for name in message.joint_names]
        return self._names_fault(names, message) or self._end_fault(names, message, now) or self._points_fault(message)

    def _names_fault(self, names: Sequence[str], message: JointTrajectory) -> str:
        if not self.allow_partial and len(names) != len(self.joints):
            return "Joints on incoming trajectory don't match the controller joints."
        if not names:
            return "Empty joint names on incoming trajectory."
        if not message.points:
            return "Empty trajectory received."
        for name in names:
            if name not in self.joints:
                return f"Incoming joint {name} doesn't match the controller's joints."
        if len(set(names)) != len(names):
            return f"Joint {next(n for n in names if names.count(n) > 1)} comes twice on incoming trajectory."
        return ""

    def _end_fault(self, names: Sequence[str], message: JointTrajectory, now: int) -> str:
        last = message.points[-1]
        if not self.allow_velocity_at_end:
            for name, velocity in zip(names, last.velocities, strict=False):
                if abs(velocity) > _REST_VELOCITY:
                    return f"Velocity of last trajectory point of joint {name} is not zero: {velocity:.15f}"
        start = stamp_ns(message.header.stamp)
        end = start + stamp_ns(last.time_from_start)
        if start and end < now:
            return (
                f"Received trajectory with non-zero start time ({start / SECOND:f}) "
                f"that ends in the past ({end / SECOND:f})"
            )
        return ""

    def _points_fault(self, message: JointTrajectory) -> str:
        count, before = len(message.joint_names), 0
        for i, point in enumerate(message.points):
            time = stamp_ns(point.time_from_start)
            if time < 0:
                return f"Point #{i} is at {time / SECOND:f} s: before the start."
            if i and time <= before:
                return (
                    f"Time between points {i - 1} and {i} is not strictly increasing, "
                    f"it is {before / SECOND:f} and {time / SECOND:f} respectively"
                )
            before = time
            fault = self._fields_fault(point, i, count)
            if fault:
                return fault
        return ""

    def _fields_fault(self, point: JointTrajectoryPoint, i: int, count: int) -> str:
        if self.allow_integration and not any(len(getattr(point, field)) for field in _FIELDS):
            return "The given trajectory has no position, velocity, or acceleration points."
        for field in (*_FIELDS, "effort"):
            values = getattr(point, field)
            may_be_empty = field != "positions" or self.allow_integration
            if len(values) != count and not (may_be_empty and not len(values)):
                return f"Mismatch between joint_names size ({count}) and {field} ({len(values)}) at point #{i}."
            if not all(abs(v) <= LARGEST for v in values):
                return f"The {field} at point #{i} are not all finite numbers."
        return ""


def read_points(message: JointTrajectory, joints: Sequence[str], here: Vector) -> list[TrajectoryPoint]:
    """The points of a trajectory that has no fault, in the controller's order.

    Args:
        message: `trajectory_msgs/msg/JointTrajectory`.
        joints: the controller's.
        here: where joints that the trajectory does not name stay.
    """
    names = [str(name) for name in message.joint_names]
    places = np.array([joints.index(name) for name in names], dtype=np.intp)
    rest = np.zeros(len(joints))

    def field(values: Vector, otherwise: Vector) -> Vector | None:
        if not len(values):
            return None
        whole = otherwise.copy()
        whole[places] = values
        return whole

    return [
        TrajectoryPoint(
            stamp_ns(point.time_from_start),
            field(point.positions, here),
            field(point.velocities, rest),
            field(point.accelerations, rest),
            field(point.effort, rest),
        )
        for point in message.points
    ]


@dataclass(frozen=True, slots=True, eq=False)
class Tolerances:
    """Largest allowed error of each joint; infinite where nothing is checked.

    Attributes:
        path: shape (3, n): position, velocity, acceleration under way [rad or m, per s, per s²].
        goal: likewise at the end.
        goal_time: how much later than planned it may get there [s]; 0 for ever.
    """

    path: Vector
    goal: Vector
    goal_time: float = 0.0

    @property
    def watches_path(self) -> bool:
        """Check whether anything is checked under way."""
        return bool(np.isfinite(self.path).any())

    @classmethod
    def of(cls, path: Sequence[float], goal: Sequence[float], stopped: float, goal_time: float) -> Tolerances:
        """Make tolerances of a file's numbers, where 0 is no tolerance.

        Args:
            path: of each joint's position under way.
            goal: of each joint's position at the end.
            stopped: of every velocity at the end.
            goal_time: [s].
        """
        none = np.full(len(path), np.inf)
        ends = np.stack([_infinite_if_zero(goal), _infinite_if_zero([stopped] * len(path)), none])
        return cls(np.stack([_infinite_if_zero(path), none, none]), ends, goal_time)

    def with_goal(self, goal: FollowJointTrajectory_Goal, joints: Sequence[str]) -> tuple[Tolerances, str]:
        """With those of a `FollowJointTrajectory` goal: a positive one counts, -1 takes one away, 0 leaves it.

        Returns:
            The tolerances, and why they are the unchanged ones though the goal has some (empty otherwise).
        """
        goal_time, fault = _resolve_tolerance(self.goal_time, stamp_ns(goal.goal_time_tolerance) / SECOND, 0.0)
        if fault:
            what = f"Illegal goal time tolerance specified: {fault}. Using default tolerances."
            return self, what
        path, what = self._with_changes("path", self.path, goal.path_tolerance, joints)
        if not what:
            ends, what = self._with_changes("goal", self.goal, goal.goal_tolerance, joints)
        return (self, what) if what else (replace(self, path=path, goal=ends, goal_time=goal_time), "")

    @staticmethod
    def _with_changes(
        kind: str, table: Vector, wanted: Iterable[JointTolerance], joints: Sequence[str]
    ) -> tuple[Vector, str]:
        changed = table.copy()
        for one in wanted:
            if one.name not in joints:
                what = f"{kind.capitalize()} tolerance specified for unknown joint '{one.name}'."
                return table, f"{what} Using default tolerances."
            j = joints.index(one.name)
            for row, field in enumerate(("position", "velocity", "acceleration")):
                changed[row, j], fault = _resolve_tolerance(table[row, j], getattr(one, field), math.inf)
                if fault:
                    what = f"Illegal {field} {kind} tolerance value specified for joint '{one.name}'."
                    return table, f"{what} Using default tolerances."
        return changed, ""


def describe_violation(off: Vector, tolerances: Vector, joints: Sequence[str]) -> str:
    """The joint that is furthest beyond its tolerance, in ros2_control's words.

    Args:
        off: how far each joint is off, shape (3, n): position, velocity, acceleration [rad or m, per s, per s²].
        tolerances: likewise.
        joints: their names.
    """
    excess = np.where(np.isfinite(tolerances), off - tolerances, -np.inf)
    row, j = np.unravel_index(int(np.argmax(excess)), excess.shape)
    field = ("Position", "Velocity", "Acceleration")[row]
    return f"{joints[int(j)]}: {field} Error: {off[row, j]:f}, {field} Tolerance: {tolerances[row, j]:f}"


def _infinite_if_zero(tolerances: Sequence[float]) -> Vector:
    return np.array([t if t > 0.0 else math.inf for t in tolerances])


def _resolve_tolerance(default: float, wanted: float, erased: float) -> tuple[float, str]:
    if wanted > 0.0:
        return wanted, ""
    if wanted == -1.0:
        return erased, ""
    return default, "" if wanted == 0.0 else f"{wanted:g}"
