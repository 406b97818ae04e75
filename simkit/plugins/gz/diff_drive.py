"""gz's differential drive: `gz::sim::systems::DiffDrive`, also with several wheels on each side (skid steering)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from simkit.msgs.topics import valid_topic
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.odometry import (
    COMMAND_TYPES,
    ODOMETRY,
    TRANSFORMS,
    TrueMotion,
    WheelOdometry,
    command_of,
    odometry_message,
    transforms,
    wheel_angles,
)
from simkit.plugins.drives.odometry_noise import NoisyOdometry, read_odometry_noise
from simkit.plugins.drives.wheel_joints import find_wheels
from simkit.plugins.gz.diff_drive_fleet import DriveFleet, fleet_of
from simkit.plugins.lookups import read_topic
from simkit.plugins.one_time_warnings import OneTimeWarnings

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.scene import SceneModel


@dataclass(frozen=True, slots=True)
class SpeedLimiter:
    """Bounds on a commanded speed and its first two derivatives (SI units); infinite where there are none."""

    velocity: tuple[float, float] = (-math.inf, math.inf)
    acceleration: tuple[float, float] = (-math.inf, math.inf)
    jerk: tuple[float, float] = (-math.inf, math.inf)

    def __deepcopy__(self, memo: dict[int, object]) -> SpeedLimiter:
        return self

    def limit(self, target: float, last: float, before_last: float, step: float) -> float:
        """The speed to command now, bounded in jerk, then acceleration, then speed (gz-math's SpeedLimiter).

        Args:
            target: wanted speed.
            last, before_last: the two speeds commanded before.
            step: time between commands [s].
        """
        old = (last - before_last) / step
        jerk = _clamp(((target - last) / step - old) / step, self.jerk)
        acceleration = _clamp(old + jerk * step, self.acceleration)
        reached = last + acceleration * step
        # without an active bound the target itself, not the target after rounding
        if abs(reached - target) <= 1e-12 * max(1.0, abs(target)):
            reached = target
        return _clamp(reached, self.velocity)


def speed_limits(params: Params) -> tuple[SpeedLimiter, SpeedLimiter]:
    """Of the linear and the angular speed: `<max_linear_velocity>` and the like; for both directions `<max_velocity>`.

    A lower bound is not positive and an upper one not negative, so that a drive can stand still.
    """

    def read(side: str, quantity: str) -> list[float]:
        endless, least, most = (-math.inf, None, 0.0) if side == "min" else (math.inf, 0.0, None)

        def bound(name: str, default: float) -> float:
            return params.number(name, default, minimum=least, maximum=most, finite=False)

        general = bound(f"{side}_{quantity}", endless)
        return [bound(f"{side}_{direction}_{quantity}", general) for direction in ("linear", "angular")]

    pairs = [list(zip(read("min", q), read("max", q), strict=True)) for q in ("velocity", "acceleration", "jerk")]
    linear, angular = (SpeedLimiter(*bounds) for bounds in zip(*pairs, strict=True))
    return linear, angular


def _clamp(value: float, bounds: tuple[float, float]) -> float:
    return max(bounds[0], min(bounds[1], value))


class DiffDrive(ModelPlugin):
    """Drives the wheels from `/model/<model>/cmd_vel`; odometry by the wheels' turns on `/model/<model>/odometry`.

    Odometry is that of the first pair of wheels. It starts at zero, in the point between them; its twist is the mean
    over the last ten steps. With `<publish_ground_truth>` (simkit's own) the true pose goes out on
    `/model/<model>/ground_truth/odom`, and with `<odometry_noise>` (simkit's own) the odometry errs and tells its
    covariance.
    """

    filenames = ("gz-sim-diff-drive-system",)
    drives = True
    names = ("gz::sim::systems::DiffDrive",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._separation = params.number("wheel_separation", 1.0, minimum=1e-6)
        self._radius = params.number("wheel_radius", 0.2, minimum=1e-6)
        self._limits = speed_limits(params)
        self._canonical = scene.canonical_link
        # gz publishes at every step where the frequency is zero
        self.after_step_rate = params.number("odom_publish_frequency", 50.0, minimum=0)
        named = [params.all("left_joint"), params.all("right_joint")]
        for name, found in zip(("left_joint", "right_joint"), named, strict=True):
            if not found:
                params.text(name, required=True)
        left, right = ([element.value for element in elements] for elements in named)
        wheels = find_wheels(scene, {"left wheel": left, "right wheel": right}, params)
        self._sides = [[joint.scoped for joint in joints] for joints in wheels.values()]
        self._servos = [
            [builder.add_velocity_servo(j.scoped, max_effort=j.axes[0].effort, owner=self.name) for j in joints]
            for joints in wheels.values()
        ]

    def load(self, parent: Any, params: Params) -> None:
        self.once = OneTimeWarnings(self)
        model = parent.name
        link = self._canonical.rsplit("::", 1)[-1]
        self._frame = params.text("frame_id", f"{model}/odom")
        self._child = params.text("child_frame_id", f"{model}/{link}")
        self._pair = (self.sim.joint(self._sides[0][0]), self.sim.joint(self._sides[1][0]))
        self._true = TrueMotion(parent, self.sim.link(self._canonical))
        self._target = (0.0, 0.0)
        self._last, self._before_last = (0.0, 0.0), (0.0, 0.0)
        self._settled = True
        self._enabled = True
        self._odometry = WheelOdometry(self._radius, self._separation, self.period)
        noise = read_odometry_noise(params)
        self._erring: NoisyOdometry | None = None
        if noise is not None:
            stream = self.random("odometry_noise", 2)
            self._erring = NoisyOdometry(noise, self._radius, self._separation, stream, wheel_angles(*self._pair))
        self._last_ns = self.sim.time_ns
        self.listen(read_topic(params, "topic", f"/model/{model}/cmd_vel"), COMMAND_TYPES, self._on_command)
        self.listen(valid_topic(f"/model/{model}/enable"), "std_msgs/msg/Bool", self._on_enable)
        self._odom = self.advertise(read_topic(params, "odom_topic", f"/model/{model}/odometry"), ODOMETRY)
        self._tf = self.advertise(read_topic(params, "tf_topic", f"/model/{model}/tf"), TRANSFORMS)
        truth = params.boolean("publish_ground_truth", False)
        self._truth = self.advertise(valid_topic(f"/model/{model}/ground_truth/odom"), ODOMETRY) if truth else None

    # ------------------------------------------------------------------ commands

    def speed_bounds(self, _: str) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and greatest speed ahead [m/s] and rate of turning [rad/s] that commands are held to."""
        linear, angular = self._limits
        return linear.velocity, angular.velocity

    def _on_command(self, message: Any) -> None:
        command = command_of(message)
        if command is None:
            self.once.not_finite()
        elif self._enabled:
            self._target, self._settled = command, False

    def _on_enable(self, message: Any) -> None:
        self._enabled = bool(message.data)
        if not self._enabled:
            self._target, self._settled = (0.0, 0.0), False

    def before_step(self) -> None:
        """Notes the wheels' angles, and takes the limited speeds one step towards the command."""
        self._odometry.note(wheel_angles(*self._pair))
        if not self._settled:
            self._command()

    @classmethod
    def before_step_together(cls, drives: Sequence[DiffDrive]) -> Callable[[Iterable[DiffDrive]], None]:
        """Of many."""
        return DriveFleet(drives).before_step

    @classmethod
    def after_step_together(cls, drives: Sequence[DiffDrive]) -> Callable[[Iterable[DiffDrive]], None]:
        """Of many."""
        return fleet_of(drives).after_step

    def _command(self) -> None:
        step = self.period
        linear, angular = (
            limiter.limit(target, last, before, step)
            for limiter, target, last, before in zip(
                self._limits, self._target, self._last, self._before_last, strict=True
            )
        )
        self._settled = (linear, angular) == self._last == self._before_last
        self._before_last, self._last = self._last, (linear, angular)
        half = angular * self._separation / 2
        for servos, speed in zip(self._servos, (linear - half, linear + half), strict=True):
            for servo in servos:
                self.sim.set_control(servo, speed / self._radius)

    # ------------------------------------------------------------------ readings

    def after_step(self) -> None:
        """Odometry and its transform."""
        now, erring, odometry = self.sim.time_ns, self._erring, self._odometry
        angles = wheel_angles(*self._pair)
        odometry.reckon(angles)
        pose = odometry.reckoning.pose
        told: tuple[Any, ...] = (odometry.twist,)
        if erring is not None:
            elapsed, self._last_ns = (now - self._last_ns) * 1e-9, now
            erring.advance(*angles, elapsed)
            covariances = erring.messages_covariance() if erring.noise.wheel_variance else ()
            pose, told = erring.reckoning.pose, (erring.twist, *covariances)
        if self._odom.wanted:
            self._odom.publish_later(partial(odometry_message, now, self._frame, self._child, pose, *told))
        if self._tf.wanted:
            self._tf.publish_later(partial(transforms, now, (self._frame, self._child, pose)))
        if self._truth is not None and self._truth.wanted:
            self._truth.publish(odometry_message(now, "world", self._child, *self._true.state()))
