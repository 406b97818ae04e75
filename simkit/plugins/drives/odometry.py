"""Odometry of wheeled bases: dead reckoning from wheel travel."""

from __future__ import annotations

import abc
import copy
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.pose import Pose, Vector, quat_conjugate, quat_from_rpy, quat_rotate

if TYPE_CHECKING:
    from simkit.runtime import Joint, Link, Model

COMMAND_TYPES = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
UNKNOWN = 1e12  # variance of quantities that a planar base does not measure; Gazebo uses the same number
MEAN_STEPS = 10  # window of the mean twist [steps], the same as Gazebo's
LONGEST = 1000  # largest number of stored angles [steps]; then the angles are integrated

Angles = tuple[float, ...]
"""Joint angles [rad]."""

Motion = tuple[float, float, float]
"""Displacement of a base in its own axes: forward [m], to the left [m] and rotation [rad]."""


@dataclass(slots=True)
class DeadReckoning:
    """Planar pose of the midpoint between two wheels, integrated from their travel: x, y [m], yaw [rad]."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def advance(self, left: float, right: float, separation: float, sideways: float = 0.0) -> None:
        """Advance the pose by the travel of both wheels, along an arc of constant curvature.

        Args:
            left: Distance rolled by the left wheel [m].
            right: Distance rolled by the right wheel [m].
            separation: Distance between the wheels [m].
            sideways: Distance slid to the left [m].
        """
        self.go((left + right) / 2, sideways, (right - left) / separation)

    def go(self, ahead: float, left: float, turn: float) -> None:
        """Advance the pose along an arc of constant curvature, by the exponential map of SE(2).

        Args:
            ahead: Forward distance in the base's axes, which turn with the base [m].
            left: Distance to the left in the same axes [m].
            turn: Rotation to the left [rad].
        """
        half = turn / 2
        # ratio of chord to arc; below 1e-4 the series is more precise than sin(x)/x
        part = math.sin(half) / half if abs(half) > 1e-4 else 1 - half * half / 6
        cos, sin = math.cos(self.yaw + half) * part, math.sin(self.yaw + half) * part
        self.x += ahead * cos - left * sin
        self.y += ahead * sin + left * cos
        self.yaw += turn

    @property
    def pose(self) -> Pose:
        """Pose with z = 0."""
        return planar_pose(self.x, self.y, self.yaw)

    def __deepcopy__(self, memo: dict[int, object]) -> DeadReckoning:
        """Return a copy for a snapshot, in a tenth of the time of `deepcopy`."""
        return DeadReckoning(self.x, self.y, self.yaw)


def planar_pose(x: float, y: float, yaw: float) -> Pose:
    """Return the pose of x, y [m] and yaw [rad] with z = 0."""
    return Pose((x, y, 0.0), quat_from_rpy(0.0, 0.0, yaw))


@dataclass(frozen=True, slots=True)
class BodyTwist:
    """Velocities in the body's own axes: linear [m/s] and angular [rad/s], each (x, y, z)."""

    linear: Sequence[float] | Vector = (0.0, 0.0, 0.0)
    angular: Sequence[float] | Vector = (0.0, 0.0, 0.0)


def rolling_twist(wheels: Sequence[Joint], radius: float, separation: float) -> BodyTwist:
    """Return the twist of a body from the speeds of its first two wheels, left and right.

    Args:
        wheels: Left and right wheel joint; further joints are ignored.
        radius: Radius of the wheels [m].
        separation: Distance between the wheels [m].
    """
    left, right = (_first_velocity(wheel) * radius for wheel in wheels[:2])
    return BodyTwist(((left + right) / 2, 0.0, 0.0), (0.0, 0.0, (right - left) / separation))


def _first_velocity(joint: Joint) -> float:
    """Return the velocity of a joint about its first axis [rad/s]."""
    if joint._one_dof >= 0:
        return float(joint._physics.data.qvel.item(joint._one_dof))
    return float(np.ravel(joint.velocity)[0])


