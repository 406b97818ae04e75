"""Derivatives of simulated readings by the scaled coordinates of the parameters, from differences of runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.errors import InputError
from simkit_identification.fitting.codes import RUNS_FAILED
from simkit_identification.fitting.evaluation import Evaluator, Point

Floats = npt.NDArray[np.float64]
SMALLEST: Final = 1e-3
"""Difference of a scaled coordinate: 0.1 % of a value. Rounding and contacts disturb smaller ones."""
_LARGEST: Final = 0.3
_TIME_STEPS: Final = 3  # steps of the simulation in a difference of a time


@dataclass
class Differences:
    """Differences of the coordinates.

    Attributes:
        steps: difference of each coordinate.
        has_effect: True for each parameter that changes a reading.
    """

    steps: Floats
    has_effect: list[bool]


def choose_differences(evaluate: Evaluator, point: Point, least: float = SMALLEST) -> Differences:
    """Return for each coordinate the smallest difference, from `least` on, that changes a reading.

    Raises:
        InputError: SK-FIT-008 no run at this point succeeds.
    """
    parameters = evaluate.parameters
    (base,) = evaluate([point])
    if base is None:
        raise _all_failed(evaluate)
    steps = np.array([_TIME_STEPS * p.step / p.scale if p.step else least for p in parameters])
    found = [False] * len(parameters)
    while not all(found):
        open_ = [i for i, is_found in enumerate(found) if not is_found and steps[i] <= max(_LARGEST, least)]
        if not open_:
            break
        moved = [_moved(point, i, _inwards(evaluate, point, i, steps[i])) for i in open_]
        for i, readings in zip(open_, evaluate(moved), strict=True):
            if readings is not None and not np.array_equal(readings, base, equal_nan=True):
                found[i] = True
            else:
                steps[i] *= 10.0
    return Differences(steps, found)


def derivatives(
    evaluate: Evaluator, point: Point, differences: Differences, *, is_central: bool
) -> tuple[Floats, Floats]:
    """Return the readings at a point, shape (size,), and their derivatives, shape (size, parameters).

    Raises:
        InputError: SK-FIT-008 the run at this point, or at both sides of it, fails.
    """
    count = len(evaluate.parameters)
    points: list[Point] = [point]
    for i in range(count):
        step = _inwards(evaluate, point, i, differences.steps[i])
        points.append(_moved(point, i, step))
        if is_central:
            points.append(_moved(point, i, -step))
    readings = evaluate(points)
    base = readings[0]
    if base is None:
        raise _all_failed(evaluate)
    result = np.zeros((len(base), count))
    per = 2 if is_central else 1
    for i in range(count):
        sides = [(readings[1 + i * per + side], points[1 + i * per + side]) for side in range(per)]
        result[:, i] = _slope(evaluate, base, point, sides, i)
    return base, result


def _slope(
    evaluate: Evaluator, base: Floats, point: Point, sides: Sequence[tuple[Floats | None, Point]], i: int
) -> Floats:
    known = [(readings, float(at[i])) for readings, at in sides if readings is not None]
    if not known:
        raise _all_failed(evaluate)
    known = [(readings, at) for readings, at in known if at != float(point[i])]
    low, high = evaluate.parameters[i].limits()
    known = [(readings, at) for readings, at in known if low - 1e-12 <= at <= high + 1e-12] or known
    if len(known) == 1:
        known.append((base, float(point[i])))
    (first, at_first), (second, at_second) = known
    return np.asarray((first - second) / (at_first - at_second), dtype=np.float64)


def _moved(point: Point, i: int, step: float) -> Floats:
    moved = np.array(point, dtype=np.float64)
    moved[i] += step
    return moved


def _inwards(evaluate: Evaluator, point: Point, i: int, step: float) -> float:
    """Return a difference in the direction in which the coordinate stays between its bounds."""
    _, high = evaluate.parameters[i].limits()
    return step if float(point[i]) + step <= high else -step


def _all_failed(evaluate: Evaluator) -> InputError:
    reasons = "; ".join(evaluate.failures[:3]) or "unknown"
    text = f"no run of the world succeeds: {reasons}"
    return InputError(RUNS_FAILED, text, help="give other first values or narrower bounds: --vary PATH=LOW:START:HIGH")
