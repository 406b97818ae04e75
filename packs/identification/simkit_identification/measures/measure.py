"""Measured quantities of a topic, and the test that tells whether two of them differ by more than chance."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

import numpy as np

from simkit.elementary_functions import log
from simkit.testing.run_record.noise_statistics import noise_statistics
from simkit_identification.measures.recording import ArrayOverTime, Floats

Kind = Literal[
    "mean", "rate", "deviation", "paired", "spread", "arrays", "power", "largest", "distribution", "estimate", "value"
]
_TINY: Final = 1e-12  # relative differences of sums that are rounding errors
_LEAST: Final = 3  # samples for a test
_MOST_PAIRS: Final = 100_000


@dataclass(frozen=True)
class Measure:
    """Samples of one quantity in one recording.

    Attributes:
        quantity: name of the quantity.
        unit: unit of the value.
        kind: test with which two measures of this quantity are compared:
            mean: mean of the samples;
            rate: inverse of their mean;
            deviation: square root of their mean, for squares of a noise;
            paired: mean of the differences at equal times;
            spread: standard deviation of the samples at equal times, as of a speed with a scale error;
            arrays: median of the differences of two arrays at equal times;
            power: square root of the geometric mean; the samples are the powers of segments that begin at equal times;
            largest: largest sample;
            distribution: median, and the distribution of the samples;
            estimate: the first sample is the value, the second its standard error, on a logarithmic scale;
            value: the first sample, without knowledge of its chance.
        values: samples, shape (n,).
        times: times of the samples [s], shape (n,); needed by paired and spread.
        is_angle: True for samples that wrap around after a full turn.
        array: samples of arrays.
        is_ratio: True for the ratio of two arrays minus 1 instead of their difference.
    """

    quantity: str
    unit: str
    kind: Kind
    values: Floats
    times: Floats | None = None
    is_angle: bool = False
    array: ArrayOverTime | None = None
    is_ratio: bool = False


class Estimate(NamedTuple):
    """Value with its uncertainty.

    Attributes:
        value: value.
        low, high: ends of the confidence interval; NaN if unknown.
    """

    value: float
    low: float = math.nan
    high: float = math.nan


class Outcome(NamedTuple):
    """Comparison of two measures.

    Attributes:
        a, b: value in each recording.
        difference: b - a, or for distributions the largest difference of their shares.
        low, high: ends of the confidence interval of the difference; NaN if unknown.
        chance: probability of such a difference if nothing differs; NaN if unknown.
    """

    a: float
    b: float
    difference: float
    low: float = math.nan
    high: float = math.nan
    chance: float = math.nan


class _Mean(NamedTuple):
    """Mean of samples, its standard error and its degrees of freedom."""

    value: float
    error: float
    freedom: float


def _mean(values: Floats) -> _Mean:
    """Return the mean of samples in the order of time, with an error that takes their correlation into account."""
    values = values[np.isfinite(values)]
    if not len(values):
        return _Mean(math.nan, math.nan, 1.0)
    statistics = noise_statistics(values, 1.0)
    value, deviation = float(statistics.mean[0]), float(statistics.deviation[0])
    if len(values) < 2 or deviation <= _TINY * abs(value):
        return _Mean(value, 0.0 if len(values) > 1 else math.nan, max(1.0, len(values) - 1.0))
    count = max(1.5, min(float(len(values)), float(statistics.independent[0])))
    return _Mean(value, deviation / math.sqrt(max(0.5, count - 1.0)), max(1.0, count - 1.0))


def estimate(measure: Measure, confidence: float) -> Estimate:
    """Return the value of a measure with its confidence interval."""
    if measure.kind == "estimate":
        value, error = float(measure.values[0]), float(measure.values[1])
        factor = math.exp(min(50.0, _quantile(confidence, 1e9) * error / value)) if value > 0.0 else 1.0
        return Estimate(value, value / factor, value * factor)
    if measure.kind in ("largest", "value", "distribution", "arrays", "spread"):
        return Estimate(_plain_value(measure))
    if measure.kind == "power":
        value, count = _geometric_mean(measure.values), len(measure.values)
        if count < _LEAST or not value:
            return Estimate(value)
        ratios = 0.5 * log(measure.values / value**2 + _TINY)
        error = float(ratios.std(ddof=1)) / math.sqrt(count)
        factor = math.exp(min(50.0, _quantile(confidence, max(1.0, 0.75 * count - 1.0)) * error))
        return Estimate(value, value / factor, value * factor)
    mean = _mean(measure.values)
    width = _quantile(confidence, mean.freedom) * mean.error
    if measure.kind == "rate":
        value = 1.0 / mean.value if mean.value > 0.0 else math.nan
        return Estimate(value, value - width * value**2, value + width * value**2)
    if measure.kind == "deviation":
        value = math.sqrt(max(0.0, mean.value))
        if not value:
            return Estimate(0.0, 0.0, 0.0)
        factor = math.exp(min(50.0, width / (2.0 * mean.value)))
        return Estimate(value, value / factor, value * factor)
    return Estimate(mean.value, mean.value - width, mean.value + width)


def _plain_value(measure: Measure) -> float:
    if measure.array is not None:
        finite = measure.array.values[np.isfinite(measure.array.values)]
        return float(np.median(finite)) if finite.size else math.nan
    values = measure.values[np.isfinite(measure.values)]
    if not len(values):
        return math.nan
    if measure.kind == "largest":
        return float(values.max())
    if measure.kind == "spread":
        return float((np.unwrap(values) if measure.is_angle else values).std())
    return float(np.median(values)) if measure.kind == "distribution" else float(values[0])


def compare_measures(a: Measure, b: Measure, confidence: float) -> Outcome:
    """Compare two measures of the same quantity by the test of their kind."""
    return _TESTS[a.kind](a, b, confidence)


# ---------------------------------------------------------------------- tests


def _quantile(confidence: float, freedom: float) -> float:
    """Return the quantile of Student's distribution for a two-sided interval."""
    from scipy.stats import t as student

    return float(student.isf((1.0 - confidence) / 2.0, max(1.0, freedom)))


