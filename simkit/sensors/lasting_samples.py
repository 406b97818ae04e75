"""Samples whose measurement lasts several steps, such as the scan of a lidar that turns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from simkit.runtime.engine.scheduler import Timetable
from simkit.sensors.sample import Memory, Sample
from simkit.sensors.sample_times import DelayedReadings, LatencyTimetable


@dataclass(frozen=True, slots=True)
class LastingSample:
    """Sample whose measurement has begun and has not ended.

    Attributes:
        start: tick of the sample's time stamp.
        end: tick at which the measurement ends.
        index: number of the sample.
        time_ns: time stamp [ns].
        noise_states: states at this sample of the noise processes that change from sample to sample.
        progress: values of the sensor's kind, which are never modified.
    """

    start: int
    end: int
    index: int
    time_ns: int
    noise_states: tuple[object, ...]
    progress: Memory

    def ended(self) -> Sample:
        """Return the sample, to be measured now."""
        sample = Sample(self.index, self.time_ns)
        if self.noise_states:
            sample.noise_states = self.noise_states
        return sample


class LastingSamples:
    """Samples that are being measured, in the order of their beginning.

    Attributes:
        samples: the samples; they are replaced, never modified, so that snapshots share them.
    """

    def __init__(self) -> None:
        self.samples: tuple[LastingSample, ...] = ()

    def begin(self, sample: Sample, start: int, end: int, progress: Memory) -> None:
        """Add a sample whose measurement begins."""
        begun = LastingSample(start, end, sample.index, sample.time_ns, sample.noise_states, progress)
        self.samples = (*self.samples, begun)

    def take_ended(self, tick: int) -> list[LastingSample]:
        """Remove and return the samples whose measurement has ended by a tick."""
        if not self.samples or self.samples[0].end > tick:
            return []
        ended = [sample for sample in self.samples if sample.end <= tick]
        self.samples = tuple(sample for sample in self.samples if sample.end > tick)
        return ended

    def advance(self, progress_of: Callable[[LastingSample], Memory]) -> None:
        """Replace the progress of each sample."""
        self.samples = tuple(replace(sample, progress=progress_of(sample)) for sample in self.samples)


class LastingTimetable(LatencyTimetable):
    """Ticks at which a sensor begins a measurement, ends one, or delivers a sample.

    Args:
        grid: ticks at which measurements begin.
        delayed: readings that have not arrived yet.
        next_index: function that returns the index of the next sample.
        lasting: samples that are being measured.
        ticks: function that returns the number of ticks that the measurement of a sample lasts, by its index.
    """

    def __init__(
        self,
        grid: Timetable,
        delayed: DelayedReadings,
        next_index: Callable[[], int],
        lasting: LastingSamples,
        ticks: Callable[[int], int],
    ) -> None:
        super().__init__(grid, delayed, next_index)
        self._lasting, self._ticks = lasting, ticks

    def next(self, tick: int) -> int:
        """Return the first due tick after a tick."""
        due: list[int] = [self._grid.next(tick)]
        due += [arrival for arrival, _ in self._delayed.samples]
        ends: Sequence[tuple[int, int]] = [(sample.end, sample.index) for sample in self._lasting.samples]
        if tick > 0 and self.is_sample(tick):  # the sample of this tick may not have begun yet
            index = self._next_index()
            ends = [*ends, (tick + self._ticks(index), index)]
        for end, index in ends:
            due.append(end)
            if end == tick:  # this measurement ends at `tick`, so that its sample is not in the queue yet
                due.append(self._delayed.arrival(tick, index))
        return min(later for later in due if later > tick)
