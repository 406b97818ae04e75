"""Limits for the speed, acceleration and jerk of commands."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from simkit.elementary_functions import arithmetic_of
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.plugins.options import Options, number
from simkit.pose import Vector

Number = Any
"""A float, or an array with a float for each of several drives."""

_QUANTITIES = ("velocity", "acceleration", "jerk")


@dataclass(frozen=True, slots=True)
class SpeedLimiter(SharedByCopies):
    """Bounds of a commanded speed and its first two derivatives (SI units); infinite if there is no limit.

    The speeds are numbers, or arrays with one number for each of several drives, which get the same bits.
    """

    velocity: tuple[float, float] = (-math.inf, math.inf)
    acceleration: tuple[float, float] = (-math.inf, math.inf)
    jerk: tuple[float, float] = (-math.inf, math.inf)

    def limit(self, target: Number, last: Number, before_last: Number, step: float) -> Number:
        """Return the speed to command now, limited in jerk, then acceleration, then speed (gz-math's SpeedLimiter).

        Args:
            target: Requested speed.
            last: Speed of the last command.
            before_last: Speed of the command before that.
            step: Time between commands [s].
        """
        of = arithmetic_of(target)
        larger, smaller = of.maximum, of.minimum
        old = (last - before_last) / step
        jerk = larger(self.jerk[0], smaller(self.jerk[1], ((target - last) / step - old) / step))
        acceleration = larger(self.acceleration[0], smaller(self.acceleration[1], old + jerk * step))
        reached = last + acceleration * step
        # without an active limit the speed is exactly the target, free of rounding errors
        is_target = abs(reached - target) <= 1e-12 * larger(1.0, abs(target))
        return larger(self.velocity[0], smaller(self.velocity[1], of.where(is_target, target, reached)))


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
    targets: Sequence[Number] | Vector,
    last: Sequence[Number] | Vector,
    before_last: Sequence[Number] | Vector,
    step: float,
) -> tuple[Number, ...]:
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