class TravelOdometry(abc.ABC):
    """Base class of odometry that is computed from joint angles at every step.

    A step only stores the angles; the pose is integrated when it is read. The twist is the mean over the last ten
    steps, or over all steps if there are fewer, as most of Gazebo's drives compute it.

    Attributes:
        stride: Number of steps that are integrated as one arc.
        mean_steps: Number of steps in the mean twist.
        reckoning: Planar pose at the last call of `reckon`; the first pose is zero.
        twist: Mean twist at the last call of `reckon`, in the base's axes.
    """

    stride = MEAN_STEPS
    mean_steps = MEAN_STEPS

    def __init__(self, step: float) -> None:
        self._step = step
        self.reckoning, self.twist = DeadReckoning(), BodyTwist()
        self._at: Angles | None = None  # angles at the last integrated point
        self._noted: list[Angles] = []  # angles that are not integrated yet, one entry per step
        self._recent: list[Angles] = []  # last integrated entries, for the mean twist

    @abc.abstractmethod
    def motion(self, before: Angles, after: Angles) -> Motion:
        """Return the displacement along the arc between two sets of angles [rad]."""

    def note(self, angles: Angles) -> None:
        """Store the angles before a step."""
        if len(self._noted) >= LONGEST:
            self._roll(angles)
        self._noted.append(angles)

    def reckon(self, angles: Angles) -> None:
        """Update `reckoning` and `twist` to the angles after a step."""
        self._roll(angles)
        elapsed = len(self._recent) * self._step
        ahead, left, turn = (total / elapsed for total in self._total_motion(angles))
        self.twist = BodyTwist((ahead, left, 0.0), (0.0, 0.0, turn))

    def _total_motion(self, angles: Angles) -> Motion:
        """Return the displacement over the steps of the mean twist, up to the current angles."""
        ahead = left = turn = 0.0
        for before, after in pairwise([*self._recent, angles]):
            more = self.motion(before, after)
            ahead, left, turn = ahead + more[0], left + more[1], turn + more[2]
        return ahead, left, turn

    def _roll(self, angles: Angles) -> None:
        """Integrate the pose over all stored angles, up to the current angles."""
        noted = self._noted
        last = self._at if self._at is not None else (noted or [angles])[0]
        for point in (*noted[self.stride :: self.stride], angles):
            self.reckoning.go(*self.motion(last, point))
            last = point
        self._at = angles
        self._recent = [*self._recent, *noted][-self.mean_steps :] or [angles]
        self._noted = []


class WheelOdometry(TravelOdometry):
    """Odometry from the angles of the left and the right wheel, equal to gz-math's `DiffDriveOdometry`.

    Args:
        radius: Radius of the wheels [m].
        separation: Distance between the wheels [m].
        step: Time between two calls of `note` [s].

    Attributes:
        noter: Callback that passes collected angles to this object, if a `DriveFleet` collects the angles of many
            drives.
    """

    noter: Callable[[], None] | None = None

    def __init__(self, radius: float, separation: float, step: float) -> None:
        super().__init__(step)
        self._radius, self._separation = radius, separation

    def motion(self, before: Angles, after: Angles) -> Motion:
        """Return the displacement along the arc on which both wheels roll."""
        left, right = ((new - old) * self._radius for new, old in zip(after, before, strict=True))
        return (left + right) / 2, 0.0, (right - left) / self._separation

    def note(self, angles: Angles) -> None:
        """Store the angles before a step."""
        self.catch_up()
        super().note(angles)

    def _total_motion(self, angles: Angles) -> Motion:
        return self.motion(self._recent[0], angles)

    def _roll(self, angles: Angles) -> None:
        self.catch_up()
        super()._roll(angles)

    def catch_up(self) -> None:
        """Store the angles that a fleet has collected for this drive."""
        if self.noter is not None:
            self.noter()

    def note_all(self, angles: Sequence[Angles]) -> None:
        """Store the angles of several steps."""
        if len(self._noted) + len(angles) <= LONGEST:
            self._noted += angles
            return
        for step_angles in angles:
            super().note(step_angles)

    def take(self, at: Angles, recent: Sequence[Angles], twist: tuple[float, float]) -> None:
        """Replace the integration state by results that a fleet computed.

        Args:
            at: Angles at the last integrated point [rad].
            recent: Angles of the last steps before `at` [rad].
            twist: Forward speed [m/s] and turning rate [rad/s].
        """
        self._at, self._recent = at, list(recent)
        self.twist = BodyTwist((twist[0], 0.0, 0.0), (0.0, 0.0, twist[1]))

    def __deepcopy__(self, memo: dict[int, object]) -> WheelOdometry:
        """Return an independent copy for a snapshot."""
        self.catch_up()
        duplicate = WheelOdometry(self._radius, self._separation, self._step)
        duplicate.reckoning, duplicate.twist, duplicate._at = copy.copy(self.reckoning), self.twist, self._at
        duplicate._noted, duplicate._recent = list(self._noted), list(self._recent)
        return duplicate


