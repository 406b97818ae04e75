"""Straight line to the goal, as the planner of Nav2's tutorial, `nav2_straightline_planner`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from simkit import Params
from simkit.extend import Options, number
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit import Plugin


class StraightLineOptions(Options):
    """Options of `StraightLine`."""

    interpolation_resolution: float = number(0.1, "m", minimum=1e-3)


class StraightLine:
    """Plans the straight line to the goal and ignores obstacles (`nav2_straightline_planner::StraightLine`).

    All poses but the last one have the yaw 0, as those of the tutorial.
    """

    def configure(self, node: Plugin, params: Params) -> None:
        """Read the parameters."""
        self._step = StraightLineOptions(params).read_all().interpolation_resolution

    def create_plan(self, grid: CostGrid, start: PlanarPose, goal: PlanarPose) -> Floats:
        """Return poses at equal distances from the start to the goal, shape (n, 3) [m, rad]."""
        count = int(math.hypot(goal.x - start.x, goal.y - start.y) / self._step)
        parts = np.arange(count) / max(count, 1)
        x, y = start.x + parts * (goal.x - start.x), start.y + parts * (goal.y - start.y)
        return np.concatenate((np.column_stack((x, y, np.zeros(count))), [goal]))
