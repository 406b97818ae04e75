"""Sensitivity of the metrics of a sweep to its parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit_learning.sweeps.result_store import SweepDescription

Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Sensitivity:
    """Influence of one parameter on one metric.

    Attributes:
        metric, parameter: names.
        correlation: Spearman's rank correlation, -1 to 1; NaN if one of them does not vary.
        first: first-order Sobol index, the share of the variance that the parameter alone explains; NaN if the design
            does not allow it.
        total: total Sobol index, with all interactions of the parameter; NaN if the design does not allow it.
    """

    metric: str
    parameter: str
    correlation: float
    first: float = float("nan")
    total: float = float("nan")


def rank_correlation(a: Numbers, b: Numbers) -> float:
    """Return Spearman's rank correlation of the finite pairs; NaN if a value does not vary."""
    known = np.isfinite(a) & np.isfinite(b)
    a, b = a[known], b[known]
    if len(a) < 3 or np.ptp(a) == 0 or np.ptp(b) == 0:
        return float("nan")
    from scipy.stats import rankdata

    return float(np.corrcoef(rankdata(a), rankdata(b))[0, 1])


def sensitivities(
    description: SweepDescription, columns: Mapping[str, Numbers], parameters: Sequence[str], metrics: Sequence[str]
) -> list[Sensitivity]:
    """Return the influence of each parameter on each metric.

    Args:
        description: content of `sweep.json`.
        columns: numbers of all runs by name.
        parameters: names of numeric parameters.
        metrics: names of numeric metrics.
    """
    influences = []
    for metric in metrics:
        indices = sobol_indices(description, columns["run"], columns[metric])
        for name in parameters:
            first, total = indices.get(name, (float("nan"), float("nan")))
            influences.append(Sensitivity(metric, name, rank_correlation(columns[name], columns[metric]), first, total))
    return influences


def sobol_indices(description: SweepDescription, runs: Numbers, values: Numbers) -> dict[str, tuple[float, float]]:
    """Return the first-order and the total Sobol index of each sampled parameter of a Saltelli design.

    The values of several seeds are averaged. The result is empty for another design, for a design that is crossed with
    a grid, and if a run is missing or has no value.
    """
    names = description["sampled"]
    points, seeds = description["points"], description["seeds"]
    if description["sampling"] != "saltelli" or description["combinations"] != 1 or len(runs) != points * seeds:
        return {}
    means = values[np.argsort(runs)].reshape(points, seeds).mean(axis=1)
    if not np.isfinite(means).all() or np.ptp(means) == 0:
        return {}
    from scipy.stats import sobol_indices as estimate

    matrices = means.reshape(len(names) + 2, -1)
    count = matrices.shape[1]
    values_of = {"f_A": matrices[:1], "f_B": matrices[1:2], "f_AB": matrices[2:].reshape(len(names), 1, count)}
    result = estimate(func=values_of, n=count, dists=None)
    first, total = np.ravel(result.first_order), np.ravel(result.total_order)
    return {name: (float(a), float(b)) for name, a, b in zip(names, first, total, strict=True)}
