"""Layers of a costmap: the static map, and the inflation around obstacles; and the table of all layers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from simkit import Params, msgs
from simkit.elementary_functions import exp
from simkit.extend import Options, boolean, number, text
from simkit_navigation.plugins.costmaps.cost_grid import (
    FREE,
    INSCRIBED,
    LETHAL,
    UNKNOWN,
    Cells,
    CostGrid,
    Mask,
    grid_of_map,
)
from simkit_navigation.plugins.costmaps.costmap_filters import BinaryFilter, KeepoutFilter, SpeedFilter
from simkit_navigation.plugins.costmaps.denoise_layer import DenoiseLayer
from simkit_navigation.plugins.costmaps.footprint import cells_within
from simkit_navigation.plugins.costmaps.obstacle_layer import ObstacleLayer
from simkit_navigation.plugins.costmaps.range_sensor_layer import RangeSensorLayer
from simkit_navigation.plugins.costmaps.voxel_layer import VoxelLayer
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, look_up

if TYPE_CHECKING:
    from simkit_navigation.plugins.costmaps.costmap_node import CostmapNode

_MAP: Final = "nav_msgs/msg/OccupancyGrid"
_UPDATE: Final = "map_msgs/msg/OccupancyGridUpdate"
_OVERLAP: Final = 1e-6  # [m]; a radius of 0.2 contains a cell at the distance of 4 cells of 0.05


class CostmapLayer(Protocol):
    """Layer of a costmap; a class of a user needs only `update_costs`."""

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        """Read the parameters of the layer, and subscribe with `node.subscribe`; called once.

        Args:
            node: plugin of the costmap.
            params: block of parameters with the name of the layer.
        """

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Write costs to `grid.cells`, which contains the costs of the layers before this one.

        Args:
            grid: costs.
            robot: pose of the robot in the frame of the grid.
        """

    def reset(self) -> None:
        """Forget what the layer has seen; called by the services that clear the costmap."""


class StaticLayerOptions(Options):
    """Options of `StaticLayer`."""

    map_topic: str = text("/map")
    enabled: bool = boolean(True)
    map_subscribe_transient_local: bool = boolean(True)
    subscribe_to_updates: bool = boolean(False)
    transform_tolerance: float = number(0.0, "s", minimum=0)
    footprint_clearing_enabled: bool = boolean(False)