def wheel_angles(left: Joint, right: Joint) -> tuple[float, float]:
    """Return the angles of two joints about their first axes [rad], faster than `Joint.position`."""
    qpos = left._physics.data.qpos
    return qpos.item(left._first_qpos), qpos.item(right._first_qpos)


def joint_angles(joints: Sequence[Joint]) -> Angles:
    """Return the angles of any number of joints about their first axes [rad], as fast as `wheel_angles`."""
    qpos: Vector = joints[0]._physics.data.qpos
    return tuple(qpos.item(joint._first_qpos) for joint in joints)


def command_of(message: Any) -> tuple[float, float] | None:
    """Return the forward speed [m/s] and turning rate [rad/s] of a Twist or TwistStamped; None if one is not finite."""
    twist = getattr(message, "twist", message)
    forward, turn = float(twist.linear.x), float(twist.angular.z)
    return (forward, turn) if math.isfinite(forward) and math.isfinite(turn) else None


class TrueMotion(SharedByCopies):
    """Ground truth of a model's pose and twist.

    Args:
        model: Handle of the model.
        canonical: Handle of its canonical link, which carries the model's frame.
    """

    def __init__(self, model: Model, canonical: Link) -> None:
        self._link = canonical
        # if both frames coincide, the link's pose is cheaper to read
        self._frame: Model | Link = canonical if canonical.scene.pose_world == model.scene.pose_world else model
        # constant vector from the link's origin to the model's origin, in the model's axes
        there = model.scene.pose_world.inverse().transform(canonical.scene.pose_world.position)
        self._arm = (-there).tolist()

    def place(self) -> tuple[float, ...]:
        """Return the world pose of the model's frame as x, y, z, qw, qx, qy, qz; fast enough for every step."""
        if self._frame is self._link and (state := self._link.root_state()) is not None:
            return state
        pose = self._frame.pose
        return (*pose.position.tolist(), *pose.quaternion.tolist())

    def state(self) -> tuple[Pose, BodyTwist]:
        """Return the world pose of the model's frame, and the frame's twist in its own axes."""
        pose = self._frame.pose
        back = quat_conjugate(pose.quaternion)
        x, y, z = quat_rotate(back, self._link.linear_velocity).tolist()
        angular = quat_rotate(back, self._link.angular_velocity).tolist()
        (wx, wy, wz), (ax, ay, az) = angular, self._arm
        return pose, BodyTwist((x + wy * az - wz * ay, y + wz * ax - wx * az, z + wx * ay - wy * ax), angular)


def planar_covariance(x: float, y: float, yaw: float) -> Vector:
    """Return a 6×6 row-major covariance, shape (36,), of a planar pose.

    Args:
        x: Variance of x [m²].
        y: Variance of y [m²].
        yaw: Variance of yaw [rad²]. The other diagonal entries are `UNKNOWN`.
    """
    return np.diag((x, y, UNKNOWN, UNKNOWN, UNKNOWN, yaw)).reshape(36)
