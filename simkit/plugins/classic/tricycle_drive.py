"""Tricycle drive of Gazebo Classic: `libgazebo_ros_tricycle_drive.so`, with its ROS 2 and its ROS 1 spelling.

A command is the speed of the driven wheel (`linear.x`) and the angle of its steering (`angular.z`). Where it differs
from Gazebo Classic on purpose: the acceleration ramp follows the commanded speed (Classic adds to the wheel's own, and
winds up while it is held), steering at a speed goes towards its angle (Classic compares it with a speed), an odometry
by the wheels counts a turn to the left as positive, and the steering without a speed is a servo (Classic sets its
angle).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.drive_outputs import DriveOutputOptions, DriveOutputs
from simkit.plugins.drives.odometry import (
    COMMAND_TYPES,
    DeadReckoning,
    TrueMotion,
    command_of,
    rolling_twist,
    wheel_angles,
)
from simkit.plugins.drives.wheel_joints import find_drive_joint, find_wheels
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.plugins.options import Options, boolean, choice, integer, number, text
from simkit.plugins.ros_names import is_ros_1

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Twist, TwistStamped
    from simkit.runtime import Model
    from simkit.scene import SceneModel

_ROS_1 = frozenset(
    {
        *("robotNamespace", "steeringJoint", "actuatedWheelJoint", "encoderWheelLeftJoint", "encoderWheelRightJoint"),
        *("actuatedWheelDiameter", "encoderWheelDiameter", "encoderWheelSeparation", "wheelTorque", "commandTopic"),
        *("odometryTopic", "odometryFrame", "robotBaseFrame", "updateRate", "steeringSpeed", "odometrySource"),
    }
)
_COVARIANCE = (1e-5, 1e-5, 1e-3)


@dataclass(frozen=True, slots=True)
class DriveSettings:
    """The plugin's parameters.

    Attributes:
        joints: steering, driven wheel, left and right wheel with an encoder.
        driven_radius, encoder_radius, separation: [m].
        acceleration, deceleration: of the driven wheel [rad/s²]; 0: no limit.
        speed_tolerance: within which the driven wheel takes its speed at once [rad/s].
        steering_speed: [rad/s]; 0: as fast as it can.
        angle_tolerance: within which the steering stands still [rad].
        torque: of the driven wheel and of the steering at a speed [N·m].
        rate: [Hz]; 0 is every step.
    """

    joints: tuple[str, str, str, str]
    driven_radius: float
    encoder_radius: float
    separation: float
    acceleration: float
    deceleration: float
    speed_tolerance: float
    steering_speed: float
    angle_tolerance: float
    torque: float
    rate: float
    from_encoders: bool
    command_topic: str
    told: DriveOutputOptions


class TricycleOptions(Options):
    """Options in the spelling of ROS 2; its topics have fixed names."""

    command_topic = "cmd_vel"
    odometry_topic = "odom"
    max_wheel_acceleration: float = number(0.0, "m/s²", minimum=0)
    publish_odom: bool = boolean()
    steering_joint: str = text("front_steering_joint")
    actuated_wheel_joint: str = text("front_wheel_joint")
    encoder_wheel_left_joint: str = text("left_wheel_joint")
    encoder_wheel_right_joint: str = text("right_wheel_joint")
    actuated_wheel_diameter: float = number(0.15, "m", minimum=1e-6)
    encoder_wheel_diameter: float = number(0.15, "m", minimum=1e-6)
    wheel_separation: float = number(0.5, "m", minimum=1e-6)
    max_wheel_deceleration: float = number(minimum=0, instead="max_wheel_acceleration")
    max_wheel_speed_tolerance: float = number(0.01, minimum=0)
    max_steering_speed: float = number(0.0, minimum=0)
    max_steering_angle_tolerance: float = number(0.01, "rad", minimum=0)
    max_wheel_torque: float = number(0.15, "N·m", minimum=0)
    update_rate: float = number(100.0, "Hz", minimum=0)
    odometry_source: int = integer(1, minimum=0, maximum=1)
    odometry_frame: str = text("odom")
    robot_base_frame: str = text("base_link")
    publish_wheel_tf: bool = boolean()
    publish_wheel_joint_state: bool = boolean()


class TricycleRos1Options(Options):
    """Options in the spelling of ROS 1; it always publishes its odometry."""

    publish_odom = True
    max_wheel_acceleration: float = number(0.0, "m/s²", element="wheelAcceleration", minimum=0)
    steering_joint: str = text("front_steering_joint", element="steeringJoint")
    actuated_wheel_joint: str = text("front_wheel_joint", element="actuatedWheelJoint")
    encoder_wheel_left_joint: str = text("left_wheel_joint", element="encoderWheelLeftJoint")
    encoder_wheel_right_joint: str = text("right_wheel_joint", element="encoderWheelRightJoint")
    actuated_wheel_diameter: float = number(0.15, "m", element="actuatedWheelDiameter", minimum=1e-6)
    encoder_wheel_diameter: float = number(0.15, "m", element="encoderWheelDiameter", minimum=1e-6)
    wheel_separation: float = number(0.5, "m", element="encoderWheelSeparation", minimum=1e-6)
    max_wheel_deceleration: float = number(element="wheelDeceleration", minimum=0, instead="max_wheel_acceleration")
    max_wheel_speed_tolerance: float = number(0.01, element="wheelSpeedTolerance", minimum=0)
    max_steering_speed: float = number(0.0, element="steeringSpeed", minimum=0)
    max_steering_angle_tolerance: float = number(0.01, "rad", element="steeringAngleTolerance", minimum=0)
    max_wheel_torque: float = number(5.0, "N·m", element="wheelTorque", minimum=0)
    update_rate: float = number(100.0, "Hz", element="updateRate", minimum=0)
    odometry_source: str = choice(("world", "encoder"), "world", element="odometrySource")
    command_topic: str = text("cmd_vel", element="commandTopic")
    odometry_topic: str = text("odom", element="odometryTopic")
    odometry_frame: str = text("odom", element="odometryFrame")
    robot_base_frame: str = text("base_link", element="robotBaseFrame")
    publish_wheel_tf: bool = boolean(element="publishWheelTF")
    publish_wheel_joint_state: bool = boolean(element="publishWheelJointState")


def read_options(params: Params) -> DriveSettings:
    """Reads either spelling."""
    given = TricycleRos1Options(params) if is_ros_1(params, _ROS_1) else TricycleOptions(params)
    acceleration, odometry = given.max_wheel_acceleration, given.publish_odom
    return DriveSettings(
        joints=(
            given.steering_joint,
            given.actuated_wheel_joint,
            given.encoder_wheel_left_joint,
            given.encoder_wheel_right_joint,
        ),
        driven_radius=given.actuated_wheel_diameter / 2,
        encoder_radius=given.encoder_wheel_diameter / 2,
        separation=given.wheel_separation,
        acceleration=acceleration,
        deceleration=given.max_wheel_deceleration,
        speed_tolerance=given.max_wheel_speed_tolerance,
        steering_speed=given.max_steering_speed,
        angle_tolerance=given.max_steering_angle_tolerance,
        torque=given.max_wheel_torque,
        rate=given.update_rate,
        from_encoders=given.odometry_source in (0, "encoder"),
        command_topic=given.command_topic,
        told=DriveOutputOptions(
            odometry_topic=given.odometry_topic,
            odometry_frame=given.odometry_frame,
            base_frame=given.robot_base_frame,
            odometry=odometry,
            odometry_tf=odometry,
            wheel_tf=given.publish_wheel_tf,
            joint_states=given.publish_wheel_joint_state,
            covariance=_COVARIANCE,
        ),
    )


class GazeboRosTricycleDrive(ModelPlugin):
    """Steers and drives one wheel from `cmd_vel`; odometry by the world's truth or by two wheels without a drive."""

    endpoints = (
        listens("cmd_vel", *COMMAND_TYPES, named_by=("commandTopic",)),
        publishes("odom", "nav_msgs/msg/Odometry", named_by=("odometryTopic",)),
        publishes("/tf", "tf2_msgs/msg/TFMessage"),
        publishes("joint_states", "sensor_msgs/msg/JointState"),
    )
    option_types = (TricycleOptions, TricycleRos1Options)
    filenames = ("libgazebo_ros_tricycle_drive.so",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options = options = read_options(params)
        self._canonical = scene.canonical_link
        steering_name, driven_name, left, right = options.joints
        steering = find_drive_joint(scene, steering_name, "steering", params)
        named = {"driven wheel": [driven_name], "left encoder wheel": [left], "right encoder wheel": [right]}
        wheels = [joint for joints in find_wheels(scene, named, params).values() for joint in joints]
        self._all = [joint for joint in (steering, *wheels) if joint is not None]
        if steering is None or len(wheels) != 3:
            return
        torque, owner = options.torque, self.name
        self._motor = builder.add_velocity_servo(wheels[0].scoped, max_effort=torque, owner=owner)
        if options.steering_speed > 0:
            self._steering = builder.add_velocity_servo(steering.scoped, max_effort=torque, owner=owner)
        else:
            self._steering = builder.add_position_servo(steering.scoped, max_effort=math.inf, owner=owner)

    def load(self, parent: Model, params: Params) -> None:
        self.once = OneTimeWarnings(self)
        self.before_step_rate = self.after_step_rate = self.options.rate
        steering, _, left, right = (self.sim.joint(joint.scoped) for joint in self._all)
        self._turned, self._pair = steering, (left, right)
        self._true = TrueMotion(parent, self.sim.link(self._canonical))
        self._command = (0.0, 0.0)
        self._speed, self._given = 0.0, 0.0
        self._last_ns = self.sim.time_ns
        self._reckoning = DeadReckoning()
        self._angles = wheel_angles(*self._pair)
        self.listen(self.options.command_topic, COMMAND_TYPES, self._on_command)
        self._outputs = DriveOutputs(self, self.options.told, self._all)

    def _on_command(self, message: Twist | TwistStamped) -> None:
        command = command_of(message)
        if command is None:
            self.once.not_finite()
        else:
            self._command = command

    # ------------------------------------------------------------------ commands

    def before_step(self) -> None:
        """Takes the wheel's speed and the steering towards the command."""
        options, (forward, angle) = self.options, self._command
        now = self.sim.time_ns
        elapsed, self._last_ns = (now - self._last_ns) * 1e-9, now
        speed = self._ramped(forward / options.driven_radius, elapsed)
        if speed != self._speed:
            self._speed = speed
            self.sim.engine.set_control(self._motor, speed)
        angle = max(-math.pi / 2, min(math.pi / 2, angle))
        given = self._steered(angle) if options.steering_speed > 0 else angle
        if given != self._given:
            self._given = given
            self.sim.engine.set_control(self._steering, given)

    def _ramped(self, target: float, elapsed: float) -> float:
        """The wheel's speed on its way to a target [rad/s]."""
        options, speed = self.options, self._speed
        is_faster = abs(target) > abs(speed) and target * speed >= 0.0
        most = options.acceleration if is_faster else options.deceleration
        if most == 0 or abs(target - speed) < options.speed_tolerance:
            return target
        return speed + max(-most * elapsed, min(most * elapsed, target - speed))

    def _steered(self, angle: float) -> float:
        """Speed of the steering on its way to an angle [rad/s]; the last bit of the way no further than it is."""
        missing = angle - wheel_angles(self._turned, self._turned)[0]
        if abs(missing) < self.options.angle_tolerance:
            return 0.0
        most = self.options.steering_speed
        if self.options.rate > 0:
            most = min(most, abs(missing) * self.options.rate)
        return math.copysign(most, missing)

    # ------------------------------------------------------------------ readings

    def after_step(self) -> None:
        """Odometry, transforms and joint states."""
        options, outputs = self.options, self._outputs
        if options.from_encoders:
            angles = wheel_angles(*self._pair)
            left, right = ((b - a) * options.encoder_radius for a, b in zip(self._angles, angles, strict=True))
            self._angles = angles
            self._reckoning.advance(left, right, options.separation)
        if outputs.wants_odometry and options.from_encoders:
            outputs.tell(self._reckoning.pose, rolling_twist(self._pair, options.encoder_radius, options.separation))
        elif outputs.wants_odometry:
            outputs.tell(*self._true.state())
        outputs.tell_joints()
