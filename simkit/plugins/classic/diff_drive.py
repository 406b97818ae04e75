"""Differential drive of Gazebo Classic: `libgazebo_ros_diff_drive.so`, with its ROS 2 and its ROS 1 spelling.

ROS 1's skid steering with four wheels is `libgazebo_ros_skid_steer_drive.so`. Each wheel is a velocity servo limited to
the wheel torque. Two differences to Gazebo Classic are deliberate. The acceleration ramp follows the commanded rim
speed, while Classic adds the speed error, which winds up while a wheel is blocked. If the odometry comes from encoders,
its forward speed is negative when the robot drives backwards.
"""

from __future__ import annotations

import abc
import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from simkit.elementary_functions import arithmetic_of
from simkit.params import Params
from simkit.plugins.classic.commanded_drive import CommandedDrive
from simkit.plugins.drives.drive_outputs import DriveOutputOptions, DriveOutputs
from simkit.plugins.drives.drive_rule import DifferentialDriveRule, DriveWheel
from simkit.plugins.drives.ground_truth import WHEEL_MOTION, GroundTruth
from simkit.plugins.drives.motion_errors import MotionErrorOptions, with_errors
from simkit.plugins.drives.odometry import (
    COMMAND_TYPES,
    DeadReckoning,
    OdometryRows,
    rim_speeds,
    rolling_twist,
    wheel_motion,
)
from simkit.plugins.drives.odometry_messages import (
    ODOMETRY,
    TRANSFORMS,
    BodyTwist,
    LatePose,
    PlanarPose,
)
from simkit.plugins.drives.odometry_noise import (
    EquivalentWheelAngles,
    NoisyOdometry,
    OdometryNoiseOptions,
    odometry_noise,
    replace_planar_pose,
)
from simkit.plugins.drives.wheel_joints import find_wheels
from simkit.plugins.endpoints import Endpoint, listens, publishes
from simkit.plugins.joint_states import JOINT_STATE
from simkit.plugins.options import (
    Options,
    block,
    boolean,
    choice,
    integer,
    number,
    numbers,
    text,
    texts,
    without_effect,
)
from simkit.plugins.ros_names import is_ros_1
from simkit.pose import Vector
from simkit.runtime.array_rules import CannotBatchError, Ids, Ticks, TopicRule, is_due, next_due
from simkit.runtime.handles.joint import wheel_angles

if TYPE_CHECKING:
    from simkit.compiler import ActuatorRef, SpecBuilder
    from simkit.runtime import Model
    from simkit.runtime.state_arrays import StateArrays
    from simkit.scene import SceneModel

_ROS_1 = ("robotNamespace", "leftJoint", "rightJoint", "wheelSeparation", "wheelDiameter", "commandTopic", "updateRate")
_CLOSE = 0.01  # rim speed error [m/s] below which a wheel jumps to its target


@dataclass(frozen=True, slots=True)
class Pair:
    """Opposite wheels: joint names, distance between them [m], radius [m]."""

    left: str
    right: str
    separation: float
    radius: float


class CommonDiffDriveOptions(DriveOutputOptions, abc.ABC):
    """Options of both spellings; an element that a spelling does not have is a constant."""

    command_topic: str = "cmd_vel"
    max_wheel_acceleration: float = 0.0
    odometry_source: str | int = "world"
    update_rate: float
    max_wheel_torque: float

    publish_ground_truth: bool = boolean()
    covariance_x: float = number(1e-5, minimum=0)
    covariance_y: float = number(1e-5, minimum=0)
    covariance_yaw: float = number(1e-3, minimum=0)
    odometry_noise: OdometryNoiseOptions = block(OdometryNoiseOptions)
    actuation_error: MotionErrorOptions = block(MotionErrorOptions)

    def read_all(self) -> Self:
        """Read the pairs of wheels, then all other options, and convert `<odometry_noise>`."""
        self.pairs = self._read_pairs()
        super().read_all()
        self.noise = odometry_noise(self.odometry_noise)
        self.actuation = self.actuation_error.motion_errors
        return self

    @abc.abstractmethod
    def _read_pairs(self) -> tuple[Pair, ...]:
        """Read the pairs of wheels."""

    @property
    def from_encoders(self) -> bool:
        """True if the odometry is computed from the wheels; False if the odometry is the ground truth."""
        return self.odometry_source in (0, "0", "encoder")


