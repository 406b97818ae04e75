"""Grid of costs around a robot, with the values of Nav2's costmaps."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose, pose_message, pose_of_message

FREE: Final = 0
INSCRIBED: Final = 253  # the robot's centre must not be here: some part of the robot would touch
LETHAL: Final = 254  # an obstacle
UNKNOWN: Final = 255

_LEAST_SIDE: Final = 1e-6  # [m] of a cell

Cells = npt.NDArray[np.uint8]
Mask = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.int64]

_BETWEEN = np.arange(1, INSCRIBED, dtype=np.int64)
_OCCUPANCY: Final = np.zeros(256, np.int8)
"""Values of `nav_msgs/msg/OccupancyGrid` by cost, as Nav2's costmap publisher translates them."""
_OCCUPANCY[1:INSCRIBED] = 1 + 97 * (_BETWEEN - 1) // 251
_OCCUPANCY[[INSCRIBED, LETHAL, UNKNOWN]] = 99, 100, -1


@dataclass(eq=False)
class CostGrid:
    """Costs of square cells.

    Attributes:
        cells: 0 free, 1 to 252 near an obstacle, 253 within the robot's inscribed radius of an obstacle, 254 obstacle,
            255 unknown, shape (rows, columns); row 0 has the lowest y, column 0 the lowest x.
        resolution: side of a cell [m].
        origin: pose of the corner of row 0 and column 0 in the frame.
        frame: name of the frame.
    """

    cells: Cells
    resolution: float
    origin: PlanarPose
    frame: str

    @property
    def diagonal(self) -> float:
        """Distance between two opposite corners [m]."""
        return math.hypot(*self.cells.shape) * self.resolution

    def distance(self, x: float, y: float) -> float:
        """Return the distance of a point from the corner of row 0 and column 0 [m]."""
        return math.hypot(x - self.origin.x, y - self.origin.y)

    def indices(self, points: Floats) -> tuple[Indices, Indices, Mask]:
        """Return rows and columns of points [m], shape (n, 2), and which of the points are within the grid."""
        local = self.origin.inverse().transform(points) / self.resolution
        columns, rows = np.floor(np.clip(local, -1e9, 1e9)).astype(np.int64).T
        inside = (rows >= 0) & (rows < self.cells.shape[0]) & (columns >= 0) & (columns < self.cells.shape[1])
        return rows, columns, inside

    def to_cell(self, x: float, y: float) -> tuple[int, int] | None:
        """Return row and column of a point [m]; None outside of the grid."""
        inverse = self.origin.inverse()  # as `indices`, with the same bits, without arrays
        cos, sin = math.cos(inverse.yaw), math.sin(inverse.yaw)
        row = (x * sin + y * cos + inverse.y) / self.resolution
        column = (x * cos + y * -sin + inverse.x) / self.resolution
        is_inside = 0.0 <= row < self.cells.shape[0] and 0.0 <= column < self.cells.shape[1]
        return (int(row), int(column)) if is_inside else None

    def centres(self, rows: npt.ArrayLike, columns: npt.ArrayLike) -> Floats:
        """Return the centres of cells [m], shape (n, 2)."""
        local = np.column_stack((np.asarray(columns, np.float64), np.asarray(rows, np.float64))) + 0.5
        return self.origin.transform(local * self.resolution)

    def costs(self, points: Floats) -> Cells:
        """Return the costs at points [m], shape (n, 2); a point outside of the grid has the cost UNKNOWN."""
        rows, columns, inside = self.indices(points)
        costs = np.full(len(rows), UNKNOWN, np.uint8)
        costs[inside] = self.cells[rows[inside], columns[inside]]
        return costs

    def is_blocked(self, points: Floats) -> Mask:
        """Check for each point [m], shape (n, 2), whether the cost is INSCRIBED or LETHAL; unknown cells are free."""
        costs = self.costs(points)
        blocked: Mask = (costs >= INSCRIBED) & (costs < UNKNOWN)
        return blocked

    def cost(self, x: float, y: float) -> int:
        """Return the cost at a point [m]; UNKNOWN outside of the grid."""
        cell = self.to_cell(x, y)
        return UNKNOWN if cell is None else int(self.cells[cell])

    def seen_from(self, frame: str, pose: PlanarPose) -> CostGrid:
        """Return the same cells in another frame.

        Args:
            frame: name of the other frame.
            pose: pose of the present frame in the other one.
        """
        return replace(self, origin=pose.compose(self.origin), frame=frame)

    # ------------------------------------------------------------------ messages

    def occupancy_message(self, time_ns: int, z: float = 0.0) -> msgs.Message:
        """Return a `nav_msgs/msg/OccupancyGrid`.

        Args:
            time_ns: time [ns].
            z: height of the cells in the frame [m].
        """
        rows, columns = self.cells.shape
        info = {"map_load_time": msgs.time(time_ns), "resolution": self.resolution, "width": columns, "height": rows}
        return msgs.make(
            "nav_msgs/msg/OccupancyGrid",
            header=msgs.header(time_ns, self.frame),
            info={**info, "origin": pose_message(self.origin, z)},
            data=_OCCUPANCY[self.cells].reshape(-1),
        )

    def raw_message(self, time_ns: int) -> msgs.Message:
        """Return a `nav2_msgs/msg/Costmap`."""
        rows, columns = self.cells.shape
        times = dict.fromkeys(("map_load_time", "update_time"), msgs.time(time_ns))
        size = {"resolution": self.resolution, "size_x": columns, "size_y": rows}
        return msgs.make(
            "nav2_msgs/msg/Costmap",
            header=msgs.header(time_ns, self.frame),
            metadata={**times, **size, "layer": "master", "origin": pose_message(self.origin)},
            data=self.cells.reshape(-1).copy(),
        )


