"""Displays of maps, costmaps and grid cells, with RViz's colours."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Pose
from simkit.extend import counted
from simkit.msgs import Message
from simkit_view.displays.display import DisplayTools, NewestMessage, pose_of
from simkit_view.displays.drawing import Drawing
from simkit_view.displays.frame_poses import Placement

UPDATE: Final = "map_msgs/msg/OccupancyGridUpdate"
"""Type of the changes of a grid, on the topic of the grid with the suffix `_updates`."""
UPDATES: Final = "_updates"
_LARGEST: Final = 2048  # cells along a side of the picture that the page draws
_LIFT: Final = 0.006  # [m] above the ground
_CELLS: Final = (0.1, 1.0, 0.0, 1.0)
_MOST_CELLS: Final = 20_000


class GridDisplay(NewestMessage):
    """Map or costmap; changes on the topic with the suffix `_updates` are applied."""

    types = ("nav_msgs/msg/OccupancyGrid",)

    def __init__(self, topic: str, tools: DisplayTools) -> None:
        super().__init__(topic, tools)
        self._cells: npt.NDArray[np.uint8] | None = None
        self._problem = ""

    def take(self, message: Message, time_ns: int) -> None:
        grid = message
        if message.__msgtype__ == UPDATE:
            self._apply(grid)
            return
        super().take(message, time_ns)
        rows, columns = int(grid.info.height), int(grid.info.width)
        cells = np.asarray(grid.data, np.int8).reshape(-1)
        self._cells, self._problem = None, ""
        if cells.size != rows * columns:
            self._problem = f"the grid has {counted(cells.size, 'cell')}; its size is {columns} x {rows}"
        elif not (math.isfinite(grid.info.resolution) and grid.info.resolution > 0):
            self._problem = f"the resolution {grid.info.resolution:g} is not above 0"
        else:
            self._cells = cells.reshape(rows, columns).view(np.uint8)

    def _apply(self, change: Message) -> None:
        """Change a rectangle of the grid."""
        cells, x, y, width, height = self._cells, change.x, change.y, int(change.width), int(change.height)
        self.has_changed = True
        if cells is None:
            return  # RViz waits for the grid, too
        data = np.asarray(change.data, np.int8).reshape(-1)
        is_inside = x >= 0 and y >= 0 and x + width <= cells.shape[1] and y + height <= cells.shape[0]
        if not is_inside or data.size != width * height:
            self._problem = f"an update of {width} x {height} cells at {x}, {y} does not fit the grid"
            return
        self._cells = cells.copy()
        self._cells[y : y + height, x : x + width] = data.reshape(height, width).view(np.uint8)

    def draw_message(self, drawing: Drawing, message: Message, at: Placement) -> None:
        if self._problem:
            drawing.tell(self._problem)
        cells = self._cells
        origin = pose_of(message.info.origin, drawing)
        if cells is None or origin is None or cells.size == 0:
            return
        factor = -(-max(cells.shape) // _LARGEST)
        if factor > 1:
            drawing.tell(
                f"the grid of {cells.shape[1]} x {counted(cells.shape[0], 'cell')} is drawn {factor} times coarser"
            )
            cells = _coarser(cells, factor)
        colours = "costmap" if "costmap" in self.topic else "map"
        drawing.grid(at, cells, message.info.resolution * factor, Pose((0.0, 0.0, _LIFT)) @ origin, colours)


def _coarser(cells: npt.NDArray[np.uint8], factor: int) -> npt.NDArray[np.uint8]:
    """Return a grid whose cells have the most occupied value of `factor` x `factor` cells; unknown counts least."""
    rows, columns = (-(-size // factor) * factor for size in cells.shape)
    padded = np.full((rows, columns), -1, np.int8)
    padded[: cells.shape[0], : cells.shape[1]] = cells.view(np.int8)
    largest = padded.reshape(rows // factor, factor, columns // factor, factor).max(axis=(1, 3))
    return np.ascontiguousarray(largest).view(np.uint8)


class GridCellsDisplay(NewestMessage):
    """Cells of `nav_msgs/GridCells` as flat squares."""

    types = ("nav_msgs/msg/GridCells",)

    def draw_message(self, drawing: Drawing, message: Message, at: Placement) -> None:
        size = float(message.cell_width), float(message.cell_height), 0.002
        cells = message.cells[:_MOST_CELLS]
        if len(cells) < len(message.cells):
            drawing.tell(f"only {_MOST_CELLS} of {counted(len(message.cells), 'cell')} drawn")
        rows = np.zeros((len(cells), 14))
        rows[:, :3] = np.array([(c.x, c.y, c.z + _LIFT) for c in cells], np.float64).reshape(-1, 3)
        rows[:, 3], rows[:, 7:10], rows[:, 10:] = 1.0, size, _CELLS
        drawing.shapes("cube", at, rows)
