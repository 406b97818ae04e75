"""Layers of a costmap: the static map, obstacles that a lidar sees, and the inflation around both."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from simkit import Params, msgs
from simkit.elementary_functions import exp
from simkit.extend import Options, boolean, number, text
from simkit_navigation.plugins.navigation.cost_grid import (
    FREE,
    INSCRIBED,
    LETHAL,
    UNKNOWN,
    Cells,
    CostGrid,
    Indices,
    grid_of_map,
)
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose, look_up

if TYPE_CHECKING:
    from simkit_navigation.plugins.navigation.nodes import CostmapNode

_MAP: Final = "nav_msgs/msg/OccupancyGrid"
_SCAN: Final = "sensor_msgs/msg/LaserScan"
_HALF_CELL: Final = 0.5
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


class StaticLayer:
    """Obstacles of the map (`nav2_costmap_2d::StaticLayer`)."""

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        self._options, self._node = StaticLayerOptions(params).read_all(), node
        self.map: CostGrid | None = None
        self._has_reported = False
        if self._options.enabled:
            node.receive(self._options.map_topic, _MAP, "map_topic", self._on_map)

    def _on_map(self, message: msgs.OccupancyGrid) -> None:
        grid = grid_of_map(message, self._node.lethal_cost_threshold, self._node.default_cost)
        if grid is None:
            if not self._has_reported:
                text = "the map on %s is empty, or its size, resolution or origin is not valid"
                self._node.log.error(text, self._options.map_topic)
            self._has_reported = True
            return
        self.map = grid

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Write the costs of the map."""
        if self.map is None:
            return
        if grid.frame == self.map.frame and grid.origin == self.map.origin and grid.cells.shape == self.map.cells.shape:
            grid.cells[:] = self.map.cells
            return
        placed = look_up(self._node.sim, grid.frame, self.map.frame)
        if placed is not None:
            rows, columns = np.indices(grid.cells.shape).reshape(2, -1)
            costs = self.map.seen_from(grid.frame, placed).costs(grid.centres(rows, columns))
            grid.cells[:] = costs.reshape(grid.cells.shape)

    def reset(self) -> None:
        """Keep the map, as Nav2 does."""


class ObstacleLayerOptions(Options):
    """Options of `ObstacleLayer`."""

    enabled: bool = boolean(True)
    observation_sources: str = text("scan")
    footprint_clearing_enabled: bool = boolean(True)


class SourceOptions(Options):
    """Options of a source of `ObstacleLayer`."""

    topic: str = text("scan")
    marking: bool = boolean(True)
    clearing: bool = boolean(True)
    inf_is_valid: bool = boolean(False)
    obstacle_max_range: float = number(2.5, "m", minimum=0)
    obstacle_min_range: float = number(0.0, "m", minimum=0)
    raytrace_max_range: float = number(3.0, "m", minimum=0)


