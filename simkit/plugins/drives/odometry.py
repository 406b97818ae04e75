"""Odometry of wheeled bases: dead reckoning from wheel travel.

The formulas accept a number, or an array with one number for each of several bases, with the same bits.
`TravelOdometry` computes the odometry of one base from the angles at every step, `FleetOdometry` that of all bases of a
simulation, and `WheelOdometryRows` that of one base in many simulations, from the angles at the necessary steps alone.
"""

from __future__ import annotations

import abc
import copy
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.plugins.drives.odometry_messages import BodyTwist, PlanarPose
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.pose import Pose, Vector, quat_conjugate, quat_rotate
from simkit.runtime.array_rules import CannotBatchError, Floats, Grid, Ids, Ticks, is_due, last_due
from simkit.runtime.handles.joint import first_velocity

if TYPE_CHECKING:
    from simkit.msgs import Message
    from simkit.runtime import Joint, Link, Model
    from simkit.runtime.state_arrays import StateArrays

COMMAND_TYPES = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
UNKNOWN = 1e12  # variance of quantities that a planar base does not measure; Gazebo uses the same number
MEAN_STEPS = 10  # window of the mean twist [steps], the same as Gazebo's
LONGEST = 1000  # largest number of stored angles [steps]; then the angles are integrated

Number = Any
"""A float, or an array with a float for each of several bases."""

Angles = Sequence[Number] | Vector
"""Joint angles [rad]."""

Motion = tuple[Number, Number, Number]
"""Displacement of a base in its own axes: forward [m], to the left [m] and rotation [rad]."""


def base_motion(left: Number, right: Number, separation: Number) -> Motion:
    """Return the displacement of a base whose wheels roll without slip, or its velocity.

    Args:
        left: distance that the rim of the left wheel rolls [m], or its speed [m/s].
        right: the same of the right wheel.
        separation: distance between the wheels [m].
    """
    return (left + right) / 2, 0.0, (right - left) / separation


def wheel_motion(before: Angles, after: Angles, radius: Number, separation: Number) -> Motion:
    """Return the displacement along the arc on which both wheels roll, from their angles (left, right) [rad]."""
    return base_motion((after[0] - before[0]) * radius, (after[1] - before[1]) * radius, separation)


def rim_speeds(forward: Number, turn: Number, separation: Number) -> tuple[Number, Number]:
    """Return the rim speeds of the left and the right wheel [m/s].

    Args:
        forward: forward speed of the base [m/s].
        turn: turning rate of the base [rad/s].
        separation: distance between the wheels [m].
    """
    half = turn * separation / 2
    return forward - half, forward + half


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
        ahead, _, turn = base_motion(left, right, separation)
        self.go(ahead, sideways, turn)

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
        return PlanarPose(self.x, self.y, self.yaw)()

    def __deepcopy__(self, memo: dict[int, object]) -> DeadReckoning:
        """Return a copy for a snapshot, in a tenth of the time of `deepcopy`."""
        return DeadReckoning(self.x, self.y, self.yaw)


