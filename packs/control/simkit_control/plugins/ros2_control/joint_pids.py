"""PID controllers of several joints, with the rules of ros2_control's control_toolbox."""

from __future__ import annotations

from typing import Final

import numpy as np

from simkit import Params
from simkit.extend import Vector

_IGNORED_CLAMPS: Final = ("antiwindup", "save_i_term")  # the clamps of the integral part always apply
ANTIWINDUP: Final = ("none", "back_calculation", "conditional_integration")


class JointPids:
    """PID controllers with the command p·e + ∫i·e dt + d·ė, one for each joint; all arrays have shape (n,).

    Attributes:
        p: command per error.
        i: command per error and second.
        d: command per rate of the error.
        i_low, i_high: bounds of the integral part of the command.
        low, high: bounds of the command.
        feedforward: command per desired velocity.
        tracking: time constant of back-calculation [s]; 0 for the time constant that control_toolbox recommends.
        deadband: largest error that does not change the integral part.
        strategy: rule for the integral part while the command is at a bound: "none" continues to integrate,
            "back_calculation" reduces the integral part by the excess of the command over its bound, and
            "conditional_integration" stops integration towards the bound.
        integral: current integral part of the command.
    """

    def __init__(self, gains: Params, joints: tuple[str, ...]) -> None:
        """Read `gains: {<joint>: {p: …, i: …, d: …}}`; `i_clamp` bounds the integral part in both directions."""
        blocks = [gains.block(joint) for joint in joints]
        for block in blocks:
            for name in _IGNORED_CLAMPS:
                block.child(name)

        def each(name: str, default: float, minimum: float | None = None, *, finite: bool = True) -> Vector:
            return np.array([b.number(name, default, minimum=minimum, finite=finite) for b in blocks])

        clamp = each("i_clamp", np.inf, 0.0, finite=False)
        clamp = np.where(clamp > 0.0, clamp, np.inf)
        self.p = each("p", 0.0)
        self.i = each("i", 0.0)
        self.d = each("d", 0.0)
        self.i_low = np.maximum(each("i_clamp_min", -np.inf, finite=False), -clamp)
        self.i_high = np.minimum(each("i_clamp_max", np.inf, finite=False), clamp)
        self.low = each("u_clamp_min", -np.inf, finite=False)
        self.high = each("u_clamp_max", np.inf, finite=False)
        self.feedforward = each("ff_velocity_scale", 0.0)
        self.tracking = each("tracking_time_constant", 0.0, 0.0)
        self.deadband = each("error_deadband", 0.0, 0.0)
        self.strategy = tuple(b.choice("antiwindup_strategy", ANTIWINDUP, "none") for b in blocks)
        self.integral = np.zeros(len(joints))

    def update(self, error: Vector, rate: Vector, step: float) -> Vector:
        """Advance the loops and return the commands.

        Args:
            error: desired − measured.
            rate: rate of the error.
            step: time since the last update [s].
        """
        unclamped = self.p * error + self.integral + self.d * rate
        command = np.clip(unclamped, self.low, self.high)
        growth = np.where(np.abs(error) > self.deadband, self.i * error, 0.0)
        for j, strategy in enumerate(self.strategy):
            surplus = command[j] - unclamped[j]
            if strategy == "back_calculation":
                growth[j] += surplus / self._tracking(j) if surplus else 0.0
            elif strategy == "conditional_integration" and surplus * error[j] < 0.0:
                growth[j] = 0.0
        self.integral = np.clip(self.integral + growth * step, self.i_low, self.i_high)
        return command

    def restart(self) -> None:
        """Reset the integral parts to 0."""
        self.integral = np.zeros_like(self.integral)

    def _tracking(self, j: int) -> float:
        if self.tracking[j] > 0.0:
            return float(self.tracking[j])
        p, i, d = abs(self.p[j]), abs(self.i[j]), abs(self.d[j])
        if i == 0.0:
            return np.inf
        return float(np.sqrt(d / i) if d > 0.0 else p / i) or np.inf
