"""Cost-aware A* on a costmap, as Nav2's `nav2_smac_planner::SmacPlanner2D`."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import Params
from simkit.extend import Options, block, boolean, integer, number
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid, Mask
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose
from simkit_navigation.plugins.planners.grid_search import Cell, Search, passable_cells, search
from simkit_navigation.plugins.planners.path_smoothing import Relaxation, facing_poses, relax
from simkit_navigation.plugins.planners.planning_error import PlanningError, Reason

if TYPE_CHECKING:
    from simkit import Plugin

_LARGEST_COST: Final = 252.0  # of a cell that the robot may cross
_NO_LIMIT: Final = 2**31 - 1
_LEAST_POINTS: Final = 12  # of a path that is smoothed, as in Nav2
_LEAST_TOLERANCE: Final = 0.001  # [cells]; below it, the goal itself must be free


class SmacSmootherOptions(Options):
    """Options of the smoother of `SmacPlanner2D`."""

    max_iterations: int = integer(1000, minimum=0)
    w_smooth: float = number(0.3, minimum=0)
    w_data: float = number(0.2, minimum=0)
    tolerance: float = number(1e-10, "m", minimum=0)
    do_refinement: bool = boolean(True)
    refinement_num: int = integer(2, minimum=0)


class SmacPlanner2DOptions(Options):
    """Options of `SmacPlanner2D`."""

    tolerance: float = number(0.125, "m", minimum=0)
    downsample_costmap: bool = boolean(False)
    downsampling_factor: int = integer(1, minimum=1)
    allow_unknown: bool = boolean(True)
    max_iterations: int = integer(1_000_000)
    max_on_approach_iterations: int = integer(1000)
    cost_travel_multiplier: float = number(1.0, minimum=0)
    use_final_approach_orientation: bool = boolean(False)
    smoother: SmacSmootherOptions = block(SmacSmootherOptions)


class SmacPlanner2D:
    """Finds the cheapest path by A* on the cells (`nav2_smac_planner::SmacPlanner2D`), and smooths it.

    A step into a cell with the cost c weighs its length times 1 + `<cost_travel_multiplier>`·c/252. The search ends
    after `<max_iterations>` cells. Once it is within `<tolerance>` of the goal, it ends after
    `<max_on_approach_iterations>` cells at the nearest one. A limit of 0 is none.

    Attributes:
        visited_cells: number of cells that the newest search took from its queue before its end.
    """

    visited_cells = 0

    def configure(self, node: Plugin, params: Params) -> None:
        """Read the parameters."""
        self._options = options = SmacPlanner2DOptions(params).read_all()
        smoother = options.smoother.read_all()
        refinements = smoother.refinement_num if smoother.do_refinement else 0
        self._relaxation = Relaxation(
            smoother.w_data, smoother.w_smooth, smoother.tolerance, smoother.max_iterations, refinements
        )

    def create_plan(self, grid: CostGrid, start: PlanarPose, goal: PlanarPose) -> Floats:
        """Return the poses from the start to the goal, shape (n, 3) [m, rad].

        Raises:
            PlanningError: there is no path.
        """
        options = self._options
        coarse = _downsampled(grid, options.downsampling_factor) if options.downsample_costmap else grid
        begin, end = coarse.to_cell(start.x, start.y), coarse.to_cell(goal.x, goal.y)
        if begin is None or end is None:
            reason = Reason.START_OUTSIDE_MAP if begin is None else Reason.GOAL_OUTSIDE_MAP
            raise PlanningError(reason, "start or goal is outside of the costmap")
        passable = passable_cells(coarse.cells, options.allow_unknown)
        tolerance = options.tolerance / coarse.resolution
        if tolerance < _LEAST_TOLERANCE and not passable[end]:
            raise PlanningError(Reason.GOAL_OCCUPIED, f"the goal ({goal.x:.4g}, {goal.y:.4g}) is occupied")
        passable[begin] = True  # there is the robot, so that there cannot be an obstacle
        weights = np.where(passable, 1.0 + options.cost_travel_multiplier * (coarse.cells / _LARGEST_COST), math.inf)
        result = search(weights, begin, end, 1.0, at_end=True)
        last = self._last_cell(result, end, tolerance)
        self.visited_cells = result.visited(last)
        points = coarse.centres(*result.path(last).T)
        points[0] = start.x, start.y
        if last == end:
            points[-1] = goal.x, goal.y
        if len(points) >= _LEAST_POINTS and options.smoother.max_iterations:
            points = relax(points, coarse, self._relaxation)
        yaw = None if options.use_final_approach_orientation and len(points) > 1 else goal.yaw
        return facing_poses(points, yaw)

    def _last_cell(self, found: Search, end: Cell, tolerance: float) -> Cell:
        """Return the cell at which A* ends: the goal, or the nearest cell within the tolerance [cells].

        Raises:
            PlanningError: there is none.
        """
        options, costs = self._options, found.costs
        most = options.max_iterations if options.max_iterations > 0 else _NO_LIMIT
        most_near = options.max_on_approach_iterations if options.max_on_approach_iterations > 0 else _NO_LIMIT
        rows, columns = np.indices(costs.shape)
        squares: npt.NDArray[np.int64] = np.asarray((rows - end[0]) ** 2 + (columns - end[1]) ** 2)
        is_near = (squares < tolerance**2) & found.reached
        limit = most
        if is_near.any():
            limit = min(most, int((costs < costs[is_near].min()).sum()) + most_near)
        if found.reached[end] and found.visited(end) < limit:
            return end
        near = np.argwhere(is_near & _first_cells(costs, limit))
        if len(near):
            row, column = min(near.tolist(), key=lambda cell: (int(squares[*cell]), float(costs[*cell])))
            return row, column
        count = int(found.reached.sum())
        if count == 1:
            raise PlanningError(Reason.START_OCCUPIED, "the start is surrounded by occupied cells")
        if count > most:
            text = f"the search ends after max_iterations = {most} cells"
            raise PlanningError(Reason.TIMEOUT, text)
        raise PlanningError(Reason.NO_VALID_PATH, "there is no path to the goal")


def _first_cells(costs: Floats, count: int) -> Mask:
    """Return the cells that a search has taken from its queue after a number of iterations."""
    if count >= costs.size:
        return np.isfinite(costs)
    largest = float(np.partition(costs, count, axis=None)[count])
    first: Mask = costs < largest
    return first


def _downsampled(grid: CostGrid, factor: int) -> CostGrid:
    """Return a grid with fewer cells; each one has the largest cost of the cells that it replaces."""
    if factor <= 1:
        return grid
    rows, columns = grid.cells.shape
    padded = np.pad(grid.cells, ((0, -rows % factor), (0, -columns % factor)))
    blocks = padded.reshape(padded.shape[0] // factor, factor, padded.shape[1] // factor, factor)
    return replace(grid, cells=blocks.max(axis=(1, 3)), resolution=grid.resolution * factor)
