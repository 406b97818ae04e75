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
from typing import TYPE_CHECKING, Any

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
from simkit.plugins.drives.steering import find_drive_joint
from simkit.plugins.drives.wheel_joints import find_wheels
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.plugins.ros_names import is_ros_1

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
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
class Options:
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


def read_options(params: Params) -> Options:
    """Reads either spelling."""
    if is_ros_1(params, _ROS_1):
        return _read_ros_1(params)
    acceleration = params.number("max_wheel_acceleration", 0.0, minimum=0)
    odometry = params.boolean("publish_odom", False)
    return Options(
        joints=(
            params.text("steering_joint", "front_steering_joint"),
            params.text("actuated_wheel_joint", "front_wheel_joint"),
            params.text("encoder_wheel_left_joint", "left_wheel_joint"),
            params.text("encoder_wheel_right_joint", "right_wheel_joint"),
        ),
        driven_radius=params.number("actuated_wheel_diameter", 0.15, minimum=1e-6) / 2,
        encoder_radius=params.number("encoder_wheel_diameter", 0.15, minimum=1e-6) / 2,
        separation=params.number("wheel_separation", 0.5, minimum=1e-6),
        acceleration=acceleration,
        deceleration=params.number("max_wheel_deceleration", acceleration, minimum=0),
        speed_tolerance=params.number("max_wheel_speed_tolerance", 0.01, minimum=0),
        steering_speed=params.number("max_steering_speed", 0.0, minimum=0),
        angle_tolerance=params.number("max_steering_angle_tolerance", 0.01, minimum=0),
        torque=params.number("max_wheel_torque", 0.15, minimum=0),
        rate=params.number("update_rate", 100.0, minimum=0),
        from_encoders=params.integer("odometry_source", 1, minimum=0, maximum=1) == 0,
        command_topic="cmd_vel",
        told=DriveOutputOptions(
            odometry_topic="odom",
            odometry_frame=params.text("odometry_frame", "odom"),
            base_frame=params.text("robot_base_frame", "base_link"),
            odometry=odometry,
            odometry_tf=odometry,
            wheel_tf=params.boolean("publish_wheel_tf", False),
            joint_states=params.boolean("publish_wheel_joint_state", False),
            covariance=_COVARIANCE,
        ),
    )


def _read_ros_1(params: Params) -> Options:
    acceleration = params.number("wheelAcceleration", 0.0, minimum=0)
    return Options(
        joints=(
            params.text("steeringJoint", "front_steering_joint"),
            params.text("actuatedWheelJoint", "front_wheel_joint"),
            params.text("encoderWheelLeftJoint", "left_wheel_joint"),
            params.text("encoderWheelRightJoint", "right_wheel_joint"),
        ),
        driven_radius=params.number("actuatedWheelDiameter", 0.15, minimum=1e-6) / 2,
        encoder_radius=params.number("encoderWheelDiameter", 0.15, minimum=1e-6) / 2,
        separation=params.number("encoderWheelSeparation", 0.5, minimum=1e-6),
        acceleration=acceleration,
        deceleration=params.number("wheelDeceleration", acceleration, minimum=0),
        speed_tolerance=params.number("wheelSpeedTolerance", 0.01, minimum=0),
        steering_speed=params.number("steeringSpeed", 0.0, minimum=0),
        angle_tolerance=params.number("steeringAngleTolerance", 0.01, minimum=0),
        torque=params.number("wheelTorque", 5.0, minimum=0),
        rate=params.number("updateRate", 100.0, minimum=0),
        from_encoders=params.choice("odometrySource", ("world", "encoder"), "world") == "encoder",
        command_topic=params.text("commandTopic", "cmd_vel"),
        told=DriveOutputOptions(
            odometry_topic=params.text("odometryTopic", "odom"),
            odometry_frame=params.text("odometryFrame", "odom"),
            base_frame=params.text("robotBaseFrame", "base_link"),
            odometry=True,
            odometry_tf=True,
            wheel_tf=params.boolean("publishWheelTF", False),
            joint_states=params.boolean("publishWheelJointState", False),
            covariance=_COVARIANCE,
        ),
    )


class GazeboRosTricycleDrive(ModelPlugin):
    """Steers and drives one wheel from `cmd_vel`; odometry by the world's truth or by two wheels without a drive."""

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

    def load(self, parent: Any, params: Params) -> None:
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

    def _on_command(self, message: Any) -> None:
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
            self.sim.set_control(self._motor, speed)
        angle = max(-math.pi / 2, min(math.pi / 2, angle))
        given = self._steered(angle) if options.steering_speed > 0 else angle
        if given != self._given:
            self._given = given
            self.sim.set_control(self._steering, given)

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
