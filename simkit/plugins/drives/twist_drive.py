"""Base class of Gazebo's drives that follow a twist and publish odometry from their wheels."""

from __future__ import annotations

import abc
from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, cast

from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.motion_errors import MotionErrorOptions, MotionErrors, with_errors
from simkit.plugins.drives.odometry import COMMAND_TYPES
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, BodyTwist, odometry_message, transforms
from simkit.plugins.drives.odometry_noise import ErringOdometry, OdometryNoiseOptions, odometry_noise
from simkit.plugins.drives.speed_limits import SpeedLimiter, SpeedLimitOptions, limit_each
from simkit.plugins.drives.wheel_joints import find_wheels
from simkit.plugins.find_entities import read_topic
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.options import Options, block, number, text

if TYPE_CHECKING:
    from simkit.compiler import ActuatorRef, SpecBuilder
    from simkit.msgs import Twist, TwistStamped
    from simkit.pose import Pose, Vector
    from simkit.runtime import Model
    from simkit.scene import SceneJoint, SceneModel

Speeds = tuple[float, ...]
"""Forward speed [m/s], for some drives the speed to the left [m/s], and turning rate [rad/s]."""


class OdometryOptions(Options):
    """Rate and topics of a drive that publishes its odometry."""

    odom_publish_frequency: float = number(50.0, "Hz", minimum=0)
    topic: str = text()
    odom_topic: str = text()
    tf_topic: str = text()


class WheeledDriveOptions(SpeedLimitOptions, OdometryOptions):
    """Options of a drive with wheels of one size."""

    wheel_separation: float = number(1.0, "m", minimum=1e-6)
    wheel_radius: float = number(0.2, "m", minimum=1e-6)
    odometry_noise: OdometryNoiseOptions = block(OdometryNoiseOptions)
    actuation_error: MotionErrorOptions = block(MotionErrorOptions)


