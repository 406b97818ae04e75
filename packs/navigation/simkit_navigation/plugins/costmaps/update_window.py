"""Part of a costmap that an update changes, as Nav2's layers declare it in `updateBounds`."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from simkit_navigation.plugins.costmaps.cost_grid import Cells, CostGrid
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose


@dataclass
class Bounds:
    """Rectangle in the frame of a costmap; it is empty at first.

    Attributes:
        min_x: lower bound of x [m].
        min_y: lower bound of y [m].
        max_x: upper bound of x [m].
        max_y: upper bound of y [m].
    """

    min_x: float = math.inf
    min_y: float = math.inf
    max_x: float = -math.inf
    max_y: float = -math.inf

    def copy(self) -> Bounds:
        """Return the same rectangle as another object."""
        return Bounds(self.min_x, self.min_y, self.max_x, self.max_y)

    def include(self, other: Bounds) -> None:
        """Extend the rectangle so that it contains another one."""
        self.min_x, self.min_y = min(self.min_x, other.min_x), min(self.min_y, other.min_y)
        self.max_x, self.max_y = max(self.max_x, other.max_x), max(self.max_y, other.max_y)

    def include_point(self, x: float, y: float) -> None:
        """Extend the rectangle so that it contains a point [m]."""
        self.include(Bounds(x, y, x, y))

    def include_everything(self) -> None:
        """Extend the rectangle so that it contains the whole costmap."""
        self.include(Bounds(-math.inf, -math.inf, math.inf, math.inf))


@dataclass(frozen=True)
class Window:
    """Cells of a costmap that an update may change.

    Attributes:
        min_i: first column.
        min_j: first row.
        max_i: column after the last one.
        max_j: row after the last one.
    """

    min_i: int
    min_j: int
    max_i: int
    max_j: int

    @property
    def rows(self) -> slice:
        """Rows of the window, as an index of `grid.cells`."""
        return slice(self.min_j, self.max_j)

    @property
    def columns(self) -> slice:
        """Columns of the window, as an index of `grid.cells`."""
        return slice(self.min_i, self.max_i)


def window_of(grid: CostGrid, bounds: Bounds) -> Window:
    """Return the cells that a rectangle touches."""
    rows, columns = grid.cells.shape
    if not (bounds.min_x <= bounds.max_x and bounds.min_y <= bounds.max_y):  # empty, or NaN
        return Window(0, 0, 0, 0)
    if grid.origin.yaw:
        return Window(0, 0, columns, rows)
    x, y, side = grid.origin.x, grid.origin.y, grid.resolution
    ends = ((bounds.min_x - x) / side, (bounds.min_y - y) / side, (bounds.max_x - x) / side, (bounds.max_y - y) / side)
    low_i, low_j, high_i, high_j = (min(max(end, -1.0), float(max(rows, columns))) for end in ends)
    first_i, first_j = min(max(math.floor(low_i), 0), columns), min(max(math.floor(low_j), 0), rows)
    last_i, last_j = min(math.floor(high_i) + 1, columns), min(math.floor(high_j) + 1, rows)
    return Window(first_i, first_j, max(last_i, first_i), max(last_j, first_j))


def window_of_layers(layers: Collection[Any], grid: CostGrid, robot: PlanarPose) -> Window:
    """Return the window of an update, which each layer may extend.

    A layer without `update_bounds` computes all cells anew, so that the window is the whole costmap.

    Args:
        layers: layers that are enabled.
        grid: costs.
        robot: pose of the robot in the frame of the grid.
    """
    bounds = Bounds()
    for layer in layers:
        if callable(getattr(layer, "update_bounds", None)):
            layer.update_bounds(robot, bounds)
        else:
            bounds.include_everything()
    return window_of(grid, bounds)


def apply_layer(name: str, layer: Any, grid: CostGrid, robot: PlanarPose, window: Window) -> None:
    """Let a layer write its costs.

    A layer with `update_bounds` receives the window in place of the pose of the robot, and changes no cell outside of
    the window.

    Raises:
        ValueError: the layer has replaced the cells by something else.
    """
    shape, before = grid.cells.shape, grid.cells
    if callable(getattr(layer, "update_bounds", None)):
        before = before.copy()
        layer.update_costs(grid, window)
    else:
        layer.update_costs(grid, robot)
    cells = grid.cells
    if not isinstance(cells, np.ndarray) or cells.dtype != np.uint8 or cells.shape != shape:
        raise ValueError(f"{name}: grid.cells must remain an array of uint8 with {shape[0]} × {shape[1]} cells")
    if cells is not before:
        before[window.rows, window.columns] = cells[window.rows, window.columns]
        grid.cells = before


def keep_outside(grid: CostGrid, before: CostGrid, window: Window) -> None:
    """Keep the costs of the update before this one outside of a window, if the costmap has not moved."""
    rows, columns = grid.cells.shape
    if (window.min_i, window.min_j, window.max_i, window.max_j) == (0, 0, columns, rows):
        return
    if before.cells.shape == grid.cells.shape and before.origin == grid.origin and before.frame == grid.frame:
        inside: Cells = grid.cells[window.rows, window.columns].copy()
        grid.cells[:] = before.cells
        grid.cells[window.rows, window.columns] = inside


def enabled_layers(layers: Mapping[str, Any], disabled: Collection[str]) -> dict[str, Any]:
    """Return the layers by name, without those that are disabled."""
    return {name: layer for name, layer in layers.items() if name not in disabled}