def rolling_twist(wheels: Sequence[Joint], radius: float, separation: float) -> BodyTwist:
    """Return the twist of a body from the speeds of its first two wheels, left and right.

    Args:
        wheels: Left and right wheel joint; further joints are ignored.
        radius: Radius of the wheels [m].
        separation: Distance between the wheels [m].
    """
    left, right = (first_velocity(wheel) * radius for wheel in wheels[:2])
    ahead, _, turn = base_motion(left, right, separation)
    return BodyTwist((ahead, 0.0, 0.0), (0.0, 0.0, turn))


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

    def _advance(self, motion: Motion) -> None:
        """Advance the pose along one arc."""
        self.reckoning.go(*motion)

    def _roll(self, angles: Angles) -> None:
        """Integrate the pose over all stored angles, up to the current angles."""
        noted = self._noted
        last = self._at if self._at is not None else (noted or [angles])[0]
        for point in (*noted[self.stride :: self.stride], angles):
            self._advance(self.motion(last, point))
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
        noter: Callback that passes collected angles to this object, if a `FleetOdometry` collects the angles of many
            drives.
    """

    noter: Callable[[], None] | None = None

    def __init__(self, radius: Number, separation: Number, step: float) -> None:
        super().__init__(step)
        self._radius, self._separation = radius, separation

    def motion(self, before: Angles, after: Angles) -> Motion:
        """Return the displacement along the arc on which both wheels roll."""
        return wheel_motion(before, after, self._radius, self._separation)

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

    def __deepcopy__(self, memo: dict[int, object]) -> WheelOdometry:
        """Return an independent copy for a snapshot."""
        self.catch_up()
        duplicate = WheelOdometry(self._radius, self._separation, self._step)
        duplicate.reckoning, duplicate.twist, duplicate._at = copy.copy(self.reckoning), self.twist, self._at
        duplicate._noted, duplicate._recent = list(self._noted), list(self._recent)
        return duplicate


class FleetOdometry(WheelOdometry):
    """Odometry of several drives together, whose angles are stored and read at the same steps.

    Sets of angles are arrays of the shape (2, drives): left wheels, right wheels.

    Args:
        members: odometry of each drive.
    """

    def __init__(self, members: Sequence[WheelOdometry]) -> None:
        radius, separation = (
            np.array([getattr(member, name) for member in members]) for name in ("_radius", "_separation")
        )
        super().__init__(radius, separation, members[0]._step)
        self._members = list(members)
        self._is_joined = False

    def join(self) -> bool:
        """Continue the integration of the members; false if the members have not all been read at the same step."""
        if self._is_joined:
            return True
        first, members = self._members[0], self._members
        if first._at is None or not first._recent:
            return False
        if any(m._at is None or m._noted or len(m._recent) != len(first._recent) for m in members):
            return False
        self._at = np.array([member._at for member in members]).T
        self._recent = list(np.array([member._recent for member in members]).transpose(1, 2, 0))
        self._is_joined = True
        return True

    def hand_over(self) -> None:
        """Give the members the results and the stored angles, so that each can continue alone."""
        if self._is_joined:
            assert self._at is not None
            ends, recent = np.asarray(self._at).T.tolist(), np.stack(self._recent).transpose(2, 0, 1).tolist()
            for member, end, steps, twist in zip(self._members, ends, recent, self.twists(), strict=True):
                member._at, member._recent = tuple(end), [tuple(angles) for angles in steps]
                member.twist = BodyTwist((twist[0], 0.0, 0.0), (0.0, 0.0, twist[1]))
            self._is_joined = False
        if self._noted:
            noted, self._noted = np.stack(self._noted).transpose(2, 0, 1).tolist(), []
            for member, steps in zip(self._members, noted, strict=True):
                member.note_all([tuple(angles) for angles in steps])

    def note(self, angles: Angles) -> None:
        """Store the angles before a step."""
        self._noted.append(angles)
        if len(self._noted) >= LONGEST:
            self.hand_over()

    def twists(self) -> list[list[float]]:
        """Return the mean forward speed [m/s] and turning rate [rad/s] of each drive."""
        twists: list[list[float]] = np.stack((self.twist.linear[0], self.twist.angular[2]), axis=1).tolist()
        return twists

    def _advance(self, motion: Motion) -> None:
        ahead, _, turn = motion
        for member, distance, angle in zip(self._members, ahead.tolist(), turn.tolist(), strict=True):
            member.reckoning.go(distance, 0.0, angle)


class OdometryRows:
    """Odometry from the two wheels of one base in n simulations.

    Args:
        count: number of simulations.
        radius: Radius of the wheels [m].
        separation: Distance between the wheels [m].

    Attributes:
        angles: Angles of the wheels at the last integrated point [rad], shape (count, 2).
        reckonings: Pose of each simulation at this point.
        values: Numbers of the last message, shape (count, 6): x, y [m], yaw [rad], forward speed, speed to the left
            [m/s] and turning rate [rad/s].
    """

    def __init__(self, count: int, radius: float, separation: float) -> None:
        self._radius, self._separation = radius, separation
        self.angles, self.reckonings = np.zeros((count, 2)), [DeadReckoning() for _ in range(count)]
        self.values = np.zeros((count, 6))

    def roll(self, ids: Ids, angles: Floats) -> None:
        """Advance the poses of some simulations along one arc, up to the angles of the wheels [rad], shape (n, 2)."""
        ahead, _, turn = wheel_motion(self.angles[ids].T, angles.T, self._radius, self._separation)
        self.angles[ids] = angles
        for row, distance, angle in zip(ids.tolist(), ahead.tolist(), turn.tolist(), strict=True):
            self.reckonings[row].go(distance, 0.0, angle)

    def store(self, ids: Ids, before: Floats, angles: Floats, elapsed: Floats | float) -> None:
        """Store the numbers of messages.

        Args:
            ids: simulations.
            before: angles of the wheels at the start of the mean twist [rad], shape (n, 2); or zero for speeds.
            angles: present angles, or the present speeds [rad/s], shape (n, 2).
            elapsed: time between both [s]; 1 for speeds.
        """
        ahead, _, turn = wheel_motion(before.T, angles.T, self._radius, self._separation)
        ways = [self.reckonings[row] for row in ids.tolist()]
        self.values[ids, :3] = [(way.x, way.y, way.yaw) for way in ways]
        self.values[ids, 3], self.values[ids, 5] = ahead / elapsed, turn / elapsed


class WheelOdometryRows(OdometryRows):
    """Odometry of `WheelOdometry` in n simulations, which needs the angles at few steps.

    These steps are those of the messages, those at the start of the mean twist of a message, and those between two arcs
    of the pose.

    Args:
        count, radius, separation: as for `OdometryRows`.
        step: Time of a step [s].
        grid: Ticks of the messages; None for every step.
    """

    def __init__(self, count: int, radius: float, separation: float, step: float, grid: Grid) -> None:
        super().__init__(count, radius, separation)
        self._step, self._grid = step, grid
        # angles before the last steps, at the index of the tick modulo their number
        self._recent, self._first_tick = np.zeros((count, MEAN_STEPS, 2)), np.zeros(count, np.int64)

    def take(self, row: int, tick: int, odometry: WheelOdometry, present: Angles) -> None:
        """Copy an odometry to one row, integrated up to the last complete arc; `present` are the angles now [rad]."""
        odometry.catch_up()
        noted = odometry._noted
        self.reckonings[row] = copy.copy(odometry.reckoning)
        self.angles[row] = odometry._at if odometry._at is not None else (*noted, present)[0]
        for angles in (*noted, present)[odometry.stride :: odometry.stride]:
            self.roll(np.array([row]), np.array([angles]))
        recent = [*odometry._recent, *noted][-MEAN_STEPS:]
        self._first_tick[row] = tick - len(recent)
        self._recent[row] = (*recent, present)[0]
        for back, angles in enumerate((present, *reversed(recent))):
            if back < MEAN_STEPS:  # the present angles take the place of the oldest ones
                self._recent[row, (tick - back) % MEAN_STEPS] = angles

    def next_stop(self, tick: int) -> int:
        """Return the first tick after a tick at which `note` must be called."""
        grid = self._grid
        if grid is None:
            return tick + 1
        since = (tick - last_due(grid, tick)) % WheelOdometry.stride
        return min(grid.next(tick), grid.next(tick + MEAN_STEPS) - MEAN_STEPS, tick + WheelOdometry.stride - since)

    def note(self, ids: Ids, ticks: Ticks, angles: Floats) -> None:
        """Store the angles after a step [rad], shape (n, 2), and update the numbers of a message that is due."""
        tick = int(ticks[0])
        if self.next_stop(tick - 1) != tick:
            return
        slots, is_message = ticks % MEAN_STEPS, is_due(self._grid, tick)
        if is_message or (tick - last_due(self._grid, tick)) % WheelOdometry.stride == 0:
            self.roll(ids, angles)
        if is_message:
            elapsed = np.minimum(MEAN_STEPS, ticks - self._first_tick[ids]) * self._step
            self.store(ids, self._recent[ids, slots], angles, elapsed)
        self._recent[ids, slots] = angles


def command_of(message: Message) -> tuple[float, float] | None:
    """Return the forward speed [m/s] and turning rate [rad/s] of a Twist or TwistStamped; None if one is not finite."""
    twist: Message = getattr(message, "twist", message)
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

    def rows(self, states: StateArrays, ids: Ids) -> Floats:
        """Return the truth in some of n simulations, with the numbers of `OdometryRows.values`, shape (len(ids), 6)."""
        name, link = self._frame.scoped, self._link.scoped
        position, quaternion = states.position(name)[ids], states.quaternion(name)[ids]
        linear = _rotate_back(quaternion, states.linear_velocity(link)[ids])
        spin = _rotate_back(quaternion, states.angular_velocity(link)[ids])
        linear = linear + np.cross(spin, np.array(self._arm))
        numbers = position[:, 0], position[:, 1], states.yaw(name)[ids], linear[:, 0], linear[:, 1], spin[:, 2]
        return np.column_stack(numbers)

    def place_rows(self, states: StateArrays) -> Callable[[Ids], Floats]:
        """Return the function that computes `place` in some of n simulations, shape (len(ids), 7).

        Raises:
            CannotBatchError: the model has no moving link.
        """
        name = self._frame.scoped
        try:
            states.place(name)
        except KeyError:
            raise CannotBatchError(f"the pose of the static model {name!r}") from None
        root = states.sim.engine.names.link(self._link.scoped).root_joint_qpos
        start = int(root) if self._frame is self._link else -1
        if start >= 0:  # a free link's state has its pose without rounding errors
            return lambda ids: states.qpos[ids, start : start + 7]
        return lambda ids: np.hstack((states.position(name)[ids], states.quaternion(name)[ids]))


def _rotate_back(quaternions: Floats, vectors: Floats) -> Floats:
    """Rotate vectors by the inverses of unit quaternions w, x, y, z."""
    w, v = quaternions[:, :1], -quaternions[:, 1:]
    twice = 2.0 * np.cross(v, vectors)
    rotated: Floats = vectors + w * twice + np.cross(v, twice)
    return rotated


def planar_covariance(x: float, y: float, yaw: float) -> Vector:
    """Return a 6×6 row-major covariance, shape (36,), of a planar pose.

    Args:
        x: Variance of x [m²].
        y: Variance of y [m²].
        yaw: Variance of yaw [rad²]. The other diagonal entries are `UNKNOWN`.
    """
    return np.diag((x, y, UNKNOWN, UNKNOWN, UNKNOWN, yaw)).reshape(36)
