"""Cost of the outline of a robot in a map."""

from __future__ import annotations

from math import cos, sin
from typing import Any, Final

from simkit_nodes.ros_modules.nav2_simple_commander.costmap_2d import PyCostmap2D
from simkit_nodes.ros_modules.nav2_simple_commander.line_iterator import LineIterator

__all__ = [
    "FREE_SPACE",
    "INSCRIBED_INFLATED_OBSTACLE",
    "LETHAL_OBSTACLE",
    "MAX_NON_OBSTACLE",
    "NO_INFORMATION",
    "FootprintCollisionChecker",
]

NO_INFORMATION: Final = 255
LETHAL_OBSTACLE: Final = 254
INSCRIBED_INFLATED_OBSTACLE: Final = 253
MAX_NON_OBSTACLE: Final = 252
FREE_SPACE: Final = 0


class FootprintCollisionChecker:
    """Checker of outlines in a map."""

    def __init__(self) -> None:
        self.costmap_: PyCostmap2D | None = None

    def setCostmap(self, costmap: PyCostmap2D) -> None:
        """Set the map."""
        self.costmap_ = costmap

    def _costmap(self) -> PyCostmap2D:
        if self.costmap_ is None:
            raise ValueError("Costmap not specified, use setCostmap to specify the costmap first")
        return self.costmap_

    def footprintCost(self, footprint: Any) -> float:
        """Return the largest cost on the edges of a `geometry_msgs.msg.Polygon` [m]; 254 for one outside the map."""
        corners = [self.worldToMapValidated(point.x, point.y) for point in footprint.points]
        if any(x is None for x, _ in corners):
            return LETHAL_OBSTACLE
        cost = 0.0
        for (x0, y0), (x1, y1) in zip(corners, [*corners[1:], corners[0]], strict=True):
            cost = max(float(self.lineCost(x0, x1, y0, y1)), cost)
            if cost == LETHAL_OBSTACLE:
                break
        return cost

    def lineCost(self, x0: Any, x1: Any, y0: Any, y1: Any, step_size: float = 0.5) -> Any:
        """Return the largest cost on a line between two cells."""
        cost: Any = 0.0
        line = LineIterator(x0, y0, x1, y1, step_size)
        while line.isValid():
            point_cost = self.pointCost(int(line.getX()), int(line.getY()))
            if point_cost == LETHAL_OBSTACLE:
                return point_cost
            cost = max(cost, point_cost)
            line.advance()
        return cost

    def worldToMapValidated(self, wx: float, wy: float) -> tuple[int, int] | tuple[None, None]:
        """Return column and row at a position [m]; None for both outside the map."""
        return self._costmap().worldToMapValidated(wx, wy)

    def pointCost(self, x: int, y: int) -> Any:
        """Return the cost of a cell."""
        return self._costmap().getCostXY(x, y)

    def footprintCostAtPose(self, x: float, y: float, theta: float, footprint: Any) -> float:
        """Return the largest cost of a `geometry_msgs.msg.Polygon` at a pose [m, rad]."""
        turned = type(footprint)()
        for point in footprint.points:
            corner = type(point)()
            corner.x = x + (point.x * cos(theta) - point.y * sin(theta))
            corner.y = y + (point.x * sin(theta) + point.y * cos(theta))
            turned.points.append(corner)
        return self.footprintCost(turned)