class ObstacleLayer:
    """Obstacles in laser scans (`nav2_costmap_2d::ObstacleLayer`).

    A beam marks the cell at its end, and clears the cells before its end.
    """

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        self._options, self._node = ObstacleLayerOptions(params).read_all(), node
        names = self._options.observation_sources.split() if self._options.enabled else []
        self._sources = {name: SourceOptions(params.block(name)).read_all() for name in names}
        self._scans: dict[str, msgs.LaserScan] = {}  # newest scan of each source
        for name, source in self._sources.items():
            node.receive(source.topic, _SCAN, f"{name}.topic", partial(self._on_scan, name))
        self._seen: Cells = np.zeros((0, 0), np.uint8)
        self._origin = PlanarPose(0.0, 0.0, 0.0)

    def _on_scan(self, source: str, message: msgs.LaserScan) -> None:
        if math.isfinite(message.angle_min + message.angle_increment):
            self._scans[source] = message

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Update the obstacles by the newest scans, and write them."""
        self._match(grid)
        seen = CostGrid(self._seen, grid.resolution, grid.origin, grid.frame)
        for name, scan in self._scans.items():
            self._add_scan(seen, scan, self._sources[name])
        if self._options.footprint_clearing_enabled:
            radius = min(self._node.inscribed_radius, seen.diagonal)
            reach = np.arange(-radius, radius + grid.resolution, grid.resolution / 2)
            around = np.stack(np.meshgrid(reach, reach), axis=-1).reshape(-1, 2)
            rows, columns, inside = seen.indices(around[np.hypot(*around.T) <= radius] + (robot.x, robot.y))
            self._seen[rows[inside], columns[inside]] = FREE
        grid.cells[self._seen == LETHAL] = LETHAL
        grid.cells[(self._seen == FREE) & (grid.cells == UNKNOWN)] = FREE

    def _match(self, grid: CostGrid) -> None:
        """Give the layer's cells the size and the place of the costmap; cells that stay inside keep their value."""
        if self._seen.shape != grid.cells.shape:
            self._seen = np.full(grid.cells.shape, UNKNOWN, np.uint8)
        elif grid.origin != self._origin:
            right = round((grid.origin.x - self._origin.x) / grid.resolution)
            up = round((grid.origin.y - self._origin.y) / grid.resolution)
            self._seen = shifted(self._seen, up, right)
        self._origin = grid.origin

    def _add_scan(self, grid: CostGrid, scan: msgs.LaserScan, options: SourceOptions) -> None:
        sensor = look_up(self._node.sim, grid.frame, scan.header.frame_id, scan.header.stamp)
        if sensor is None:  # the newest transform is older than the scan
            sensor = look_up(self._node.sim, grid.frame, scan.header.frame_id)
        if sensor is None:
            return
        ranges = np.asarray(scan.ranges, np.float64)
        angles = np.asarray(scan.angle_min + scan.angle_increment * np.arange(len(ranges)), np.float64)
        hits = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges <= scan.range_max)
        if options.clearing:
            reach = np.where(hits, ranges, 0.0)
            if options.inf_is_valid:
                reach = np.where(ranges == math.inf, options.raytrace_max_range, reach)
            longest = min(
                options.raytrace_max_range, grid.diagonal + grid.distance(sensor.x, sensor.y) + 2 * grid.resolution
            )
            rows, columns = _cells_before(grid, sensor, np.minimum(reach, longest), angles)
            grid.cells[rows, columns] = FREE
        if options.marking:
            is_near = hits & (ranges >= options.obstacle_min_range) & (ranges <= options.obstacle_max_range)
            rows, columns, inside = grid.indices(_ends(sensor, ranges[is_near], angles[is_near]))
            grid.cells[rows[inside], columns[inside]] = LETHAL

    def reset(self) -> None:
        """Forget all obstacles."""
        self._seen[:] = UNKNOWN
        self._scans.clear()


def _ends(sensor: PlanarPose, ranges: Floats, angles: Floats) -> Floats:
    """Return the ends of beams [m], shape (n, 2)."""
    return sensor.transform(np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles))))


def _cells_before(grid: CostGrid, sensor: PlanarPose, reach: Floats, angles: Floats) -> tuple[Indices, Indices]:
    """Return rows and columns of the cells that beams cross before their ends."""
    step = grid.resolution * _HALF_CELL
    along = np.arange(0.0, max(float(reach.max(initial=0.0)), 0.0), step)
    distances, directions = np.broadcast_arrays(along[:, None], angles)
    is_before = distances < reach - grid.resolution
    rows, columns, inside = grid.indices(_ends(sensor, distances[is_before], directions[is_before]))
    return rows[inside], columns[inside]


def shifted(cells: Cells, up: int, right: int) -> Cells:
    """Return cells of a window that has moved by some cells; new cells are unknown."""
    moved = np.full(cells.shape, UNKNOWN, np.uint8)
    (rows, columns), (y, x) = cells.shape, (up, right)
    if abs(y) < rows and abs(x) < columns:
        moved[max(-y, 0) : rows - max(y, 0), max(-x, 0) : columns - max(x, 0)] = cells[
            max(y, 0) : rows - max(-y, 0), max(x, 0) : columns - max(-x, 0)
        ]
    return moved


class InflationLayerOptions(Options):
    """Options of `InflationLayer`."""

    enabled: bool = boolean(True)
    inflation_radius: float = number(0.55, "m", minimum=0)
    cost_scaling_factor: float = number(10.0, "1/m", minimum=0)
    inflate_unknown: bool = boolean(False)


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
    "nav2_costmap_2d::InflationLayer": InflationLayer,
}
DEFAULT_LAYERS: Final = {
    "static_layer": "nav2_costmap_2d::StaticLayer",
    "obstacle_layer": "nav2_costmap_2d::ObstacleLayer",
    "inflation_layer": "nav2_costmap_2d::InflationLayer",
}
