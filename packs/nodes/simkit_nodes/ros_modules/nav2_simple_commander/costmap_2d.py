"""Costs of the cells of a map."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["PyCostmap2D"]


class PyCostmap2D:
    """Map with a cost for each cell.

    Args:
        occupancy_map: `nav_msgs.msg.OccupancyGrid`; -1 becomes 255.
    """

    def __init__(self, occupancy_map: Any) -> None:
        info = occupancy_map.info
        self.size_x, self.size_y, self.resolution = info.width, info.height, info.resolution
        self.origin_x, self.origin_y = info.origin.position.x, info.origin.position.y
        self.global_frame_id, self.costmap_timestamp = occupancy_map.header.frame_id, occupancy_map.header.stamp
        self.costmap = np.asarray(occupancy_map.data).astype(np.uint8)

    def getSizeInCellsX(self) -> int:
        """Return the number of columns."""
        return int(self.size_x)

    def getSizeInCellsY(self) -> int:
        """Return the number of rows."""
        return int(self.size_y)

    def getSizeInMetersX(self) -> float:
        """Return the distance between the left edge and the centre of the last column [m]."""
        return float((self.size_x - 1 + 0.5) * self.resolution)

    def getSizeInMetersY(self) -> float:
        """Return the distance between the lower edge and the centre of the last row [m]."""
        return float((self.size_y - 1 + 0.5) * self.resolution)

    def getOriginX(self) -> float:
        """Return x of the lower left corner [m]."""
        return float(self.origin_x)

    def getOriginY(self) -> float:
        """Return y of the lower left corner [m]."""
        return float(self.origin_y)

    def getResolution(self) -> float:
        """Return the edge of a cell [m]."""
        return float(self.resolution)

    def getGlobalFrameID(self) -> str:
        """Return the frame of the map."""
        return str(self.global_frame_id)

    def getCostmapTimestamp(self) -> Any:
        """Return the stamp of the map."""
        return self.costmap_timestamp

    def getCostXY(self, mx: int, my: int) -> Any:
        """Return the cost of a cell by its column and row."""
        return self.costmap[self.getIndex(mx, my)]

    def getCostIdx(self, index: int) -> Any:
        """Return the cost of a cell by its number."""
        return self.costmap[index]

    def setCost(self, mx: int, my: int, cost: Any) -> None:
        """Set the cost of a cell."""
        self.costmap[self.getIndex(mx, my)] = cost

    def mapToWorld(self, mx: int, my: int) -> tuple[float, float]:
        """Return the centre of a cell [m]."""
        return self.origin_x + (mx + 0.5) * self.resolution, self.origin_y + (my + 0.5) * self.resolution

    def worldToMapValidated(self, wx: float, wy: float) -> tuple[int, int] | tuple[None, None]:
        """Return column and row at a position [m]; None for both outside the map."""
        if wx < self.origin_x or wy < self.origin_y:
            return None, None
        mx, my = int((wx - self.origin_x) // self.resolution), int((wy - self.origin_y) // self.resolution)
        return (mx, my) if mx < self.size_x and my < self.size_y else (None, None)

    def getIndex(self, mx: int, my: int) -> int:
        """Return the number of a cell."""
        return int(my * self.size_x + mx)
