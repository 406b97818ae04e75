"""Occupancy grid of beams: how many crossed each cell, and how many ended in it."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Pose
from simkit.sensors.occupancy_map import OccupancyMap

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
Counts = npt.NDArray[np.int32]

_LEAST_BEAMS: Final = 2  # through a known cell
_OCCUPIED: Final = 0.1  # share of the beams through a cell that end in it; both as in Karto
_LEAST_ENDS: Final = 2  # in an occupied cell; with one end, 2 % of the cells behind walls are false at 2 cm of noise
_MARGIN: Final = 40  # cells by which the grid grows


class BeamCounts:
    """Counts of beams in a grid that grows; beams can be taken out again.

    Args:
        resolution: side of a cell [m].
    """

    def __init__(self, resolution: float) -> None:
        self._resolution = resolution
        self._beams: Counts = np.zeros((0, 0), np.int32)  # through each cell
        self._ends: Counts = np.zeros((0, 0), np.int32)  # in each cell
        self._corner = (0, 0)  # row and column of the first cell; the origin is the corner of the cell (0, 0)

    def add(self, start: tuple[float, float], ends: Floats, is_hit: npt.NDArray[np.bool_], sign: int = 1) -> None:
        """Add beams.

        Args:
            start: position of the sensor [m].
            ends: ends of the beams [m], shape (n, 2).
            is_hit: whether each beam ended at an obstacle.
            sign: 1 to add the beams, -1 to take them out.
        """
        if not len(ends):
            return
        origin, side = np.array(start), self._resolution
        steps = np.abs(np.floor(ends / side) - np.floor(origin / side)).max(axis=1).astype(np.int64)
        numbers = steps + ~is_hit  # cells before the end; a beam without a hit crosses its last cell, too
        beam = np.repeat(np.arange(len(ends)), numbers)
        step = np.arange(len(beam)) - np.repeat(np.cumsum(numbers) - numbers, numbers)
        share = step / np.maximum(steps[beam], 1)
        through = origin + (ends[beam] - origin) * share[:, None]
        free, occupied = _cells(through, side), _cells(ends[is_hit], side)
        everything = np.concatenate((free, occupied))
        self._grow(everything.min(axis=0), everything.max(axis=0))
        rows, columns = self._beams.shape
        for cells, grids in ((free, (self._beams,)), (occupied, (self._beams, self._ends))):
            row, column = (cells - np.array(self._corner)).T
            counts = np.bincount(row * columns + column, minlength=rows * columns).reshape(rows, columns)
            for grid in grids:
                grid += (sign * counts).astype(np.int32)

    def _grow(self, low: Integers, high: Integers) -> None:
        """Make the grid larger, so that it contains the cells from `low` to `high`."""
        rows, columns = self._beams.shape
        first = np.array(self._corner)
        last = first + np.array((rows - 1, columns - 1))
        if not rows:
            first, last = low, low - 1
        elif (low >= first).all() and (high <= last).all():
            return
        begin = np.where(low < first, low - _MARGIN, first) if rows else low - _MARGIN
        end = np.where(high > last, high + _MARGIN, last) if rows else high + _MARGIN
        shape = tuple((end - begin + 1).tolist())
        at = tuple(slice(k, k + n) for k, n in zip((first - begin).tolist(), (rows, columns), strict=True))
        for name in ("_beams", "_ends"):
            larger = np.zeros(shape, np.int32)
            larger[at] = getattr(self, name)
            setattr(self, name, larger)
        self._corner = (int(begin[0]), int(begin[1]))

    def occupancy(self) -> OccupancyMap:
        """Return the map: 100 for occupied cells, 0 for free ones, -1 for cells that few beams have reached."""
        is_met, is_sure = self._ends > _OCCUPIED * self._beams, self._ends >= _LEAST_ENDS
        is_occupied, is_known = is_met & is_sure, (self._beams >= _LEAST_BEAMS) & (is_sure | ~is_met)
        cells = np.where(is_known, np.where(is_occupied, 100, 0), -1).astype(np.int8)
        known_rows, known_columns = (np.nonzero(self._beams.any(axis=axis))[0] for axis in (1, 0))
        if not len(known_rows):
            return OccupancyMap(np.zeros((0, 0), np.int8), self._resolution, Pose())
        row, column = int(known_rows[0]), int(known_columns[0])
        cells = np.ascontiguousarray(cells[row : known_rows[-1] + 1, column : known_columns[-1] + 1])
        x, y = (self._corner[1] + column) * self._resolution, (self._corner[0] + row) * self._resolution
        return OccupancyMap(cells, self._resolution, Pose((x, y, 0.0)))


def _cells(points: Floats, side: float) -> Integers:
    """Return row and column of the cells of points, shape (n, 2)."""
    cells: Integers = np.floor(points[:, ::-1] / side).astype(np.int64)
    return cells
