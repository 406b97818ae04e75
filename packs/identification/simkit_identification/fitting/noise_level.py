"""Standard deviations of noise, estimated from the residuals that the best trajectory leaves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2

from simkit.errors import InputError
from simkit.float_sum import float_sum
from simkit_identification.fitting.codes import NO_EFFECT, RUNS_FAILED
from simkit_identification.fitting.evaluation import Evaluator
from simkit_identification.fitting.parameters import Parameter
from simkit_identification.fitting.residuals import Residuals
from simkit_identification.fitting.uncertainty import CONFIDENCE

Floats = npt.NDArray[np.float64]
_NEAR: Final = 4.0  # standard errors between a measured gain and 1 within which the gain is 1


@dataclass(frozen=True)
class NoiseLevel:
    """Estimated standard deviation of noise.

    Attributes:
        value: most likely value.
        low, high: ends of its interval.
        effective: effective number of readings.
        topics: topics whose readings have this noise.
    """

    value: float
    low: float
    high: float
    effective: float
    topics: tuple[str, ...]


def estimate_noise(
    evaluate: Evaluator, residuals: Residuals, values: Sequence[float], readings: Floats, parameter: Parameter
) -> NoiseLevel:
    """Estimate a standard deviation by the likelihood of the residuals.

    One run with the first value of the deviation shows which readings the noise changes, and how much.

    Args:
        evaluate: evaluator.
        residuals: recorded readings.
        values: best values of the other parameters.
        readings: simulated readings without noise.
        parameter: standard deviation.

    Raises:
        InputError: SK-FIT-005 the noise changes no reading; SK-FIT-008 the run fails.
    """
    first = parameter.start or 0.01
    (noisy,) = evaluate.at_values([list(values)], {parameter.path: first})
    if noisy is None:
        raise InputError(RUNS_FAILED, f"{parameter.path}: the run with noise fails: {evaluate.failures[-1]}")
    change, rest = noisy - readings, readings - residuals.recorded
    powers, effective, topics = [], 0.0, []
    for i, name in enumerate(residuals.columns):
        here = residuals.column == i
        if not np.any(np.nan_to_num(change[here])):
            continue
        error = rest[here][np.isfinite(rest[here])]
        if len(error) < 2:
            continue
        gain = float(np.sqrt(np.nanmean(change[here] ** 2))) / first
        if abs(gain - 1.0) < _NEAR / np.sqrt(2.0 * len(error)):
            gain = 1.0
        powers.append((float(np.mean(error * error)) / (gain * gain), _effective(error)))
        topics.append(name.channel.topic)
    if not powers:
        text = f"{parameter.path}: the noise changes no reading that the recording and the world share"
        help_ = "record the topic of the sensor, or include it with --compare; the noise of the file needs a type"
        raise InputError(NO_EFFECT, text, help=help_)
    effective = float_sum(count for _, count in powers)
    variance = float_sum(power * count for power, count in powers) / effective
    ends = [variance * effective / chi2.ppf(0.5 + side * 0.5 * CONFIDENCE, effective) for side in (1.0, -1.0)]
    return NoiseLevel(
        float(np.sqrt(variance)),
        float(np.sqrt(ends[0])),
        float(np.sqrt(ends[1])),
        effective,
        tuple(dict.fromkeys(topics)),
    )


def _effective(error: Floats) -> float:
    """Return the effective number of readings for their variance, from the correlation of neighbours."""
    power = float(np.sum(error * error))
    rho = float(np.clip(np.sum(error[1:] * error[:-1]) / power, 0.0, 0.99)) if power > 0 else 0.0
    if rho < 2.0 / np.sqrt(len(error)):
        return float(len(error))
    return max(2.0, len(error) * (1 - rho * rho) / (1 + rho * rho))
