"""Simulated time on an integer tick grid: never accumulated, never rounded to milliseconds."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

_MAX_DENOMINATOR = 1_000_000  # greatest denominator of a rate that is taken for a fraction


Jitter = Callable[[int], float]
"""Deviation of the k-th sample from its time, from -1 to 1."""


def exact_fraction(value: float | int | str | Fraction) -> Fraction:
    """The decimal number as written: 0.001 is 1/1000, not the nearest binary fraction."""
    return value if isinstance(value, Fraction) else Fraction(str(value))


def exact_rate(rate: float) -> Fraction:
    """A rate [Hz] as it was meant: the decimal number as written, or a third where that was computed as 1/3."""
    simple = Fraction(rate).limit_denominator(_MAX_DENOMINATOR)
    return simple if float(simple) == rate else exact_fraction(rate)


@dataclass(frozen=True, slots=True)
class SampleTiming:
    """When something is sampled: at phase + k·period + spread·jitter(k), k = 0, 1, 2, …

    Attributes:
        period, phase, spread: [s], exactly; a period of 0 is every step.
        jitter: gives a number within ±1 for every k; None for no jitter.
    """

    period: Fraction
    phase: Fraction = Fraction(0)
    spread: Fraction = Fraction(0)
    jitter: Jitter | None = None


class Clock:
    """Converts ticks to time.

    Args:
        timestep: length of a step [s].
    """

    def __init__(self, timestep: float) -> None:
        self.timestep = float(timestep)
        self._step = exact_fraction(timestep)
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
        return math.floor(exact_fraction(duration) / self._step + Fraction(1, 2))

    def grid(self, rate: float, from_start: bool = False) -> TickGrid | None:
        """The ticks at which something periodic is due; None for every step.

        Args:
            rate: [Hz].
            from_start: due after the very first step as well, as Gazebo's sensors are.
        """
        if rate <= 0:
            return None
        period = 1 / (exact_rate(rate) * self._step)
        return TickGrid(period, from_start) if period > 1 else None

    def samples(self, timing: SampleTiming) -> TickGrid | ShiftedTickGrid | None:
        """The ticks at which a sensor samples, a grid from the start if not shifted; None for every step."""
        period = timing.period / self._step
        if not timing.phase and (timing.jitter is None or period < 3):
            return TickGrid(period, from_start=True) if period > 1 else None
        phase, spread = timing.phase / self._step, timing.spread / self._step
        return ShiftedTickGrid(max(period, Fraction(1)), phase, spread, timing.jitter)

    def ticks_to_cover(self, duration: float | Fraction) -> int:
        """The fewest whole steps that are no shorter than a duration [s]."""
        return math.ceil(exact_fraction(duration) / self._step)


class TickGrid:
    """Ticks ceil(k·period), k = 1, 2, …, exactly; and tick 1 where it is wanted from the start.

    Args:
        period: in ticks, more than 1.
    """

    __slots__ = ("_den", "_from_start", "_num")

    def __init__(self, period: Fraction, from_start: bool = False) -> None:
        self._num, self._den, self._from_start = period.numerator, period.denominator, from_start

    @property
    def cycle(self) -> int:
        """After so many ticks the pattern repeats."""
        return self._num

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


class ShiftedTickGrid:
    """Ticks ceil(phase + k·period) + jitter(k), k = 0, 1, 2, …, but not before tick 1.

    Which ticks those are follows from k alone, so any stretch of them can be had without what was before. The jitter is
    whole ticks, so that it is as often early as late.

    Args:
        period: in ticks, at least 1.
        phase: in ticks.
        spread: of the jitter in ticks; kept so far below half a period that no two samples change places or meet.
        jitter: gives a number within ±1 for every k.
    """

    __slots__ = ("_den", "_jitter", "_most", "_num", "_phase", "_spread")

    def __init__(self, period: Fraction, phase: Fraction, spread: Fraction, jitter: Jitter | None) -> None:
        self._den = math.lcm(period.denominator, phase.denominator)
        self._num, self._phase = int(period * self._den), int(phase * self._den)
        # two neighbours are at least floor(period) apart
        self._most = min(math.floor(spread + Fraction(1, 2)), (math.floor(period) - 1) // 2) if jitter else 0
        self._spread, self._jitter = float(spread), jitter

    def tick(self, index: int) -> int:
        """Tick of the k-th sample, k = 0, 1, 2, …"""
        at = -(-(self._phase + index * self._num) // self._den)
        if self._most and self._jitter is not None:
            shift = math.floor(self._spread * self._jitter(index) + 0.5)
            at += max(-self._most, min(self._most, shift))
        return max(1, at)

    def next(self, tick: int) -> int:
        """First due tick after a tick."""
        index = max(0, ((tick - self._most) * self._den - self._phase) // self._num)
        while (found := self.tick(index)) <= tick:
            index += 1
        return found
