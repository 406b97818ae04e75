"""Statistics of sensor noise, and tests whether two samples can come from the same noise."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final, Literal

import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul

Floats = npt.NDArray[np.float64]

FALSE_ALARM: Final = 1e-11
"""Probability that one test reports equal noise as different.

A field has about ten tests. In 10 000 checks of a robot with 100 fields, the probability of any false alarm is
therefore below 0.1 %.
"""
QUANTILES: Final = 129
_COMPONENTS: Final = 16  # maximum number of components with separate statistics; a covariance has 9
_MIN_SAMPLES: Final = 8  # minimum number of samples for a test
_SLOW_DRIFT: Final = 4  # number of slowest Fourier components, in which a drift appears
_DRIFT_RATIO: Final = 4.0  # mean power, relative to white noise, from which a drift is assumed; chance 1e-4
_WALK: Final = 13.2  # 4 pi² / 3: variance of the mean of a random walk, divided by the power of its slowest component
_ALLAN_LEAST: Final = 20  # minimum number of independent differences of averages for an Allan deviation


@dataclass
class NoiseStatistics:
    """Statistics of the residual (reading minus ground truth) of one field.

    Attributes:
        count: Number of samples.
        mean, deviation: Mean and standard deviation in the field's unit, shape (components,).
        quantiles: Quantiles at equidistant probabilities, shape (components, quantiles).
        taus: Averaging times of the Allan deviation [s], shape (taus,).
        allan: Allan deviation at these times, shape (components, taus).
        independent: Number of independent samples that would give the mean with the same accuracy, shape (components,).
        kurtosis: Fourth moment divided by the squared variance (3 for a normal distribution), shape (components,).
    """

    count: int
    mean: Floats
    deviation: Floats
    quantiles: Floats
    taus: Floats
    allan: Floats
    independent: Floats = field(default_factory=lambda: np.zeros(0))
    kurtosis: Floats = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True)
class StatisticDifference:
    """Statistic that proves two samples to come from different noise.

    Attributes:
        what: "mean", "deviation", "distribution", "allan" or "count".
        component: Index of the component.
        golden, run: Values in both runs; for a distribution, the share of samples below `at`.
        at: Value at which two distributions differ most, in the field's unit; for an Allan deviation, the averaging
            time [s].
        limit: Largest difference that chance explains; a ratio for deviations.
    """

    what: Literal["mean", "deviation", "distribution", "allan", "count"]
    component: int
    golden: float
    run: float
    limit: float
    at: float = math.nan


def noise_statistics(residual: npt.ArrayLike, period: float) -> NoiseStatistics:
    """Return the statistics of noise.

    Args:
        residual: Reading minus ground truth, shape (samples,) or (samples, components). Samples that are not finite are
            left out. Many components (rays, pixels) are pooled to one, without an Allan deviation.
        period: Time between two samples [s].
    """
    values = np.asarray(residual, np.float64)
    values = values.reshape(len(values), -1 if values.size else max(1, int(np.prod(values.shape[1:]))))
    is_pooled = values.shape[1] > _COMPONENTS
    if is_pooled:
        values = values.reshape(-1, 1)
    values = values[np.isfinite(values).all(axis=1)]
    components = values.shape[1]
    if len(values) == 0:
        nothing = np.zeros((components, 0))
        zero = np.zeros(components)
        return NoiseStatistics(0, zero, zero, nothing, np.zeros(0), nothing, zero, zero)
    mean, deviation = values.mean(axis=0), values.std(axis=0)
    taus, allan = (np.zeros(0), np.zeros((1, 0))) if is_pooled else _allan(values, period)
    with np.errstate(invalid="ignore", divide="ignore"):
        kurtosis = np.nan_to_num(((values - mean) ** 4).mean(axis=0) / deviation**4, nan=3.0, posinf=3.0)
    return NoiseStatistics(
        count=len(values),
        mean=mean,
        deviation=deviation,
        quantiles=np.quantile(values, np.linspace(0.0, 1.0, QUANTILES), axis=0).T,
        taus=taus,
        allan=allan,
        independent=np.array([_independent_samples(values[:, c] - mean[c]) for c in range(components)]),
        kurtosis=kurtosis,
    )


def statistic_differences(
    golden: NoiseStatistics, run: NoiseStatistics, absolute: float = 0.0, relative: float = 0.0
) -> list[StatisticDifference]:
    """Return the statistics that prove two samples to differ, each with a false-alarm probability of `FALSE_ALARM`.

    Args:
        golden: Statistics of the golden run.
        run: Statistics of the new run, of the same field.
        absolute: Additional tolerance for means, in the field's unit.
        relative: Additional relative tolerance for deviations.
    """
    if golden.mean.shape != run.mean.shape:
        return [StatisticDifference("count", 0, float(golden.mean.size), float(run.mean.size), 0.0)]
    if min(golden.count, run.count) < _MIN_SAMPLES:
        if (golden.count < _MIN_SAMPLES) != (run.count < _MIN_SAMPLES):
            return [StatisticDifference("count", 0, float(golden.count), float(run.count), 0.0)]
        return []
    differences = []
    for component in range(golden.mean.size):
        of_deviation = _deviation_difference(golden, run, component, relative)
        of_mean = _mean_difference(golden, run, component, absolute)
        differences += [of_mean, of_deviation]
        if of_deviation is None:  # a different mean or deviation also changes the distribution
            differences.append(None if of_mean else _distribution_difference(golden, run, component, absolute))
            differences.append(_allan_difference(golden, run, component, relative))
    return [deviance for deviance in differences if deviance is not None]


def detectable_ratio(count: float, kurtosis: float = 3.0) -> float:
    """Return the smallest ratio of two deviations that is almost always detected in two samples of this size."""
    from scipy.stats import norm

    if count < _MIN_SAMPLES:
        return math.inf
    error = math.sqrt(max(kurtosis - 1.0, 0.1) / 4.0 * 2.0 / count)
    return math.exp((float(norm.isf(FALSE_ALARM / 2.0)) + 3.0) * error)


# ---------------------------------------------------------------------- tests


def _mean_difference(
    golden: NoiseStatistics, run: NoiseStatistics, c: int, absolute: float
) -> StatisticDifference | None:
    """Compare means by a t-test with the number of independent samples."""
    from scipy.stats import t as student

    counts = _sample_counts(golden, c), _sample_counts(run, c)
    variance = golden.deviation[c] ** 2 / counts[0] + run.deviation[c] ** 2 / counts[1]
    freedom = max(1.0, min(counts) - 1.0)
    limit = float(student.isf(FALSE_ALARM / 2.0, freedom)) * math.sqrt(variance) + absolute
    limit += 8.0 * np.finfo(float).eps * max(abs(golden.mean[c]), abs(run.mean[c]))
    if abs(golden.mean[c] - run.mean[c]) <= limit:
        return None
    return StatisticDifference("mean", c, float(golden.mean[c]), float(run.mean[c]), limit)


def _deviation_difference(
    golden: NoiseStatistics, run: NoiseStatistics, c: int, relative: float
) -> StatisticDifference | None:
    """Compare deviations by the logarithm of their ratio, with variance (kurtosis - 1) / 4 / samples.

    Source: Shoemaker, "Fixing the F test for equal variances", The American Statistician 57(2), 2003.
    """
    a, b = float(golden.deviation[c]), float(run.deviation[c])
    if a == b:
        return None
    floor = 1e-12 * max(abs(golden.mean[c]), abs(run.mean[c]))
    if a <= floor or b <= floor:  # one sample has no noise
        return StatisticDifference("deviation", c, a, b, 1.0) if max(a, b) > 4.0 * floor else None
    kurtosis = max(3.0, *(s.kurtosis[c] for s in (golden, run) if s.kurtosis.size))
    inverse = 1.0 / max(2.0, _sample_counts(golden, c) - 1.0) + 1.0 / max(2.0, _sample_counts(run, c) - 1.0)
    error = math.sqrt((kurtosis - 1.0) / 4.0 * inverse)
    sigmas = _standard_errors(min(_sample_counts(golden, c), _sample_counts(run, c)))
    limit = math.exp(min(100.0, sigmas * error)) * (1.0 + relative)
    return StatisticDifference("deviation", c, a, b, limit) if max(a / b, b / a) > limit else None


def _distribution_difference(
    golden: NoiseStatistics, run: NoiseStatistics, c: int, absolute: float
) -> StatisticDifference | None:
    """Compare distributions by the Kolmogorov-Smirnov test, with the smallest distance that the quantiles allow."""
    a, b = golden.quantiles[c], run.quantiles[c]
    if a.size < 2 or b.size < 2 or golden.deviation[c] == 0.0:
        return None
    values = np.unique(np.concatenate([a, b]))
    low_a, high_a = _share_limits(a, values)
    gap = np.maximum(low_a - _share_limits(b, values + absolute)[1], _share_limits(b, values - absolute)[0] - high_a)
    at = int(np.argmax(gap))
    counts = _sample_counts(golden, c), _sample_counts(run, c)
    limit = math.sqrt(-math.log(FALSE_ALARM / 2.0) / 2.0 * (1.0 / counts[0] + 1.0 / counts[1]))
    if gap[at] <= limit:
        return None
    low_b, high_b = _share_limits(b, values)
    below = (low_a[at] + high_a[at]) / 2.0, (low_b[at] + high_b[at]) / 2.0
    return StatisticDifference("distribution", c, float(below[0]), float(below[1]), limit, float(values[at]))


def _allan_difference(
    golden: NoiseStatistics, run: NoiseStatistics, c: int, relative: float
) -> StatisticDifference | None:
    """Compare Allan deviations at equal averaging times by the F distribution; return the largest difference."""
    from scipy.stats import f as fisher

    common = [float(tau) for tau in golden.taus if np.isclose(run.taus, tau, rtol=1e-6).any()]
    worst: StatisticDifference | None = None
    most = 1.0
    for tau in common:
        a = float(golden.allan[c][np.isclose(golden.taus, tau, rtol=1e-6)][0])
        b = float(run.allan[c][np.isclose(run.taus, tau, rtol=1e-6)][0])
        if a <= 0.0 or b <= 0.0:
            continue
        freedom = [_degrees_of_freedom(s, c, tau) for s in (golden, run)]
        level = FALSE_ALARM / 2.0 / len(common)
        limit = math.sqrt(max(float(fisher.isf(level, *freedom)), float(fisher.isf(level, *freedom[::-1]))))
        limit *= 1.0 + relative
        if max(a / b, b / a) / limit > most:
            most, worst = max(a / b, b / a) / limit, StatisticDifference("allan", c, a, b, limit, tau)
    return worst


def _degrees_of_freedom(statistics: NoiseStatistics, c: int, tau: float) -> float:
    """Return the degrees of freedom of an Allan variance: half the number of averages, less for heavy tails."""
    width = max(1.0, tau / float(statistics.taus[0]))
    kurtosis = 3.0 + max(0.0, float(statistics.kurtosis[c]) - 3.0 if statistics.kurtosis.size else 0.0) / width
    return max(2.0, statistics.count / width / (kurtosis - 1.0))


def _sample_counts(statistics: NoiseStatistics, c: int) -> float:
    """Return the number of independent samples of a component."""
    if not statistics.independent.size:
        return float(statistics.count)
    return float(max(2.0, min(statistics.count, statistics.independent[c])))


def _standard_errors(count: float) -> float:
    """Return the limit of a test in standard errors; the limit is higher for few samples."""
    from scipy.stats import t as student

    return float(student.isf(FALSE_ALARM / 2.0, max(2.0, count - 1.0)))


def _share_limits(quantiles: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return the smallest and the largest possible share of samples up to each value, given their quantiles."""
    steps, at_most = quantiles.size - 1, np.searchsorted(quantiles, values, side="right")
    return np.clip((at_most - 1) / steps, 0.0, 1.0), np.clip(at_most / steps, 0.0, 1.0)


