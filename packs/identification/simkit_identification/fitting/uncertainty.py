"""Intervals of fitted parameters, and which parameters a recording cannot tell apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.stats import t as student

from simkit.linear_algebra import matmul
from simkit_identification.fitting.evaluation import Evaluator
from simkit_identification.fitting.parameters import Parameter
from simkit_identification.fitting.residuals import Residuals
from simkit_identification.fitting.search import Loss, cost_of, robust_factors

Floats = npt.NDArray[np.float64]
CONFIDENCE: Final = 0.95
SIMILAR: Final = 0.95
"""Correlation of two errors above which a recording hardly tells the parameters apart."""
_SINGULAR: Final = 1e-5  # smallest ratio of the singular values of the derivatives that counts as information
_UNKNOWN: Final = 1.0  # standard deviation of a scaled coordinate that tells nothing
_FINEST: Final = 2e-6  # half an interval of a scaled coordinate at least: limit of the search
_POOR: Final = 0.3  # relative error of the quadratic form at which the cost itself is followed
_FEW_CLUSTERS: Final = 20


@dataclass
class Uncertainty:
    """Uncertainty of a point.

    Attributes:
        covariance: covariance of the scaled coordinates, with the correlation of the residuals in time.
        correlation: correlation of the errors.
        low, high: ends of the intervals of the coordinates.
        effective: effective number of readings for each parameter.
        unresolved: directions that the recording tells nothing about, each with a weight for each parameter.
        followed: True for each parameter whose interval follows the cost instead of the quadratic form.
    """

    covariance: Floats
    correlation: Floats
    low: Floats
    high: Floats
    effective: Floats
    unresolved: list[Floats]
    followed: list[bool]


def uncertainty_at(
    evaluate: Evaluator, residuals: Residuals, point: Floats, readings: Floats, slopes: Floats, loss: Loss
) -> Uncertainty:
    """Return the uncertainty at the best point.

    Args:
        evaluate: evaluator.
        residuals: residuals with their final weights.
        point: best point.
        readings: simulated readings there.
        slopes: derivatives of the readings there, shape (size, parameters).
        loss: loss of the search.
    """
    vector = residuals.vector(readings)
    factors = robust_factors(vector, loss)
    weighted = residuals.jacobian(slopes) * factors[:, None]
    vector = vector * factors
    count, unknowns = max(residuals.count, 1), weighted.shape[1]
    variance = float(np.sum(vector * vector)) / max(count - unknowns, 1)
    information = matmul(weighted.T, weighted)
    scale = np.sqrt(np.maximum(np.diag(information), 1e-300))
    _, singular, rows = np.linalg.svd(weighted / scale, full_matrices=False)
    deviations = np.sqrt(variance) / np.maximum(singular, 1e-300)
    is_lost = (singular < _SINGULAR * singular.max(initial=0.0)) | (
        np.array([np.abs(d * r / scale).max() for d, r in zip(deviations, rows, strict=True)]) > _UNKNOWN
    )
    unresolved = [_in_coordinates(row / scale) for row in rows[is_lost]]
    kept = rows[~is_lost] / singular[~is_lost, None]
    inverse = matmul(kept.T, kept) / np.outer(scale, scale)
    plain = variance * inverse
    middle = _long_run_covariance(weighted * vector[:, None], residuals)
    robust = matmul(inverse, middle, inverse) * (count / max(count - unknowns, 1))
    inflation = np.maximum(np.diag(robust) / np.maximum(np.diag(plain), 1e-300), 1.0)
    covariance = plain * np.sqrt(np.outer(inflation, inflation))
    effective = count / inflation
    spread = np.sqrt(np.diag(covariance))
    factor = student.ppf(0.5 + 0.5 * CONFIDENCE, np.maximum(effective - unknowns, 1.0))
    low, high = point - factor * spread, point + factor * spread
    is_followed = _follow_cost(evaluate, residuals, point, covariance, information, factor, (low, high), loss)
    for i, parameter in enumerate(evaluate.parameters):
        least = max(_FINEST, parameter.step / parameter.scale if parameter.step else 0.0)
        low[i], high[i] = min(low[i], point[i] - least), max(high[i], point[i] + least)
        if any(abs(direction[i]) > 0.1 for direction in unresolved):
            low[i], high[i] = evaluate.parameters[i].limits()
    correlation = covariance / np.maximum(np.outer(spread, spread), 1e-300)
    return Uncertainty(covariance, correlation, low, high, effective, unresolved, is_followed)


def _in_coordinates(direction: Floats) -> Floats:
    return np.asarray(direction / np.linalg.norm(direction), dtype=np.float64)


def _long_run_covariance(scores: Floats, residuals: Residuals) -> Floats:
    """Return the covariance of the sum of scores, whose terms are correlated in time.

    Scores of the same time are added first, because topics may repeat each other. Then neighbours in time are weighted
    by Bartlett's kernel, with the bandwidth of Andrews (1991) for a process of first order. Many short recordings
    are taken as independent of each other instead.
    """
    used = np.flatnonzero(residuals.weights)
    if len(np.unique(residuals.recording)) >= _FEW_CLUSTERS:
        return _cluster_covariance(scores[used], residuals.recording[used])
    total = np.zeros((scores.shape[1], scores.shape[1]))
    for recording in np.unique(residuals.recording[used]):
        here = used[residuals.recording[used] == recording]
        _, order = np.unique(residuals.sample[here], return_inverse=True)
        sums = np.zeros((int(order.max()) + 1, scores.shape[1]))
        np.add.at(sums, order, scores[here])
        bandwidth = _bandwidth(sums)
        total += matmul(sums.T, sums)
        for lag in range(1, bandwidth + 1):
            product = matmul(sums[lag:].T, sums[:-lag])
            total += (1.0 - lag / (bandwidth + 1.0)) * (product + product.T)
    return total


def _cluster_covariance(scores: Floats, cluster: npt.NDArray[np.intp]) -> Floats:
    _, order = np.unique(cluster, return_inverse=True)
    sums = np.zeros((int(order.max()) + 1, scores.shape[1]))
    np.add.at(sums, order, scores)
    return np.asarray(matmul(sums.T, sums) * (len(sums) / (len(sums) - 1.0)), dtype=np.float64)


def _bandwidth(sums: Floats) -> int:
    """Return the number of neighbours in time whose scores are taken as correlated."""
    count = len(sums)
    if count < 4:
        return 0
    numerator = denominator = 0.0
    for column in sums.T:
        power = float(np.sum(column * column))
        if power <= 0:
            continue
        rho = float(np.clip(np.sum(column[1:] * column[:-1]) / power, -0.97, 0.97))
        noise = (power / count) ** 2 * (1 - rho * rho) ** 2
        numerator += 4 * rho * rho * noise / ((1 - rho) ** 6 * (1 + rho) ** 2)
        denominator += noise / (1 - rho) ** 4
    if denominator <= 0:
        return 0
    return int(min(np.ceil(1.1447 * (numerator / denominator * count) ** (1 / 3)), count // 3))


def _follow_cost(
    evaluate: Evaluator,
    residuals: Residuals,
    point: Floats,
    covariance: Floats,
    information: Floats,
    factor: Floats,
    ends: tuple[Floats, Floats],
    loss: Loss,
) -> list[bool]:
    """Move the ends of intervals to where the cost is as high as the quadratic form says, if they differ much.

    From the best point, the other parameters follow along the line of their conditional means.
    """
    limits = np.array([p.limits() for p in evaluate.parameters])
    (base,) = evaluate([point])
    if base is None:
        return [False] * len(point)
    cost = cost_of(residuals.vector(base), loss)
    followed = []
    for i in range(len(point)):
        is_followed = False
        spread = np.sqrt(covariance[i, i])
        if evaluate.parameters[i].step or not _FINEST < factor[i] * spread < _UNKNOWN:
            followed.append(False)
            continue
        for sign, end in ((-1.0, ends[0]), (1.0, ends[1])):
            direction = sign * factor[i] * covariance[:, i] / spread
            wanted = 0.5 * float(matmul(direction, information, direction))
            share = _distance(evaluate, residuals, point, direction, limits, cost, wanted, loss)
            if share is not None:
                end[i] = point[i] + share * direction[i]
                is_followed = True
        followed.append(is_followed)
    return followed


def _distance(
    evaluate: Evaluator,
    residuals: Residuals,
    point: Floats,
    direction: Floats,
    limits: Floats,
    cost: float,
    wanted: float,
    loss: Loss,
) -> float | None:
    """Return how far along a direction the cost has risen by an amount; None if the quadratic form is right."""
    share, rise = 1.0, np.nan
    for number in range(5):
        at = np.clip(point + share * direction, limits[:, 0], limits[:, 1])
        (readings,) = evaluate([at])
        if readings is None:
            return None
        rise = (cost_of(residuals.vector(readings), loss) - cost) / max(wanted, 1e-300)
        if number == 0 and abs(rise - 1.0) < _POOR:
            return None
        if abs(rise - 1.0) < 0.1:
            break
        share = float(np.clip(share / np.sqrt(max(rise, 0.04)), 0.1, 5.0))
    return share


def describe_confusion(parameters: Sequence[Parameter], uncertainty: Uncertainty) -> list[str]:
    """Return a sentence for each group of parameters that the recording cannot tell apart."""
    sentences = []
    told: set[tuple[int, ...]] = set()
    for direction in uncertainty.unresolved:
        members = tuple(i for i in range(len(direction)) if abs(direction[i]) > 0.1)
        told.add(members)
        names = _listed([parameters[i].name for i in members])
        if len(members) == 1:
            sentences.append(f"{names} cannot be found from this recording: no value fits better than another")
            continue
        sentences.append(f"{names} cannot be told apart by this recording{_known_part(parameters, direction, members)}")
    count = len(parameters)
    for i in range(count):
        for j in range(i + 1, count):
            value = uncertainty.correlation[i, j]
            if abs(value) > SIMILAR and not any({i, j} <= set(members) for members in told):
                sentences.append(
                    f"{parameters[i].name} and {parameters[j].name} can hardly be told apart by this recording: their "
                    f"errors have the correlation {value:+.3f}"
                )
    return sentences


def _known_part(parameters: Sequence[Parameter], direction: Floats, members: tuple[int, ...]) -> str:
    """Return which combination of two parameters is known, if it is a ratio or a product."""
    if len(members) != 2 or not all(parameters[i].is_log for i in members):
        return ""
    first, second = direction[members[0]], direction[members[1]]
    if abs(abs(first) - abs(second)) > 0.1:
        return ""
    return f"; only their {'ratio' if first * second > 0 else 'product'} is known"


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
