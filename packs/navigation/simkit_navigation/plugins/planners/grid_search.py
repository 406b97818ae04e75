"""Search of the cheapest path on a grid, with Dijkstra's algorithm or A*, by SciPy's compiled graph search."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit_navigation.plugins.costmaps.cost_grid import INSCRIBED, UNKNOWN, Cells, CostGrid, Mask
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

Cell = tuple[int, int]
"""Row and column of a cell."""

_STEPS: Final = (
    (0, 1),
    (0, -1),
    (1, 0),
    (-1, 0),
    (1, 1),
    (1, -1),
    (-1, 1),
    (-1, -1),
)  # (up, right), straight ones first
_STRAIGHT: Final = 4
_DETOUR: Final = 0.25  # part of the straight way's cost by which a path may be dearer before A* searches everything
_SAME: Final = 1e-12  # relative difference of two costs that are the same but for rounding errors
_LEAST_STEP: Final = 1e-9  # relative cost of a step that is no rounding error
_FINITE: Final = 1e300  # an edge into a blocked cell has an infinite cost, and lies beyond this limit


@dataclass(frozen=True, eq=False)
class Search:
    """Result of a search from one cell.

    Attributes:
        begin: cell of the start.
        costs: cost of the cheapest path to each cell; infinite for a cell that was not reached, shape (rows, columns).
            A* adds the heuristic of the cell and subtracts that of the start.
        steps: costs of the steps from each cell of a grid with a border, shape (rows + 2, columns + 2, steps).
        before: index of the cell before each cell in that grid, or below 0.
    """

    begin: Cell
    costs: Floats
    steps: Floats
    before: npt.NDArray[np.int32]

    @property
    def reached(self) -> Mask:
        """Cells to which there is a path."""
        result: Mask = np.isfinite(self.costs)
        return result

    def visited(self, end: Cell) -> int:
        """Return the number of cells that the search takes from its queue before a cell."""
        return int((self.costs < self.costs[end]).sum())

    def path(self, end: Cell) -> npt.NDArray[np.int64]:
        """Return rows and columns of the cells from the start to a cell, shape (n, 2).

        A grid has many paths with the same cost. The one that stays near the straight line is returned.
        """
        (row, column), (first_row, first_column) = end, self.begin
        across, along = row - first_row, column - first_column
        cells = [end]
        while (row, column) != self.begin and len(cells) <= self.costs.size:
            places = [
                (abs((up + row - first_row) * along - (right + column - first_column) * across), up, right)
                for up, right in self._cheapest_steps(row, column)
            ]
            _, up, right = min(places)
            row, column = row + up, column + right
            cells.append((row, column))
        return np.array(cells[::-1], np.int64)

    def _cheapest_steps(self, row: int, column: int) -> list[Cell]:
        """Return the steps from a cell to the cells that may come before it in a cheapest path."""
        width = self.costs.shape[1] + 2
        known = divmod(int(self.before[(row + 1) * width + column + 1]), width)
        present, cheapest = float(self.costs[row, column]), [(known[0] - 1 - row, known[1] - 1 - column)]
        for index, (up, right) in enumerate(_STEPS[: self.steps.shape[2]]):
            there = row - up, column - right
            if 0 <= there[0] < self.costs.shape[0] and 0 <= there[1] < self.costs.shape[1]:
                cost, step = float(self.costs[there]), float(self.steps[there[0] + 1, there[1] + 1, index])
                # a step that costs nothing may lead around in a circle
                if step > _LEAST_STEP * present and cost + step <= present + _SAME * present:
                    cheapest.append((-up, -right))
        return cheapest


def passable_cells(cells: Cells, allow_unknown: bool) -> Mask:
    """Return the cells that the centre of the robot may cross."""
    passable: Mask = np.where(cells == UNKNOWN, allow_unknown, cells < INSCRIBED).astype(bool)
    return passable


def search(
    weights: Floats, begin: Cell, end: Cell | None = None, least: float = 0.0, steps: int = 8, at_end: bool = False
) -> Search:
    """Search the cheapest paths from a cell.

    A step costs its length [cells] times the mean weight of both cells. A diagonal step must not cut the corner of a
    blocked cell. With a cell `end`, the search is A* with the straight distance times `least` as heuristic: the same
    search with the cost of each step changed by the difference of the heuristic, which ends soon after `end`.

    Args:
        weights: cost of a way of one cell's side; infinite for a blocked cell, shape (rows, columns).
        begin: row and column of the start.
        end: row and column of the end; None for Dijkstra's algorithm.
        least: least weight of a cell; the heuristic must not be larger than the true cost.
        steps: number of neighbours of a cell, 4 or 8.
        at_end: take the weight of the cell at the end of a step in place of the mean.
    """
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import dijkstra

    rows, columns = weights.shape
    size = (rows + 2) * (columns + 2)
    neighbours, starts = _edges(rows, columns, steps)
    heuristic = None if end is None else _heuristic(weights.shape, end, least)
    costs = _edge_costs(weights, steps, at_end, heuristic)
    limits = (_FINITE,) if heuristic is None else (_DETOUR * float(heuristic[begin]), _FINITE)
    graph = csr_matrix((costs.reshape(-1), neighbours, starts), (size, size))
    first = (begin[0] + 1) * (columns + 2) + begin[1] + 1
    for limit in limits:
        costs_to, before = dijkstra(graph, indices=first, return_predecessors=True, limit=limit)
        inner = costs_to.reshape(rows + 2, columns + 2)[1:-1, 1:-1]
        if end is None or np.isfinite(inner[end]):
            break
    return Search(begin, inner, costs, before)


@lru_cache(maxsize=2)
def _edges(rows: int, columns: int, steps: int) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """Return the neighbours of all cells of a grid with a border of one cell, and where those of each cell begin."""
    width, size = columns + 2, (rows + 2) * (columns + 2)
    offsets = np.array([up * width + right for up, right in _STEPS[:steps]], np.int64)
    neighbours = (np.arange(size)[:, None] + offsets) % size  # those of the border are blocked, whichever they are
    return neighbours.reshape(-1).astype(np.int32), np.arange(0, size * steps + 1, steps, dtype=np.int32)


def _edge_costs(weights: Floats, steps: int, at_end: bool, heuristic: Floats | None) -> Floats:
    """Return the costs of the steps from each cell of a grid with a border, shape (rows + 2, columns + 2, steps)."""
    rows, columns = weights.shape
    wide = np.full((rows + 4, columns + 4), math.inf)
    wide[2:-2, 2:-2] = weights
    block = np.where(np.isinf(wide), math.inf, 0.0)
    here = wide[1:-1, 1:-1]
    heights = None if heuristic is None else np.pad(heuristic, 2)
    costs = np.empty((rows + 2, columns + 2, steps))
    for index, (up, right) in enumerate(_STEPS[:steps]):
        there = _shifted(wide, up, right)
        cost = there + _shifted(block, 0, 0) if at_end else (here + there) * 0.5
        if index >= _STRAIGHT:
            cost = cost * math.sqrt(2.0) + _shifted(block, up, 0) + _shifted(block, 0, right)
        if heights is not None:
            cost += _shifted(heights, up, right) - _shifted(heights, 0, 0)
            np.maximum(cost, 0.0, out=cost)  # a rounding error below 0
        costs[:, :, index] = cost
    return costs


def _shifted(wide: Floats, up: int, right: int) -> Floats:
    """Return the part of an array with a border that is shifted by one step, without the border."""
    rows, columns = wide.shape
    return wide[1 + up : rows - 1 + up, 1 + right : columns - 1 + right]


def _heuristic(shape: tuple[int, int], end: Cell, least: float) -> Floats:
    """Return the least cost of the way from each cell to a cell, shape (rows, columns)."""
    rows, columns = np.arange(shape[0]) - end[0], np.arange(shape[1]) - end[1]
    straight: Floats = np.sqrt((rows * rows)[:, None] + columns * columns) * least
    return straight


def nearest_cell(grid: CostGrid, allowed: Mask, pose: PlanarPose, reach: float) -> Cell | None:
    """Return the allowed cell that is nearest to a pose, within a distance [m]; None if there is none."""
    cell = grid.to_cell(pose.x, pose.y)
    if cell is None:
        return None
    span = math.ceil(min(reach / grid.resolution, max(allowed.shape))) + 1
    low, left = max(cell[0] - span, 0), max(cell[1] - span, 0)
    rows, columns = np.nonzero(allowed[low : cell[0] + span + 1, left : cell[1] + span + 1])
    if not len(rows):
        return None
    distances = np.hypot(*(grid.centres(rows + low, columns + left) - (pose.x, pose.y)).T)
    best = int(distances.argmin())
    is_near = distances[best] <= reach + grid.resolution
    return (int(rows[best]) + low, int(columns[best]) + left) if is_near else None
