"""Layer with obstacles in three dimensions (`nav2_costmap_2d::VoxelLayer`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import Params, msgs
from simkit.extend import boolean, integer, number
from simkit_navigation.plugins.costmaps.cost_grid import FREE, LETHAL, UNKNOWN, CostGrid, Mask
from simkit_navigation.plugins.costmaps.observation_buffer import Observation, SourceOptions
from simkit_navigation.plugins.costmaps.obstacle_layer import (
    ObstacleLayer,
    ObstacleLayerOptions,
    cells_of,
    in_grid,
    move_window,
)
from simkit_navigation.plugins.costmaps.ray_cells import AT_ONCE, RayTracer
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.costmaps.costmap_node import CostmapNode

_VOXELS: Final = 16  # of a column, in 32 bits: the upper 16 for marked voxels, the lower for known free ones
_LOW: Final = np.uint32(0xFFFF)
_SHORTER: Final = 1e-5  # share of a ray that leaves the map by which Nav2 shortens it
_TOP_MARGIN: Final = 0.01  # [m] below the top of the map, where rays that leave it end
_BITS: Final = np.array([bin(number).count("1") for number in range(1 << _VOXELS)], np.uint8)
"""Number of bits by 16-bit word."""

Columns = npt.NDArray[np.uint32]


class VoxelLayerOptions(ObstacleLayerOptions):
    """Options of `VoxelLayer`."""

    origin_z: float = number(0.0, "m")
    z_resolution: float = number(0.2, "m", minimum=1e-3)
    z_voxels: int = integer(10, minimum=1, maximum=_VOXELS)
    unknown_threshold: int = integer(15, minimum=0)
    mark_threshold: int = integer(0, minimum=0)
    publish_voxel_map: bool = boolean(False)


class VoxelLayer(ObstacleLayer):
    """Obstacles in columns of voxels (`nav2_costmap_2d::VoxelLayer`).

    A point marks the voxel that contains it. The voxels on the line from the sensor to the point become free. A cell
    is an obstacle if more than `<mark_threshold>` voxels of its column are marked.

    The bits of a column are those of `nav2_voxel_grid`: voxel i is marked if the bits i and i + 16 are set, unknown if
    only the bit i is set, and free if none is.
    """

    _options: VoxelLayerOptions

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        super().on_initialize(node, params)
        self._columns: Columns = np.zeros((0, 0), np.uint32)
        self._voxels = None
        if self._options.publish_voxel_map and self._options.enabled:
            self._voxels = node.advertise("~/voxel_grid", "nav2_msgs/msg/VoxelGrid", latched=True)

    def _read_options(self, params: Params) -> VoxelLayerOptions:
        return VoxelLayerOptions(params).read_all()

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Update the voxels by the messages in effect, and write the obstacles."""
        super().update_costs(grid, robot)
        if self._voxels is not None and self._voxels.wanted:
            self._voxels.publish(self._message(grid))

    def _resize(self, grid: CostGrid) -> None:
        super()._resize(grid)
        self._columns = np.full(grid.cells.shape, _LOW, np.uint32)

    def _shift(self, up: int, right: int) -> None:
        super()._shift(up, right)
        moved: Columns = np.full(self._columns.shape, _LOW, np.uint32)
        move_window(self._columns, moved, up, right)
        self._columns = moved

    # ------------------------------------------------------------------ observations

    def _observe(self, grid: CostGrid) -> None:
        observed = []
        for buffer in self._buffers.values():
            observed += [(buffer.options, seen) for seen in reversed(buffer.observations(grid.frame))]
        for options, seen in observed:
            if options.clearing:
                self._clear_points(grid, seen, options)
        for options, seen in observed:
            if options.marking:
                self._mark_points(grid, seen, options)

    def _clear_points(self, grid: CostGrid, seen: Observation, options: SourceOptions) -> None:
        """Free the voxels on the lines to points, as Nav2's `VoxelLayer::raytraceFreespace`."""
        own, side = self._options, grid.resolution
        rows, columns = grid.cells.shape
        sides, counts = (side, side, own.z_resolution), (columns, rows, own.z_voxels)
        start, _ = in_grid(grid, seen, slice(0))
        at = (*start, seen.origin[2] - own.origin_z)
        if not all(0 <= place < one * count for place, one, count in zip(at, sides, counts, strict=True)):
            self._report_outside(options)
            return
        tracer = RayTracer(
            [place / one for place, one in zip(at, sides, strict=True)],
            (rows, columns, own.z_voxels),
            cells_of(options.raytrace_max_range, side),
            cells_of(options.raytrace_min_range, side),
        )
        for begin in range(0, len(seen.points[0]), AT_ONCE):
            part = slice(begin, begin + AT_ONCE)
            z = seen.points[2][part].astype(np.float64) - own.origin_z
            ends = _ray_ends(at, (*in_grid(grid, seen, part)[1], z), sides, counts)
            cells = [end / one for end, one in zip(ends, sides, strict=True)]
            inside = np.ones(len(z), np.bool_)
            for cell, count in zip(cells, counts, strict=True):
                inside &= (cell >= 0) & (cell < count)
            tracer.add(cells if inside.all() else [cell[inside] for cell in cells])
        word = _words(tracer.cells())
        self._columns &= ~(word | (word << np.uint32(_VOXELS)))
        marked, unknown = self._columns >> np.uint32(_VOXELS), (self._columns >> np.uint32(_VOXELS)) ^ self._columns
        # the bits above the highest voxel are unknown for ever, so Nav2 adds their number to the threshold
        most_unknown = own.unknown_threshold + _VOXELS - own.z_voxels
        costs = np.where(_BITS[unknown & _LOW] <= most_unknown, np.uint8(FREE), np.uint8(UNKNOWN))
        np.copyto(self._seen, costs, where=(word > 0) & (_BITS[marked] <= own.mark_threshold))

    def _mark_points(self, grid: CostGrid, seen: Observation, options: SourceOptions) -> None:
        """Mark the voxels of points within the range of the source and the heights of the layer."""
        own = self._options
        start, (x, y) = in_grid(grid, seen)
        z = seen.points[2].astype(np.float64)
        squares = (x - start[0]) ** 2 + (y - start[1]) ** 2 + (z - seen.origin[2]) ** 2
        keep = (squares < options.obstacle_max_range**2) & (squares >= options.obstacle_min_range**2)
        keep &= (z >= own.min_obstacle_height) & (z <= own.max_obstacle_height)
        levels = np.maximum(np.floor((z[keep] - own.origin_z) / own.z_resolution), 0.0)
        indices = [np.floor(axis[keep] / grid.resolution) for axis in (x, y)]
        rows, columns = grid.cells.shape
        inside = (indices[0] >= 0) & (indices[0] < columns) & (indices[1] >= 0) & (indices[1] < rows)
        inside &= levels < own.z_voxels
        column, row, level = (axis[inside].astype(np.int64) for axis in (*indices, levels))
        marks = np.zeros((rows, columns, own.z_voxels), np.bool_)
        marks.reshape(-1)[(row * columns + column) * own.z_voxels + level] = True
        word = _words(marks)
        self._columns |= word | (word << np.uint32(_VOXELS))
        is_marked = (word > 0) & (_BITS[self._columns >> np.uint32(_VOXELS)] > own.mark_threshold)
        self._seen[is_marked] = LETHAL

    # ------------------------------------------------------------------ services and messages

    def reset(self) -> None:
        """Forget all obstacles."""
        super().reset()
        self._columns[:] = _LOW

    def clear_area(self, area: Mask) -> None:
        super().clear_area(area)
        if area.shape == self._columns.shape:
            self._columns[area] = _LOW

    def _message(self, grid: CostGrid) -> msgs.Message:
        rows, columns = self._columns.shape
        own = self._options
        return msgs.make(
            "nav2_msgs/msg/VoxelGrid",
            header=msgs.header(self._node.sim.time_ns, grid.frame),
            data=self._columns.reshape(-1).copy(),
            origin={"x": grid.origin.x, "y": grid.origin.y, "z": own.origin_z},
            resolutions={"x": grid.resolution, "y": grid.resolution, "z": own.z_resolution},
            size_x=columns,
            size_y=rows,
            size_z=own.z_voxels,
        )


