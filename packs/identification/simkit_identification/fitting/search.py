"""Search for the values with the smallest residuals: least squares for smooth costs, CMA-ES for noisy ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Final, Literal

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares
from scipy.stats import qmc

from simkit.errors import InputError
from simkit.install_command import install_command
from simkit_identification.fitting.derivatives import Differences, derivatives
from simkit_identification.fitting.evaluation import Evaluator, Point
from simkit_identification.fitting.residuals import Residuals

Floats = npt.NDArray[np.float64]
Method = Literal["auto", "least-squares", "cma"]
Loss = Literal["linear", "soft_l1"]
METHODS: Final = ("auto", "least-squares", "cma")
_TOLERANCE: Final = 3e-7  # of the scaled coordinates and of the cost
_MOST_STEPS: Final = 40  # of least squares
_MOST_GENERATIONS: Final = 60  # of CMA-ES
_SMALLEST_SPREAD: Final = 2e-3  # of CMA-ES, at which a search ends
_FAILED: Final = 10.0  # cost of a failed run over the largest cost of another run
_GRID: Final = 13  # points of a search along one coordinate
_NARROWER: Final = 0.3  # range of the next grid over that of the last


@dataclass
class Found:
    """Result of a search.

    Attributes:
        point: best point.
        cost: half the sum of squared weighted residuals there.
        has_converged: False if the search ended before its tolerance.
        message: reason of the end.
    """

    point: Floats
    cost: float
    has_converged: bool
    message: str


def cost_of(vector: Floats, loss: Loss) -> float:
    """Return half the sum of squared residuals, or of their robust losses."""
    squares = vector * vector
    if loss == "soft_l1":
        squares = 2.0 * (np.sqrt(1.0 + squares) - 1.0)
    return 0.5 * float(np.sum(squares))


def robust_factors(vector: Floats, loss: Loss) -> Floats:
    """Return the factors by which a robust loss reduces residuals and their derivatives."""
    if loss == "linear":
        return np.ones_like(vector)
    return np.asarray(1.0 / np.sqrt(np.sqrt(1.0 + vector * vector)), dtype=np.float64)


def first_points(evaluate: Evaluator, residuals: Residuals, loss: Loss, seed: int) -> tuple[Floats, float]:
    """Return the best of some points in the box of the parameters, and its cost; the first values are among them.

    Raises:
        InputError: SK-FIT-008 no run succeeds.
    """
    parameters = evaluate.parameters
    count = 6 * len(parameters)
    low, high = np.array([p.box() for p in parameters]).T
    samples = qmc.LatinHypercube(len(parameters), rng=np.random.default_rng(seed)).random(count)
    points: list[Point] = [np.zeros(len(parameters)), *(low + samples * (high - low))]
    costs = _costs(evaluate, residuals, points, loss)
    best = int(np.argmin(costs))
    return np.array(points[best], dtype=np.float64), costs[best]


def _costs(evaluate: Evaluator, residuals: Residuals, points: Sequence[Point], loss: Loss) -> list[float]:
    """Return the cost of each point; that of a failed run is above all others."""
    costs = [np.nan if readings is None else cost_of(residuals.vector(readings), loss) for readings in evaluate(points)]
    largest = np.nanmax(costs) if not np.all(np.isnan(costs)) else 1.0
    return [float(_FAILED * largest + 1.0) if np.isnan(cost) else float(cost) for cost in costs]


def search_least_squares(
    evaluate: Evaluator,
    residuals: Residuals,
    point: Point,
    differences: Differences,
    loss: Loss,
    on_step: Callable[[float], None],
) -> Found:
    """Search with SciPy's trust region, from derivatives by differences of runs."""
    low, high = np.array([p.limits() for p in evaluate.parameters]).T
    inside = np.clip(point, low + 1e-9 * (high - low), high - 1e-9 * (high - low))
    worst = 0.0

    def function(u: Floats) -> Floats:
        nonlocal worst
        (readings,) = evaluate([u])
        if readings is None:
            size = len(residuals.recorded)
            return np.full(size, np.sqrt(2.0 * _FAILED * (worst + 1.0) / max(size, 1)))
        vector = residuals.vector(readings)
        cost = cost_of(vector, loss)
        worst = max(worst, cost)
        on_step(cost)
        return vector

    def jacobian(u: Floats) -> Floats:
        _, slopes = derivatives(evaluate, u, differences, is_central=False)
        return residuals.jacobian(slopes)

    result = least_squares(
        function, inside, jac=jacobian, bounds=(low, high), method="trf", loss=loss,
        xtol=_TOLERANCE, ftol=_TOLERANCE, gtol=1e-12, max_nfev=_MOST_STEPS,
    )  # fmt: skip
    return Found(np.asarray(result.x), float(result.cost), result.status > 0, str(result.message))