class DiffDriveOptions(CommonDiffDriveOptions):
    """Options in the spelling of ROS 2."""

    update_rate: float = number(100.0, "Hz", minimum=0)
    max_wheel_torque: float = number(5.0, "N·m", minimum=0)
    max_wheel_acceleration: float = number(0.0, "m/s²", minimum=0)
    odometry_frame: str = text("odom")
    robot_base_frame: str = text("base_footprint")
    odometry_source: int = integer(1, minimum=0, maximum=1)
    publish_odom: bool = boolean()
    publish_odom_tf: bool = boolean()
    publish_wheel_tf: bool = boolean()
    num_wheel_pairs: int = integer(1, minimum=1)
    left_joints: tuple[str, ...] = texts(element="left_joint", required=True)
    right_joints: tuple[str, ...] = texts(element="right_joint", required=True)
    wheel_separations: tuple[float, ...] = numbers("m", element="wheel_separation", minimum=1e-6)
    wheel_diameters: tuple[float, ...] = numbers("m", element="wheel_diameter", minimum=1e-6)

    def _read_pairs(self) -> tuple[Pair, ...]:
        _ = self.update_rate  # read first, so that its error is reported before the errors of the wheels
        count, left, right = self.num_wheel_pairs, self.left_joints, self.right_joints
        if left and right and not len(left) == len(right) == count:
            found_text = f"found {len(left)} <left_joint> and {len(right)} <right_joint>"
            allowed = f"expected one of each for each of {count} <num_wheel_pairs>"
            self.params.error("SK-PARAM-002", f"{found_text}, {allowed}")
            return ()
        # a pair without a number in the file gets Gazebo's default
        separations = [*self.wheel_separations, *[0.34] * (len(left) - len(self.wheel_separations))]
        diameters = [*self.wheel_diameters, *[0.15] * (len(left) - len(self.wheel_diameters))]
        joined = zip(left, right, separations, diameters, strict=False)
        return tuple(Pair(a, b, separation, diameter / 2) for a, b, separation, diameter in joined)


class DiffDriveRos1Options(CommonDiffDriveOptions):
    """Options in the spelling of ROS 1."""

    left_joint: str = text("left_joint", element="leftJoint")
    right_joint: str = text("right_joint", element="rightJoint")
    legacy_mode: bool = boolean(True, element="legacyMode")
    wheel_separation: float = number(0.34, "m", element="wheelSeparation", minimum=1e-6)
    wheel_diameter: float = number(0.15, "m", element="wheelDiameter", minimum=1e-6)
    publish_odom: bool = boolean(True, element="publishTf")
    update_rate: float = number(100.0, "Hz", element="updateRate", minimum=0)
    max_wheel_torque: float = number(5.0, "N·m", element="wheelTorque", minimum=0)
    max_wheel_acceleration: float = number(0.0, "m/s²", element="wheelAcceleration", minimum=0)
    command_topic: str = text("cmd_vel", element="commandTopic")
    odometry_topic: str = text("odom", element="odometryTopic")
    odometry_frame: str = text("odom", element="odometryFrame")
    robot_base_frame: str = text("base_footprint", element="robotBaseFrame")
    odometry_source: str = choice(("world", "encoder", "1", "0"), "world", element="odometrySource")
    publish_odom_tf: bool = boolean(True, element="publishOdomTF")
    publish_wheel_tf: bool = boolean(element="publishWheelTF")
    publish_wheel_joint_state: bool = boolean(element="publishWheelJointState")
    ros_debug_level: bool = without_effect(element="rosDebugLevel")

    def _read_pairs(self) -> tuple[Pair, ...]:
        left, right = self.left_joint, self.right_joint
        if self.legacy_mode:
            # files from before 2016 have swapped names of the wheels
            left, right = right, left
            if not self.params.has("legacyMode"):
                text = "no <legacyMode>: the left and the right wheel are exchanged, as in Gazebo Classic with ROS 1"
                hint = "if the robot turns to the wrong side: <legacyMode>false</legacyMode>"
                self.params.warning("SK-PARAM-009", text, hint)
        return (Pair(left, right, self.wheel_separation, self.wheel_diameter / 2),)

    @property
    def publishes_odom_tf(self) -> bool:
        return self.publish_odom_tf and self.publish_odom  # Gazebo's <publishTf> switches both