def _two_sided(statistic: float, freedom: float) -> float:
    from scipy.stats import t as student

    return float(min(1.0, 2.0 * student.sf(abs(statistic), max(1.0, freedom))))


def _of_difference(a: float, b: float, difference: _Mean, confidence: float) -> Outcome:
    """Return the outcome of a difference with a standard error."""
    value, error, freedom = difference
    if math.isnan(error) or math.isnan(value):
        return Outcome(a, b, value)
    if error == 0.0:
        is_equal = abs(value) <= _TINY * max(abs(a), abs(b))
        return Outcome(a, b, 0.0 if is_equal else value, value, value, 1.0 if is_equal else 0.0)
    width = _quantile(confidence, freedom) * error
    return Outcome(a, b, value, value - width, value + width, _two_sided(value / error, freedom))


def _freedom(first: _Mean, second: _Mean) -> float:
    """Return the degrees of freedom of a difference of two means (Welch–Satterthwaite)."""
    one, two = first.error**2, second.error**2
    if one + two <= 0.0:
        return 1e9
    return (one + two) ** 2 / (one**2 / first.freedom + two**2 / second.freedom)


def _compare_means(a: Measure, b: Measure, confidence: float) -> Outcome:
    first, second = _mean(a.values), _mean(b.values)
    error = math.hypot(first.error, second.error)
    difference = _Mean(second.value - first.value, error, _freedom(first, second))
    return _of_difference(first.value, second.value, difference, confidence)


def _compare_rates(a: Measure, b: Measure, confidence: float) -> Outcome:
    first, second = (
        _Mean(1.0 / m.value, m.error / m.value**2, m.freedom) if m.value > 0.0 else _Mean(math.nan, math.nan, 1.0)
        for m in (_mean(a.values), _mean(b.values))
    )
    error = math.hypot(first.error, second.error)
    difference = _Mean(second.value - first.value, error, _freedom(first, second))
    return _of_difference(first.value, second.value, difference, confidence)


def _of_ratio(a: float, b: float, errors: tuple[float, float], freedom: float, confidence: float) -> Outcome:
    """Return the outcome of two positive values whose logarithms have standard errors."""
    if max(a, b) <= 0.0:
        return Outcome(a, b, 0.0, 0.0, 0.0, 1.0)
    if min(a, b) <= _TINY * max(a, b):
        return Outcome(a, b, b - a, chance=0.0)
    error = math.hypot(*errors)
    if math.isnan(error):
        return Outcome(a, b, b - a)
    ratio = math.log(b / a)
    if error == 0.0:
        return Outcome(a, b, b - a, b - a, b - a, 1.0 if abs(ratio) <= _TINY else 0.0)
    width = min(50.0, _quantile(confidence, freedom) * error)
    low, high = a * math.expm1(ratio - width), a * math.expm1(ratio + width)
    return Outcome(a, b, b - a, low, high, _two_sided(ratio / error, freedom))


def _compare_deviations(a: Measure, b: Measure, confidence: float) -> Outcome:
    means = _mean(a.values), _mean(b.values)
    values = [math.sqrt(max(0.0, mean.value)) for mean in means]
    errors = [0.5 * m.error / m.value if m.value > 0.0 else 0.0 for m in means]
    scaled = [_Mean(0.0, error, m.freedom) for error, m in zip(errors, means, strict=True)]
    return _of_ratio(values[0], values[1], (errors[0], errors[1]), _freedom(scaled[0], scaled[1]), confidence)


