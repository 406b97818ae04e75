"""Planar move of Gazebo Classic, in ROS 2 and ROS 1 spelling: `libgazebo_ros_planar_move.so`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Self, cast

import numpy as np

from simkit.params import Params
from simkit.plugins.drives.drive_outputs import DriveOutputOptions, DriveOutputs
from simkit.plugins.drives.kinematic_motion import KinematicMotion, KinematicMover, KinematicPlugin, VelocityTarget
from simkit.plugins.drives.motion_errors import MotionErrorOptions, with_errors
from simkit.plugins.drives.odometry import COMMAND_TYPES, TrueMotion, planar_covariance
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, BodyTwist
from simkit.plugins.drives.odometry_noise import ErringOdometry, WheellessOdometryNoiseOptions, odometry_noise
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.options import block, boolean, number, text
from simkit.plugins.ros_names import is_ros_1
from simkit.pose import Pose, quat_from_rpy

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Twist, TwistStamped
    from simkit.runtime import Model
    from simkit.runtime.engine.simulated_time import TickGrid
    from simkit.scene import SceneModel

_ROS_1 = ("robotNamespace", "commandTopic", "odometryTopic", "odometryFrame", "robotBaseFrame")
_ROS_1_TIMES = ("odometryRate", "cmdTimeout")


class PlanarMoveOptions(DriveOutputOptions):
    """Options in the spelling of ROS 2, whose topics have fixed names; rates in Hz, 0 is every step.

    Attributes:
        timeout: time for which a command stays active [s].
        is_level: True if the odometry has the height 0 and the twist covariance 0.
    """

    command_topic: str = "cmd_vel"
    timeout = math.inf

    covariance_x: float = number(1e-5, minimum=0)
    covariance_y: float = number(1e-5, minimum=0)
    covariance_yaw: float = number(1e-3, minimum=0)
    odometry_noise: WheellessOdometryNoiseOptions = block(WheellessOdometryNoiseOptions)
    actuation_error: MotionErrorOptions = block(MotionErrorOptions)
    odometry_frame: str = text("odom")
    robot_base_frame: str = text("base_footprint")
    update_rate: float = number(20.0, "Hz", minimum=0)
    publish_rate: float = number(20.0, "Hz", minimum=0)
    publish_odom: bool = boolean(True)
    publish_odom_tf: bool = boolean(True)


class PlanarMoveRos1Options(DriveOutputOptions):
    """Options in the spelling of ROS 1, which has one rate for the odometry and its transform."""

    update_rate = 0.0
    is_level = True

    odometry_noise: WheellessOdometryNoiseOptions = block(WheellessOdometryNoiseOptions)
    actuation_error: MotionErrorOptions = block(MotionErrorOptions)
    publish_rate: float = number(20.0, "Hz", element="odometryRate", minimum=0)
    publishes_transform: bool = boolean(True, element="publishOdometryTf")
    cmd_timeout: float = number(-1.0, "s", element="cmdTimeout")
    command_topic: str = text("cmd_vel", element="commandTopic")
    odometry_topic: str = text("odom", element="odometryTopic")
    odometry_frame: str = text("odom", element="odometryFrame")
    robot_base_frame: str = text("base_footprint", element="robotBaseFrame")

    @property
    def timeout(self) -> float:
        """Time for which a command stays active [s]; unlimited if `<cmdTimeout>` is negative or missing."""
        return self.cmd_timeout if self.cmd_timeout >= 0 else math.inf

    def read_all(self) -> Self:
        """Read all options; a rate of 0 publishes neither the odometry nor the transform."""
        super().read_all()
        self.publish_odom = self.publish_rate > 0
        self.publish_odom_tf = self.publish_odom and self.publishes_transform
        return self


def read_options(params: Params) -> PlanarMoveOptions | PlanarMoveRos1Options:
    """Read the options in either spelling; ROS 1's if one of its names occurs and there is no `<ros>` block."""
    kind = PlanarMoveRos1Options if is_ros_1(params, (*_ROS_1, *_ROS_1_TIMES)) else PlanarMoveOptions
    return kind(params).read_all()