def changed_area(before: CostGrid, now: CostGrid) -> tuple[int, int, int, int] | None:
    """Return first row, last row + 1, first column and last column + 1 of the cells that differ.

    The result is all zeros if no cell differs, and None if size or place of the grids differ.
    """
    places = [(grid.cells.shape, grid.origin, grid.resolution, grid.frame) for grid in (before, now)]
    if places[0] != places[1]:
        return None
    differs = before.cells != now.cells
    rows, columns = (np.flatnonzero(differs.any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return 0, 0, 0, 0
    return int(rows[0]), int(rows[-1]) + 1, int(columns[0]), int(columns[-1]) + 1


def update_messages(grid: CostGrid, area: tuple[int, int, int, int], time_ns: int) -> tuple[msgs.Message, msgs.Message]:
    """Return the costs of an area as `map_msgs/msg/OccupancyGridUpdate` and as `nav2_msgs/msg/CostmapUpdate`."""
    top, bottom, left, right = area
    cells = grid.cells[top:bottom, left:right]
    header, place = msgs.header(time_ns, grid.frame), {"x": left, "y": top}
    shown = _OCCUPANCY[cells].reshape(-1)
    occupancy = {**place, "width": right - left, "height": bottom - top, "data": shown}
    raw = {**place, "size_x": right - left, "size_y": bottom - top, "data": cells.reshape(-1).copy()}
    return (
        msgs.make("map_msgs/msg/OccupancyGridUpdate", header=header, **occupancy),
        msgs.make("nav2_msgs/msg/CostmapUpdate", header=header, **raw),
    )


def updated_grid(grid: CostGrid, message: msgs.CostmapUpdate) -> CostGrid | None:
    """Return a grid with the costs of a `nav2_msgs/msg/CostmapUpdate`; None if they do not fit into the grid."""
    rows, columns = slice(message.y, message.y + message.size_y), slice(message.x, message.x + message.size_x)
    data = np.asarray(message.data, np.uint8)
    if (
        rows.stop > grid.cells.shape[0]
        or columns.stop > grid.cells.shape[1]
        or data.size != message.size_x * message.size_y
    ):
        return None
    cells = grid.cells.copy()
    cells[rows, columns] = data.reshape(message.size_y, message.size_x)
    return replace(grid, cells=cells)


def grid_of_message(message: msgs.Costmap) -> CostGrid | None:
    """Return the grid of a `nav2_msgs/msg/Costmap`; None if the message is not valid."""
    info, data = message.metadata, np.asarray(message.data, np.uint8)
    return _grid(data, info.size_y, info.size_x, info, message.header.frame_id)


def grid_of_map(message: msgs.OccupancyGrid, table: Cells) -> CostGrid | None:
    """Return the grid of a `nav_msgs/msg/OccupancyGrid`; None if the message is not valid.

    Args:
        message: map.
        table: cost by occupancy as an unsigned byte, shape (256,); see `cost_table`.
    """
    info, data = message.info, np.asarray(message.data, np.int8)
    return _grid(table[data.view(np.uint8)], info.height, info.width, info, message.header.frame_id)


def cost_table(lethal_threshold: int, unknown: int, unknown_value: int = 255, is_trinary: bool = True) -> Cells:
    """Return the cost by occupancy as an unsigned byte, as Nav2's `StaticLayer::interpretValue`, shape (256,).

    Args:
        lethal_threshold: smallest occupancy of an obstacle, 1 to 100.
        unknown: cost of unknown cells.
        unknown_value: occupancy of unknown cells as an unsigned byte; 255 is -1.
        is_trinary: True if an occupancy below the threshold is free; else it is scaled to the cost of an obstacle.
    """
    occupancy = np.arange(256, dtype=np.int64)
    below = np.zeros(256, np.int64) if is_trinary else occupancy * LETHAL // lethal_threshold
    costs = np.where(occupancy >= lethal_threshold, LETHAL, below)
    return np.where(occupancy == unknown_value, unknown, costs).astype(np.uint8)


def _grid(
    costs: Cells, rows: int, columns: int, info: msgs.MapMetaData | msgs.CostmapMetaData, frame: str
) -> CostGrid | None:
    origin, resolution = pose_of_message(info.origin), float(f"{info.resolution:.7g}")  # it has 32 bits
    if origin is None or not _LEAST_SIDE <= resolution < math.inf or not rows * columns or costs.size != rows * columns:
        return None
    return CostGrid(costs.reshape(rows, columns), resolution, origin, frame)