def _compare_powers(a: Measure, b: Measure, confidence: float) -> Outcome:
    """Compare powers segment by segment, because a drive has phases of different power.

    The mean of logarithms gives each segment the same weight; else a start of the motors would decide alone.
    """
    count = min(len(a.values), len(b.values))
    first, second = a.values[:count], b.values[:count]
    values = [_geometric_mean(side) for side in (first, second)]
    if count < _LEAST or min(values) <= 1e-9 * max(values):
        return _of_ratio(values[0], values[1], (math.nan, math.nan), 1.0, confidence)
    floor = _TINY * max(float(first.max()), float(second.max()))
    ratios = 0.5 * log((second + floor) / (first + floor))
    # neighbouring segments are correlated a little, which costs a quarter of the degrees of freedom
    error = float(ratios.std(ddof=1)) / math.sqrt(count)
    return _of_ratio(values[0], values[1], (error, 0.0), max(1.0, 0.75 * count - 1.0), confidence)


def _geometric_mean(powers: Floats) -> float:
    """Return the amplitude of a typical segment: the square root of the geometric mean of the powers."""
    largest = float(powers.max(initial=0.0))
    if largest <= 0.0:
        return 0.0
    return math.sqrt(largest * math.exp(float(np.mean(log(powers / largest + _TINY)))))


def paired_values(a: Measure, b: Measure) -> tuple[Floats, Floats]:
    """Return the samples of two measures at equal times: those of the slower one, the other interpolated."""
    assert a.times is not None and b.times is not None
    sides = []
    for measure in (a, b):
        known = np.isfinite(measure.values)
        order = np.argsort(measure.times[known], kind="stable")  # type: ignore[index]
        values = measure.values[known][order]
        sides.append((measure.times[known][order], np.unwrap(values) if measure.is_angle else values))  # type: ignore[index]
    (times_a, values_a), (times_b, values_b) = sides
    if min(len(times_a), len(times_b)) < 2:
        return np.empty(0), np.empty(0)
    start, end = max(times_a[0], times_b[0]) - 1e-9, min(times_a[-1], times_b[-1]) + 1e-9
    inside_a, inside_b = ((t >= start) & (t <= end) for t in (times_a, times_b))
    if np.count_nonzero(inside_a) <= np.count_nonzero(inside_b):
        grid = times_a[inside_a]
        return values_a[inside_a], np.interp(grid, times_b, values_b)
    grid = times_b[inside_b]
    return np.interp(grid, times_a, values_a), values_b[inside_b]


