"""Costs under the outline of a robot at many poses."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt

from simkit_navigation.plugins.costmaps.cost_grid import UNKNOWN, Cells, CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats

Numbers = npt.NDArray[np.floating[Any]]

_AT_ONCE: Final = 200_000  # points of an outline that are looked up together


def costs_of_cells(cells: Cells, resolution: float, x: Numbers, y: Numbers) -> Cells:
    """Return the costs at points in the frame of the cells [m]; a point outside has the cost UNKNOWN."""
    columns, rows = np.floor(x * (1.0 / resolution)), np.floor(y * (1.0 / resolution))
    inside = (columns >= 0) & (columns < cells.shape[1]) & (rows >= 0) & (rows < cells.shape[0])
    index = np.where(inside, rows * cells.shape[1] + columns, 0).astype(np.int64)
    costs: Cells = np.where(inside, cells.reshape(-1)[index], np.uint8(UNKNOWN))
    return costs


def footprint_costs(grid: CostGrid, points: Floats, x: Numbers, y: Numbers, cos: Numbers, sin: Numbers) -> Cells:
    """Return the largest cost on the outline at each pose.

    Args:
        grid: costs; the poses are given in the frame of its cells.
        points: points of the outline, from `edge_points`, at most one cell apart.
        x: places of the robot [m], shape (n,).
        y: places of the robot [m], shape (n,).
        cos: cosines of its headings, shape (n,).
        sin: sines of its headings, shape (n,).
    """
    largest = np.empty(len(x), np.uint8)
    share = max(1, _AT_ONCE // len(points))
    across, along = points[:, 1], points[:, 0]
    for at in range(0, len(x), share):
        part = slice(at, at + share)
        c, s = cos[part, None], sin[part, None]
        costs = costs_of_cells(
            grid.cells, grid.resolution, x[part, None] + c * along - s * across, y[part, None] + s * along + c * across
        )
        largest[part] = costs.max(axis=1)
    return largest
