"""Shortest path on a costmap, as Nav2's `nav2_navfn_planner::NavfnPlanner` with Dijkstra's algorithm."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import Params
from simkit.extend import Options, boolean, number
from simkit_navigation.plugins.navigation.cost_grid import INSCRIBED, UNKNOWN, Cells, CostGrid, Mask
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit import Plugin

_NEUTRAL: Final = 50.0  # weight of a free cell
_FACTOR: Final = 0.8  # weight of a cost; both as in NavFn
_STEPS: Final = ((0, 1), (1, 0), (1, 1), (1, -1))  # to half of the eight neighbours; the others are their reverse
_SMOOTHING: Final = 60  # iterations
_REPAIRS: Final = 20  # repetitions of the check
_KEPT: Final = 0.05  # weight of the original point in a smoothed one


class GridPlannerOptions(Options):
    """Options of `GridPlanner`."""

    tolerance: float = number(0.5, "m", minimum=0)
    allow_unknown: bool = boolean(True)


class GridPlanner:
    """Finds the path with the smallest sum of length times weight (`nav2_navfn_planner::NavfnPlanner`).

    A cell with the cost c weighs 50 + 0.8·c, as in NavFn. A path goes between the centres of the eight neighbours of a
    cell, and never through a cell within the inscribed radius of an obstacle. It is then smoothed.
    """

    def configure(self, node: Plugin, params: Params) -> None:
        """Read the parameters."""
        self._options = GridPlannerOptions(params).read_all()

    def create_plan(self, grid: CostGrid, start: PlanarPose, goal: PlanarPose) -> list[list[float]]:
        """Return x and y of poses from the start to the goal [m]; empty if there is no path.

        If the goal is occupied, the path ends at the nearest reachable cell within `<tolerance>` [m].
        """
        limit = np.where(grid.cells == UNKNOWN, not self._options.allow_unknown, grid.cells >= INSCRIBED)
        passable = ~limit
        begin, end = grid.to_cell(start.x, start.y), grid.to_cell(goal.x, goal.y)
        if begin is None or end is None:
            return []
        begin = _nearest(grid, passable, start, grid.resolution * 6) if not passable[begin] else begin
        if begin is None:
            return []
        number_of = np.full(passable.shape, -1, np.int32)
        number_of[passable] = np.arange(int(passable.sum()), dtype=np.int32)
        distances, before = _search(grid.cells, number_of, int(number_of[begin]))
        reachable = np.zeros(passable.shape, bool)
        reachable[passable] = np.isfinite(distances)
        is_exact = bool(reachable[end])
        last = end if is_exact else _nearest(grid, reachable, goal, self._options.tolerance)
        if last is None:
            return []
        cells = [int(number_of[last])]
        while before[cells[-1]] >= 0:
            cells.append(int(before[cells[-1]]))
        rows, columns = np.nonzero(passable)
        points = grid.centres(rows[cells[::-1]], columns[cells[::-1]])
        points[0] = start.x, start.y
        if is_exact:
            points[-1] = goal.x, goal.y
        plan: list[list[float]] = _smooth(points, grid).tolist()
        return plan


def _nearest(grid: CostGrid, allowed: Mask, pose: PlanarPose, reach: float) -> tuple[int, int] | None:
    """Return the allowed cell that is nearest to a pose, within a distance [m]; None if there is none."""
    rows, columns = np.nonzero(allowed)
    if not len(rows):
        return None
    distances = np.hypot(*(grid.centres(rows, columns) - (pose.x, pose.y)).T)
    best = int(distances.argmin())
    return (int(rows[best]), int(columns[best])) if distances[best] <= reach + grid.resolution else None


def _search(cells: Cells, number_of: npt.NDArray[np.int32], begin: int) -> tuple[Floats, npt.NDArray[np.int32]]:
    """Return the weighted distance of each passable cell from one of them, and the cell before it (or below 0)."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import dijkstra

    weights = _NEUTRAL + _FACTOR * np.where(cells == UNKNOWN, 0, cells)
    (rows, columns), firsts, seconds, lengths = cells.shape, [], [], []
    for up, right in _STEPS:
        here = slice(0, rows - up), slice(max(-right, 0), columns - max(right, 0))
        other = slice(up, rows), slice(max(right, 0), columns - max(-right, 0))
        both = (number_of[here] >= 0) & (number_of[other] >= 0)
        if up and right:  # a diagonal step must not cut the corner of an obstacle
            both &= (number_of[here[0], other[1]] >= 0) & (number_of[other[0], here[1]] >= 0)
        firsts.append(number_of[here][both])
        seconds.append(number_of[other][both])
        lengths.append((weights[here][both] + weights[other][both]) * (0.5 * np.hypot(up, right)))
    count = int(number_of.max()) + 1
    pairs = np.concatenate(firsts), np.concatenate(seconds)
    graph = csr_matrix((np.concatenate(lengths), pairs), (count, count))
    distances, before = dijkstra(graph, directed=False, indices=begin, return_predecessors=True)
    return distances, before


def _smooth(points: Floats, grid: CostGrid) -> Floats:
    """Return a path without the corners of the grid; where it would touch an obstacle, it keeps its points."""
    smooth = points.copy()
    for _ in range(_SMOOTHING):
        middle = (smooth[:-2] + smooth[2:]) / 2
        smooth[1:-1] = (1.0 - _KEPT) * (smooth[1:-1] + middle) / 2 + _KEPT * points[1:-1]
    for _ in range(_REPAIRS):
        middle = (smooth[:-1] + smooth[1:]) / 2
        bad = np.flatnonzero(grid.is_blocked(middle) | grid.is_blocked(smooth[:-1]) | grid.is_blocked(smooth[1:]))
        if not len(bad):
            return smooth
        smooth[bad], smooth[bad + 1] = points[bad], points[bad + 1]
    return points