def read_options(params: Params) -> CommonDiffDriveOptions:
    """Read the options in either spelling; ROS 1's if one of its names occurs and there is no `<ros>` block."""
    if is_ros_1(params, _ROS_1):
        return DiffDriveRos1Options(params).read_all()
    options = DiffDriveOptions(params).read_all()
    for name, fixed in (("command_topic", options.command_topic), ("odometry_topic", options.odometry_topic)):
        # the ROS 2 plugin has no such element, but one that repeats the fixed name is harmless
        if any(c.name == name and c.value.strip("/") == fixed for c in params.children):
            params.child(name)
    return options


class GazeboRosDiffDrive(CommandedDrive):
    """Drives pairs of wheels from `cmd_vel`, and publishes odometry on `odom` and `/tf`.

    The last command stays active until the next. `<publish_ground_truth>` (simkit's own) publishes the model's true
    pose on `ground_truth/odom` and the slip of the wheels on `ground_truth/wheel_slip`, at the same instants as the
    odometry. `<odometry_noise>` (simkit's own) adds errors to
    the odometry of either source; the covariance of the odometry accumulates the wheels' errors. `<actuation_error>`
    (simkit's own) makes the wheels turn faster or slower than commanded.
    """

    endpoints: ClassVar[tuple[Endpoint, ...]] = (
        listens("cmd_vel", *COMMAND_TYPES, named_by=("commandTopic",)),
        publishes("odom", ODOMETRY, named_by=("odometryTopic",)),
        publishes("/tf", TRANSFORMS),
        publishes("ground_truth/odom", ODOMETRY),
        publishes("ground_truth/wheel_slip", WHEEL_MOTION),
        publishes("joint_states", JOINT_STATE),
    )
    option_types: ClassVar[tuple[type[Options], ...]] = (DiffDriveOptions, DiffDriveRos1Options)
    filenames = ("libgazebo_ros_diff_drive.so",)

    def read(self, params: Params) -> CommonDiffDriveOptions:
        """Read the options, with the element names of ROS 1 or ROS 2 that the file uses."""
        return read_options(params)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options = options = self.read(params)
        sides = {"left wheel": [p.left for p in options.pairs], "right wheel": [p.right for p in options.pairs]}
        wheels = find_wheels(scene, sides, params)
        self._joints: list[str] = []  # scoped names
        self._servos: list[ActuatorRef] = []
        self._canonical = scene.canonical_link
        for joint in (joint for pair in zip(*wheels.values(), strict=False) for joint in pair):
            self._joints.append(joint.scoped)
            servo = builder.add_velocity_servo(
                joint.scoped, max_effort=options.max_wheel_torque, owner=self.name, joint_limit=False
            )
            self._servos.append(servo)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self.start(parent, options.command_topic, options.update_rate)
        self._wheels = [self.sim.joint(name) for name in self._joints]
        self._rims = [0.0] * len(self._wheels)
        self._reckoning = DeadReckoning()
        self._angles = self._first_angles()
        self._erring, self._followed = self._create_noisy_odometry()
        self._last_read_ns = self.sim.time_ns
        self._outputs = DriveOutputs(
            self, options, [wheel.scene for wheel in self._wheels], lambda: self._measured()[0]
        )
        truth = parent, self._true, self._joints, "", options.robot_base_frame
        self._truth = GroundTruth(self, *truth) if options.publish_ground_truth else None

    # ------------------------------------------------------------------ commands

    def before_step(self) -> None:
        """Move each wheel's rim speed towards its target, by at most the acceleration limit."""
        (forward, turn), elapsed = with_errors(self.options.actuation, self._command), self._elapsed()
        for index, pair in enumerate(self.options.pairs):
            for side, target in enumerate(rim_speeds(forward, turn, pair.separation)):
                wheel = 2 * index + side
                speed = self._ramped(self._rims[wheel], target, elapsed)
                if speed != self._rims[wheel]:
                    self._rims[wheel] = speed
                    self.sim.engine.set_control(self._servos[wheel], speed / pair.radius)

    def _ramped(self, speed: Any, target: Any, elapsed: Any) -> Any:
        """Return the next rim speed towards a target [m/s]; each number may be an array."""
        limit = self.options.max_wheel_acceleration
        if limit == 0:
            return target
        of, step, missing = arithmetic_of(target), limit * elapsed, target - speed
        return of.where(abs(missing) < _CLOSE, target, speed + of.maximum(-step, of.minimum(step, missing)))

    # ------------------------------------------------------------------ readings

    def after_step(self) -> None:
        """Publish odometry, transforms, ground truth and joint states."""
        options = self.options
        if self._erring is not None:
            self._advance_with_noise(self._erring)
        elif options.from_encoders:
            self._advance()
        if self._truth is not None:
            self._truth.publish()
        if self._outputs.wants_odometry:
            self._outputs.tell(*self._measured(), *self._covariances())
        self._outputs.tell_joints()

    def _measured(self) -> tuple[LatePose, BodyTwist]:
        """Return pose and twist from `<odometry_source>`; the twist is in the robot's own axes.

        The pose may be a function that computes it later.
        """
        if self._erring is not None:
            reckoned, twist = self._erring.reckoning, self._erring.twist
            return (
                replace_planar_pose(self._true.state()[0], reckoned) if self._followed is not None else reckoned.pose
            ), twist
        if not self.options.from_encoders:
            return self._true.state()
        pair = self.options.pairs[0]
        reckoned = self._reckoning
        twist = rolling_twist(self._wheels, pair.radius, pair.separation)
        return PlanarPose(reckoned.x, reckoned.y, reckoned.yaw), twist

    def _create_noisy_odometry(self) -> tuple[NoisyOdometry | None, EquivalentWheelAngles | None]:
        """Return the odometry with noise; for ground truth, also return the wheel angles of the true motion."""
        options, followed = self.options, None
        if options.noise is None:
            return None, None
        pair, angles, start = options.pairs[0], self._angles, None
        if not options.from_encoders:
            followed = EquivalentWheelAngles(self._true.state()[0], pair.radius, pair.separation)
            angles, start = followed.angles, followed.start
        stream = self.random("odometry_noise", 2)
        return NoisyOdometry(options.noise, pair.radius, pair.separation, stream, angles, start), followed

    def _advance_with_noise(self, odometry: NoisyOdometry) -> None:
        now = self.sim.time_ns
        elapsed, self._last_read_ns = (now - self._last_read_ns) * 1e-9, now
        if self._followed is None:
            odometry.advance(*self._first_angles(), elapsed)
        else:
            left, right, sideways = self._followed.follow(self._true.state()[0])
            odometry.advance(left, right, elapsed, sideways)

    def _covariances(self) -> tuple[Vector, ...]:
        """Return the covariances of the accumulated wheel errors; none for the values in the file."""
        odometry = self._erring
        return () if odometry is None or not odometry.noise.wheel_variance else odometry.messages_covariance()

    def _advance(self) -> None:
        pair = self.options.pairs[0]
        angles = self._first_angles()
        self._reckoning.go(*wheel_motion(self._angles, angles, pair.radius, pair.separation))
        self._angles = angles

    def _first_angles(self) -> tuple[float, float]:
        left, right = self._wheels[:2]
        return wheel_angles(left, right)

    def array_rule(self) -> GazeboRosDiffDriveRule:
        return GazeboRosDiffDriveRule(self)