class GazeboRosPlanarMove(KinematicPlugin):
    """Moves the model in the plane with the twist on `cmd_vel`: forward, left, and rotation about the vertical.

    The linear speeds are along the model's heading, at the model's origin. Each command stays active until the next, in
    ROS 1 at most for `<cmdTimeout>` [s]. The plugin does not tilt or lift the model: on static objects the model
    slides, and without any contact it falls. The odometry on `odom` and `/tf` is the model's true pose in the world and
    its true twist along its heading. In ROS 1 the odometry has the height 0 and the twist covariance 0; an
    `<odometryRate>` of 0 publishes nothing.

    `libgazebo_ros_force_based_move.so` of ROS 1 reaches the same velocities by forces; its gains are not used.

    `<odometry_noise>` and `<actuation_error>` (simkit's own) add errors to the odometry and to the motion.

    Gazebo sets the velocity only at `<update_rate>` (20 Hz), and friction brakes the model in between. simkit reads
    commands at this rate, but sets the velocity at every step.
    """

    endpoints = (
        listens("cmd_vel", *COMMAND_TYPES, named_by=("commandTopic",)),
        publishes("odom", ODOMETRY, named_by=("odometryTopic",)),
        publishes("/tf", TRANSFORMS),
    )
    option_types = (PlanarMoveOptions, PlanarMoveRos1Options)
    filenames = ("libgazebo_ros_planar_move.so", "libgazebo_ros_force_based_move.so")

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options = read_options(params)
        self.after_step_rate = self.options.publish_rate
        self._canonical = scene.canonical_link
        self._links = [link.scoped for link in scene.all_links()]
        canonical = next(link for link in scene.all_links() if link.scoped == scene.canonical_link)
        self._in_canonical = canonical.pose_world.inverse() @ scene.pose_world

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        variances = options.covariance_x, options.covariance_y, options.covariance_yaw
        self._covariances = (planar_covariance(*variances), np.zeros(36)) if options.is_level else ()
        self._true = TrueMotion(parent, self.sim.link(self._canonical))
        self._requested = self._command = (0.0, 0.0, 0.0)
        self._requested_ns = self.sim.time_ns
        self._next = 0
        self._actuation = options.actuation_error.motion_errors
        self._erring: ErringOdometry | None = None
        noise = odometry_noise(options.odometry_noise)
        if noise is not None:
            sizes = options.odometry_noise.wheel_radius, options.odometry_noise.wheel_separation
            stream = self.random("odometry_noise", 2)
            self._erring = ErringOdometry(noise, *sizes, stream, self._true.state()[0], self.sim.time_ns)
        self._motion = KinematicMotion(self.sim, self._links, self._canonical, self._in_canonical)
        self._mover = KinematicMover(self.sim)
        if not self._motion:
            message = f"plugin {self.name!r}: model {self.scoped!r} has a joint to the world and cannot move"
            params.diagnostics.warning("SK-PLUGIN-053", message, self.where, "remove the joint to the world")
        self.listen(options.command_topic, COMMAND_TYPES, self._on_command)
        self._outputs = DriveOutputs(self, options, (), lambda: self._reading()[0])

    def command_timeout(self, _: str) -> float:
        """Return the time for which a command stays active [s]."""
        return self.options.timeout

    # ------------------------------------------------------------------ commands

    def _on_command(self, message: Twist | TwistStamped) -> None:
        twist = cast("Twist", getattr(message, "twist", message))
        requested = float(twist.linear.x), float(twist.linear.y), float(twist.angular.z)
        if are_usable(*requested):
            (ahead, aside, _), (_, _, turn) = self.bounded((*requested[:2], 0.0), (0.0, 0.0, requested[2]))
            ahead, aside, turn = with_errors(self._actuation, (ahead, aside, turn))
            self._requested, self._requested_ns = (ahead, aside, turn), self.sim.time_ns
        else:
            self._once.not_finite()

    def velocity_targets(self) -> list[VelocityTarget]:
        """Return the commanded velocity of the model, in the axes of its heading; empty if the model cannot move."""
        tick = self.sim.tick
        if tick >= self._next:
            grid: TickGrid | None = self.sim.engine.clock.grid(self.options.update_rate)
            self._next = grid.next(tick) if grid is not None else tick
            self._command = self._requested
        if (self.sim.time_ns - self._requested_ns) * 1e-9 > self.options.timeout:
            self._requested = self._command = (0.0, 0.0, 0.0)
        if not self._motion:
            return []
        ahead, aside, turn = self._command
        pose = self._motion.frame
        level = Pose(pose.position, quat_from_rpy(0.0, 0.0, float(pose.rpy[2])))
        return [VelocityTarget(self._motion, level, (ahead, aside, 0.0), (0.0, 0.0, turn), falls=True)]

    # ------------------------------------------------------------------ readings

    def after_step(self) -> None:
        """Publish the odometry and its transform."""
        erring = self._erring
        if erring is not None:
            erring.follow(self._true.state()[0], self.sim.time_ns)
        if self._outputs.wants_odometry:
            spread = self._covariances if erring is None else erring.covariances or self._covariances
            self._outputs.tell(*self._reading(), *spread)

    def _reading(self) -> tuple[Pose, BodyTwist]:
        """Return the pose, and the twist in the plane along the heading; the true ones without errors."""
        pose, twist = self._true.state()
        if self._erring is not None:
            return self._erring.pose(pose), self._erring.twist
        level = quat_from_rpy(0.0, 0.0, -float(pose.rpy[2]))
        x, y, _ = Pose((0.0, 0.0, 0.0), level).rotate(pose.rotate(twist.linear)).tolist()
        return pose, BodyTwist((x, y, 0.0), (0.0, 0.0, float(pose.rotate(twist.angular)[2])))