def _ray_ends(
    at: tuple[float, ...], points: tuple[Floats, ...], sides: tuple[float, ...], counts: tuple[int, ...]
) -> list[Floats]:
    """Return the ends of the rays to points [m]: two cells before the point, and at the border of the voxels.

    Args:
        at: position of the sensor from the corner of the voxels [m].
        points: x, y and z of the points from the corner of the voxels [m].
        sides: sides of a voxel along x, y and z [m].
        counts: numbers of voxels along x, y and z.
    """
    ways = [point - place for point, place in zip(points, at, strict=True)]
    distance = np.sqrt(ways[0] * ways[0] + ways[1] * ways[1] + ways[2] * ways[2])
    share = np.maximum((distance - 2 * sides[0]) / np.where(distance > 0, distance, 1.0), 0.0)
    ways = [way * share for way in ways]
    part = np.ones(len(distance))
    is_out = np.zeros(len(distance), np.bool_)
    for axis, (way, side, count) in enumerate(zip(ways, sides, counts, strict=True)):
        border = (count - 0.5) * side  # Nav2's end of a map is half a cell inside of it: Costmap2D::getSizeInMetersX
        margin, least = (_TOP_MARGIN, 0.0) if axis == 2 else (0.0, -np.inf)
        for beyond, limit in ((at[axis] + way > border, border - margin), (at[axis] + way < 0, 0.0)):
            if beyond.any():
                reach = np.maximum((limit - at[axis]) / np.where(beyond, way, 1.0), least)
                part = np.where(beyond, np.minimum(part, reach), part)
                is_out |= beyond
    part = np.where(is_out, part - np.sign(part) * _SHORTER, part)
    return [place + way * part for place, way in zip(at, ways, strict=True)]


def _words(voxels: npt.NDArray[np.bool_]) -> Columns:
    """Return a word for each column of voxels, whose bit i is that of the level i, shape (rows, columns)."""
    words = np.zeros(voxels.shape[:2], np.uint32)
    for level in range(voxels.shape[2]):
        words |= voxels[:, :, level].astype(np.uint32) << np.uint32(level)
    return words
