"""Differential drive controller of ros2_controllers, with odometry: `diff_drive_controller/DiffDriveController`."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from simkit import Pose, msgs
from simkit.extend import Cylinder, Sphere
from simkit.float_sum import float_sum
from simkit.linear_algebra import norm
from simkit.plugins.drives.odometry import COMMAND_TYPES, DeadReckoning, base_motion, command_of
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, BodyTwist, odometry_message, transforms
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.diff_drive_options import DriveOptions

if TYPE_CHECKING:
    from simkit.msgs import Twist, TwistStamped
    from simkit.runtime.communication.parameter import Parameter


_SHORTEST_PERIOD = 1e-4  # [s]; shorter periods give no useful speed


class RollingMeanOdometry:
    """Odometry of the midpoint between two wheels: its pose, and the mean of its speeds over recent updates.

    Args:
        window: number of updates over which the twist is averaged.

    Attributes:
        reckoning: planar pose, zero at the start.
    """

    def __init__(self, window: int) -> None:
        self.reckoning = DeadReckoning()
        self._speeds: deque[tuple[float, float]] = deque(maxlen=max(1, window))

    def roll(self, left: float, right: float, separation: float, elapsed: float) -> bool:
        """Advance the pose by the distances that the wheels have rolled.

        Args:
            left: distance of the left wheel's rim [m].
            right: distance of the right wheel's rim [m].
            separation: distance between the wheels [m].
            elapsed: time since the last call [s].

        Returns:
            False if the time was too short to compute a speed; the pose is then unchanged.
        """
        if elapsed < _SHORTEST_PERIOD:
            return False
        self.reckoning.advance(left, right, separation)
        ahead, _, turn = base_motion(left, right, separation)
        self._speeds.append((ahead / elapsed, turn / elapsed))
        return True

    def follow(self, ahead: float, turn: float, elapsed: float) -> None:
        """Advance the pose as if the base followed a command exactly, and set the twist to the command.

        Args:
            ahead: linear velocity [m/s].
            turn: angular velocity [rad/s].
            elapsed: time since the last call [s].
        """
        # the speeds of two wheels that are 1 m apart
        self.reckoning.advance((ahead - turn / 2) * elapsed, (ahead + turn / 2) * elapsed, 1.0)
        self._speeds.clear()
        self._speeds.append((ahead, turn))  # a commanded speed needs no mean

    @property
    def twist(self) -> BodyTwist:
        """Mean twist over the window, in the axes of the base."""
        if not self._speeds:
            return BodyTwist()
        count = len(self._speeds)
        ahead, turn = (float_sum(speeds) / count for speeds in zip(*self._speeds, strict=True))
        return BodyTwist((ahead, 0.0, 0.0), (0.0, 0.0, turn))


_STAMPED = "geometry_msgs/msg/TwistStamped"
_NS = 1_000_000_000
_NO_MOTION = (0.0, 0.0)


class DiffDriveController(Controller):
    """Drives wheels by velocity from `~/cmd_vel`, and publishes odometry on `~/odom` and `/tf`.

    A command is valid for `cmd_vel_timeout`; then the base brakes. Commands are limited in jerk, acceleration and speed
    before they become wheel speeds. Three points differ from ros2_controllers on purpose. Open-loop odometry follows
    the limited command (as in ROS 1) instead of the requested command. Odometry is zero at the wheel angles of the
    first activation, so it starts without a jump. Messages are published at multiples of the `publish_rate` period,
    so delays do not add up.
    """

    types = ("diff_drive_controller/DiffDriveController",)

    def configure(self) -> None:
        before = self.params.diagnostics.error_count
        options = DriveOptions(self.params, self.plugin.ros.namespace, self._wheel_size_of_model)
        self._options = options
        self._period_ns = max(round(_NS / options.publish_rate), 1) if options.publish_rate > 0 else 0
        self._multipliers = self._read_multipliers(options.is_ros_1)
        if self.params.diagnostics.error_count > before:
            return
        self._once = OneTimeWarnings(self.plugin)
        self._accepts_commands = False  # true while the controller is active
        self._command, self._stamp_ns = _NO_MOTION, 0
        self._last, self._before_last = _NO_MOTION, _NO_MOTION
        self._commanded: tuple[object, object] | None = None  # last command to the wheels, and the wheel sizes for it
        self._odometry = RollingMeanOdometry(options.window)
        self._has_begun = False
        self._angles: tuple[float, float] | None = None  # wheel angles at the last update of the odometry
        self._reckoned_ns = self._published_ns = 0
        self._open_topics(options)

    def _open_topics(self, options: DriveOptions) -> None:
        types = COMMAND_TYPES[::-1] if options.stamped else COMMAND_TYPES
        self.listen("~/cmd_vel", types, self._on_command)
        if not options.stamped and not options.is_ros_1:
            self.listen("~/cmd_vel_unstamped", COMMAND_TYPES, self._on_command)
        self._odom = self.advertise("~/odom", ODOMETRY)
        self._tf = self.advertise("/tf", TRANSFORMS) if options.publish_tf else None
        if self._tf is not None:
            self._tf.present = lambda: transforms(self.sim.time_ns, self.odometry_frame)
        self._limited = self.advertise("~/cmd_vel_out", _STAMPED) if options.publish_limited else None

    def speed_bounds(self, topic: str) -> tuple[tuple[float, float], tuple[float, float]] | None:
        """Return the bounds of the commands on a topic; None for topics without commands.

        Returns:
            Lowest and highest linear velocity [m/s], and lowest and highest angular velocity [rad/s].
        """
        if not self._takes(topic):
            return None
        linear, angular = self._options.linear, self._options.angular
        return (linear.least, linear.most), (angular.least, angular.most)

    def command_timeout(self, topic: str) -> float | None:
        """Return the time after which a command on a topic expires [s]; None for topics without commands."""
        return self._options.timeout_ns / _NS if self._takes(topic) else None

    def _takes(self, topic: str) -> bool:
        """Check whether the controller receives commands on a topic."""
        return topic in (self.plugin.ros.topic(self.topic(name)) for name in ("~/cmd_vel", "~/cmd_vel_unstamped"))

    def command_interfaces(self) -> Sequence[str]:
        return [f"{name}/velocity" for name in (*self._options.left, *self._options.right)]

    def state_interfaces(self) -> Sequence[str]:
        if self._options.open_loop:
            return ()
        interface = "position" if self._options.position_feedback else "velocity"
        return [f"{name}/{interface}" for name in (*self._options.left, *self._options.right)]

    def activate(self) -> None:
        now = self.sim.time_ns
        self._command, self._last, self._before_last = _NO_MOTION, _NO_MOTION, _NO_MOTION
        self._stamp_ns, self._commanded = now, None
        if not self._has_begun:
            self._has_begun, self._published_ns, self._reckoned_ns = True, now, now
        self._accepts_commands = True

    def deactivate(self) -> None:
        self._accepts_commands = False
        self._drive(_NO_MOTION, self._sizes())

    # ------------------------------------------------------------------ commands

    def _on_command(self, message: Twist | TwistStamped) -> None:
        if not self._accepts_commands:
            self._warn("inactive", "a command arrived while the controller is inactive; the command is ignored")
            return
        command = command_of(message)
        if command is None:
            self._warn("finite", "a command has a value that is NaN or infinite; the command is ignored")
            return
        header = getattr(message, "header", None)
        stamp = 0 if header is None else msgs.stamp_ns(header.stamp)
        self._command, self._stamp_ns = command, stamp or self.sim.time_ns

    def _warn(self, key: str, message: str) -> None:
        self._once.warn("SK-CONTROL-045", f"{self.name} {key}", f"controller {self.name!r}: {message}")

    @property
    def odometry_frame(self) -> tuple[str, str, Pose]:
        """Name of the odometry frame, name of the base frame, and pose of the base in the odometry frame."""
        return self._options.odom_frame, self._options.base_frame, self._odometry.reckoning.pose

    def update(self, now_ns: int, period: float) -> None:
        """Update the odometry to the current time, then command the wheels with the limited command."""
        options = self._options
        if now_ns - self._stamp_ns > options.timeout_ns:
            self._command = _NO_MOTION
        sizes = self._sizes()
        self._update_odometry(now_ns, sizes)
        self._publish(now_ns)
        (ahead, turn), last, before = self._command, self._last, self._before_last
        self._before_last = last
        self._last = (
            options.linear.limit(ahead, last[0], before[0], period),
            options.angular.limit(turn, last[1], before[1], period),
        )
        if self._limited is not None and self._limited.wanted:
            self._limited.publish_later(partial(_twist_stamped, now_ns, options.base_frame, *self._last))
        self._drive(self._last, sizes)

    def _drive(self, command: tuple[float, float], sizes: tuple[float, float, float]) -> None:
        if self._commanded == (command, sizes):
            return  # the command interfaces keep their values
        self._commanded = command, sizes
        separation, left_radius, right_radius = sizes
        ahead, turn = command
        half, count = turn * separation / 2, len(self._options.left)
        self.commands.values = [(ahead - half) / left_radius] * count + [(ahead + half) / right_radius] * count

    # ------------------------------------------------------------------ odometry

    def _update_odometry(self, now_ns: int, sizes: tuple[float, float, float]) -> None:
        elapsed = (now_ns - self._reckoned_ns) / _NS
        separation, left_radius, right_radius = sizes
        if self._options.open_loop:
            self._odometry.follow(*self._last, elapsed)
        else:
            left, right = self._wheel_motion()
            if not math.isfinite(left + right):
                return  # the hardware has not been read yet
            if self._angles is None:
                self._angles, self._reckoned_ns = (left, right), now_ns
                return
            if self._options.position_feedback:
                # rotation of the wheels while the controller was inactive counts as motion
                old_left, old_right = self._angles
                distances = (left - old_left) * left_radius, (right - old_right) * right_radius
            else:
                distances = left * left_radius * elapsed, right * right_radius * elapsed
            if not self._odometry.roll(*distances, separation, elapsed):
                return
            self._angles = left, right
        self._reckoned_ns = now_ns

    def _wheel_motion(self) -> tuple[float, float]:
        """Return the mean of the wheels on each side: angles [rad], or speeds [rad/s]."""
        values, count = self.states.values.tolist(), len(self._options.left)
        if count == 1:
            left, right = values
            return left, right
        return float_sum(values[:count]) / count, float_sum(values[count:]) / count

    def _publish(self, now_ns: int) -> None:
        """Publish odometry and its transform if the next multiple of the publish period is reached."""
        options, period_ns = self._options, self._period_ns
        if period_ns:
            missed = (now_ns - self._published_ns) // period_ns
            if missed < 1:
                return
            self._published_ns += missed * period_ns
        has_odom, has_tf = self._odom.wanted, self._tf is not None and self._tf.wanted
        if not has_odom and not has_tf:
            return
        pose, frames = self._odometry.reckoning.pose, (options.odom_frame, options.base_frame)
        if has_odom:
            arguments = *frames, pose, self._odometry.twist, options.pose_covariance, options.twist_covariance
            self._odom.publish_later(partial(odometry_message, now_ns, *arguments))
        if self._tf is not None and has_tf:
            self._tf.publish_later(partial(transforms, now_ns, (*frames, pose)))

    # ------------------------------------------------------------------ sizes

    def _sizes(self) -> tuple[float, float, float]:
        """Return the separation and the radii of the left and the right wheels, with multipliers [m]."""
        (separation, left, right), options = self._multipliers, self._options
        return options.separation * separation.value, options.radius * left.value, options.radius * right.value

    def _read_multipliers(self, is_ros_1: bool) -> tuple[Parameter[float], ...]:
        """Declare live multipliers of the separation and of the two radii."""
        radius = self.params.number("wheel_radius_multiplier", 1.0, minimum=1e-3) if is_ros_1 else 1.0
        defaults = {
            "wheel_separation_multiplier": (1.0, "multiplier of the distance between the wheels"),
            "left_wheel_radius_multiplier": (radius, "multiplier of the radius of the left wheels"),
            "right_wheel_radius_multiplier": (radius, "multiplier of the radius of the right wheels"),
        }
        return tuple(self.declare(n, v, minimum=1e-3, description=text) for n, (v, text) in defaults.items())

    def _wheel_size_of_model(self, left: str, right: str) -> tuple[float | None, float | None]:
        """Return separation and radius [m] from the model: from joint positions and the left wheel's shape."""
        joints = [self.hardware.joints.get(name) for name in (left, right)]
        if joints[0] is None or joints[1] is None:
            return None, None
        scenes = [joint.handle.scene for joint in joints if joint is not None]
        offset = scenes[0].pose_world.position - scenes[1].pose_world.position
        shapes = [c.geometry for c in self.sim.link(scenes[0].child_link).scene.collisions]
        radii = [shape.radius for shape in shapes if isinstance(shape, (Cylinder, Sphere))]
        return norm(offset), float(max(radii)) if radii else None


def _twist_stamped(time_ns: int, frame: str, ahead: float, turn: float) -> TwistStamped:
    twist = {"linear": {"x": ahead}, "angular": {"z": turn}}
    message: TwistStamped = msgs.make(_STAMPED, header=msgs.header(time_ns, frame), twist=twist)
    return message
