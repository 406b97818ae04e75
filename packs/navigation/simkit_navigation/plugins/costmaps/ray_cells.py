"""Cells of a grid that rays cross, as Nav2's costmaps trace them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit_navigation.plugins.navigation.planar_pose import Floats

Touched = npt.NDArray[np.bool_]
Numbers = npt.NDArray[np.int64]

AT_ONCE: Final = 1 << 14
"""Number of rays that are best added at once: the arrays of more rays do not fit into the cache of a core."""

_LARGEST_TABLE: Final = 1 << 26  # numbers of rays that are made unique with a table; more are sorted
_CELLS_AT_ONCE: Final = 1 << 16


class RayTracer:
    """Rays from a common start, and the cells that they cross, the first and the last cell included.

    The cells are those of `nav2_voxel_grid::VoxelGrid::raytraceLine`, and with whole numbers and one level those of
    `nav2_costmap_2d::Costmap2D::raytraceLine`: both use Bresenham's algorithm. Rays that cross the same cells are
    traced once.

    Args:
        start: column, row and level of the common start; the fraction is the place within the cell.
        shape: rows, columns and levels of the grid.
        most: length [cells] at which a longer ray ends.
        least: length [cells] before which nothing is crossed; a shorter ray is left out.
    """

    def __init__(self, start: Sequence[float], shape: tuple[int, int, int], most: int, least: int = 0) -> None:
        self._start, self._shape, self._most, self._least = start, shape, most, least
        self._lengths = min(most, max(shape)) + 1  # possible numbers of steps
        size = shape[0] * shape[1] * shape[2] * self._lengths
        self._table = np.zeros(size, np.bool_) if not least and size <= _LARGEST_TABLE else None
        self._rays: list[tuple[Numbers, ...]] = []

    def add(self, ends: Sequence[Floats]) -> None:
        """Add rays.

        Args:
            ends: columns, rows and levels of the ends, each of shape (n,); all ends must be within the grid.
        """
        ways = [end - at for at, end in zip(self._start, ends, strict=True)]
        distance = np.sqrt(ways[0] * ways[0] + ways[1] * ways[1] + ways[2] * ways[2])
        last = [end.astype(np.int64) for end in ends]
        if self._least:
            is_long = np.floor(distance) >= self._least
            distance, ways, last = distance[is_long], [way[is_long] for way in ways], [cell[is_long] for cell in last]
            share = np.where(distance > 0, self._least / np.where(distance > 0, distance, 1.0), 0.0)
            first = [(at + way * share).astype(np.int64) for at, way in zip(self._start, ways, strict=True)]
        else:
            first = [np.full(len(distance), int(at)) for at in self._start]
        steps = [np.abs(end - begin) for begin, end in zip(first, last, strict=True)]
        longest = np.maximum(np.maximum(steps[0], steps[1]), steps[2])
        scale = np.minimum(1.0, self._most / np.where(distance > 0, distance, 1.0))
        count = np.minimum((scale * longest).astype(np.int64), longest)  # steps along the longest axis
        _, columns, levels = self._shape
        key = ((last[1] * columns + last[0]) * levels + last[2]) * self._lengths + count
        if self._table is not None:
            self._table[key] = True
            return
        for cell, at in zip(first, self._start, strict=True):  # the first cells differ by at most `least` cells
            key = key * (2 * self._least + 3) + (cell - int(at) + self._least + 1)
        kept = np.unique(key, return_index=True)[1]
        self._rays.append(tuple(numbers[kept] for numbers in (*first, *last, count)))

    def cells(self) -> Touched:
        """Return which cells the rays cross, in the shape of the grid."""
        rows, columns, levels = self._shape
        touched = np.zeros(rows * columns * levels, np.bool_)
        for *ends, count in self._distinct_rays():
            first, last = ends[:3], ends[3:]
            steps = [np.abs(end - begin) for begin, end in zip(first, last, strict=True)]
            longest = np.maximum(np.maximum(steps[0], steps[1]), steps[2])
            signs = [np.sign(end - begin) for begin, end in zip(first, last, strict=True)]
            at_once = max(1, _CELLS_AT_ONCE // (int(count.max(initial=0)) + 1))
            for begin in range(0, len(count), at_once):
                part = slice(begin, begin + at_once)
                lengths = count[part] + 1
                ray = np.repeat(np.arange(len(lengths)), lengths)
                along = np.arange(len(ray)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
                # the error of Bresenham's algorithm begins with half of the longest axis and wraps at the whole of it
                half, whole = (longest[part] // 2)[ray], np.maximum(longest[part], 1)[ray]
                column, row, level = (
                    at[part][ray] + sign[part][ray] * ((half + along * step[part][ray]) // whole)
                    for at, sign, step in zip(first, signs, steps, strict=True)
                )
                touched[(row * columns + column) * levels + level] = True
        return touched.reshape(self._shape)

    def _distinct_rays(self) -> list[tuple[Numbers, ...]]:
        """Return groups of rays: columns, rows and levels of the first and the last cells, and numbers of steps."""
        if self._table is None:
            return self._rays
        key, count = np.divmod(np.flatnonzero(self._table), self._lengths)
        key, level = np.divmod(key, self._shape[2])
        row, column = np.divmod(key, self._shape[1])
        first = (np.full(len(count), int(at)) for at in self._start)
        return [(*first, column, row, level, count)]
