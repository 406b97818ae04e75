"""Tricycle controller of ros2_controllers: one wheel that is driven and steered."""

from __future__ import annotations

import math
from collections.abc import Sequence

from simkit import Params
from simkit.plugins.drives.odometry import Motion
from simkit_control.plugins.ros2_control.diff_drive_options import read_bound
from simkit_control.plugins.ros2_control.reference_drive import ReferenceDrive, read_size

_FREE_ERROR = math.pi / 6
"""Error of the steering angle [rad] up to which the wheel has its full speed."""
_SLOWEST = 0.01
"""Share of the speed that the wheel keeps while the error of the steering angle is above 90°."""


class CommandLimits:
    """Bounds of a command and of its rate of change, the same in both directions.

    Attributes:
        least, most: bounds of the command.
        rise: largest rate of a command that moves away from zero; None without a limit.
        fall: largest rate of a command that moves towards zero; None without a limit.
    """

    def __init__(self, block: Params, value: str, rise: str, fall: str) -> None:
        most = read_bound(block, f"max_{value}", 0.0, None)
        least = read_bound(block, f"min_{value}", None, 0.0) if value == "position" else None
        self.most = most if most is not None else math.inf if least is None else -least
        self.least = -self.most if least is None else least
        self.rise, slowing = (read_bound(block, f"max_{name}", 0.0, None) for name in (rise, fall))
        self.fall = self.rise if slowing is None else slowing

    def limit(self, target: float, last: float, period: float) -> float:
        """Return a target command after limiting its change and then its value."""
        change = target - last
        rate = self.rise if change * last >= 0.0 else self.fall
        reached = target
        if rate is not None and abs(change) > rate * period:
            reached = last + math.copysign(rate * period, change)
        return min(max(reached, self.least), self.most)


class TricycleDrive(ReferenceDrive):
    """Drives one wheel by velocity and steers the same wheel by position; two other wheels follow.

    After the command has expired, the wheel stops and is steered straight ahead.
    """

    types = ("tricycle_controller/TricycleController",)
    default_timeout = 0.5
    default_variances = (0.0,) * 6

    def read_timeout(self, params: Params) -> float:
        milliseconds = params.number("cmd_vel_timeout", self.default_timeout * 1000.0, minimum=0, maximum=1e12)
        return milliseconds / 1000.0

    def read_wheels(self, params: Params) -> None:
        self.topics = ("~/cmd_vel", "~/odom", "/tf")
        self._joints = [params.text(f"{name}_joint_name", required=True) for name in ("traction", "steering")]
        self._radius, self._wheelbase = read_size(params, ["wheel_radius"]), read_size(params, ["wheelbase"])
        self._traction = CommandLimits(params.block("traction"), "velocity", "acceleration", "deceleration")
        self._steering = CommandLimits(params.block("steering"), "position", "velocity", "velocity")
        self._last, self._angle, self._period = [0.0, 0.0], 0.0, 0.0

    def command_interfaces(self) -> Sequence[str]:
        return [f"{self._joints[0]}/velocity", f"{self._joints[1]}/position"]

    def state_interfaces(self) -> Sequence[str]:
        return self.command_interfaces()

    def activate(self) -> None:
        super().activate()
        self._last = [0.0, 0.0]

    def measured_twist(self, values: Sequence[float], period: float) -> Motion:
        rim, self._angle = values[0] * self._radius, values[1]
        self._period = period
        return rim * math.cos(self._angle), 0.0, rim * math.sin(self._angle) / self._wheelbase

    def wheel_commands(self, reference: Motion | None) -> list[float]:
        ahead, _, turn = reference or (0.0, 0.0, 0.0)
        if turn and not ahead:
            angle, speed = math.copysign(math.pi / 2, turn), abs(turn) * self._wheelbase / self._radius
        else:
            angle = math.atan(turn * self._wheelbase / ahead) if turn else 0.0
            speed = ahead / (self._radius * math.cos(angle))
        error = abs(angle - self._angle)
        if error >= _FREE_ERROR:  # the wheel is slow until it is steered
            speed *= _SLOWEST if error > math.pi / 2 else math.cos(error)
        limits = (self._traction, self._steering)
        targets = zip(limits, (speed, angle), self._last, strict=True)
        self._last = [limit.limit(target, last, self._period) for limit, target, last in targets]
        return list(self._last)