class TwistDrive(ModelPlugin):
    """Follows the last twist command within speed limits, and publishes odometry with its transform."""

    drives = True
    _limiters: Sequence[SpeedLimiter]  # one for each speed
    _canonical: str  # scoped name of the link that is the odometry's child frame
    _radius: float  # wheel radius [m]
    actuation: MotionErrors | None = None  # differences between the speeds and their commands
    _erring: ErringOdometry | None = None

    def add_wheels(
        self, scene: SceneModel, builder: SpecBuilder, named: Mapping[str, Sequence[str]]
    ) -> list[SceneJoint]:
        """Find the wheel joints and add a velocity servo to each, with the joint's effort limit.

        Args:
            scene: Model of the drive.
            builder: Builder of the compiled model.
            named: Joint names by role, such as `left wheel`.

        Returns:
            The joints that were found, in the order of the roles.
        """
        wheels = find_wheels(scene, named, self.params)
        self._joint_names = [[joint.scoped for joint in joints] for joints in wheels.values()]
        self._servos = [
            [builder.add_velocity_servo(j.scoped, max_effort=j.axes[0].effort, owner=self.name) for j in joints]
            for joints in wheels.values()
        ]
        return [joint for joints in wheels.values() for joint in joints]

    def start(self) -> None:
        """Set all speeds to zero; `load` must call this method first."""
        self._target: Speeds = (0.0,) * len(self._limiters)
        self._last = self._before_last = self._target
        self._settled = True  # the speeds have reached the command

    @property
    def wheels(self) -> list[list[tuple[str, ActuatorRef]]]:
        """Scoped name of the joint and servo of each wheel, by role."""
        sides = zip(self._joint_names, self._servos, strict=True)
        return [list(zip(names, servos, strict=True)) for names, servos in sides]

    @property
    def speed_history(self) -> tuple[Speeds, Speeds, Speeds]:
        """Target speeds, speeds of the last command, and of the command before that."""
        return self._target, self._last, self._before_last

    def open_topics(self, parent: Model, params: Params) -> None:
        """Open the topics of commands, odometry and its transform."""
        model = parent.name
        topic = read_topic(params, "topic", f"/model/{model}/cmd_vel")
        self.command_topic = self.ros.topic(topic)
        self.listen(topic, COMMAND_TYPES, self.on_twist)
        self.open_odometry(parent, params)

    def open_odometry(self, parent: Model, params: Params) -> None:
        """Open the topics of odometry and its transform."""
        model, link = parent.name, self._canonical.rsplit("::", 1)[-1]
        self._frame = params.text("frame_id", f"{model}/odom")
        self._child = params.text("child_frame_id", f"{model}/{link}")
        self._odom = self.advertise(read_topic(params, "odom_topic", f"/model/{model}/odometry"), ODOMETRY)
        self._tf = self.advertise(read_topic(params, "tf_topic", f"/model/{model}/tf"), TRANSFORMS)
        self._tf.present = lambda: transforms(self.sim.time_ns, (self._frame, self._child, self.odometry_pose()))

    # ------------------------------------------------------------------ commands

    def on_twist(self, message: Twist | TwistStamped) -> None:
        """Set the target speeds from a `Twist` or `TwistStamped`."""
        speeds = self.speeds_of(cast("Twist", getattr(message, "twist", message)))
        if are_usable(*speeds):
            self.aim(speeds)
        else:
            self._once.not_finite()

    def speeds_of(self, twist: Twist) -> Speeds:
        """Return the components of a twist that the drive follows, one for each limiter."""
        return float(twist.linear.x), float(twist.angular.z)

    def aim(self, speeds: Speeds) -> None:
        """Set the target speeds that apply from the next step on."""
        self._target, self._settled = speeds, False

    def next_speeds(self) -> Speeds:
        """Advance the limited speeds by one step towards the target; return them with the errors of the actuation."""
        speeds = limit_each(self._limiters, self._target, self._last, self._before_last, self.period)
        self._settled = speeds == self._last == self._before_last
        self._before_last, self._last = self._last, speeds
        return with_errors(self.actuation, speeds)

    def turn_wheels(self, rims: Sequence[float]) -> None:
        """Set the wheel speed of each side.

        Args:
            rims: Circumferential wheel speed of each side [m/s].
        """
        for servos, rim in zip(self._servos, rims, strict=True):
            for servo in servos:
                self.sim.engine.set_control(servo, rim / self._radius)

    # ------------------------------------------------------------------ readings

    @abc.abstractmethod
    def odometry_pose(self) -> Pose:
        """Return the pose of the base in the odometry frame."""

    def add_odometry_errors(self, options: WheeledDriveOptions, pose: Pose) -> None:
        """Repeat the odometry with the errors of `<odometry_noise>`, from an initial pose on; `load` calls this."""
        noise = odometry_noise(options.odometry_noise)
        if noise is not None:
            sizes = options.wheel_radius, options.wheel_separation
            stream = self.random("odometry_noise", 2)
            self._erring = ErringOdometry(noise, *sizes, stream, pose, self.sim.time_ns)

    def publish_reckoned(self, pose: Pose, twist: BodyTwist) -> None:
        """Publish the odometry, with its errors if there are any."""
        erring = self._erring
        if erring is None:
            self.publish_odometry(pose, twist)
        else:
            erring.follow(pose, self.sim.time_ns)
            self.publish_odometry(erring.pose(pose), erring.twist, *erring.covariances)

    def reckoned_pose(self, pose: Pose) -> Pose:
        """Return a pose of the odometry, with its errors if there are any."""
        return pose if self._erring is None else self._erring.pose(pose)

    def publish_odometry(self, pose: Pose, twist: BodyTwist, *covariances: Vector) -> None:
        """Publish the pose of the base and its transform, if the topics have subscribers.

        Args:
            pose: Pose of the base in the odometry frame.
            twist: Twist in the axes of the base.
            *covariances: Covariances of pose and twist, as for `odometry_message`.
        """
        now = self.sim.time_ns
        if self._odom.wanted:
            message = partial(odometry_message, now, self._frame, self._child, pose, twist, *covariances)
            self._odom.publish_later(message)
        if self._tf.wanted:
            self._tf.publish_later(partial(transforms, now, (self._frame, self._child, pose)))
