"""Layer with the obstacles that lidars and depth cameras see (`nav2_costmap_2d::ObstacleLayer`)."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Final, TypeVar

import numpy as np
import numpy.typing as npt

from simkit import Params, msgs
from simkit.extend import Options, boolean, integer, number, text
from simkit_navigation.plugins.costmaps.cost_grid import FREE, LETHAL, UNKNOWN, Cells, CostGrid, Indices, Mask
from simkit_navigation.plugins.costmaps.footprint import cells_within
from simkit_navigation.plugins.costmaps.observation_buffer import (
    CLOUD,
    SCAN,
    Observation,
    ObservationBuffer,
    SourceOptions,
    find_pose,
)
from simkit_navigation.plugins.costmaps.ray_cells import AT_ONCE, RayTracer
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose, planar_of

if TYPE_CHECKING:
    from simkit_navigation.plugins.costmaps.costmap_node import CostmapNode

Number = TypeVar("Number", bound=np.generic)

_HALF_CELL: Final = 0.5
_BORDER: Final = 1e-3  # [m] inside of the upper border of the map, where Nav2 ends rays that leave the map


class ObstacleLayerOptions(Options):
    """Options of `ObstacleLayer`."""

    enabled: bool = boolean(True)
    observation_sources: str = text("scan")
    footprint_clearing_enabled: bool = boolean(True)
    combination_method: int = integer(1, minimum=0, maximum=2)
    min_obstacle_height: float = number(-math.inf, "m", finite=False)
    max_obstacle_height: float = number(math.inf, "m", finite=False)


class ObstacleLayer:
    """Obstacles in laser scans and point clouds (`nav2_costmap_2d::ObstacleLayer`).

    A beam marks the cell at its end, and clears the cells before its end.
    """

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        self._node = node
        self._options = self._read_options(params)
        names = self._options.observation_sources.split() if self._options.enabled else []
        self._buffers: dict[str, ObservationBuffer] = {}
        for name in names:
            options = SourceOptions(params.block(name)).read_all()
            self._buffers[name] = ObservationBuffer(node, options)
            kind = SCAN if options.data_type == "LaserScan" else CLOUD
            node.receive(options.topic, kind, f"{name}.topic", buffer_callback(self, name))
            if options.inf_is_valid and kind == CLOUD:
                node.log.warning("inf_is_valid of %s has no effect on point clouds", name)
            if options.marking and options.max_obstacle_height <= 0:
                text = "nothing above the ground becomes an obstacle: max_obstacle_height of the source is"
                node.report_once(f"height {name}", f"{name}: {text} {options.max_obstacle_height:g}")
        self._seen: Cells = np.zeros((0, 0), np.uint8)
        self._origin = PlanarPose(0.0, 0.0, 0.0)

    def _read_options(self, params: Params) -> ObstacleLayerOptions:
        return ObstacleLayerOptions(params).read_all()

    def add_message(self, source: str, message: msgs.Message) -> None:
        """Store a message of a source; a scan with invalid angles is ignored."""
        buffer = self._buffers[source]
        if buffer.options.data_type == "PointCloud2" or math.isfinite(message.angle_min + message.angle_increment):
            buffer.add(message)

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Update the obstacles by the messages in effect, and write them."""
        if not self._options.enabled:
            return
        self._match(grid)
        seen = CostGrid(self._seen, grid.resolution, grid.origin, grid.frame)
        self._observe(seen)
        if self._options.footprint_clearing_enabled:
            self._seen[cells_within(seen, self._node.footprint, robot)] = FREE
        combine(grid.cells, self._seen, self._options.combination_method, self._node.default_cost)

    def _match(self, grid: CostGrid) -> None:
        """Give the layer's cells the size and the place of the costmap; cells that stay inside keep their value."""
        if self._seen.shape != grid.cells.shape:
            self._resize(grid)
        elif grid.origin != self._origin:
            right = round((grid.origin.x - self._origin.x) / grid.resolution)
            up = round((grid.origin.y - self._origin.y) / grid.resolution)
            self._shift(up, right)
        self._origin = grid.origin

    def _resize(self, grid: CostGrid) -> None:
        self._seen = np.full(grid.cells.shape, UNKNOWN, np.uint8)

    def _shift(self, up: int, right: int) -> None:
        self._seen = shifted(self._seen, up, right)

    # ------------------------------------------------------------------ observations

    def _observe(self, grid: CostGrid) -> None:
        """Clear the cells before all points of all sources, then mark the cells of the points."""
        observations = []
        for buffer in self._buffers.values():
            options = buffer.options
            if options.data_type == "LaserScan" and not options.sensor_frame:
                observations += [(options, scan) for scan in reversed(buffer.current_messages())]
            else:
                observations += [(options, seen) for seen in reversed(buffer.observations(grid.frame))]
        for clears in (True, False):
            for options, seen in observations:
                if not (options.clearing if clears else options.marking):
                    continue
                if isinstance(seen, Observation):
                    (self._clear_points if clears else self._mark_points)(grid, seen, options)
                else:
                    self._add_scan(grid, seen, options, clears)

    def _add_scan(self, grid: CostGrid, scan: msgs.LaserScan, options: SourceOptions, clears: bool) -> None:
        """Clear the cells before the ends of the beams, or mark the cells at their ends."""
        placed = find_pose(self._node, grid.frame, scan)
        if placed is None:
            return
        sensor = planar_of(placed[0])
        ranges = np.asarray(scan.ranges, np.float64)
        angles = np.asarray(scan.angle_min + scan.angle_increment * np.arange(len(ranges)), np.float64)
        hits = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges <= scan.range_max)
        own, low, high = self._options, options.min_obstacle_height, options.max_obstacle_height
        if not clears:
            low, high = max(low, own.min_obstacle_height), min(high, own.max_obstacle_height)
        if math.isfinite(low) or math.isfinite(high):
            rotation, height = placed[0].matrix[2].tolist(), float(placed[0].position[2])
            reached = np.where(hits, ranges, 0.0)
            z = height + rotation[0] * (reached * np.cos(angles)) + rotation[1] * (reached * np.sin(angles))
            hits &= (z >= low) & (z <= high)
        if clears:
            reach = np.where(hits, ranges, 0.0)
            if options.inf_is_valid:
                reach = np.where(ranges == math.inf, options.raytrace_max_range, reach)
            longest = min(
                options.raytrace_max_range, grid.diagonal + grid.distance(sensor.x, sensor.y) + 2 * grid.resolution
            )
            reach = np.minimum(reach, longest)
            rows, columns = _cells_before(grid, sensor, reach, angles, options.raytrace_min_range)
            grid.cells[rows, columns] = FREE
        else:
            is_near = hits & (ranges >= options.obstacle_min_range) & (ranges <= options.obstacle_max_range)
            rows, columns, inside = grid.indices(_ends(sensor, ranges[is_near], angles[is_near]))
            grid.cells[rows[inside], columns[inside]] = LETHAL

    def _clear_points(self, grid: CostGrid, seen: Observation, options: SourceOptions) -> None:
        """Clear the cells on the lines to points, as Nav2's `ObstacleLayer::raytraceFreespace`."""
        rows, columns = grid.cells.shape
        side = grid.resolution
        start, _ = in_grid(grid, seen, slice(0))
        if not (0 <= start[0] < columns * side and 0 <= start[1] < rows * side):
            self._report_outside(options)
            return
        tracer = RayTracer(
            (math.floor(start[0] / side), math.floor(start[1] / side), 0.0),
            (rows, columns, 1),
            cells_of(options.raytrace_max_range, side),
            cells_of(options.raytrace_min_range, side),
        )
        for begin in range(0, len(seen.points[0]), AT_ONCE):
            points = in_grid(grid, seen, slice(begin, begin + AT_ONCE))[1]
            column, row = (np.floor(end / side) for end in _ends_in_map(start, points, (columns * side, rows * side)))
            inside = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
            column, row = column[inside], row[inside]
            tracer.add((column, row, np.zeros(len(column))))
        grid.cells[tracer.cells()[:, :, 0]] = FREE

    def _mark_points(self, grid: CostGrid, seen: Observation, options: SourceOptions) -> None:
        """Mark the cells of points within the range of the source and the heights of the layer."""
        start, (x, y) = in_grid(grid, seen)
        squares = (x - start[0]) ** 2 + (y - start[1]) ** 2
        keep = (squares <= options.obstacle_max_range**2) & (squares >= options.obstacle_min_range**2)
        z = seen.points[2]
        keep &= (z >= np.float32(self._options.min_obstacle_height)) & (
            z <= np.float32(self._options.max_obstacle_height)
        )
        columns, rows = (np.floor(axis[keep] / grid.resolution).astype(np.int64) for axis in (x, y))
        inside = (rows >= 0) & (rows < grid.cells.shape[0]) & (columns >= 0) & (columns < grid.cells.shape[1])
        grid.cells[rows[inside], columns[inside]] = LETHAL

    def _report_outside(self, options: SourceOptions) -> None:
        text = "the sensor of %s is outside of the costmap, so nothing is cleared along its rays"
        self._node.report_once(f"outside {options.topic}", text % options.topic)

    # ------------------------------------------------------------------ services

    def reset(self) -> None:
        """Forget all obstacles."""
        self._seen[:] = UNKNOWN
        for buffer in self._buffers.values():
            buffer.clear()

    def clear_area(self, area: Mask) -> None:
        """Forget the obstacles in an area of the costmap; what a source still sees comes back with the next update."""
        if area.shape == self._seen.shape:
            self._seen[area] = UNKNOWN


