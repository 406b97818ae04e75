"""Simultaneous localisation and mapping on a grid: scans are matched with the map that the scans before them made.

The pose of a scan is that with the best agreement near the pose that the odometry predicts: a search over a lattice of
poses, then over ever finer ones (Olson: *Real-time correlative scan matching*, 2009). Loops are not closed.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Pose
from simkit.elementary_functions import exp
from simkit.sensors.occupancy_map import OccupancyMap
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

Floats = npt.NDArray[np.float64]
Counts = npt.NDArray[np.int32]

_SIGMA: Final = 0.1  # [m] standard deviation of the distance between the end of a ray and an obstacle
_MOST_RAYS: Final = 120  # rays of a scan that are matched
_REACH: Final = (0.3, 0.3)  # [m], [rad] of the search
_STEPS: Final = ((0.05, 0.03), (0.0125, 0.01), (0.004, 0.003))  # [m], [rad] of each lattice
_PENALTY: Final = 0.1  # of a pose at the border of the search
_LEAST_BEAMS: Final = 2  # through a known cell
_OCCUPIED: Final = 0.1  # share of the beams through a cell that end in it; both as in Karto
_MARGIN: Final = 40  # cells by which the map grows


class ScanMapper:
    """Map that grows with each scan.

    Args:
        resolution: side of a cell [m].
        max_range: longest range that is used [m].

    Attributes:
        pose: pose of the robot in the map at the last scan.
        scans: number of scans in the map.
    """

    def __init__(self, resolution: float, max_range: float) -> None:
        self._resolution, self._max_range = resolution, max_range
        self.pose = PlanarPose(0.0, 0.0, 0.0)
        self.scans = 0
        self._beams: Counts = np.zeros((0, 0), np.int32)  # through each cell
        self._ends: Counts = np.zeros((0, 0), np.int32)  # in each cell
        self._corner = (0, 0)  # row and column of the first cell; the origin is the corner of the cell (0, 0)

    def add_scan(self, predicted: PlanarPose, sensor: PlanarPose, ranges: Floats, angles: Floats, limit: float) -> None:
        """Find the pose of a scan, and add the scan to the map.

        Args:
            predicted: pose of the robot that the odometry predicts.
            sensor: pose of the sensor in the frame of the robot.
            ranges: ranges [m]; NaN for no measurement, infinite for nothing within the range.
            angles: directions in the frame of the sensor [rad].
            limit: longest range of the sensor [m].
        """
        longest = min(limit, self._max_range)
        is_hit = np.isfinite(ranges) & (ranges > 0.0) & (ranges <= longest)
        directions = np.column_stack((np.cos(angles), np.sin(angles)))
        ends = sensor.transform(directions[is_hit] * ranges[is_hit, None])
        self.pose = self._matched(predicted, ends) if self.scans else predicted
        self.scans += 1
        reach = np.where(is_hit, ranges, np.where(ranges > longest, longest, 0.0))
        self._count(self.pose.compose(sensor), self.pose.transform(ends), directions, reach, is_hit)

    # ------------------------------------------------------------------ matching

    def _matched(self, guess: PlanarPose, points: Floats) -> PlanarPose:
        """Return the pose near a guess with the best agreement of the ends of rays and the map."""
        if not len(points):
            return guess
        points = points[:: max(1, len(points) // _MOST_RAYS)]
        field, corner = self._field()
        best = np.array((guess.x, guess.y, guess.yaw))
        start, reach = best.copy(), np.array((_REACH[0], _REACH[0], _REACH[1]))
        for step, turn in _STEPS:
            steps = np.array((step, step, turn))
            counts = np.maximum(np.rint(reach / steps), 1.0)
            axes = [best[k] + steps[k] * np.arange(-counts[k], counts[k] + 1) for k in range(3)]
            best, reach = self._best(axes, start, points, field, corner), 2 * steps
        x, y, yaw = best.tolist()
        return PlanarPose(x, y, yaw)

    def _best(
        self, axes: list[Floats], start: Floats, points: Floats, field: Floats, corner: tuple[int, int]
    ) -> Floats:
        """Return the pose of a lattice with the best agreement."""
        xs, ys, yaws = axes
        best, best_score = start, -np.inf
        for yaw in yaws.tolist():
            turned = PlanarPose(0.0, 0.0, yaw).transform(points)
            columns = _interpolated(turned[:, 0, None] + xs, corner[1], self._resolution)
            rows = _interpolated(turned[:, 1, None] + ys, corner[0], self._resolution)
            scores = _agreement(field, rows, columns)
            away = ((xs - start[0]) ** 2 + (ys[:, None] - start[1]) ** 2) / _REACH[0] ** 2
            scores -= _PENALTY * (away + ((yaw - start[2]) / _REACH[1]) ** 2)
            index = int(scores.argmax())
            if scores.flat[index] > best_score:
                row, column = divmod(index, len(xs))
                best_score, best = float(scores.flat[index]), np.array((xs[column], ys[row], yaw))
        return best

    def _field(self) -> tuple[Floats, tuple[int, int]]:
        """Return the agreement of the end of a ray in each cell, with a border of zeros, and its corner."""
        from scipy.ndimage import distance_transform_edt

        is_occupied = self._ends > _OCCUPIED * self._beams
        distance = distance_transform_edt(~np.pad(is_occupied, 2)) * self._resolution
        field = exp(-(distance**2) / (2 * _SIGMA**2))
        field[[0, -1]] = 0.0
        field[:, [0, -1]] = 0.0
        return field, (self._corner[0] - 2, self._corner[1] - 2)

    # ------------------------------------------------------------------ map

    def _count(
        self, sensor: PlanarPose, ends: Floats, directions: Floats, reach: Floats, is_hit: npt.NDArray[np.bool_]
    ) -> None:
        """Count the beams of a scan through the cells."""
        side = self._resolution
        along = np.arange(0.0, float(reach.max(initial=0.0)) + side, side)
        distances, numbers = np.broadcast_arrays(along[:, None], np.arange(len(reach)))
        is_before = distances < reach - side * np.where(is_hit, 0.5, 0.0)
        through = sensor.transform(directions[numbers[is_before]] * distances[is_before][:, None])
        free, occupied = _cells(through, side), _cells(ends, side)
        everything = np.concatenate((free, occupied))
        if not len(everything):
            return
        self._grow(everything.min(axis=0), everything.max(axis=0))
        for cells in (free, occupied):
            np.add.at(self._beams, tuple((cells - self._corner).T), 1)
        np.add.at(self._ends, tuple((occupied - self._corner).T), 1)

    def _grow(self, low: npt.NDArray[np.int64], high: npt.NDArray[np.int64]) -> None:
        """Make the map larger, so that it contains the cells from `low` to `high`."""
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
        """Return the map: 100 for occupied cells, 0 for free ones, -1 for cells that few beams have crossed."""
        is_known, is_occupied = self._beams >= _LEAST_BEAMS, self._ends > _OCCUPIED * self._beams
        cells = np.where(is_known, np.where(is_occupied, 100, 0), -1).astype(np.int8)
        known_rows, known_columns = np.nonzero(self._beams.any(axis=1))[0], np.nonzero(self._beams.any(axis=0))[0]
        if not len(known_rows):
            return OccupancyMap(np.zeros((0, 0), np.int8), self._resolution, Pose())
        row, column = int(known_rows[0]), int(known_columns[0])
        cells = np.ascontiguousarray(cells[row : known_rows[-1] + 1, column : known_columns[-1] + 1])
        x, y = (self._corner[1] + column) * self._resolution, (self._corner[0] + row) * self._resolution
        return OccupancyMap(cells, self._resolution, Pose((x, y, 0.0)))


def _cells(points: Floats, side: float) -> npt.NDArray[np.int64]:
    """Return row and column of the cells of points, shape (n, 2)."""
    cells: npt.NDArray[np.int64] = np.floor(points[:, ::-1] / side).astype(np.int64)
    return cells


def _interpolated(coordinates: Floats, corner: int, side: float) -> tuple[npt.NDArray[np.int64], Floats]:
    """Return the index of the cell before each coordinate, and the weight of the cell after it."""
    at = coordinates / side - corner - 0.5
    index = np.floor(at)
    return index.astype(np.int64), at - index


def _agreement(
    field: Floats, rows: tuple[npt.NDArray[np.int64], Floats], columns: tuple[npt.NDArray[np.int64], Floats]
) -> Floats:
    """Return the mean of the field at the ends of rays, for all shifts: shape (shifts in y, shifts in x)."""
    row, column = (np.clip(index, 0, size - 2) for (index, _), size in zip((rows, columns), field.shape, strict=True))
    up, right = (np.clip(weight, 0.0, 1.0) for _, weight in (rows, columns))
    row, up, column, right = row[:, :, None], up[:, :, None], column[:, None, :], right[:, None, :]
    lower, upper = field[row, column], field[row + 1, column]
    left = lower + (upper - lower) * up
    lower, upper = field[row, column + 1], field[row + 1, column + 1]
    values = left + (lower + (upper - lower) * up - left) * right
    mean: Floats = values.sum(axis=0) / len(values)
    return mean
