"""Limits for the speed, acceleration and jerk of commands."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.plugins.options import Options, number
from simkit.pose import Vector

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


class SpeedLimiterArrays:
    """Several limiters that limit arrays of speeds, one column for each limiter, with the bits of `SpeedLimiter`."""

    def __init__(self, limiters: Sequence[SpeedLimiter]) -> None:
        self._bounds = [np.array([getattr(one, quantity) for one in limiters]).T for quantity in _QUANTITIES]

    def limit(self, target: Vector, last: Vector, before_last: Vector, step: float) -> Vector:
        """Return the speeds to command now; see `SpeedLimiter.limit`."""
        velocity, acceleration, jerk = self._bounds
        old = (last - before_last) / step
        wanted = np.maximum(jerk[0], np.minimum(jerk[1], ((target - last) / step - old) / step))
        gain = np.maximum(acceleration[0], np.minimum(acceleration[1], old + wanted * step))
        reached = last + gain * step
        is_target = np.abs(reached - target) <= 1e-12 * np.maximum(1.0, np.abs(target))
        speeds: Vector = np.maximum(velocity[0], np.minimum(velocity[1], np.where(is_target, target, reached)))
        return speeds


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
