"""Bounds on the speeds that a mobile base is told, as the controllers of ros2_controllers have them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from simkit.params import Params

_ENDLESS = math.inf


@dataclass(frozen=True, slots=True)
class RateLimits:
    """Bounds on a speed, its rate and the rate of that; SI units, infinite where there is none.

    Attributes:
        least, most: of the speed.
        acceleration, deceleration: of the rate while the speed is positive: upwards (≥ 0) and downwards (≤ 0).
        reverse_acceleration, reverse_deceleration: the same while it is negative: away from zero (≤ 0), towards it
            (≥ 0). From rest the bounds are those of the two accelerations.
        least_jerk, most_jerk: of the rate of the rate.
    """

    least: float = -_ENDLESS
    most: float = _ENDLESS
    acceleration: float = _ENDLESS
    deceleration: float = -_ENDLESS
    reverse_acceleration: float = -_ENDLESS
    reverse_deceleration: float = _ENDLESS
    least_jerk: float = -_ENDLESS
    most_jerk: float = _ENDLESS

    def __deepcopy__(self, memo: dict[int, object]) -> RateLimits:
        return self

    def limit(self, wanted: float, last: float, before_last: float, period: float) -> float:
        """The speed to command now: bounded in jerk, then in acceleration, then in speed.

        Jerk is bounded while the change grows; it may end at once, or a speed would swing about the one wanted for
        ever. (The rule of control_toolbox's RateLimiter since 2024; before that jerks of twice the bound went through,
        and the swinging.)

        Args:
            wanted: the speed asked for.
            last, before_last: what was commanded in the two periods before.
            period: [s].
        """
        speed, change = wanted, last - before_last
        growth = (speed - last) - change
        if growth * (speed - last) > 0:
            square = period * period
            speed = last + change + min(max(growth, self.least_jerk * square), self.most_jerk * square)
        down = self.deceleration if last > 0 else self.reverse_acceleration
        up = self.reverse_deceleration if last < 0 else self.acceleration
        # without a bound in force the speed itself, not the one after rounding
        if speed - last > up * period:
            speed = last + up * period
        elif speed - last < down * period:
            speed = last + down * period
        return min(max(speed, self.least), self.most)


def read_rate_limits(block: Params) -> RateLimits:
    """The limits in `linear.x` or `angular.z`.

    A kind of limit is in force where `has_velocity_limits` and the like is true, or is not there and a bound is (they
    went out of use); what is not bounded below is bounded as above. NaN is no bound.
    """
    least, most = _pair(block, "velocity")
    least_jerk, most_jerk = _pair(block, "jerk")
    down, up = _pair(block, "acceleration")
    deceleration = _bound(block, "max_deceleration", None, 0.0)
    reverse = _bound(block, "max_acceleration_reverse", None, 0.0)
    back = _bound(block, "max_deceleration_reverse", 0.0, None)
    if up == _ENDLESS:
        return RateLimits(least, most, least_jerk=least_jerk, most_jerk=most_jerk)
    away = down if reverse is None else reverse
    return RateLimits(
        least=least,
        most=most,
        acceleration=up,
        deceleration=away if deceleration is None else deceleration,
        reverse_acceleration=away,
        reverse_deceleration=up if back is None else back,
        least_jerk=least_jerk,
        most_jerk=most_jerk,
    )


def _pair(block: Params, what: str) -> tuple[float, float]:
    """The bounds `min_<what>` and `max_<what>`; infinite where none is in force."""
    told = block.has(f"has_{what}_limits")
    wanted = block.boolean(f"has_{what}_limits", False)
    least, most = _bound(block, f"min_{what}", None, 0.0), _bound(block, f"max_{what}", 0.0, None)
    if told and not wanted:
        return -_ENDLESS, _ENDLESS
    if most is None:
        if wanted or least is not None:
            # a lower bound alone would be none, and nobody would know
            _report_missing(block, what)
        return -_ENDLESS, _ENDLESS
    return -most if least is None else least, most


def _report_missing(block: Params, what: str) -> None:
    given = f"has_{what}_limits is true" if block.has(f"has_{what}_limits") else f"there is min_{what}"
    hint = "without it nothing is limited" if block.has(f"max_{what}") else f"min_{what} is -max_{what} unless given"
    block.error("SK-CONTROL-042", f"{given}, but there is no max_{what} [{_UNITS[what]}]", hint)


_UNITS = {"velocity": "m/s or rad/s", "acceleration": "m/s² or rad/s²", "jerk": "m/s³ or rad/s³"}


def _bound(block: Params, name: str, minimum: float | None, maximum: float | None) -> float | None:
    """A bound; None where it is absent or NaN."""
    found = block.child(name)
    if found is None or found.value.strip().lstrip(".").lower() == "nan":
        return None
    return block.number(name, minimum=minimum, maximum=maximum, finite=False)
