"""Layer that removes small groups of obstacles (`nav2_costmap_2d::DenoiseLayer`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from simkit import Params
from simkit.extend import Options, boolean, integer
from simkit_navigation.plugins.costmaps.cost_grid import FREE, INSCRIBED, UNKNOWN, CostGrid
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.costmaps.costmap_node import CostmapNode


class DenoiseLayerOptions(Options):
    """Options of `DenoiseLayer`."""

    enabled: bool = boolean(True)
    minimal_group_size: int = integer(2)
    group_connectivity_type: int = integer(8)


class DenoiseLayer:
    """Removes groups of obstacles with fewer cells than `<minimal_group_size>` (`nav2_costmap_2d::DenoiseLayer`).

    Cells of a group touch at their sides, or, if `<group_connectivity_type>` is 8, also at their corners. The layer
    changes the costs of the layers before it, so it comes before the inflation.
    """

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        self._options, self._node = DenoiseLayerOptions(params).read_all(), node
        if self._options.group_connectivity_type not in (4, 8):
            text = "group_connectivity_type: found %d; expected 4 or 8; 8 is used"
            node.report_once("group_connectivity_type", text % self._options.group_connectivity_type)

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Free the cells of small groups."""
        options = self._options
        if not options.enabled or options.minimal_group_size <= 1:
            return
        is_obstacle = grid.cells >= INSCRIBED
        if self._node.default_cost == UNKNOWN:  # else unknown cells count as obstacles, as in Nav2
            is_obstacle &= grid.cells != UNKNOWN
        if not is_obstacle.any():
            return
        import cv2

        connectivity = 4 if options.group_connectivity_type == 4 else 8
        count, labels = cv2.connectedComponents(is_obstacle.astype(np.uint8), connectivity=connectivity)
        sizes = np.bincount(labels.reshape(-1), minlength=count)
        is_small = sizes < options.minimal_group_size
        is_small[0] = False  # the cells without an obstacle
        grid.cells[is_small[labels]] = FREE

    def reset(self) -> None:
        """Keep nothing, because the layer has no memory."""