def buffer_callback(layer: ObstacleLayer, source: str) -> partial[None]:
    """Return the function that stores the messages of a source in a layer."""
    return partial(layer.add_message, source)


def in_grid(
    grid: CostGrid, seen: Observation, part: slice = slice(None)
) -> tuple[tuple[float, float], tuple[Floats, Floats]]:
    """Return the place of the sensor, and x and y of points, from the corner of the grid along its axes [m].

    Args:
        grid: grid.
        seen: observation.
        part: points of the observation that are returned.
    """
    cos, sin = math.cos(grid.origin.yaw), math.sin(grid.origin.yaw)
    x, y = (axis[part].astype(np.float64) for axis in seen.points[:2])
    x -= grid.origin.x
    y -= grid.origin.y
    at_x, at_y = seen.origin[0] - grid.origin.x, seen.origin[1] - grid.origin.y
    if grid.origin.yaw:
        x, y = cos * x + sin * y, cos * y - sin * x
        at_x, at_y = cos * at_x + sin * at_y, cos * at_y - sin * at_x
    return (at_x, at_y), (x, y)


def _ends_in_map(start: tuple[float, float], points: tuple[Floats, Floats], sizes: tuple[float, float]) -> list[Floats]:
    """Return the ends of rays to points [m]; a ray that leaves the map ends at its border."""
    ends, ways = list(points), [point - at for point, at in zip(points, start, strict=True)]
    for is_upper in (False, True):
        for axis, size in enumerate(sizes):
            is_out = ends[axis] > size if is_upper else ends[axis] < 0
            if not is_out.any():
                continue
            share = ((size if is_upper else 0.0) - start[axis]) / np.where(is_out, ways[axis], 1.0)
            ends[1 - axis] = np.where(is_out, start[1 - axis] + ways[1 - axis] * share, ends[1 - axis])
            ends[axis] = np.where(is_out, size - _BORDER if is_upper else 0.0, ends[axis])
    return ends


