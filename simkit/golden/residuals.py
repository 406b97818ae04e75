"""The noise of a sensor: what it reads less what is true, in numbers that do not depend on the samples."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.golden.columns import Rows
from simkit.golden.record import Array, Stream

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.scenario import Scenario


def residuals_of(scenario: Scenario, sim: Simulation, topic: str, type_name: str) -> Residuals | None:
    """What keeps the statistics of a topic's noise; None where nobody asks for them, or no sensor publishes it."""
    from simkit.golden.columns import fields_of

    fields = fields_of(type_name)
    paths = [
        path
        for path in (*fields.numbers, *fields.arrays)
        if any(t.statistics for t in scenario.tolerance(topic, path)[:1])
    ]
    sensor = next((s for s in sim.structure.all_sensors() if s.topic == topic), None)
    if not paths or sensor is None:
        return None
    return Residuals(sensor, type_name, frozenset(paths))


class Residuals:
    """Collects readings and truths of some fields.

    Args:
        sensor: that publishes.
        type_name: of its messages.
        paths: of the fields.
    """

    def __init__(self, sensor: Any, type_name: str, paths: frozenset[str]) -> None:
        self._sensor, self._paths = sensor, paths
        self._read, self._true = Rows(type_name), Rows(type_name)

    def take(self, message: Any) -> None:
        """A reading that is published now."""
        self._read.take(message)
        self._true.take(self._sensor.truth)

    def fill(self, stream: Stream) -> None:
        """Puts statistics in the place of the samples."""
        from simkit.golden.statistics import summarise

        read, true = self._read.columns()[0], self._true.columns()[0]
        times = stream.times_ns * 1e-9
        period = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
        for path in sorted(self._paths):
            column, truth = read[path], true[path]
            if column.lengths is not None or column.values.shape != truth.values.shape or not len(column.values):
                continue
            with np.errstate(invalid="ignore"):  # rays that hit nothing, in both
                residual = _table(column.values) - _table(truth.values)
            if not np.nan_to_num(residual).any():
                continue  # there is no noise: samples are compared
            stream.statistics[path] = summarise(residual, period)
            del stream.columns[path]


def _table(values: Array) -> Array:
    """A row for each message."""
    return values.reshape(len(values), -1).astype(np.float64)
