"""Messages of plugins and samples of sensors in all environments of a batch, which are taken at their own rates."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from simkit.extend import Sensor
from simkit.msgs import Message
from simkit.runtime.array_rules import Grid, Ids, SensorRule, Ticks, TopicRule
from simkit.runtime.engine.scheduler import Timetable
from simkit_learning.environments.array_view import ArrayView
from simkit_learning.environments.message_arrays import Array, conversion_of

Floats = npt.NDArray[np.float64]


class SampledRows:
    """Newest numbers of a message that a plugin publishes at its own rate, in all environments.

    Args:
        rule: array rule of the message.
        observed: function that returns the numbers that the environment that resets all others observes now.
        count: number of environments.

    Attributes:
        values: numbers of the newest message, shape (count, numbers).
    """

    def __init__(self, rule: TopicRule, observed: Callable[[], npt.ArrayLike], count: int) -> None:
        self._rule, self._observed = rule, observed
        self.values: Floats = np.zeros((count, *np.shape(observed())))

    @property
    def grid(self) -> Grid:
        """Ticks of the messages; None for every step."""
        return self._rule.grid

    def take(self, row: int) -> None:
        """Copy the state of the environment that resets all others to one row."""
        self.values[row] = self._observed()
        self._rule.take(row)

    def next_stop(self, tick: int) -> int:
        """Return the first tick after a tick at which `note` must be called."""
        return self._rule.next_stop(tick)

    def sample(self, ids: Ids, ticks: Ticks) -> None:
        """Store the messages of some environments, at the present tick of each."""
        self.values[ids] = self._rule.read(ids, ticks)

    def note(self, ids: Ids, ticks: Ticks) -> None:
        """Store what later messages of some environments need, at the present tick of each."""
        self._rule.note(ids, ticks)


def _convert(message: Message) -> Array:
    """Return the numbers of a message, as observations have them."""
    return conversion_of(message)[0](message)


class SampledSensor:
    """Samples of one sensor in all environments.

    Args:
        sensor: sensor of the environment that resets all others.
        rule: its array rule.
        view: state of all environments.
        is_truth: leave out the noise.
    """

    def __init__(self, sensor: Sensor, rule: SensorRule, view: ArrayView, is_truth: bool) -> None:
        rule.bind(view, is_truth=is_truth)
        rule.convert = _convert
        self._sensor, self._rule = sensor, rule
        self._index: Ticks = np.zeros(view.count, np.int64)  # number of the newest sample
        self._grid: Timetable | None = None if sensor.is_manual else sensor.timetable()

    @property
    def needs_acceleration(self) -> bool:
        """True if the sample depends on accelerations."""
        return "qacc" in self._rule.inputs

    def take(self, row: int) -> None:
        """Copy the state of the sensor to one environment."""
        self._index[row] = self._sensor.count
        self._rule.take(row)

    def count(self, ids: Ids, first: int, last: int) -> None:
        """Count the samples at the rate of the sensor from one tick to another, and the sample of an observation."""
        if self._sensor.is_manual:
            self._index[ids] += 1
        elif self._grid is None:
            self._index[ids] += last - first
        else:
            due, tick = 0, self._grid.next(first)
            while tick <= last:
                due, is_last, tick = due + 1, tick == last, self._grid.next(tick)
            self._index[ids] += due if due and is_last else due + 1

    def read(self, ids: Ids) -> npt.NDArray[np.float32] | npt.NDArray[np.float64]:
        """Return the readings in all environments; only rows of `ids` have noise."""
        return self._rule.read(ids, self._index)