def cells_of(distance: float, resolution: float) -> int:
    """Return the number of cells that a distance [m] reaches; at most a million."""
    return math.ceil(max(min(distance / resolution, 1e6), 0.0))


def combine(master: Cells, layer: Cells, method: int, default: int) -> None:
    """Write the cells of a layer to the costmap.

    Args:
        master: cells of the costmap.
        layer: cells of the layer; UNKNOWN where it knows nothing.
        method: Nav2's `combination_method`: 0 overwrites, 1 takes the larger cost, 2 does so but keeps unknown cells.
        default: cost of unknown cells, which method 0 also writes.
    """
    if method == 0:
        known = np.where(layer == UNKNOWN, np.uint8(default), layer)
        np.copyto(master, known, where=known != UNKNOWN)
        return
    is_written = (layer != UNKNOWN) & (master != UNKNOWN) & (layer > master)
    if method == 1:
        is_written |= (layer != UNKNOWN) & (master == UNKNOWN)
    np.copyto(master, layer, where=is_written)


def _ends(sensor: PlanarPose, ranges: Floats, angles: Floats) -> Floats:
    """Return the ends of beams [m], shape (n, 2)."""
    return sensor.transform(np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles))))


def _cells_before(
    grid: CostGrid, sensor: PlanarPose, reach: Floats, angles: Floats, least: float
) -> tuple[Indices, Indices]:
    """Return rows and columns of the cells that beams cross before their ends, from a distance [m] on."""
    step = grid.resolution * _HALF_CELL
    along = np.arange(0.0, max(float(reach.max(initial=0.0)), 0.0), step)
    distances, directions = np.broadcast_arrays(along[:, None], angles)
    is_before = (distances < reach - grid.resolution) & (distances >= least)
    rows, columns, inside = grid.indices(_ends(sensor, distances[is_before], directions[is_before]))
    return rows[inside], columns[inside]


def shifted(cells: Cells, up: int, right: int) -> Cells:
    """Return cells of a window that has moved by some cells; new cells are unknown."""
    moved = np.full(cells.shape, UNKNOWN, np.uint8)
    move_window(cells, moved, up, right)
    return moved


def move_window(cells: npt.NDArray[Number], moved: npt.NDArray[Number], up: int, right: int) -> None:
    """Copy the cells of a window to the array of the same window after it has moved by some cells."""
    (rows, columns), (y, x) = cells.shape, (up, right)
    if abs(y) < rows and abs(x) < columns:
        moved[max(-y, 0) : rows - max(y, 0), max(-x, 0) : columns - max(x, 0)] = cells[
            max(y, 0) : rows - max(-y, 0), max(x, 0) : columns - max(-x, 0)
        ]