class StaticLayer:
    """Obstacles of the map (`nav2_costmap_2d::StaticLayer`)."""

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        self._options, self._node = StaticLayerOptions(params).read_all(), node
        self.map: CostGrid | None = None
        self._has_reported = False
        self._is_subscribing = self._options.enabled
        if self._options.enabled:
            topic = self._options.map_topic
            node.receive(topic, _MAP, "map_topic", self._on_map)
            if self._options.subscribe_to_updates:
                node.receive(f"{topic}_updates", _UPDATE, "map_topic", self._on_update)
        self._is_subscribing = False

    def _on_map(self, message: msgs.OccupancyGrid) -> None:
        if self._is_subscribing and not self._options.map_subscribe_transient_local:
            return  # a volatile subscription of ROS does not receive what was published before it
        grid = grid_of_map(message, self._node.map_costs)
        if grid is None:
            if not self._has_reported:
                text = "the map on %s is empty, or its size, resolution or origin is not valid"
                self._node.log.error(text, self._options.map_topic)
            self._has_reported = True
            return
        self.map = grid

    def _on_update(self, message: msgs.OccupancyGridUpdate) -> None:
        """Replace a rectangle of the map."""
        grid, data = self.map, np.asarray(message.data, np.int8)
        if grid is None:
            return
        rows, columns = grid.cells.shape
        fits = 0 <= message.y <= rows - message.height and 0 <= message.x <= columns - message.width
        if not fits or data.size != message.width * message.height or message.header.frame_id != grid.frame:
            text = "an update of the map on %s is ignored: it is outside of the map, or has another frame or size"
            self._node.report_once("map update", text % self._options.map_topic)
            return
        costs = self._node.map_costs[data.view(np.uint8)].reshape(message.height, message.width)
        grid.cells[message.y : message.y + message.height, message.x : message.x + message.width] = costs

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Write the costs of the map."""
        if self.map is None:
            return
        if self._options.footprint_clearing_enabled:
            placed = look_up(self._node.sim, self.map.frame, grid.frame)
            if placed is not None:
                self.map.cells[cells_within(self.map, self._node.footprint, placed.compose(robot))] = FREE
        if grid.frame == self.map.frame and grid.origin == self.map.origin and grid.cells.shape == self.map.cells.shape:
            self._write(grid, self.map.cells, np.True_)
            return
        placed = look_up(self._node.sim, grid.frame, self.map.frame)
        if placed is not None:
            rows, columns = np.indices(grid.cells.shape).reshape(2, -1)
            moved = self.map.seen_from(grid.frame, placed)
            at_row, at_column, inside = moved.indices(grid.centres(rows, columns))
            costs = np.full(len(rows), UNKNOWN, np.uint8)
            costs[inside] = moved.cells[at_row[inside], at_column[inside]]
            self._write(grid, costs.reshape(grid.cells.shape), inside.reshape(grid.cells.shape))

    def _write(self, grid: CostGrid, costs: Cells, inside: Mask | np.bool_) -> None:
        """Write the costs inside of the map; with `<use_maximum>`, only those above the present ones."""
        if self._node.uses_maximum:
            inside = inside & (costs != UNKNOWN) & ((grid.cells == UNKNOWN) | (grid.cells < costs))
        np.copyto(grid.cells, costs, where=inside)

    def reset(self) -> None:
        """Keep the map, as Nav2 does."""


class InflationLayerOptions(Options):
    """Options of `InflationLayer`."""

    enabled: bool = boolean(True)
    inflation_radius: float = number(0.55, "m", minimum=0)
    cost_scaling_factor: float = number(10.0, "1/m", minimum=0)
    inflate_unknown: bool = boolean(False)
    inflate_around_unknown: bool = boolean(False)


class InflationLayer:
    """Costs that decay with the distance from the obstacles (`nav2_costmap_2d::InflationLayer`).

    Within the inscribed radius r of an obstacle, the cost is 253. Beyond it, at the distance d, the cost is
    252·exp(-`<cost_scaling_factor>`·(d - r)), and 0 beyond `<inflation_radius>`.
    """

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        self._options, self._node = InflationLayerOptions(params).read_all(), node

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Write the costs around the obstacles."""
        options, inscribed = self._options, self._node.inscribed_radius
        is_lethal = grid.cells == LETHAL
        if options.inflate_around_unknown:
            is_lethal |= grid.cells == UNKNOWN
        if not options.enabled or not is_lethal.any():
            return
        import cv2

        distance = cv2.distanceTransform((~is_lethal).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
        metres = distance.astype(np.float64) * grid.resolution
        costs = np.zeros(grid.cells.shape, np.uint8)
        near = metres <= options.inflation_radius + _OVERLAP
        decay = exp(-options.cost_scaling_factor * np.maximum(metres[near] - inscribed, 0.0))
        costs[near] = np.where(metres[near] <= inscribed + _OVERLAP, INSCRIBED, decay * (INSCRIBED - 1))
        costs[is_lethal] = LETHAL
        is_unknown = grid.cells == UNKNOWN
        unknown = costs >= (1 if options.inflate_unknown else INSCRIBED)
        grid.cells[:] = np.where(is_unknown & ~unknown, UNKNOWN, np.maximum(costs, np.where(is_unknown, 0, grid.cells)))

    def reset(self) -> None:
        """Keep nothing, because the layer has no memory."""


LAYERS: Final[dict[str, type[CostmapLayer]]] = {
    "nav2_costmap_2d::StaticLayer": StaticLayer,
    "nav2_costmap_2d::ObstacleLayer": ObstacleLayer,
    "nav2_costmap_2d::VoxelLayer": VoxelLayer,
    "nav2_costmap_2d::RangeSensorLayer": RangeSensorLayer,
    "nav2_costmap_2d::DenoiseLayer": DenoiseLayer,
    "nav2_costmap_2d::InflationLayer": InflationLayer,
    "nav2_costmap_2d::KeepoutFilter": KeepoutFilter,
    "nav2_costmap_2d::SpeedFilter": SpeedFilter,
    "nav2_costmap_2d::BinaryFilter": BinaryFilter,
}
DEFAULT_LAYERS: Final = {
    "static_layer": "nav2_costmap_2d::StaticLayer",
    "obstacle_layer": "nav2_costmap_2d::ObstacleLayer",
    "inflation_layer": "nav2_costmap_2d::InflationLayer",
}
