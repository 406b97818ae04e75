"""Interface of a costmap for its layers and filters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from simkit_navigation.plugins.navigation.server_interface import Node

if TYPE_CHECKING:
    from simkit_navigation.plugins.costmaps.cost_grid import Cells
    from simkit_navigation.plugins.costmaps.footprint import Footprint


class CostmapNode(Node, Protocol):
    """Plugin of a costmap.

    Attributes:
        footprint: outline of the robot.
        inscribed_radius: largest radius around the robot's origin within its outline [m].
        default_cost: cost of unknown cells.
        lethal_cost_threshold: smallest occupancy of an obstacle in a map.
        map_costs: cost by occupancy of a map as an unsigned byte, shape (256,).
        uses_maximum: True if the map does not lower the costs of the layers before it.
        is_rolling: True if the costmap moves with the robot.
    """

    footprint: Footprint
    inscribed_radius: float
    default_cost: int
    lethal_cost_threshold: int
    map_costs: Cells
    uses_maximum: bool
    is_rolling: bool

    def report_once(self, cause: str, message: str) -> None:
        """Warn about a sensor, a mask or a parameter that cannot be used, once for each cause."""
