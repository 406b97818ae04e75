"""Residuals of a fit: weighted differences between recorded and simulated readings, and their samples in time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit_identification.fitting.problem import RepeatedRecording
from simkit_identification.fitting.readings import Channel, is_compared

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.intp]
_FIRST: Final = 0.01  # first guess of the noise of a column, as a share of its variation
_LEAST: Final = 1e-5  # smallest noise of a column, as a share of its variation: readings without noise weigh alike
_NOISE_OF_SECOND_DIFFERENCES: Final = 6.0**0.5  # of white noise: its second differences have 6 times the variance
_MAD: Final = 1.4826  # standard deviation of a normal distribution over its median absolute deviation


@dataclass(frozen=True)
class ColumnName:
    """Column of a channel, the same in all recordings."""

    channel: Channel
    column: str


class Residuals:
    """Recorded readings in the order of the evaluator's, with a weight for each.

    Args:
        recordings: recordings.
        skip: seconds at the beginning of each recording that are not compared.
        compare: patterns of topics, each perhaps with a field: `/imu.angular_velocity`; empty for all.

    Attributes:
        recorded: recorded readings, shape (size,).
        columns: names of the columns.
        column: index of the column of each reading.
        sample: index of the sample of each reading; readings of one time of one recording have the same.
        times: time of each reading [s].
        recording: index of the recording of each reading.
        weights: inverse of the standard deviation of each reading; 0 for those that are not compared or have no number.
        deviations: standard deviation of each column.
    """

    def __init__(self, recordings: Sequence[RepeatedRecording], skip: float = 0.0, compare: Sequence[str] = ()) -> None:
        names: dict[ColumnName, int] = {}
        recorded, column, times, recording_of = [], [], [], []
        for number, recording in enumerate(recordings):
            for readings in recording.readings:
                rows = len(readings.times)
                here = [
                    names.setdefault(ColumnName(readings.channel, name), len(names))
                    for name in readings.channel.columns
                ]
                recorded.append(readings.values.ravel())
                column.append(np.tile(here, rows))
                times.append(np.repeat(readings.times, len(here)))
                recording_of.append(np.full(rows * len(here), number))
        self.columns = list(names)
        self.recorded: Floats = np.concatenate(recorded) if recorded else np.empty(0)
        self.column: Integers = np.concatenate(column).astype(np.intp) if column else np.empty(0, dtype=np.intp)
        self.times: Floats = np.concatenate(times) if times else np.empty(0)
        self.recording: Integers = (
            np.concatenate(recording_of).astype(np.intp) if recording_of else np.empty(0, dtype=np.intp)
        )
        keys = np.stack((self.recording.astype(np.float64), np.round(self.times, 9)), axis=1)
        _, sample = np.unique(keys, axis=0, return_inverse=True)
        self.sample: Integers = sample.ravel().astype(np.intp)
        self._skipped = (self.times < skip - 1e-9) | ~np.isfinite(self.recorded)
        self._is_used = np.array([is_compared(name.channel.topic, name.column, compare) for name in self.columns], bool)
        self._means = np.array([self._mean(i) for i in range(len(self.columns))])
        self._ranges = np.array([self._variation(i) for i in range(len(self.columns))])
        self.deviations: Floats = np.array([self._first_deviation(i) for i in range(len(self.columns))])
        self.weights: Floats = np.empty(0)
        self._set_weights()

    @property
    def count(self) -> int:
        """Number of compared readings."""
        return int(np.count_nonzero(self.weights))

    def vector(self, simulated: Floats) -> Floats:
        """Return the weighted residuals; 0 where either has no number."""
        difference = (simulated - self.recorded) * self.weights
        return np.where(np.isfinite(difference), difference, 0.0)

    def jacobian(self, derivatives: Floats) -> Floats:
        """Return the derivatives of the weighted residuals, shape (size, parameters)."""
        weighted = derivatives * self.weights[:, None]
        return np.where(np.isfinite(weighted) & np.isfinite(self.recorded)[:, None], weighted, 0.0)

    def use_columns_with_effect(self, derivatives: Floats) -> None:
        """Compare only the columns that some parameter changes.

        Args:
            derivatives: derivatives of the readings, shape (size, parameters).
        """
        size = np.nan_to_num(np.abs(derivatives)).max(axis=1, initial=0.0)
        largest = np.zeros(len(self.columns))
        np.maximum.at(largest, self.column, size)
        self._is_used &= largest > 1e-9 * np.maximum(self._ranges, 1e-9)
        self._set_weights()

    def is_used(self, channel: Channel) -> bool:
        """Check whether a column of a channel is compared."""
        return any(used and name.channel == channel for name, used in zip(self.columns, self._is_used, strict=True))

    def reweight(self, simulated: Floats) -> None:
        """Take the standard deviation of each column from its residuals."""
        raw = simulated - self.recorded
        for i in range(len(self.columns)):
            here = raw[(self.column == i) & ~self._skipped]
            here = here[np.isfinite(here)]
            if len(here):
                deviation = float(np.sqrt(np.mean(here * here)))
                self.deviations[i] = max(deviation, _LEAST * self._ranges[i], 1e-12)
        self._set_weights()

    def column_errors(self, simulated: Floats) -> Floats:
        """Return the root mean square residual of each column; NaN without readings."""
        raw = simulated - self.recorded
        errors = np.full(len(self.columns), np.nan)
        for i in range(len(self.columns)):
            here = raw[(self.column == i) & ~self._skipped]
            here = here[np.isfinite(here)]
            if len(here):
                errors[i] = np.sqrt(np.mean(here * here))
        return errors

    def relative_error(self, simulated: Floats, topic: str = "") -> float:
        """Return the weighted residuals as a share of the weighted variation of the recorded readings.

        Args:
            simulated: simulated readings.
            topic: topic whose columns are meant; empty for all.
        """
        residuals = self.vector(simulated) ** 2
        variation = np.nan_to_num((self.recorded - self._means[self.column]) * self.weights) ** 2
        if topic:
            of_topic = np.array([name.channel.topic == topic for name in self.columns])[self.column]
            residuals, variation = residuals[of_topic], variation[of_topic]
        total = float(np.sum(variation))
        return float(np.sqrt(np.sum(residuals) / total)) if total > 0 else float("nan")

    def _set_weights(self) -> None:
        weights = np.where(self._is_used, 1.0 / self.deviations, 0.0)
        self.weights = np.where(self._skipped, 0.0, weights[self.column]) if len(self.column) else np.empty(0)

    def _mean(self, i: int) -> float:
        values = self.recorded[self.column == i]
        values = values[np.isfinite(values)]
        return float(np.mean(values)) if len(values) else 0.0

    def _variation(self, i: int) -> float:
        values = self.recorded[self.column == i]
        values = values[np.isfinite(values)]
        return float(np.std(values)) if len(values) else 0.0

    def _first_deviation(self, i: int) -> float:
        """Return the noise of a column from its second differences, at least a share of its variation."""
        values = self.recorded[self.column == i]
        values = values[np.isfinite(values)]
        noise = 0.0
        if len(values) > 8:
            second = np.diff(values, 2)
            noise = _MAD * float(np.median(np.abs(second))) / _NOISE_OF_SECOND_DIFFERENCES
        return float(max(noise, _FIRST * float(self._ranges[i]), 1e-9))
