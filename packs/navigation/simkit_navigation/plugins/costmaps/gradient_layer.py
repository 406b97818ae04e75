"""Costs that decrease along the rows of a costmap, as the layer of Nav2's tutorial, `nav2_gradient_costmap_plugin`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.extend import Options, boolean
from simkit_navigation.plugins.costmaps.cost_grid import LETHAL, CostGrid
from simkit_navigation.plugins.costmaps.update_window import Bounds, Window
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.costmaps.costmap_node import CostmapNode

_STEP: Final = 10  # GRADIENT_FACTOR of the tutorial
_PERIOD: Final = 22  # cells after which the costs repeat: GRADIENT_SIZE + 2 of the tutorial


class GradientLayerOptions(Options):
    """Options of `GradientLayer`."""

    enabled: bool = boolean(True)


class GradientLayer:
    """Overwrites all costs by a pattern of steps (`nav2_gradient_costmap_plugin::GradientLayer`).

    From the left edge of the window on, the costs of a row are 254, 244, … 44, and again.
    """

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        """Read the parameters."""
        GradientLayerOptions(params).read_all()
        self._last: Bounds | None = None

    def update_bounds(self, robot: PlanarPose, bounds: Bounds) -> None:
        """Include the bounds of the update before this one; the first update covers everything."""
        present = bounds.copy()
        if self._last is None:
            bounds.include_everything()
        else:
            bounds.include(self._last)
        self._last = present

    def update_costs(self, grid: CostGrid, window: Window) -> None:
        """Write the pattern inside the window."""
        costs = LETHAL - _STEP * (np.arange(window.max_i - window.min_i) % _PERIOD)
        grid.cells[window.rows, window.columns] = costs.astype(np.uint8)

    def reset(self) -> None:
        """Cover everything in the next update."""
        self._last = None
