"""Bounds on the speed, acceleration and jerk of commands."""

from __future__ import annotations

import math
from dataclasses import dataclass

from simkit.params import Params


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
