"""Tricycle drive of Gazebo Classic: `libgazebo_ros_tricycle_drive.so`, with its ROS 2 and its ROS 1 spelling.

A command has the speed of the driven wheel (`linear.x`) and the angle of its steering (`angular.z`). Deliberate
differences to Gazebo Classic:

- With a limit of the wheel acceleration, the motor's command changes step by step from its last value. Classic starts
  each step from the measured speed of the wheel, so a load on the wheel also reduces the command.
- With a maximum steering speed, the steering moves at this speed to the commanded angle. Classic chooses the direction
  of the steering by comparing the angle error with the commanded speed of the wheel.
- In odometry from the wheels, a turn to the left is positive. In Classic it is negative.
- Without a maximum steering speed, a servo moves the steering. Classic sets the position of the joint.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.classic.commanded_drive import CommandedDrive
from simkit.plugins.drives.drive_outputs import DriveOutputOptions, DriveOutputs
from simkit.plugins.drives.odometry import COMMAND_TYPES, DeadReckoning, rolling_twist, wheel_motion
from simkit.plugins.drives.wheel_joints import find_drive_joint, find_wheels
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.options import boolean, choice, integer, number, text
from simkit.plugins.ros_names import is_ros_1
from simkit.runtime.handles.joint import wheel_angles

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.pose import Pose
    from simkit.runtime import Model
    from simkit.scene import SceneModel

_ROS_1 = frozenset(
    {
        *("robotNamespace", "steeringJoint", "actuatedWheelJoint", "encoderWheelLeftJoint", "encoderWheelRightJoint"),
        *("actuatedWheelDiameter", "encoderWheelDiameter", "encoderWheelSeparation", "wheelTorque", "commandTopic"),
        *("odometryTopic", "odometryFrame", "robotBaseFrame", "updateRate", "steeringSpeed", "odometrySource"),
    }
)


class CommonTricycleOptions(DriveOutputOptions):
    """Options of both spellings: the odometry and its transform are published together."""

    @property
    def publishes_odom_tf(self) -> bool:
        return self.publish_odom


class TricycleOptions(CommonTricycleOptions):
    """Options in the spelling of ROS 2; its topics have fixed names.

    The torque limit [N·m] applies to the driven wheel, and also to the steering if it has a maximum speed. If the
    wheel's speed error is within its tolerance [rad/s], the wheel gets the target speed at once. If the steering's
    angle error is within its tolerance [rad], the steering stops. A maximum steering speed of 0 means as fast as
    possible; an acceleration of 0 means no limit.
    """

    command_topic: str = "cmd_vel"
    max_wheel_acceleration: float = number(0.0, "rad/s²", minimum=0)
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


class TricycleRos1Options(CommonTricycleOptions):
    """Options in the spelling of ROS 1; the odometry is always published."""

    max_wheel_acceleration: float = number(0.0, "rad/s²", element="wheelAcceleration", minimum=0)
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


class GazeboRosTricycleDrive(CommandedDrive):
    """Steers and drives one wheel from `cmd_vel`; its odometry is the ground truth or from two undriven wheels."""

    endpoints = (
        listens("cmd_vel", *COMMAND_TYPES, named_by=("commandTopic",)),
        publishes("odom", "nav_msgs/msg/Odometry", named_by=("odometryTopic",)),
        publishes("/tf", "tf2_msgs/msg/TFMessage"),
        publishes("joint_states", "sensor_msgs/msg/JointState"),
    )
    option_types = (TricycleOptions, TricycleRos1Options)
    filenames = ("libgazebo_ros_tricycle_drive.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        kind = TricycleRos1Options if is_ros_1(params, _ROS_1) else TricycleOptions
        self.options = options = kind(params).read_all()
        self._from_encoders = options.odometry_source in (0, "encoder")
        self._driven_radius, self._radius = options.actuated_wheel_diameter / 2, options.encoder_wheel_diameter / 2
        self._canonical = scene.canonical_link
        steering = find_drive_joint(scene, options.steering_joint, "steering", params)
        named = {
            "driven wheel": [options.actuated_wheel_joint],
            "left encoder wheel": [options.encoder_wheel_left_joint],
            "right encoder wheel": [options.encoder_wheel_right_joint],
        }
        wheels = [joint for joints in find_wheels(scene, named, params).values() for joint in joints]
        self._all = [joint for joint in (steering, *wheels) if joint is not None]
        if steering is None or len(wheels) != 3:
            return
        torque, owner = options.max_wheel_torque, self.name
        add_motor = partial(builder.add_velocity_servo, max_effort=torque, owner=owner, joint_limit=False)
        self._motor = add_motor(wheels[0].scoped)
        if options.max_steering_speed > 0:
            self._steering = add_motor(steering.scoped)
        else:
            self._steering = builder.add_position_servo(steering.scoped, max_effort=math.inf, owner=owner)

    def load(self, parent: Model, params: Params) -> None:
        self.start(parent, self.options.command_topic, self.options.update_rate)
        steering, _, left, right = (self.sim.joint(joint.scoped) for joint in self._all)
        self._steering_joint, self._pair = steering, (left, right)
        self._speed, self._steering_target = 0.0, 0.0
        self._reckoning = DeadReckoning()
        self._angles = wheel_angles(*self._pair)
        self._outputs = DriveOutputs(self, self.options, self._all, self._pose)

    # ------------------------------------------------------------------ commands

    def before_step(self) -> None:
        """Move the wheel's speed and the steering towards the command."""
        forward, angle = self._command
        speed = self._ramped(forward / self._driven_radius, self._elapsed())
        if speed != self._speed:
            self._speed = speed
            self.sim.engine.set_control(self._motor, speed)
        angle = max(-math.pi / 2, min(math.pi / 2, angle))
        target = self._steering_speed(angle) if self.options.max_steering_speed > 0 else angle
        if target != self._steering_target:
            self._steering_target = target
            self.sim.engine.set_control(self._steering, target)

    def _ramped(self, target: float, elapsed: float) -> float:
        """Return the wheel's next speed towards a target [rad/s]."""
        options, speed = self.options, self._speed
        is_faster = abs(target) > abs(speed) and target * speed >= 0.0
        most = options.max_wheel_acceleration if is_faster else options.max_wheel_deceleration
        if most == 0 or abs(target - speed) < options.max_wheel_speed_tolerance:
            return target
        return speed + max(-most * elapsed, min(most * elapsed, target - speed))

    def _steering_speed(self, angle: float) -> float:
        """Return the steering speed towards an angle [rad/s], limited so that the next update does not overshoot."""
        missing = angle - wheel_angles(self._steering_joint, self._steering_joint)[0]
        if abs(missing) < self.options.max_steering_angle_tolerance:
            return 0.0
        most = self.options.max_steering_speed
        if self.options.update_rate > 0:
            most = min(most, abs(missing) * self.options.update_rate)
        return math.copysign(most, missing)

    # ------------------------------------------------------------------ readings

    def _pose(self) -> Pose:
        """Return the pose of the base in the odometry frame."""
        return self._reckoning.pose if self._from_encoders else self._true.state()[0]

    def after_step(self) -> None:
        """Publish odometry, transforms and joint states."""
        separation, outputs = self.options.wheel_separation, self._outputs
        if self._from_encoders:
            angles = wheel_angles(*self._pair)
            self._reckoning.go(*wheel_motion(self._angles, angles, self._radius, separation))
            self._angles = angles
        if outputs.wants_odometry and self._from_encoders:
            outputs.tell(self._reckoning.pose, rolling_twist(self._pair, self._radius, separation))
        elif outputs.wants_odometry:
            outputs.tell(*self._true.state())
        outputs.tell_joints()
