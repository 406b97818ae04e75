"""gz's differential drive: `gz::sim::systems::DiffDrive`, also with several wheels on each side (skid steering)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from simkit.msgs.topics import valid_topic
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.lookups import find_axis_joint
from simkit.plugins.odometry import (
    COMMAND_TYPES,
    ODOMETRY,
    TRANSFORMS,
    DeadReckoning,
    TrueMotion,
    command_of,
    odometry_message,
    rolling_twist,
    transforms,
)
from simkit.plugins.odometry_noise import ErringOdometry, read_odometry_noise

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.scene import SceneModel


@dataclass(frozen=True, slots=True)
class SpeedLimiter:
    """Bounds on a commanded speed and its first two derivatives (SI units); infinite where there are none."""

    velocity: tuple[float, float] = (-math.inf, math.inf)
    acceleration: tuple[float, float] = (-math.inf, math.inf)
    jerk: tuple[float, float] = (-math.inf, math.inf)

    @classmethod
    def from_params(cls, params: Params, direction: str) -> SpeedLimiter:
        """`<max_linear_velocity>` and the like; `<max_velocity>` stands for both directions where they are absent."""

        def bounds(quantity: str) -> tuple[float, float]:
            low, high = (_bound(params, side, direction, quantity) for side in ("min", "max"))
            if low > high:
                message = f"found min {low:g} above max {high:g} for {direction} {quantity}, allowed is min ≤ max"
                params.error("SK-PARAM-002", message)
                return (-math.inf, math.inf)
            return low, high

        return cls(bounds("velocity"), bounds("acceleration"), bounds("jerk"))

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


def _bound(params: Params, side: str, direction: str, quantity: str) -> float:
    endless = -math.inf if side == "min" else math.inf
    general = params.number(f"{side}_{quantity}", endless, finite=False)
    return params.number(f"{side}_{direction}_{quantity}", general, finite=False)


def _clamp(value: float, bounds: tuple[float, float]) -> float:
    return max(bounds[0], min(bounds[1], value))


class DiffDrive(ModelPlugin):
    """Drives the wheels from `/model/<model>/cmd_vel`; odometry by the wheels' turns on `/model/<model>/odometry`.

    Odometry starts at zero, in the point between the wheels; its twist is that of the first pair of wheels now.
    With `<publish_ground_truth>` (simkit's own) the true pose goes out on `/model/<model>/ground_truth/odom`, and with
    `<odometry_noise>` (simkit's own) the odometry errs and tells its covariance.
    """

    filenames = ("gz-sim-diff-drive-system",)
    drives = True
    names = ("gz::sim::systems::DiffDrive",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._separation = params.number("wheel_separation", 1.0, minimum=1e-6)
        self._radius = params.number("wheel_radius", 0.2, minimum=1e-6)
        self._limits = (SpeedLimiter.from_params(params, "linear"), SpeedLimiter.from_params(params, "angular"))
        self._canonical = scene.canonical_link
        sides = []
        self._servos: list[list[Any]] = []
        for name in ("left_joint", "right_joint"):
            elements = params.all(name)
            if not elements:
                params.text(name, required=True)
            found = [find_axis_joint(scene, element.value, params) for element in elements]
            joints = [joint for joint in found if joint is not None]
            sides.append([joint.scoped for joint in joints])
            self._servos.append(
                [builder.add_velocity_servo(j.scoped, max_effort=j.axes[0].effort, owner=self.name) for j in joints]
            )
        self._sides = sides

    def load(self, parent: Any, params: Params) -> None:
        model = parent.name
        link = self._canonical.rsplit("::", 1)[-1]
        self._frame = params.text("frame_id", f"{model}/odom")
        self._child = params.text("child_frame_id", f"{model}/{link}")
        # gz publishes at every step where the frequency is not positive
        self.after_step_rate = max(0.0, params.number("odom_publish_frequency", 50.0))
        self._pair = tuple(self.sim.joint(names[0]) for names in self._sides)
        self._true = TrueMotion(parent, self.sim.link(self._canonical))
        self._target = (0.0, 0.0)
        self._last, self._before_last = (0.0, 0.0), (0.0, 0.0)
        self._settled = True
        self._enabled = True
        self._reckoning = DeadReckoning()
        self._angles = self._read_angles()
        noise = read_odometry_noise(params)
        self._erring: ErringOdometry | None = None
        if noise is not None:
            stream = self.random("odometry_noise", 2)
            self._erring = ErringOdometry(noise, self._radius, self._separation, stream, self._angles)
        self._last_ns = self.sim.time_ns
        self.listen(valid_topic(params.text("topic", f"/model/{model}/cmd_vel")), COMMAND_TYPES, self._on_command)
        self.listen(valid_topic(f"/model/{model}/enable"), "std_msgs/msg/Bool", self._on_enable)
        self._odom = self.advertise(valid_topic(params.text("odom_topic", f"/model/{model}/odometry")), ODOMETRY)
        self._tf = self.advertise(valid_topic(params.text("tf_topic", f"/model/{model}/tf")), TRANSFORMS)
        truth = params.boolean("publish_ground_truth", False)
        self._truth = self.advertise(valid_topic(f"/model/{model}/ground_truth/odom"), ODOMETRY) if truth else None

    # ------------------------------------------------------------------ commands

    def _on_command(self, message: Any) -> None:
        command = command_of(message)
        if command is None:
            self.log.warning("%s: a command that is not finite is left out", self.name)
        elif self._enabled:
            self._target, self._settled = command, False

    def _on_enable(self, message: Any) -> None:
        self._enabled = bool(message.data)
        if not self._enabled:
            self._target, self._settled = (0.0, 0.0), False

    def before_step(self) -> None:
        """Takes the limited speeds one step towards the command."""
        if self._settled:
            return
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
        now = self.sim.time_ns
        self._advance()
        erring = self._erring
        pose = (erring.reckoning if erring is not None else self._reckoning).pose
        if self._odom.wanted:
            told: tuple[Any, ...] = (rolling_twist(self._pair, self._radius, self._separation),)
            if erring is not None:
                told = (erring.twist, *(erring.messages_covariance() if erring.noise.wheel_variance else ()))
            self._odom.publish_later(partial(odometry_message, now, self._frame, self._child, pose, *told))
        if self._tf.wanted:
            self._tf.publish_later(partial(transforms, now, (self._frame, self._child, pose)))
        if self._truth is not None and self._truth.wanted:
            self._truth.publish(odometry_message(now, "world", self._child, *self._true.state()))

    def _advance(self) -> None:
        angles = self._read_angles()
        if self._erring is not None:
            elapsed, self._last_ns = (self.sim.time_ns - self._last_ns) * 1e-9, self.sim.time_ns
            self._erring.advance(*angles, elapsed)
        left, right = ((new - old) * self._radius for new, old in zip(angles, self._angles, strict=True))
        self._angles = angles
        self._reckoning.advance(left, right, self._separation)

    def _read_angles(self) -> tuple[float, float]:
        left, right = self._pair
        return float(left.position), float(right.position)
