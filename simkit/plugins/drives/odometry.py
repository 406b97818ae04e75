"""What wheeled bases share: dead reckoning from wheel travel, and the messages that carry it."""

from __future__ import annotations

import abc
import copy
import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit import msgs
from simkit.pose import Pose, Vector, quat_conjugate, quat_from_rpy, quat_rotate

if TYPE_CHECKING:
    from simkit.runtime import Joint, Link, Model

ODOMETRY = "nav_msgs/msg/Odometry"
TRANSFORMS = "tf2_msgs/msg/TFMessage"
COMMAND_TYPES = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
UNKNOWN = 1e12  # variance of what a planar base does not measure, as Gazebo writes it
MEAN_STEPS = 10  # of the mean of a twist, as Gazebo's
LONGEST = 1000  # steps that angles are kept of

Angles = tuple[float, ...]
"""Of joints [rad]."""

Motion = tuple[float, float, float]
"""How far ahead [m], to the left [m] and round [rad] a base has gone, in its own axes."""


@dataclass(slots=True)
class DeadReckoning:
    """Planar pose of the point between two wheels, from how far each has rolled: x, y [m], yaw [rad]."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def advance(self, left: float, right: float, separation: float, sideways: float = 0.0) -> None:
        """Rolls on along an arc of constant curvature.

        Args:
            left, right: distance rolled by each wheel [m].
            separation: between the wheels [m].
            sideways: distance slid to the left [m].
        """
        self.go((left + right) / 2, sideways, (right - left) / separation)

    def go(self, ahead: float, left: float, turn: float) -> None:
        """On along an arc of constant curvature: the exponential of SE(2).

        Args:
            ahead, left: in the base's own axes, which turn on the way [m].
            turn: to the left [rad].
        """
        half = turn / 2
        # chord of the arc; the series keeps full precision where sin(x)/x would lose it
        part = math.sin(half) / half if abs(half) > 1e-4 else 1 - half * half / 6
        cos, sin = math.cos(self.yaw + half) * part, math.sin(self.yaw + half) * part
        self.x += ahead * cos - left * sin
        self.y += ahead * sin + left * cos
        self.yaw += turn

    @property
    def pose(self) -> Pose:
        return Pose((self.x, self.y, 0.0), quat_from_rpy(0.0, 0.0, self.yaw))


@dataclass(frozen=True, slots=True)
class BodyTwist:
    """Velocities in the body's own axes: linear [m/s] and angular [rad/s], each (x, y, z)."""

    linear: Sequence[float] | Vector = (0.0, 0.0, 0.0)
    angular: Sequence[float] | Vector = (0.0, 0.0, 0.0)


def rolling_twist(wheels: Sequence[Joint], radius: float, separation: float) -> BodyTwist:
    """What the turning of the first two wheels, left and right, says of the body between them; lengths m."""
    left, right = (float(wheel.velocity) * radius for wheel in wheels[:2])
    return BodyTwist(((left + right) / 2, 0.0, 0.0), (0.0, 0.0, (right - left) / separation))


class TravelOdometry(abc.ABC):
    """Odometry from what the joints of a base say at the end of every step.

    Angles are only noted at a step; what they say is worked out when it is asked for. The twist is the mean over the
    last ten steps, or as many as there were, as Gazebo has it for most bases.

    Attributes:
        stride: how many steps are taken for one arc.
        mean_steps: how many steps the twist is the mean over.
        reckoning: where the base was on the plane at the last `reckon`; it begins at zero.
        twist: over the last steps before that, in the base's axes.
    """

    stride = MEAN_STEPS
    mean_steps = MEAN_STEPS

    def __init__(self, step: float) -> None:
        self._step = step
        self.reckoning, self.twist = DeadReckoning(), BodyTwist()
        self._at: Angles | None = None  # angles that the way is reckoned up to
        self._noted: list[Angles] = []  # one a step
        self._recent: list[Angles] = []  # the last ones that the way is reckoned of

    @abc.abstractmethod
    def motion(self, before: Angles, after: Angles) -> Motion:
        """What a change of angles [rad] says; it is additive along an arc."""

    def note(self, angles: Angles) -> None:
        """Before every step."""
        if len(self._noted) >= LONGEST:
            self._roll(angles)
        self._noted.append(angles)

    def reckon(self, angles: Angles) -> None:
        """After a step: brings `reckoning` and `twist` up to it."""
        self._roll(angles)
        elapsed = len(self._recent) * self._step
        ahead, left, turn = (total / elapsed for total in self._total_motion(angles))
        self.twist = BodyTwist((ahead, left, 0.0), (0.0, 0.0, turn))

    def _total_motion(self, angles: Angles) -> Motion:
        """How far it went in the last steps, up to these angles."""
        ahead = left = turn = 0.0
        for before, after in pairwise([*self._recent, angles]):
            more = self.motion(before, after)
            ahead, left, turn = ahead + more[0], left + more[1], turn + more[2]
        return ahead, left, turn

    def _roll(self, angles: Angles) -> None:
        """Along all that was noted, and on to these angles."""
        noted = self._noted
        last = self._at if self._at is not None else (noted or [angles])[0]
        for point in (*noted[self.stride :: self.stride], angles):
            self.reckoning.go(*self.motion(last, point))
            last = point
        self._at = angles
        self._recent = [*self._recent, *noted][-self.mean_steps :] or [angles]
        self._noted = []