def _compare_pairs(a: Measure, b: Measure, confidence: float) -> Outcome:
    first, second = paired_values(a, b)
    if len(first) < _LEAST:
        return Outcome(_plain_mean(a), _plain_mean(b), math.nan)
    step = max(1, len(first) // _MOST_PAIRS)
    differences = (second - first)[::step]
    if a.is_angle:
        differences = np.mod(differences + math.pi, 2.0 * math.pi) - math.pi
    return _of_difference(float(first.mean()), float(second.mean()), _mean(differences), confidence)


def _compare_spreads(a: Measure, b: Measure, confidence: float) -> Outcome:
    """Compare standard deviations at equal times: the influence of each pair on the logarithm of their ratio."""
    first, second = paired_values(a, b)
    if len(first) < _LEAST:
        return Outcome(_plain_value(a), _plain_value(b), math.nan)
    step = max(1, len(first) // _MOST_PAIRS)
    one, two = first[::step] - first[::step].mean(), second[::step] - second[::step].mean()
    squares = float((one**2).mean()), float((two**2).mean())
    values = math.sqrt(squares[0]), math.sqrt(squares[1])
    if min(values) <= _TINY * max(values):
        return _of_ratio(values[0], values[1], (math.nan, math.nan), 1.0, confidence)
    influence = _mean(0.5 * (two**2 / squares[1] - one**2 / squares[0]))
    return _of_ratio(values[0], values[1], (influence.error, 0.0), influence.freedom, confidence)


def _plain_mean(measure: Measure) -> float:
    finite = measure.values[np.isfinite(measure.values)]
    return float(finite.mean()) if len(finite) else math.nan


def array_differences(a: ArrayOverTime, b: ArrayOverTime, *, is_ratio: bool) -> tuple[Floats, float, float]:
    """Return the median of b - a (or b / a - 1) over the items, for each row of a with a row of b at its time.

    Returns:
        Differences, and the medians of the compared items of both.
    """
    period = float(np.median(np.diff(b.times))) if len(b.times) > 1 else 0.0
    near = np.clip(np.searchsorted(b.times, a.times), 1, max(1, len(b.times) - 1))
    near = np.where(np.abs(b.times[near - 1] - a.times) < np.abs(b.times[near] - a.times), near - 1, near)
    found: list[float] = []
    middles: list[tuple[float, float]] = []
    for row, other in enumerate(near.tolist()):
        if abs(float(b.times[other] - a.times[row])) > 0.51 * period:
            continue
        one, two = a.values[row].astype(np.float64), b.values[other].astype(np.float64)
        both = np.isfinite(one) & np.isfinite(two)
        if np.count_nonzero(both) < _LEAST:
            continue
        one, two = one[both], two[both]
        if is_ratio:
            both = one > 0.0
            one, two = one[both], two[both]
        found.append(float(np.median(two / one - 1.0 if is_ratio else two - one)))
        middles.append((float(np.median(one)), float(np.median(two))))
    if not found:
        return np.empty(0), math.nan, math.nan
    middle = np.array(middles).mean(axis=0)
    return np.array(found), float(middle[0]), float(middle[1])


def _compare_arrays(a: Measure, b: Measure, confidence: float) -> Outcome:
    assert a.array is not None and b.array is not None
    if a.array.shape != b.array.shape or len(b.array.times) < 2:
        return Outcome(_plain_value(a), _plain_value(b), math.nan)
    differences, first, second = array_differences(a.array, b.array, is_ratio=a.is_ratio)
    if len(differences) < _LEAST:
        return Outcome(first, second, math.nan)
    if a.is_ratio:
        first, second = 1.0, 1.0 + float(differences.mean())
    return _of_difference(first, second, _mean(differences), confidence)


def _compare_largest(a: Measure, b: Measure, _: float) -> Outcome:
    """Compare largest values: count the samples of one side that are larger than all of the other side.

    If both sides have the same distribution, each of the largest samples of both is from either side by chance.
    """
    first, second = a.values[np.isfinite(a.values)], b.values[np.isfinite(b.values)]
    if not len(first) or not len(second):
        return Outcome(math.nan, math.nan, math.nan)
    tops = float(first.max()), float(second.max())
    wins = [int(np.count_nonzero(x > top * (1.0 + 1e-6))) for x, top in ((first, tops[1]), (second, tops[0]))]
    larger = 0 if wins[0] else 1
    share = (len(first), len(second))[larger] / (len(first) + len(second))
    return Outcome(tops[0], tops[1], tops[1] - tops[0], chance=min(1.0, 2.0 * share ** max(wins)) if any(wins) else 1.0)


def _compare_distributions(a: Measure, b: Measure, _: float) -> Outcome:
    """Compare distributions by the test of Kolmogorov and Smirnov, with the numbers of independent samples."""
    from scipy.stats import kstwobign

    first, second = (np.sort(m.values[np.isfinite(m.values)]) for m in (a, b))
    if min(len(first), len(second)) < 8:
        return Outcome(_plain_value(a), _plain_value(b), math.nan)
    counts = [_mean(m.values).freedom + 1.0 if np.ptp(m.values) > 0.0 else float(len(m.values)) for m in (a, b)]
    every = np.unique(np.concatenate((first, second)))
    # equal times that differ by a rounding error are equal
    shares = [np.searchsorted(x, every + 1e-9, side="right") / len(x) for x in (first, second)]
    distance = float(np.abs(shares[0] - shares[1]).max())
    effective = math.sqrt(counts[0] * counts[1] / (counts[0] + counts[1]))
    return Outcome(_plain_value(a), _plain_value(b), distance, chance=float(kstwobign.sf(distance * effective)))


def _compare_estimates(a: Measure, b: Measure, confidence: float) -> Outcome:
    values = float(a.values[0]), float(b.values[0])
    errors = [float(m.values[1] / m.values[0]) if m.values[0] > 0.0 else 0.0 for m in (a, b)]
    return _of_ratio(values[0], values[1], (errors[0], errors[1]), 1e9, confidence)


def _compare_values(a: Measure, b: Measure, _: float) -> Outcome:
    """Compare values without a test; equal ones are the same."""
    first, second = float(a.values[0]), float(b.values[0])
    is_equal = abs(second - first) <= 1e-9 * max(abs(first), abs(second))
    return Outcome(first, second, second - first, chance=1.0 if is_equal else math.nan)


_TESTS: Final[dict[Kind, Callable[[Measure, Measure, float], Outcome]]] = {
    "mean": _compare_means,
    "rate": _compare_rates,
    "deviation": _compare_deviations,
    "paired": _compare_pairs,
    "spread": _compare_spreads,
    "arrays": _compare_arrays,
    "power": _compare_powers,
    "largest": _compare_largest,
    "distribution": _compare_distributions,
    "estimate": _compare_estimates,
    "value": _compare_values,
}
