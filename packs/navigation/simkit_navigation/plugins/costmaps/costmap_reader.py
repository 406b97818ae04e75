"""Plugin that receives a costmap from its topic."""

from __future__ import annotations

from typing import Final

from simkit import msgs
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid, grid_of_message, updated_grid
from simkit_navigation.plugins.navigation.node_parameters import NodeParameters

COSTMAP: Final = "nav2_msgs/msg/Costmap"
_UPDATE: Final = "nav2_msgs/msg/CostmapUpdate"


class CostmapReader(NodeParameters):
    """Plugin that receives a costmap.

    Attributes:
        grid: newest valid costmap; None before the first one.
    """

    grid: CostGrid | None

    def read_costmap(self, topic: str) -> None:
        """Receive the costmap of a topic, and its changes on the topic with the suffix `_updates`."""
        self.grid = None
        self.subscribe(topic, self._on_costmap)
        self.subscribe(f"{topic}_updates", self._on_update)

    def _on_costmap(self, message: msgs.Costmap) -> None:
        if not self._once.has_type(message, COSTMAP, "costmap_topic"):
            return
        grid = grid_of_message(message)
        if grid is None:
            text = "a costmap is ignored that is empty, or whose size, resolution or origin is not valid"
            self._once.left_out("costmap", text)
        else:
            self.grid = grid

    def _on_update(self, message: msgs.CostmapUpdate) -> None:
        if self.grid is None or not self._once.has_type(message, _UPDATE, "costmap_topic"):
            return
        grid = updated_grid(self.grid, message)
        if grid is None:
            self._once.left_out("costmap update", "a change of a costmap is ignored that does not fit into the costmap")
        else:
            self.grid = grid