class GazeboRosDiffDriveRule(DifferentialDriveRule):
    """Drive of Gazebo Classic in n simulations, with any number of pairs of wheels."""

    def __init__(self, plugin: GazeboRosDiffDrive) -> None:
        if plugin.options.actuation is not None:
            raise CannotBatchError(f"<actuation_error> of plugin {type(plugin).__name__}")
        pairs = [(side, pair) for pair in plugin.options.pairs for side in (0, 1)]
        wheels = [
            DriveWheel(joint, servo, side, pair.separation, pair.radius)
            for joint, servo, (side, pair) in zip(plugin._wheels, plugin._servos, pairs, strict=True)
        ]
        super().__init__(plugin, plugin.command_topic, wheels)
        self._drive = plugin

    def bind(self, states: StateArrays) -> None:
        super().bind(states)
        pair = self._drive.options.pairs[0]
        self._rim_speeds = np.zeros((states.count, len(self._drive._wheels)))
        self._last_ns = np.zeros(states.count)
        self.odometry = OdometryRows(states.count, pair.radius, pair.separation)

    def take(self, row: int, tick: int) -> None:
        drive = self._drive
        self.target[row], self._last_ns[row], self._rim_speeds[row] = drive._command, drive._last_ns, drive._rims
        self.odometry.angles[row], self.odometry.reckonings[row] = drive._angles, copy.copy(drive._reckoning)
        if drive._erring is not None:
            self.take_noise(row, drive._erring, drive._last_read_ns)

    def next_stop(self, ids: Ids, tick: int) -> int:
        return next_due(self.grid, tick)

    def before_step(self, ids: Ids, ticks: Ticks) -> None:
        """Move each wheel's rim speed towards its target, by at most the acceleration limit."""
        if not is_due(self.grid, int(ticks[0])):
            return
        now = np.array([self._clock.time_ns(tick) for tick in ticks.tolist()], float)
        elapsed = (now - self._last_ns[ids]) * 1e-9
        self._last_ns[ids] = now
        before = self._rim_speeds[ids]
        speeds = self._drive._ramped(before, self.rims(self.target[ids]), elapsed[:, None])
        self._rim_speeds[ids] = speeds
        self.turn_wheels(ids, speeds, speeds != before)

    def after_step(self, ids: Ids, ticks: Ticks) -> None:
        if not self.observes_wheels or not is_due(self.grid, int(ticks[0])):
            return
        if self.has_noise:
            self.advance_noise(ids, ticks)
            return
        self.odometry.roll(ids, self.wheel_angles(ids))
        speeds = self.wheel_velocities(ids)
        self.odometry.store(ids, np.zeros_like(speeds), speeds, 1.0)

    def reading(self, topic: str) -> TopicRule | None:
        drive = self._drive
        if topic and topic == drive._outputs.odometry_topic:
            if drive._followed is not None:
                raise CannotBatchError(f"topic {topic}: ground truth with <odometry_noise>")
            return self.wheel_odometry() if drive.options.from_encoders else self.true_odometry(drive._true)
        if drive._truth is not None and topic == drive._truth.odometry_topic:
            return self.true_odometry(drive._true)
        return None


