"""Times at which a sensor samples and at which its readings arrive: rate, phase, jitter, latency."""

from __future__ import annotations

import bisect
import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from simkit.params import Params
from simkit.runtime.engine.random_streams import RandomStreams
from simkit.runtime.engine.scheduler import Timetable
from simkit.runtime.engine.simulated_time import Clock, SampleTiming, exact_fraction, exact_rate
from simkit.sensors.sample import Sample

MAX_LATENCY = 3600.0  # [s]; all readings that have not arrived yet are kept
_MILLISECOND = Fraction(1, 1000)
_ROUNDING: Final = 1e-9  # [steps]
_LOWEST_RATE: Final = 2.0**-31
"""Rate [Hz] whose period is the longest duration of a run; a lower one has the same samples."""


@dataclass(frozen=True, slots=True)
class TimingOptions:
    """Timing options common to all sensors; all times in s.

    Attributes:
        phase: shift of the grid of samples.
        jitter: greatest deviation of a sample from the grid, early or late.
        latency: time from a sample to its arrival.
        latency_jitter: greatest deviation from the latency.
        set_rate_topic: topic of type `std_msgs/msg/Float64` that changes the rate [Hz]; empty for none.
    """

    phase: float = 0.0
    jitter: float = 0.0
    latency: float = 0.0
    latency_jitter: float = 0.0
    set_rate_topic: str = ""


def read_timing(params: Params, rate: float) -> TimingOptions:
    """Read the timing elements of a `<sensor>` at `rate` [Hz]."""
    jitter = params.number("jitter", 0.0, minimum=0)
    latency = params.number("latency", 0.0, minimum=0, maximum=MAX_LATENCY)
    latency_jitter = params.number("latency_jitter", 0.0, minimum=0)
    if jitter > 0 and rate <= 0:
        message = "<jitter> has no effect on a sensor that samples at every step"
        params.diagnostics.warning("SK-SENSOR-023", message, params.block("jitter").where, "add an <update_rate>")
        jitter = 0.0
    elif jitter > 0 and 2 * exact_fraction(jitter) * exact_rate(rate) >= 1:
        limit = f"less than half a period, {0.5 / rate:g} s at {rate:g} Hz"
        params.block("jitter").error("SK-SENSOR-022", f"<jitter>{jitter:g}</jitter> is too large; the limit is {limit}")
        jitter = 0.0
    if latency_jitter > latency:
        element = f"<latency_jitter>{latency_jitter:g}</latency_jitter>"
        message = f"{element} is too large; the limit is the <latency>, {latency:g} s"
        params.block("latency_jitter").error("SK-SENSOR-022", message)
        latency_jitter = latency
    phase = params.number("phase", 0.0, minimum=0)
    return TimingOptions(phase, jitter, latency, latency_jitter, params.text("set_rate_topic", ""))


class SampleTimes:
    """Sample times of a sensor at any rate.

    Args:
        options: timing options of the file.
        clock: the simulation's clock.
        streams: random streams for the jitter, which is drawn by the number of the grid instant.
        scoped: scoped name of the sensor, which names the stream.
        in_milliseconds: True truncates the period to whole milliseconds, as Gazebo does.
    """

    def __init__(
        self, options: TimingOptions, clock: Clock, streams: RandomStreams, scoped: str, in_milliseconds: bool
    ) -> None:
        self._clock, self._in_milliseconds = clock, in_milliseconds
        self._phase, self._spread = exact_fraction(options.phase), exact_fraction(options.jitter)
        self._last: tuple[float, Timetable | None] | None = None
        self._jitter = None
        if options.jitter > 0:
            stream = streams.stream(scoped, "jitter")
            self._jitter = lambda k: float(stream.uniform(k)[0])

    def period(self, rate: float) -> Fraction:
        """Return the period [s] of a rate [Hz] on the grid; 0 is every step."""
        period = 1 / exact_rate(max(rate, _LOWEST_RATE)) if rate > 0 else Fraction(0)
        return period // _MILLISECOND * _MILLISECOND if self._in_milliseconds else period

    def is_too_fast(self, rate: float) -> bool:
        """Check whether a rate [Hz] needs more samples than there are steps."""
        return rate > 0 and exact_rate(rate) * exact_fraction(self._clock.timestep) > 1

    def nominal_interval(self, rate: float) -> float:
        """Return the mean time [s] between two samples."""
        return max(float(self.period(rate)), self._clock.timestep)

    def grid(self, rate: float) -> Timetable | None:
        """Return the ticks of a rate [Hz]; None for every step."""
        if self._last is None or self._last[0] != rate:  # a reset asks for the same rate, and fractions are slow
            timing = SampleTiming(self.period(rate), self._phase, self._spread, self._jitter)
            self._last = rate, self._clock.samples(timing)
        return self._last[1]


