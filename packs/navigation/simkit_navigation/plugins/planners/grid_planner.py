"""Cheapest path on a costmap, as Nav2's `nav2_navfn_planner::NavfnPlanner`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.extend import Options, boolean, number
from simkit_navigation.plugins.costmaps.cost_grid import LETHAL, UNKNOWN, CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose
from simkit_navigation.plugins.planners.grid_search import nearest_cell, passable_cells, search
from simkit_navigation.plugins.planners.path_smoothing import facing_poses
from simkit_navigation.plugins.planners.planning_error import PlanningError, Reason

if TYPE_CHECKING:
    from simkit import Plugin

_NEUTRAL: Final = 50.0  # weight of a free cell
_FACTOR: Final = 0.8  # weight of a cost; both as in NavFn
_CLEARED: Final = 6  # cells around a blocked start, within which the path may begin
_SMOOTHING: Final = 60  # iterations
_REPAIRS: Final = 20  # repetitions of the check
_KEPT: Final = 0.05  # weight of the original point in a smoothed one


class GridPlannerOptions(Options):
    """Options of `GridPlanner`."""

    tolerance: float = number(0.5, "m", minimum=0)
    use_astar: bool = boolean(False)
    allow_unknown: bool = boolean(True)
    use_final_approach_orientation: bool = boolean(False)


class GridPlanner:
    """Finds the path with the smallest sum of length times weight (`nav2_navfn_planner::NavfnPlanner`).

    A cell with the cost c weighs 50 + 0.8·c, as in NavFn. A path goes between the centres of the eight neighbours of a
    cell, and never through a cell within the inscribed radius of an obstacle. It is then smoothed. A* finds a path of
    the same weight as Dijkstra's algorithm, and visits fewer cells.

    Attributes:
        visited_cells: number of cells that the newest search took from its queue before the goal.
    """

    visited_cells = 0

    def configure(self, node: Plugin, params: Params) -> None:
        """Read the parameters."""
        self._options = GridPlannerOptions(params).read_all()

    def create_plan(self, grid: CostGrid, start: PlanarPose, goal: PlanarPose) -> Floats | list[list[float]]:
        """Return the poses from the start to the goal, shape (n, 3) [m, rad]; empty if there is no path.

        If the goal is occupied, the path ends at the nearest reachable cell within `<tolerance>` [m].

        Raises:
            PlanningError: there is no path.
        """
        options, passable = self._options, passable_cells(grid.cells, self._options.allow_unknown)
        begin, end = grid.to_cell(start.x, start.y), grid.to_cell(goal.x, goal.y)
        if begin is None or end is None:
            return []
        if not options.tolerance and grid.cells[end] == LETHAL:
            raise PlanningError(Reason.GOAL_OCCUPIED, f"the goal ({goal.x:.4g}, {goal.y:.4g}) is occupied")
        free = begin if passable[begin] else nearest_cell(grid, passable, start, grid.resolution * _CLEARED)
        if free is None:
            raise PlanningError(Reason.START_OCCUPIED, f"the start ({start.x:.4g}, {start.y:.4g}) is occupied")
        weights = np.where(passable, _NEUTRAL + _FACTOR * np.where(grid.cells == UNKNOWN, 0, grid.cells), math.inf)
        result = search(weights, free, end if options.use_astar else None, _NEUTRAL)
        reached = result.reached
        last = end if reached[end] else nearest_cell(grid, reached, goal, options.tolerance)
        if last is None:
            return []
        self.visited_cells = result.visited(last)
        points = grid.centres(*result.path(last).T)
        points[0] = start.x, start.y
        if last == end:
            points[-1] = goal.x, goal.y
        yaw = None if options.use_final_approach_orientation and len(points) > 1 else goal.yaw
        return facing_poses(_smooth(points, grid), yaw)


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
