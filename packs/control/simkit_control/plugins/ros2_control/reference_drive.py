"""Base class of the controllers of mobile bases that follow a reference twist: steering drives and mecanum drives."""

from __future__ import annotations

import abc
import math
from collections import deque
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, ClassVar, cast

import numpy as np

from simkit import Params, Pose, msgs
from simkit.extend import counted
from simkit.float_sum import float_sum
from simkit.plugins.drives.odometry import COMMAND_TYPES, DeadReckoning, Motion
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, BodyTwist, odometry_message, transforms
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.ros_parameter_block import read_names, read_numbers
from simkit_control.plugins.ros2_control.controller import Controller

if TYPE_CHECKING:
    from simkit.msgs import Twist, TwistStamped

_AT_REST: Motion = (0.0, 0.0, 0.0)


class ReferenceDrive(Controller):
    """Follows the twist on `~/reference`, and publishes odometry on `~/odometry` and `~/tf_odometry`.

    A reference is valid for `reference_timeout` [s]; 0 makes it valid for one update. Odometry starts at zero.

    Attributes:
        default_timeout: default of `reference_timeout` [s].
        default_variances: default of the diagonals of the covariances.
        topics: names of the topics of the commands, the odometry and its transform; `read_wheels` may change them.
        publish_rate: rate of the odometry [Hz]; 0 for every update; `read_wheels` may change it.
    """

    default_timeout: ClassVar[float] = 1.0
    default_variances: ClassVar[Sequence[float]] = (0.0, 7.0, 14.0, 21.0, 28.0, 35.0)

    topics: tuple[str, str, str]
    publish_rate: float = 0.0
    _published = -1  # number of the last instant of the publish rate

    def configure(self) -> None:
        params, variances = self.params, self.default_variances
        self.topics = ("~/reference", "~/odometry", "~/tf_odometry")
        self._timeout_ns = round(self.read_timeout(params) * 1e9)
        self._frames = params.text("odom_frame_id", "odom"), params.text("base_frame_id", "base_link")
        names = "pose_covariance_diagonal", "twist_covariance_diagonal"
        self._covariances = tuple(np.diag(read_numbers(params, n, variances, minimum=0.0)).reshape(36) for n in names)
        self._open_loop = params.boolean("open_loop", False)
        self._twists: deque[Motion] = deque(maxlen=params.integer("velocity_rolling_window_size", 10, minimum=1))
        has_transform = params.boolean("enable_odom_tf", True)
        params.child("use_stamped_vel")  # both types of commands are accepted
        self.read_wheels(params)
        self._reckoning = DeadReckoning()
        self._reference: Motion | None = None
        self._stamp_ns, self._is_active, self._once = 0, False, self.one_time_warnings()
        command, odometry, transform = self.topics
        self.listen(command, COMMAND_TYPES[::-1], self._on_reference)
        self.listen(f"{command}_unstamped", COMMAND_TYPES, self._on_reference)
        self._odometry = self.advertise(odometry, ODOMETRY)
        self._transform = self.advertise(transform, TRANSFORMS) if has_transform else None
        if self._transform is not None:
            self._transform.present = lambda: transforms(self.sim.time_ns, self.odometry_frame)

    def read_timeout(self, params: Params) -> float:
        """Return the time [s] for which a reference is valid."""
        names = ("reference_timeout", "cmd_vel_timeout")
        name = next((name for name in names if params.has(name)), names[0])
        return params.number(name, self.default_timeout, minimum=0, maximum=1e9)

    @abc.abstractmethod
    def read_wheels(self, params: Params) -> None:
        """Read the joints and the sizes of the base."""

    @abc.abstractmethod
    def wheel_commands(self, reference: Motion | None) -> list[float]:
        """Return the values of the command interfaces for a twist [m/s, m/s, rad/s]; None stops the base."""

    @abc.abstractmethod
    def measured_twist(self, values: Sequence[float], period: float) -> Motion:
        """Return the twist of the base [m/s, m/s, rad/s] from the values of the state interfaces."""

    @property
    def odometry_frame(self) -> tuple[str, str, Pose]:
        """Name of the odometry frame, name of the base frame, and pose of the base in the odometry frame."""
        return *self._frames, self._reckoning.pose

    def command_timeout(self, topic: str) -> float | None:
        """Return the time after which a reference on a topic expires [s]; None for other topics."""
        topics = (self.plugin.ros.topic(self.topic(name)) for name in (self.topics[0], f"{self.topics[0]}_unstamped"))
        return self._timeout_ns / 1e9 if topic in topics else None

    def activate(self) -> None:
        self._reference, self._is_active = None, True

    def deactivate(self) -> None:
        self._is_active = False
        self.commands.values = self.wheel_commands(None)

    def update(self, now_ns: int, period: float) -> None:
        """Update the odometry to the current time, then command the wheels."""
        if self._timeout_ns and now_ns - self._stamp_ns > self._timeout_ns:
            self._reference = None
        twist = self.measured_twist(self.states.values.tolist(), period)
        if self._open_loop:
            twist = self._reference or _AT_REST
        if math.isfinite(float_sum(twist)) and period > 0.0:
            self._reckoning.go(*(speed * period for speed in twist))
            self._twists.append(twist)
        self.commands.values = self.wheel_commands(self._reference)
        if not self._timeout_ns:
            self._reference = None
        self._publish(now_ns)

    def _on_reference(self, message: Twist | TwistStamped) -> None:
        if not self._is_active:
            self._warn("inactive", "a command arrived while the controller is inactive; the command is ignored")
            return
        twist = cast("Twist", getattr(message, "twist", message))
        reference = float(twist.linear.x), float(twist.linear.y), float(twist.angular.z)
        if not are_usable(*reference):
            self._warn("finite", "a command has a value that is NaN or infinite; the command is ignored")
            return
        header = getattr(message, "header", None)
        self._stamp_ns = (0 if header is None else msgs.stamp_ns(header.stamp)) or self.sim.time_ns
        self._reference = reference

    def _warn(self, key: str, message: str) -> None:
        self._once.warn("SK-CONTROL-045", f"{self.name} {key}", f"controller {self.name!r}: {message}")

    def _mean_twist(self) -> BodyTwist:
        """Return the mean twist over the window, in the axes of the base."""
        if not self._twists:
            return BodyTwist()
        ahead, left, turn = (float_sum(values) / len(self._twists) for values in zip(*self._twists, strict=True))
        return BodyTwist((ahead, left, 0.0), (0.0, 0.0, turn))

    def _publish(self, now_ns: int) -> None:
        if self.publish_rate > 0.0:
            instant = math.floor(now_ns * 1e-9 * self.publish_rate + 1e-6)
            if instant == self._published:
                return
            self._published = instant
        pose = self._reckoning.pose
        if self._odometry.wanted:
            message = partial(odometry_message, now_ns, *self._frames, pose, self._mean_twist(), *self._covariances)
            self._odometry.publish_later(message)
        if self._transform is not None and self._transform.wanted:
            self._transform.publish_later(partial(transforms, now_ns, (*self._frames, pose)))


def read_joints(params: Params, names: Sequence[str], counts: Sequence[int]) -> list[str]:
    """Return the joints in the first parameter of `names` that exists; a wrong number of joints is an error."""
    name = next((name for name in names if params.has(name)), names[0])
    joints = read_names(params, name, required=True, code="SK-CONTROL-041")
    if joints and len(joints) not in counts:
        allowed = " or ".join(map(str, counts))
        params.error("SK-CONTROL-040", f"{name} names {counted(len(joints), 'joint')}; this controller needs {allowed}")
    return joints


def read_size(params: Params, names: Sequence[str], default: float | None = None) -> float:
    """Return the positive number [m] in the first parameter of `names` that exists."""
    name = next((name for name in names if params.has(name)), names[0])
    return params.number(name, default, required=default is None, minimum=1e-6) or 1.0
