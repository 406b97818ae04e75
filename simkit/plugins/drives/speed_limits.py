"""Limits for the speed, acceleration and jerk of commands."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.plugins.options import Options, number

_QUANTITIES = ("velocity", "acceleration", "jerk")


@dataclass(frozen=True, slots=True)
class SpeedLimiter(SharedByCopies):
    """Bounds of a commanded speed and its first two derivatives (SI units); infinite if there is no limit."""

    velocity: tuple[float, float] = (-math.inf, math.inf)
    acceleration: tuple[float, float] = (-math.inf, math.inf)
    jerk: tuple[float, float] = (-math.inf, math.inf)

    def limit(self, target: float, last: float, before_last: float, step: float) -> float:
        """Return the speed to command now, limited in jerk, then acceleration, then speed (gz-math's SpeedLimiter).

        Args:
            target: Requested speed.
            last: Speed of the last command.
            before_last: Speed of the command before that.
            step: Time between commands [s].
        """
        old = (last - before_last) / step
        jerk = _clamp(((target - last) / step - old) / step, self.jerk)
        acceleration = _clamp(old + jerk * step, self.acceleration)
        reached = last + acceleration * step
        # without an active limit the speed is exactly the target, free of rounding errors
        if abs(reached - target) <= 1e-12 * max(1.0, abs(target)):
            reached = target
        return _clamp(reached, self.velocity)


class SpeedLimitOptions(Options):
    """Limits of the linear and the angular speed of a drive; options such as `<max_velocity>` apply to both speeds.

    A lower limit must not be positive and an upper limit not negative, so that a drive can stop.
    """

    min_velocity: float = number(-math.inf, maximum=0.0, finite=False)
    min_linear_velocity: float = number(-math.inf, "m/s", maximum=0.0, finite=False, instead="min_velocity")
    min_angular_velocity: float = number(-math.inf, "rad/s", maximum=0.0, finite=False, instead="min_velocity")
    max_velocity: float = number(math.inf, minimum=0.0, finite=False)
    max_linear_velocity: float = number(math.inf, "m/s", minimum=0.0, finite=False, instead="max_velocity")
    max_angular_velocity: float = number(math.inf, "rad/s", minimum=0.0, finite=False, instead="max_velocity")
    min_acceleration: float = number(-math.inf, maximum=0.0, finite=False)
    min_linear_acceleration: float = number(-math.inf, "m/s²", maximum=0.0, finite=False, instead="min_acceleration")
    min_angular_acceleration: float = number(-math.inf, "rad/s²", maximum=0.0, finite=False, instead="min_acceleration")
    max_acceleration: float = number(math.inf, minimum=0.0, finite=False)
    max_linear_acceleration: float = number(math.inf, "m/s²", minimum=0.0, finite=False, instead="max_acceleration")
    max_angular_acceleration: float = number(math.inf, "rad/s²", minimum=0.0, finite=False, instead="max_acceleration")
    min_jerk: float = number(-math.inf, "m/s³", maximum=0.0, finite=False)
    min_linear_jerk: float = number(-math.inf, "m/s³", maximum=0.0, finite=False, instead="min_jerk")
    min_angular_jerk: float = number(-math.inf, "rad/s³", maximum=0.0, finite=False, instead="min_jerk")
    max_jerk: float = number(math.inf, "m/s³", minimum=0.0, finite=False)
    max_linear_jerk: float = number(math.inf, "m/s³", minimum=0.0, finite=False, instead="max_jerk")
    max_angular_jerk: float = number(math.inf, "rad/s³", minimum=0.0, finite=False, instead="max_jerk")


class LimiterOptions(Options):
    """Limits of one speed; unlimited by default."""

    min_velocity: float = number(-math.inf, maximum=0.0, finite=False)
    max_velocity: float = number(math.inf, minimum=0.0, finite=False)
    min_acceleration: float = number(-math.inf, maximum=0.0, finite=False)
    max_acceleration: float = number(math.inf, minimum=0.0, finite=False)
    min_jerk: float = number(-math.inf, "m/s³", maximum=0.0, finite=False)
    max_jerk: float = number(math.inf, "m/s³", minimum=0.0, finite=False)


def speed_limits(options: SpeedLimitOptions) -> tuple[SpeedLimiter, SpeedLimiter]:
    """Return the limiters of the linear and the angular speed."""
    linear, angular = (
        SpeedLimiter(*((bounds[f"min_{axis}_{q}"], bounds[f"max_{axis}_{q}"]) for q in _QUANTITIES))
        for bounds in [{name: getattr(options, name) for name in SpeedLimitOptions.fields()}]
        for axis in ("linear", "angular")
    )
    return linear, angular


def speed_limiter(options: LimiterOptions) -> SpeedLimiter:
    """Return the limiter of one speed."""
    return SpeedLimiter(*((getattr(options, f"min_{q}"), getattr(options, f"max_{q}")) for q in _QUANTITIES))


def limit_each(
    limiters: Sequence[SpeedLimiter],
    targets: Sequence[float],
    last: Sequence[float],
    before_last: Sequence[float],
    step: float,
) -> tuple[float, ...]:
    """Return the speeds to command now, each limited by its own limiter.

    Args:
        limiters: Limiter of each speed.
        targets: Requested speeds.
        last: Speeds of the last command.
        before_last: Speeds of the command before that.
        step: Time between commands [s].
    """
    speeds = zip(limiters, targets, last, before_last, strict=True)
    return tuple(limiter.limit(target, latest, before, step) for limiter, target, latest, before in speeds)


def _clamp(value: float, bounds: tuple[float, float]) -> float:
    return max(bounds[0], min(bounds[1], value))
