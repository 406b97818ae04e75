"""Simulated time on an integer tick grid: never accumulated, never rounded to milliseconds."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Final

from simkit.argument_checks import checked_integer, checked_number

_MAX_DENOMINATOR = 1_000_000  # largest denominator of a rate that is interpreted as a fraction


Jitter = Callable[[int], float]
"""Deviation of the k-th sample from its time, from -1 to 1."""


def exact_fraction(value: float | int | str | Fraction) -> Fraction:
    """Return the decimal number as written: 0.001 is 1/1000, not the nearest binary fraction."""
    return value if isinstance(value, Fraction) else Fraction(str(value))


@lru_cache(maxsize=256)  # computing it takes 10 µs, and each reset asks for the rates of all tasks
def exact_rate(rate: float) -> Fraction:
    """Return the intended rate [Hz]: the decimal number as written, or 1/3 for a float computed as 1/3."""
    simple = Fraction(rate).limit_denominator(_MAX_DENOMINATOR)
    return simple if float(simple) == rate else exact_fraction(rate)


@dataclass(frozen=True, slots=True)
class SampleTiming:
    """Sample times phase + k·period + spread·jitter(k) for k = 0, 1, 2 and so on.

    Attributes:
        period: period [s], exact; 0 for every step.
        phase: time of the first sample [s], exact.
        spread: largest deviation by jitter [s], exact.
        jitter: function that returns a number within ±1 for every k; None for no jitter.
    """

    period: Fraction
    phase: Fraction = Fraction(0)
    spread: Fraction = Fraction(0)
    jitter: Jitter | None = None


LONGEST_DURATION: Final = 2.0**31 - 1.0
"""Longest duration [s], 68 years: the largest time of a ROS message."""

_MAX_GRIDS: Final = 256  # number of grids that a clock keeps, because a program may change rates all the time

_USUAL_COUNT: Final = 1_000_000  # up to this number of steps, a count needs no further check


class Clock:
    """Conversion of ticks to time.

    Args:
        timestep: length of a step [s].
    """

    def __init__(self, timestep: float) -> None:
        self.timestep = float(timestep)
        self._step = exact_fraction(timestep)
        self._step_ns = self._step * 1_000_000_000
        self._whole_ns = self._step_ns.numerator if self._step_ns.denominator == 1 else 0
        self._grids: dict[tuple[float, bool], TickGrid | None] = {}

    def time_ns(self, tick: int) -> int:
        """Return the time of a tick [ns], rounded half up if a step is not a whole number of nanoseconds."""
        if self._whole_ns:
            return tick * self._whole_ns
        return math.floor(tick * self._step_ns + Fraction(1, 2))

    def times_ns(self, ticks: Sequence[int]) -> list[int]:
        """Return the times of several ticks [ns]; see `time_ns`."""
        whole = self._whole_ns
        return [tick * whole for tick in ticks] if whole else list(map(self.time_ns, ticks))

    def tick_at(self, time_ns: int) -> int:
        """Return the first tick at or after a time [ns]."""
        if self._whole_ns:
            return -(-time_ns // self._whole_ns)
        tick = max(0, math.floor(time_ns / self._step_ns) - 1)
        while self.time_ns(tick) < time_ns:
            tick += 1
        return tick

    def time(self, tick: int) -> float:
        """Return the time of a tick [s]: the float nearest to the exact value."""
        return tick * self._step.numerator / self._step.denominator

    def ticks(self, duration: float) -> int:
        """Return the number of whole steps in a duration [s], rounded to the nearest."""
        return math.floor(exact_fraction(duration) / self._step + Fraction(1, 2))

    def checked_count(self, count: object) -> int:
        """Return a number of steps, or raise an error for what is none."""
        if type(count) is int and 0 <= count <= _USUAL_COUNT:
            return count
        return checked_integer(count, "count", 0, self.ticks(LONGEST_DURATION))

    def checked_ticks(self, duration: object, name: str) -> int:
        """Return the number of whole steps in a duration [s], or raise an error for what is no duration."""
        return self.ticks(checked_number(duration, name, 0.0, LONGEST_DURATION, unit="s"))

    def grid(self, rate: float, from_start: bool = False) -> TickGrid | None:
        """Return the ticks at which a periodic task is due; None for every step.

        Args:
            rate: rate of the task [Hz].
            from_start: the task is also due after the very first step, like Gazebo's sensors.
        """
        if rate <= 0:
            return None
        if (rate, from_start) not in self._grids:
            if len(self._grids) > _MAX_GRIDS:
                self._grids.clear()
            period = 1 / (exact_rate(rate) * self._step)
            self._grids[rate, from_start] = TickGrid(period, from_start) if period > 1 else None
        return self._grids[rate, from_start]

    def samples(self, timing: SampleTiming) -> TickGrid | ShiftedTickGrid | None:
        """Return the ticks at which a sensor samples; None for every step.

        Without a shift, the grid begins with the first step.
        """
        period = timing.period / self._step
        if not timing.phase and (timing.jitter is None or period < 3):
            return TickGrid(period, from_start=True) if period > 1 else None
        phase, spread = timing.phase / self._step, timing.spread / self._step
        return ShiftedTickGrid(max(period, Fraction(1)), phase, spread, timing.jitter)

    def ticks_to_cover(self, duration: float | Fraction) -> int:
        """Return the least number of whole steps that last at least a duration [s]."""
        return math.ceil(exact_fraction(duration) / self._step)


class TickGrid:
    """Ticks ceil(k·period), k = 1, 2, …, exactly; with `from_start` also tick 1.

    Args:
        period: period [ticks], more than 1.
        from_start: add tick 1.
    """

    __slots__ = ("_den", "_from_start", "_num")

    def __init__(self, period: Fraction, from_start: bool = False) -> None:
        self._num, self._den, self._from_start = period.numerator, period.denominator, from_start

    @property
    def cycle(self) -> int:
        """Number of ticks after which the pattern repeats."""
        return self._num

    def tick(self, index: int) -> int:
        """Return the tick of the k-th sample."""
        return -(-index * self._num // self._den)

    def index(self, tick: int) -> int:
        """Return the number of samples that are due up to and including a tick."""
        return tick * self._den // self._num

    def next(self, tick: int) -> int:
        """Return the first due tick after a tick."""
        num, den = self._num, self._den
        if tick <= 0 and self._from_start:
            return 1
        return -(-(tick * den // num + 1) * num // den)


class ShiftedTickGrid:
    """Ticks ceil(phase + k·period) + round(spread·jitter(k)), k = 0, 1, 2, …, but not before tick 1.

    The ticks follow from k alone, so that any range of them can be computed without the previous ones. The jitter is
    rounded outside `ceil`, so that samples are early as often as they are late.

    Args:
        period: period [ticks], at least 1.
        phase: tick of the first sample.
        spread: largest jitter [ticks]; limited to less than half a period, so that samples keep their order.
        jitter: function that returns a number within ±1 for every k.
    """

    __slots__ = ("_den", "_jitter", "_most", "_num", "_phase", "_spread")

    def __init__(self, period: Fraction, phase: Fraction, spread: Fraction, jitter: Jitter | None) -> None:
        self._den = math.lcm(period.denominator, phase.denominator)
        self._num, self._phase = int(period * self._den), int(phase * self._den)
        # two neighbours are at least floor(period) apart
        self._most = min(math.floor(spread + Fraction(1, 2)), (math.floor(period) - 1) // 2) if jitter else 0
        self._spread, self._jitter = float(spread), jitter

    def tick(self, index: int) -> int:
        """Return the tick of the k-th sample, counted from 0."""
        at = -(-(self._phase + index * self._num) // self._den)
        if self._most and self._jitter is not None:
            shift = math.floor(self._spread * self._jitter(index) + 0.5)
            at += max(-self._most, min(self._most, shift))
        return max(1, at)

    def next(self, tick: int) -> int:
        """Return the first due tick after a tick."""
        index = max(0, ((tick - self._most) * self._den - self._phase) // self._num)
        while (following := self.tick(index)) <= tick:
            index += 1
        return following