# ---------------------------------------------------------------------- statistics of a sample


def _allan(values: Floats, period: float) -> tuple[Floats, Floats]:
    """Return the averaging times [s], each twice the previous one, and the overlapping Allan deviations.

    Source: IEEE Std 952-1997, annex C; Riley, "Handbook of Frequency Stability Analysis", NIST SP 1065, 5.2.4.
    """
    count = len(values)
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values - values.mean(axis=0), axis=0)])
    taus, deviations = [], []
    width = 1
    while count // width > _ALLAN_LEAST:
        means = (sums[width:] - sums[:-width]) / width
        steps = means[width:] - means[:-width]
        taus.append(width * period)
        deviations.append(np.sqrt(0.5 * (steps**2).mean(axis=0)))
        width *= 2
    table = np.array(deviations).T if deviations else np.zeros((values.shape[1], 0))
    return np.array(taus), table


def _independent_samples(centred: Floats) -> float:
    """Return the number of independent samples that would give the mean with the same accuracy.

    The number is computed from the autocorrelation.

    Source: Geyer, "Practical Markov chain Monte Carlo", Statistical Science 7(4), 1992: adds pairs of
    correlations as long as the sum of a pair is positive.
    """
    from scipy.fft import irfft, next_fast_len, rfft

    count = len(centred)
    total = float(matmul(centred, centred))
    if count < _MIN_SAMPLES or total <= 0.0:
        return float(count)
    length = int(next_fast_len(2 * count))
    spectrum = rfft(centred, length)
    correlation = irfft(np.abs(spectrum) ** 2, length)[: count // 2] / total
    pairs = correlation[: correlation.size // 2 * 2].reshape(-1, 2).sum(axis=1)
    ends = np.flatnonzero(pairs <= 3.0 / math.sqrt(count))
    pairs = pairs[: int(ends[0])] if ends.size else pairs
    time = max(1.0, 2.0 * float(pairs.sum()) - 1.0)
    slow = np.abs(np.fft.rfft(centred)[1 : 1 + _SLOW_DRIFT]) ** 2 / total
    if float(slow.mean()) > _DRIFT_RATIO:  # a random walk: its mean varies more than its slowest component
        time = max(time, _WALK * float(slow.max()))
    return max(1.0, count / time)