def has_cma() -> bool:
    """Check whether the package `cmaes` is installed."""
    return find_spec("cmaes") is not None


def search_cma(
    evaluate: Evaluator,
    residuals: Residuals,
    point: Point,
    loss: Loss,
    seed: int,
    on_step: Callable[[float], None],
) -> Found:
    """Search without derivatives: CMA-ES, or a grid that becomes narrower for one parameter.

    Raises:
        InputError: SK-INPUT-004 the package `cmaes` is not installed.
    """
    if len(evaluate.parameters) == 1:
        return _search_grid(evaluate, residuals, point, loss, on_step)
    if not has_cma():
        text = "a search by CMA-ES needs cmaes, which is missing"
        raise InputError("SK-INPUT-004", text, help=install_command("fit"))
    limits = np.array([p.limits() for p in evaluate.parameters])
    boxes = np.array([p.box() for p in evaluate.parameters])
    optimiser: Any = import_module("cmaes").CMA(
        mean=np.array(point, dtype=np.float64), sigma=float(0.3 * np.min(boxes[:, 1] - boxes[:, 0])),
        bounds=limits, seed=seed,
    )  # fmt: skip
    best, lowest = np.array(point, dtype=np.float64), _costs(evaluate, residuals, [point], loss)[0]
    for _ in range(_MOST_GENERATIONS):
        points = [optimiser.ask() for _ in range(optimiser.population_size)]
        costs = _costs(evaluate, residuals, points, loss)
        optimiser.tell(list(zip(points, costs, strict=True)))
        if min(costs) < lowest:
            at = int(np.argmin(costs))
            best, lowest = np.array(points[at]), costs[at]
        on_step(lowest)
        spread = np.ptp(np.array(points), axis=0).max()
        if spread < _SMALLEST_SPREAD or optimiser.should_stop():
            return Found(best, lowest, True, "the points of CMA-ES are together")
    return Found(best, lowest, False, f"CMA-ES made {_MOST_GENERATIONS} generations")


def _search_grid(
    evaluate: Evaluator, residuals: Residuals, point: Point, loss: Loss, on_step: Callable[[float], None]
) -> Found:
    """Search one coordinate on a grid, then on narrower ones around the best point.

    The result is the minimum of a parabola through the costs of the last grid, because single costs are noisy.
    """
    parameter = evaluate.parameters[0]
    low, high = parameter.limits()
    begin, end = parameter.box()
    best, lowest = float(point[0]), _costs(evaluate, residuals, [point], loss)[0]
    while True:
        grid = np.linspace(begin, end, _GRID)
        costs = _costs(evaluate, residuals, [[u] for u in grid], loss)
        at = int(np.argmin(costs))
        if costs[at] < lowest:
            best, lowest = float(grid[at]), costs[at]
        on_step(lowest)
        is_edge = at in (0, _GRID - 1) and low < grid[at] < high
        half = 0.5 * (end - begin) * (1.0 if is_edge else _NARROWER)
        if half < 0.1:
            break
        begin, end = max(low, best - half), min(high, best + half)
    a, b, _ = np.polyfit(grid - best, costs, 2)
    vertex = best - b / (2.0 * a) if a > 0 else best
    vertex = float(np.clip(vertex, grid[0], grid[-1]))
    return Found(np.array([vertex]), _costs(evaluate, residuals, [[vertex]], loss)[0], True, "the grid is narrow")
