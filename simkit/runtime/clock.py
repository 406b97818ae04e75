"""Simulated time on an integer tick grid: never accumulated, never rounded to milliseconds."""

from __future__ import annotations

import math
from fractions import Fraction


def exact(value: float | int | str | Fraction) -> Fraction:
    """The decimal number as written: 0.001 is 1/1000, not the nearest binary fraction."""
    return value if isinstance(value, Fraction) else Fraction(str(value))


class Clock:
    """Converts ticks to time.

    Args:
        timestep: length of a step [s].
    """

    def __init__(self, timestep: float) -> None:
        self.timestep = float(timestep)
        self._step = exact(timestep)
        self._step_ns = self._step * 1_000_000_000
        self._whole_ns = self._step_ns.numerator if self._step_ns.denominator == 1 else 0

    def time_ns(self, tick: int) -> int:
        """Time of a tick [ns], rounded half up where a step is no whole number of nanoseconds."""
        if self._whole_ns:
            return tick * self._whole_ns
        return math.floor(tick * self._step_ns + Fraction(1, 2))

    def time(self, tick: int) -> float:
        """Time of a tick [s]: the float nearest to the exact value."""
        return tick * self._step.numerator / self._step.denominator

    def ticks(self, duration: float) -> int:
        """Whole steps in a duration [s], rounded to the nearest."""
        return math.floor(exact(duration) / self._step + Fraction(1, 2))

    def grid(self, rate: float, from_start: bool = False) -> Grid | None:
        """The ticks at which something periodic is due; None for every step.

        Args:
            rate: [Hz].
            from_start: due after the very first step as well, as Gazebo's sensors are.
        """
        if rate <= 0:
            return None
        period = 1 / (exact(rate) * self._step)
        return Grid(period, from_start) if period > 1 else None


class Grid:
    """Ticks ceil(k·period), k = 1, 2, …, exactly; and tick 1 where it is wanted from the start.

    Args:
        period: in ticks, more than 1.
    """

    __slots__ = ("_den", "_from_start", "_num")

    def __init__(self, period: Fraction, from_start: bool = False) -> None:
        self._num, self._den, self._from_start = period.numerator, period.denominator, from_start

    def tick(self, index: int) -> int:
        """Tick of the k-th sample."""
        return -(-index * self._num // self._den)

    def index(self, tick: int) -> int:
        """How many samples are due up to and including a tick."""
        return tick * self._den // self._num

    def next(self, tick: int) -> int:
        """First due tick after a tick."""
        num, den = self._num, self._den
        if tick <= 0 and self._from_start:
            return 1
        return -(-(tick * den // num + 1) * num // den)