class DelayedReadings:
    """Queue of readings that were measured and are not delivered yet, in order of arrival.

    Args:
        options: timing options of the file.
        clock: the simulation's clock.
        streams: random streams for the jitter, which is drawn by the index of the sample.
        scoped: scoped name of the sensor, which names the stream.
        delays: functions that return a further delay [s] of a sample from its index; all delays are added.
        keeps_order: False lets a sample arrive before an older one.
    """

    def __init__(
        self,
        options: TimingOptions,
        clock: Clock,
        streams: RandomStreams,
        scoped: str,
        delays: Sequence[Callable[[int], float]] = (),
        keeps_order: bool = True,
    ) -> None:
        self._delays, self._keeps_order = tuple(delays), keeps_order
        self._clock, self._latency = clock, exact_fraction(options.latency)
        self._spread = options.latency_jitter
        self._stream = streams.stream(scoped, "latency") if options.latency_jitter > 0 else None
        self._steps = clock.ticks_to_cover(self._latency)
        self.samples: deque[tuple[int, Sample]] = deque()

    def arrival(self, tick: int, index: int) -> int:
        """Return the tick at which sample `index`, measured at `tick`, arrives; in order, not before an older one."""
        steps = self._steps
        if self._stream is not None or self._delays:
            late = float(self._latency)
            if self._stream is not None:
                late += self._spread * float(self._stream.uniform(index)[0])
            for delay in self._delays:
                late += delay(index)
            # the quotient of a delay of whole steps may be above the number of steps by a rounding error
            slack = _ROUNDING if self._delays else 0.0
            steps = max(0, math.ceil(late / self._clock.timestep - slack))
        is_bounded = self._keeps_order and self.samples
        return max(tick + steps, self.samples[-1][0]) if is_bounded else tick + steps

    def add(self, tick: int, sample: Sample) -> int:
        """Add a sample measured at `tick`; return the tick at which it arrives."""
        arrival = self.arrival(tick, sample.index)
        if self._keeps_order:
            self.samples.append((arrival, sample))
        else:
            self.samples.insert(bisect.bisect_right(self.samples, arrival, key=lambda row: row[0]), (arrival, sample))
        return arrival

    def arrived(self, tick: int) -> list[Sample]:
        """Remove and return the samples that have arrived by `tick`."""
        readings = []
        while self.samples and self.samples[0][0] <= tick:
            readings.append(self.samples.popleft()[1])
        return readings


class LatencyTimetable:
    """Ticks at which a sensor with latency measures a sample or delivers one.

    Args:
        grid: ticks of the samples; None for every step.
        delayed: readings that have not arrived yet.
        next_index: function that returns the index of the next sample to measure.
    """

    def __init__(self, grid: Timetable, delayed: DelayedReadings, next_index: Callable[[], int]) -> None:
        self._grid, self._delayed, self._next_index = grid, delayed, next_index

    def is_sample(self, tick: int) -> bool:
        """Check whether a sample is due at a tick."""
        return self._grid.next(tick - 1) == tick

    def next(self, tick: int) -> int:
        """Return the first due tick after a tick."""
        due_tick = self._grid.next(tick)
        for arrival, _ in self._delayed.samples:
            if arrival > tick:
                due_tick = min(due_tick, arrival)
                break
        if tick > 0 and self.is_sample(tick):
            # this sample will be measured at `tick`, so it is not in the queue yet
            arrival = self._delayed.arrival(tick, self._next_index())
            if arrival > tick:
                due_tick = min(due_tick, arrival)
        return due_tick