class WheelOdometry(TravelOdometry):
    """Odometry from the angles of the left and the right wheel, as gz-math's `DiffDriveOdometry` has it.

    Args:
        radius, separation: of the wheels [m].
        step: from one noting to the next [s].

    Attributes:
        noter: notes for it what is still to be noted, where somebody does that for many (see `DriveFleet`).
    """

    noter: Callable[[], None] | None = None

    def __init__(self, radius: float, separation: float, step: float) -> None:
        super().__init__(step)
        self._radius, self._separation = radius, separation

    def motion(self, before: Angles, after: Angles) -> Motion:
        """Along the arc that both wheels roll."""
        left, right = ((new - old) * self._radius for new, old in zip(after, before, strict=True))
        return (left + right) / 2, 0.0, (right - left) / self._separation

    def note(self, angles: Angles) -> None:
        """Before every step."""
        self.catch_up()
        super().note(angles)

    def _total_motion(self, angles: Angles) -> Motion:
        return self.motion(self._recent[0], angles)

    def _roll(self, angles: Angles) -> None:
        self.catch_up()
        super()._roll(angles)

    def catch_up(self) -> None:
        """Has noted what others have seen for it."""
        if self.noter is not None:
            self.noter()

    def note_all(self, angles: Sequence[Angles]) -> None:
        """Those of several steps."""
        if len(self._noted) + len(angles) <= LONGEST:
            self._noted += angles
            return
        for one in angles:
            super().note(one)

    def take(self, at: Angles, recent: Sequence[Angles], twist: tuple[float, float]) -> None:
        """What others have reckoned for it: up to which angles, those of the steps before, speed ahead and turning."""
        self._at, self._recent = at, list(recent)
        self.twist = BodyTwist((twist[0], 0.0, 0.0), (0.0, 0.0, twist[1]))

    def __deepcopy__(self, memo: dict[int, object]) -> WheelOdometry:
        """A state of its own, for a snapshot."""
        self.catch_up()
        made = WheelOdometry(self._radius, self._separation, self._step)
        made.reckoning, made.twist, made._at = copy.copy(self.reckoning), self.twist, self._at
        made._noted, made._recent = list(self._noted), list(self._recent)
        return made


def wheel_angles(left: Joint, right: Joint) -> tuple[float, float]:
    """Of two joints with one axis [rad]: cheaper than their positions, for every step."""
    qpos = left._physics.data.qpos
    return qpos.item(left._one_qpos), qpos.item(right._one_qpos)


def joint_angles(joints: Sequence[Joint]) -> Angles:
    """The same of more joints."""
    qpos: Vector = joints[0]._physics.data.qpos
    return tuple(qpos.item(joint._one_qpos) for joint in joints)


def command_of(message: Any) -> tuple[float, float] | None:
    """Forward speed [m/s] and turning rate [rad/s] of a Twist or TwistStamped; None unless both are finite."""
    twist = getattr(message, "twist", message)
    forward, turn = float(twist.linear.x), float(twist.angular.z)
    return (forward, turn) if math.isfinite(forward) and math.isfinite(turn) else None


