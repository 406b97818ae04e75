"""Path of straight lines in any direction, as Nav2's `nav2_theta_star_planner::ThetaStarPlanner`."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import Params
from simkit.extend import Options, boolean, integer, number
from simkit_navigation.plugins.costmaps.cost_grid import Cells, CostGrid, Mask
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose
from simkit_navigation.plugins.planners.grid_search import passable_cells, search
from simkit_navigation.plugins.planners.path_smoothing import facing_poses
from simkit_navigation.plugins.planners.planning_error import PlanningError, Reason

if TYPE_CHECKING:
    from simkit import Plugin

_LARGEST_COST: Final = 252.0  # of a cell that the robot may cross
_SCALE: Final = 2**20  # of costs as integers, whose sum has the same bits on every processor
_SAMPLES: Final = 3  # of a line for each cell
_MOST_CORNERS: Final = 48  # cells of the path at which a line may begin or end


class ThetaStarPlannerOptions(Options):
    """Options of `ThetaStarPlanner`."""

    how_many_corners: int = integer(8)
    allow_unknown: bool = boolean(True)
    w_euc_cost: float = number(1.0, minimum=0)
    w_traversal_cost: float = number(2.0, minimum=0)
    use_final_approach_orientation: bool = boolean(False)


class ThetaStarPlanner:
    """Finds a path of straight lines in any direction (`nav2_theta_star_planner::ThetaStarPlanner`).

    A line costs `<w_euc_cost>` for each cell of its length, and `<w_traversal_cost>`·((26 + 0.9·c)/252)² for each cell
    with the cost c that it crosses, as in Nav2. Theta* looks for the lines during the search. Here, A* finds the
    cheapest path of cells, of 8 or 4 neighbours (`<how_many_corners>`); then the cheapest lines of sight between its
    cells replace it.
    """

    def configure(self, node: Plugin, params: Params) -> None:
        """Read the parameters."""
        self._options = options = ThetaStarPlannerOptions(params).read_all()
        scaled = ((26.0 + 0.9 * cost) / _LARGEST_COST for cost in range(256))
        self._crossing = np.array([options.w_traversal_cost * part * part for part in scaled])

    def create_plan(self, grid: CostGrid, start: PlanarPose, goal: PlanarPose) -> Floats | list[list[float]]:
        """Return the poses from the start to the goal, shape (n, 3) [m, rad]; empty if there is no path.

        Raises:
            PlanningError: the goal is occupied.
        """
        options = self._options
        begin, end = grid.to_cell(start.x, start.y), grid.to_cell(goal.x, goal.y)
        if begin is None or end is None:
            return []
        passable = passable_cells(grid.cells, options.allow_unknown)
        passable[begin] = True  # there is the robot, so that there cannot be an obstacle
        if not passable[end]:
            raise PlanningError(Reason.GOAL_OCCUPIED, f"the goal ({goal.x:.4g}, {goal.y:.4g}) is occupied")
        weights = np.where(passable, options.w_euc_cost + self._crossing[grid.cells], math.inf)
        steps = 4 if options.how_many_corners == 4 else 8
        result = search(weights, begin, end, options.w_euc_cost, steps, at_end=True)
        if not result.reached[end]:
            return []
        path = result.path(end)
        for cells in (self._lines(grid.cells, passable, path), path):  # a line may touch the corner of a cell
            points = grid.centres(*cells.T)
            points[0], points[-1] = (start.x, start.y), (goal.x, goal.y)
            points = _interpolated(points, grid.resolution)
            if not grid.is_blocked(points).any():
                break
        yaw = None if options.use_final_approach_orientation and len(points) > 1 else goal.yaw
        return facing_poses(points, yaw)

    def _lines(self, cells: Cells, passable: Mask, path: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
        """Return the cells of a path at which lines of sight begin and end, with the least cost."""
        stride = -(-len(path) // _MOST_CORNERS)
        corners = path[np.append(np.arange(0, len(path) - 1, stride), len(path) - 1)]
        crossing = np.round(self._crossing * _SCALE).astype(np.int64)[cells]
        costs, before = [0.0], [-1]
        for index in range(1, len(corners)):
            ways = self._line_costs(crossing, passable, corners[:index], corners[index])
            totals = np.array(costs) + ways
            best = int(totals.argmin())
            costs.append(float(totals[best]))
            before.append(best)
        kept = [len(corners) - 1]
        while before[kept[-1]] >= 0:
            kept.append(before[kept[-1]])
        lines: npt.NDArray[np.int64] = corners[kept[::-1]]
        return lines

    def _line_costs(
        self, crossing: npt.NDArray[np.int64], passable: Mask, begins: npt.NDArray[np.int64], end: npt.NDArray[np.int64]
    ) -> Floats:
        """Return the costs of lines to a cell; infinite for a line through a blocked cell, but for a step."""
        ways = (end - begins).astype(np.float64)
        longest = np.abs(ways).max(axis=1)
        parts = np.arange(1, int(longest.max()) * _SAMPLES + 1) / _SAMPLES
        is_inside = parts <= longest[:, None]
        along = np.minimum(parts / np.maximum(longest[:, None], 1.0), 1.0)
        rows, columns = (
            np.floor(begins[:, None, axis] + 0.5 + along * ways[:, None, axis]).astype(np.int64) for axis in (0, 1)
        )
        is_blocked = (~passable[rows, columns] & is_inside).any(axis=1) & (longest > 1)
        crossed = np.where(is_inside, crossing[rows, columns], 0).sum(axis=1) / (_SCALE * _SAMPLES)
        lengths = np.sqrt(ways[:, 0] * ways[:, 0] + ways[:, 1] * ways[:, 1])
        return np.where(is_blocked, math.inf, self._options.w_euc_cost * lengths + crossed)


def _interpolated(points: Floats, distance: float) -> Floats:
    """Return points on the lines between points, at equal distances [m], and the last point."""
    parts = []
    for begin, end in itertools.pairwise(points):
        count = max(int(math.hypot(*(end - begin)) / distance), 1)
        parts.append(begin + (np.arange(count) / count)[:, None] * (end - begin))
    return np.concatenate((*parts, points[-1:]))
