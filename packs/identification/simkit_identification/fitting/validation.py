"""Cross-validation: values from a part of the recordings, and their errors on the rest."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit_identification.fitting.evaluation import Evaluator
from simkit_identification.fitting.residuals import Residuals
from simkit_identification.fitting.search import Loss, robust_factors

Floats = npt.NDArray[np.float64]
_FOLDS: Final = 5


@dataclass(frozen=True)
class Fold:
    """Part of the recordings that the search did not see.

    Attributes:
        name: held-out part.
        values: values from the other parts by path.
        error: root mean square of the weighted residuals of the part with these values.
        own_error: the same with the values of the whole fit.
    """

    name: str
    values: dict[str, float]
    error: float
    own_error: float


def cross_validate(
    evaluate: Evaluator,
    residuals: Residuals,
    point: Floats,
    readings: Floats,
    slopes: Floats,
    loss: Loss,
    names: list[str],
) -> list[Fold]:
    """Return the folds: recordings if there are several, else blocks of time.

    The values of a fold come from one step of Gauss and Newton away from the best point, not from a new search; the
    error is that of a run with these values.

    Args:
        evaluate: evaluator.
        residuals: residuals with their final weights.
        point: best point.
        readings: simulated readings there.
        slopes: derivatives of the readings.
        loss: loss of the search.
        names: names of the recordings.
    """
    vector = residuals.vector(readings)
    factors = robust_factors(vector, loss)
    weighted, reduced = residuals.jacobian(slopes) * factors[:, None], vector * factors
    masks = _parts(residuals, names)
    limits = np.array([p.limits() for p in evaluate.parameters])
    points, kept = [], []
    for name, held_out in masks:
        is_rest = ~held_out
        if not np.any(weighted[is_rest]) or not np.any(residuals.weights[held_out]):
            continue
        scale = np.maximum(np.linalg.norm(weighted, axis=0), 1e-300)
        step = np.linalg.lstsq(weighted[is_rest] / scale, -reduced[is_rest], rcond=1e-5)[0] / scale
        points.append(np.clip(point + np.clip(step, -0.5, 0.5), limits[:, 0], limits[:, 1]))
        kept.append((name, held_out))
    folds = []
    for (name, held_out), at, found in zip(kept, points, evaluate(points) if points else [], strict=True):
        if found is not None:
            here = held_out & (residuals.weights > 0)
            values = dict(zip((p.path for p in evaluate.parameters), evaluate.values_of(at), strict=True))
            error = float(np.sqrt(np.mean(residuals.vector(found)[here] ** 2)))
            folds.append(Fold(name, values, error, float(np.sqrt(np.mean(vector[here] ** 2)))))
    return folds


def _parts(residuals: Residuals, names: list[str]) -> list[tuple[str, npt.NDArray[np.bool_]]]:
    if len(names) > 1:
        groups = np.arange(len(names)) * _FOLDS // len(names) if len(names) > _FOLDS else np.arange(len(names))
        parts = []
        for group in np.unique(groups):
            members = np.flatnonzero(groups == group)
            name = names[members[0]] if len(members) == 1 else f"recordings {members[0] + 1} to {members[-1] + 1}"
            parts.append((name, np.isin(residuals.recording, members)))
        return parts
    used = residuals.times[residuals.weights > 0]
    if not len(used):
        return []
    edges = np.linspace(used.min(), used.max(), _FOLDS + 1)
    edges[-1] += 1e-9
    return [(f"{a:.3g} to {b:.3g} s", (residuals.times >= a) & (residuals.times < b)) for a, b in pairwise(edges)]