class TrueMotion:
    """Where a model really is and how it moves.

    Args:
        model: handle of the model.
        canonical: handle of its canonical link, which carries the model's frame.
    """

    def __init__(self, model: Model, canonical: Link) -> None:
        self._link = canonical
        # where both frames are one, the link's pose is cheaper to read
        self._frame: Model | Link = canonical if canonical.scene.pose_world == model.scene.pose_world else model
        # from the link's origin to the model's, in the model's axes: fixed for ever
        there = model.scene.pose_world.inverse().transform(canonical.scene.pose_world.position)
        self._arm = (-there).tolist()

    def __deepcopy__(self, memo: dict[int, object]) -> TrueMotion:
        return self

    def place(self) -> tuple[float, ...]:
        """World pose of the model's frame as x, y, z, qw, qx, qy, qz: cheap enough for every step."""
        if self._frame is self._link and (state := self._link.root_state()) is not None:
            return state
        pose = self._frame.pose
        return (*pose.position.tolist(), *pose.quaternion.tolist())

    def state(self) -> tuple[Pose, BodyTwist]:
        """World pose of the model's frame, and that frame's velocity in its own axes."""
        pose = self._frame.pose
        back = quat_conjugate(pose.quaternion)
        x, y, z = quat_rotate(back, self._link.linear_velocity).tolist()
        angular = quat_rotate(back, self._link.angular_velocity).tolist()
        (wx, wy, wz), (ax, ay, az) = angular, self._arm
        return pose, BodyTwist((x + wy * az - wz * ay, y + wz * ax - wx * az, z + wx * ay - wy * ax), angular)


def planar_covariance(x: float, y: float, yaw: float) -> Vector:
    """6×6 row-major covariance, shape (36,): the three planar variances, and a huge one for the rest."""
    return np.diag((x, y, UNKNOWN, UNKNOWN, UNKNOWN, yaw)).reshape(36)


def odometry_message(
    time_ns: int,
    frame: str,
    child: str,
    pose: Pose,
    twist: BodyTwist,
    covariance: Vector | None = None,
    twist_covariance: Vector | None = None,
) -> msgs.Odometry:
    """A `nav_msgs/msg/Odometry`: pose of `child` in `frame`, twist in `child`'s axes.

    Covariances are row-major, shape (36,): zeros without one, and the twist's is the pose's where it has none.
    """
    types = message_types()
    point, vector, quaternion = types["Point"], types["Vector3"], types["Quaternion"]
    w, x, y, z = pose.quaternion.tolist()
    # each message its own arrays: who receives one may keep or change it
    first = np.zeros(36) if covariance is None else covariance.copy()
    second = first.copy() if twist_covariance is None else twist_covariance.copy()
    place = types["Pose"](point(*pose.position.tolist()), quaternion(x, y, z, w))
    motion = types["Twist"](vector(*map(float, twist.linear)), vector(*map(float, twist.angular)))
    message: msgs.Odometry = types["Odometry"](
        msgs.header(time_ns, frame),
        child,
        types["PoseWithCovariance"](place, first),
        types["TwistWithCovariance"](motion, second),
    )
    return message


def transform(time_ns: int, frame: str, child: str, pose: Pose) -> msgs.TransformStamped:
    """A `geometry_msgs/msg/TransformStamped`: where `child` is in `frame`."""
    types = message_types()
    w, x, y, z = pose.quaternion.tolist()
    place = types["Transform"](types["Vector3"](*pose.position.tolist()), types["Quaternion"](x, y, z, w))
    message: msgs.TransformStamped = types["TransformStamped"](msgs.header(time_ns, frame), child, place)
    return message


def transforms(time_ns: int, *items: tuple[str, str, Pose]) -> msgs.TFMessage:
    """A `tf2_msgs/msg/TFMessage`: for each (frame, child, pose), where `child` is in `frame`."""
    message: msgs.TFMessage = msgs.type_of(TRANSFORMS)([transform(time_ns, *item) for item in items])
    return message


@functools.cache
def message_types() -> Mapping[str, Any]:
    """The classes themselves: filling them directly is several times faster than `msgs.make`."""
    geometry = "Point Vector3 Quaternion Pose Twist PoseWithCovariance TwistWithCovariance Transform TransformStamped"
    others = (ODOMETRY, TRANSFORMS, "std_msgs/msg/Header", "builtin_interfaces/msg/Time")
    names = (*(f"geometry_msgs/msg/{name}" for name in geometry.split()), *others)
    return {name.rsplit("/", 1)[1]: msgs.type_of(name) for name in names}