class SkidSteerOptions(CommonDiffDriveOptions):
    """Options of `GazeboRosSkidSteerDrive`."""

    wheel_separation: float = number(0.4, "m", element="wheelSeparation", minimum=1e-6)
    wheel_diameter: float = number(0.15, "m", element="wheelDiameter", minimum=1e-6)
    left_front_joint: str = text("left_front_joint", element="leftFrontJoint")
    left_rear_joint: str = text("left_rear_joint", element="leftRearJoint")
    right_front_joint: str = text("right_front_joint", element="rightFrontJoint")
    right_rear_joint: str = text("right_rear_joint", element="rightRearJoint")
    update_rate: float = number(100.0, "Hz", element="updateRate", minimum=0)
    max_wheel_torque: float = number(5.0, "N·m", element="torque", minimum=0)
    command_topic: str = text("cmd_vel", element="commandTopic")
    odometry_topic: str = text("odom", element="odometryTopic")
    odometry_frame: str = text("odom", element="odometryFrame")
    robot_base_frame: str = text("base_footprint", element="robotBaseFrame")
    publish_odom_tf: bool = boolean(element="broadcastTF")
    covariance_x: float = number(1e-4, minimum=0)
    covariance_y: float = number(1e-4, minimum=0)
    covariance_yaw: float = number(1e-2, minimum=0)
    is_level = True

    def _read_pairs(self) -> tuple[Pair, ...]:
        left, right = (self.left_front_joint, self.left_rear_joint), (self.right_front_joint, self.right_rear_joint)
        separation, radius = self.wheel_separation, self.wheel_diameter / 2
        return tuple(Pair(a, b, separation, radius) for a, b in zip(left, right, strict=True))


class GazeboRosSkidSteerDrive(GazeboRosDiffDrive):
    """Drives four wheels from `<commandTopic>` (`cmd_vel`); both wheels of a side have the same rim speed.

    The odometry on `<odometryTopic>` (`odom`) is the model's true pose and twist in the plane, with height zero. With
    `<broadcastTF>` the pose, with its height, is also on `/tf`. The last command stays active until the next.
    """

    endpoints = (
        listens("cmd_vel", *COMMAND_TYPES, named_by=("commandTopic",)),
        publishes("odom", "nav_msgs/msg/Odometry", named_by=("odometryTopic",)),
        publishes("/tf", "tf2_msgs/msg/TFMessage"),
        publishes("ground_truth/odom", "nav_msgs/msg/Odometry"),
        publishes("ground_truth/wheel_slip", WHEEL_MOTION),
    )
    option_types = (SkidSteerOptions,)
    filenames = ("libgazebo_ros_skid_steer_drive.so",)

    def read(self, params: Params) -> CommonDiffDriveOptions:
        return SkidSteerOptions(params).read_all()

    def array_rule(self) -> GazeboRosDiffDriveRule:
        return GazeboRosDiffDriveRule(self)
