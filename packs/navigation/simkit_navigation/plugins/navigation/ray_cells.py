"""Cells of a grid that rays cross, as Nav2's costmaps trace them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit_navigation.plugins.navigation.planar_pose import Floats

Touched = npt.NDArray[np.bool_]
Numbers = npt.NDArray[np.int64]

_LARGEST_TABLE: Final = 1 << 24  # numbers of rays that are made unique with a table; more are sorted
_CELLS_AT_ONCE: Final = 1 << 21


def traced_cells(
    start: Sequence[float],
    ends: Sequence[Floats],
    shape: tuple[int, int, int],
    most: int,
    least: int = 0,
) -> Touched:
    """Return which cells of a grid rays cross, the first and the last cell included.

    The cells are those of `nav2_voxel_grid::VoxelGrid::raytraceLine`, and with whole numbers and one level those of
    `nav2_costmap_2d::Costmap2D::raytraceLine`: both use Bresenham's algorithm. Rays that cross the same cells are
    traced once.

    Args:
        start: column, row and level of the common start; the fraction is the place within the cell.
        ends: columns, rows and levels of the ends, each of shape (n,); all ends must be within the grid.
        shape: rows, columns and levels of the grid.
        most: length [cells] at which a longer ray ends.
        least: length [cells] before which nothing is crossed; a shorter ray is left out.

    Returns:
        Array of the shape rows × columns × levels.
    """
    rows, columns, levels = shape
    touched = np.zeros(rows * columns * levels, np.bool_)
    ways = [np.asarray(end, np.float64) - at for at, end in zip(start, ends, strict=True)]
    distance = np.sqrt(ways[0] * ways[0] + ways[1] * ways[1] + ways[2] * ways[2])
    last = [np.asarray(end, np.float64).astype(np.int64) for end in ends]
    if least > 0:
        is_long = np.floor(distance) >= least
        distance, ways, last = distance[is_long], [way[is_long] for way in ways], [cell[is_long] for cell in last]
        share = np.where(distance > 0, least / np.where(distance > 0, distance, 1.0), 0.0)
        first = [(at + way * share).astype(np.int64) for at, way in zip(start, ways, strict=True)]
    else:
        first = [np.full(len(distance), int(at), np.int64) for at in start]
    steps = [np.abs(end - begin) for begin, end in zip(first, last, strict=True)]
    longest = np.maximum(np.maximum(steps[0], steps[1]), steps[2])
    scale = np.minimum(1.0, most / np.where(distance > 0, distance, 1.0))
    count = np.minimum((scale * longest).astype(np.int64), longest)  # steps along the longest axis
    kept = _distinct_rays(first, last, count, shape, int(start[0]), int(start[1]), int(start[2]))
    first, last = [cell[kept] for cell in first], [cell[kept] for cell in last]
    steps, longest, count = [step[kept] for step in steps], longest[kept], count[kept]
    signs = [np.where(end > begin, 1, -1) for begin, end in zip(first, last, strict=True)]
    divisor = np.maximum(longest, 1)
    at_once = max(1, _CELLS_AT_ONCE // (int(count.max(initial=0)) + 1))
    for begin in range(0, len(count), at_once):
        part = slice(begin, begin + at_once)
        lengths = count[part] + 1
        ray = np.repeat(np.arange(len(lengths)), lengths)
        along = np.arange(len(ray)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
        # the error of Bresenham's algorithm begins with half of the longest axis and wraps at the whole of it
        half, whole = (longest[part] // 2)[ray], divisor[part][ray]
        column, row, level = (
            at[part][ray] + sign[part][ray] * ((half + along * step[part][ray]) // whole)
            for at, sign, step in zip(first, signs, steps, strict=True)
        )
        touched[(row * columns + column) * levels + level] = True
    return touched.reshape(shape)


def _distinct_rays(
    first: Sequence[Numbers],
    last: Sequence[Numbers],
    count: Numbers,
    shape: tuple[int, int, int],
    *start: int,
) -> Numbers:
    """Return the numbers of rays of which no two have the same first cell, last cell and length."""
    if not len(count):
        return np.zeros(0, np.int64)
    _, columns, levels = shape
    key = (last[1] * columns + last[0]) * levels + last[2]
    key = key * (int(count.max()) + 1) + count
    for cell, at in zip(first, start, strict=True):
        moved = cell - at
        low = int(moved.min())
        key = key * (int(moved.max()) - low + 1) + (moved - low)
    size = int(key.max()) + 1
    if size > _LARGEST_TABLE:
        return np.unique(key, return_index=True)[1].astype(np.int64)
    table = np.full(size, -1, np.int32)
    table[key] = np.arange(len(key), dtype=np.int32)
    return table[table >= 0].astype(np.int64)
