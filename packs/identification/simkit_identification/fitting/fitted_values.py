"""Fitted values, compared topics and curves of a fit."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class FittedParameter:
    """Parameter with its result.

    Attributes:
        path: path of `--set`.
        start: first value.
        value: fitted value.
        low, high: ends of its 95 % interval.
        unit: SI unit; empty if unknown.
        effective: effective number of readings that the interval is based on.
        is_followed: True if the interval follows the cost, because the quadratic form is poor.
    """

    path: str
    start: float
    value: float
    low: float
    high: float
    unit: str = ""
    effective: float = 0.0
    is_followed: bool = False


@dataclass(frozen=True)
class ComparedTopic:
    """Topic of a recording that was compared, or the reason why it was not.

    Attributes:
        topic: topic.
        readings: number of compared readings.
        before, after: root mean square residual over the variation of the readings, with the first and the fitted
            values, as a mean over the columns.
        note: reason why the topic tells nothing; empty if it was compared.
    """

    topic: str
    readings: int = 0
    before: float = float("nan")
    after: float = float("nan")
    note: str = ""


@dataclass(frozen=True)
class FitCurve:
    """Readings of one column for a plot.

    Attributes:
        label: topic and column.
        recording: name of the recording.
        times: times [s].
        recorded, before, after: recorded numbers, and those of runs with the first and the fitted values.
        deviation: standard deviation of the residuals.
    """

    label: str
    recording: str
    times: Floats
    recorded: Floats
    before: Floats
    after: Floats
    deviation: float


def interval_text(parameter: FittedParameter) -> str:
    """Return the ends of an interval with as many digits as tell them apart."""
    size, width = abs(parameter.value), parameter.high - parameter.low
    digits = 6 if not width > 0 or size == 0 else int(min(max(math.ceil(math.log10(size / width)) + 3, 4), 12))
    return f"{parameter.low:.{digits}g} to {parameter.high:.{digits}g}"
