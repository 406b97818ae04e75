"""Validation and tolerances of incoming trajectories, with the rules of ros2_control."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.extend import LARGEST, Vector
from simkit.msgs import stamp_ns
from simkit.plugins.joints.joint_trajectory import SECOND
from simkit_control.plugins.ros2_control.trajectory import TrajectoryPoint

if TYPE_CHECKING:
    from simkit.msgs import FollowJointTrajectory_Goal, JointTolerance, JointTrajectory, JointTrajectoryPoint

_FIELDS: Final = ("positions", "velocities", "accelerations")
_REST_VELOCITY: Final = 1.1920929e-07  # epsilon of a 32-bit float, the threshold in ros2_controllers


@dataclass(frozen=True, slots=True)
class TrajectoryRules:
    """Rules for the trajectories that a controller accepts.

    Attributes:
        joints: joints of the controller.
        allow_partial: true if a trajectory may name a subset of the joints.
        allow_integration: true if velocities or accelerations may replace positions.
        allow_velocity_at_end: true if the last point may have a velocity.
    """

    joints: tuple[str, ...]
    allow_partial: bool = False
    allow_integration: bool = False
    allow_velocity_at_end: bool = False

    def fault(self, message: JointTrajectory, now: int) -> str:
        """Return the reason to reject a trajectory, worded as in ros2_control; empty for a valid trajectory.

        Args:
            message: `trajectory_msgs/msg/JointTrajectory` to check.
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


def read_points(message: JointTrajectory, joints: Sequence[str], current: Vector) -> list[TrajectoryPoint]:
    """Convert a valid trajectory to points in the order of the controller's joints.

    Args:
        message: `trajectory_msgs/msg/JointTrajectory` to convert.
        joints: joints of the controller.
        current: positions of joints that the trajectory does not name.
    """
    names = [str(name) for name in message.joint_names]
    indices = np.array([joints.index(name) for name in names], dtype=np.intp)
    rest = np.zeros(len(joints))

    def field(values: Vector, default: Vector) -> Vector | None:
        if not len(values):
            return None
        complete = default.copy()
        complete[indices] = values
        return complete

    return [
        TrajectoryPoint(
            stamp_ns(point.time_from_start),
            field(point.positions, current),
            field(point.velocities, rest),
            field(point.accelerations, rest),
            field(point.effort, rest),
        )
        for point in message.points
    ]


@dataclass(frozen=True, slots=True, eq=False)
class Tolerances:
    """Largest allowed error of each joint; infinite for errors that are not checked.

    Attributes:
        path: tolerances during the motion, shape (3, n): position, velocity, acceleration [rad or m, per s, per s²].
        goal: tolerances at the end, in the same shape.
        goal_time: allowed delay at the end [s]; 0 for an unlimited delay.
    """

    path: Vector
    goal: Vector
    goal_time: float = 0.0

    @property
    def watches_path(self) -> bool:
        """True if any error is checked during the motion."""
        return bool(np.isfinite(self.path).any())

    @classmethod
    def of(cls, path: Sequence[float], goal: Sequence[float], stopped: float, goal_time: float) -> Tolerances:
        """Create tolerances from the numbers in a file, where 0 means no tolerance.

        Args:
            path: position tolerance of each joint during the motion.
            goal: position tolerance of each joint at the end.
            stopped: velocity tolerance of all joints at the end.
            goal_time: allowed delay at the end [s].
        """
        none = np.full(len(path), np.inf)
        ends = np.stack([_infinite_if_zero(goal), _infinite_if_zero([stopped] * len(path)), none])
        return cls(np.stack([_infinite_if_zero(path), none, none]), ends, goal_time)

    def with_goal(self, goal: FollowJointTrajectory_Goal, joints: Sequence[str]) -> tuple[Tolerances, str]:
        """Apply the tolerances of a goal: a positive number replaces a tolerance, -1 removes it, 0 does not change it.

        Returns:
            The tolerances to use, and a warning if the goal's tolerances were invalid and ignored (empty otherwise).
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
        kind: str, table: Vector, goal: Iterable[JointTolerance], joints: Sequence[str]
    ) -> tuple[Vector, str]:
        changed = table.copy()
        for tolerance in goal:
            if tolerance.name not in joints:
                what = f"{kind.capitalize()} tolerance specified for unknown joint '{tolerance.name}'."
                return table, f"{what} Using default tolerances."
            j = joints.index(tolerance.name)
            for row, field in enumerate(("position", "velocity", "acceleration")):
                changed[row, j], fault = _resolve_tolerance(table[row, j], getattr(tolerance, field), math.inf)
                if fault:
                    what = f"Illegal {field} {kind} tolerance value specified for joint '{tolerance.name}'."
                    return table, f"{what} Using default tolerances."
        return changed, ""


def describe_violation(errors: Vector, tolerances: Vector, joints: Sequence[str]) -> str:
    """Describe the joint that exceeds its tolerance most, worded as in ros2_control.

    Args:
        errors: absolute error of each joint, shape (3, n): position, velocity, acceleration [rad or m, per s, per s²].
        tolerances: tolerances in the same shape.
        joints: names of the joints.
    """
    excess = np.where(np.isfinite(tolerances), errors - tolerances, -np.inf)
    row, j = np.unravel_index(int(np.argmax(excess)), excess.shape)
    field = ("Position", "Velocity", "Acceleration")[row]
    return f"{joints[int(j)]}: {field} Error: {errors[row, j]:f}, {field} Tolerance: {tolerances[row, j]:f}"


def _infinite_if_zero(tolerances: Sequence[float]) -> Vector:
    return np.array([t if t > 0.0 else math.inf for t in tolerances])


def _resolve_tolerance(default: float, requested: float, erased: float) -> tuple[float, str]:
    if requested > 0.0:
        return requested, ""
    if requested == -1.0:
        return erased, ""
    return default, "" if requested == 0.0 else f"{requested:g}"
