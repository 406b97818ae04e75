"""Last step of scan matching: points are moved onto the lines that the points of other scans form around them.

A correlative search ends at the steps of its lattice, and its smeared grid says little about the yaw. Here the
distances of the points to local lines are minimised by Gauss-Newton (Censi: *An ICP variant using a point-to-line
metric*, 2008).
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.elementary_functions import arctan2
from simkit.pose import wrap_angle
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

Floats = npt.NDArray[np.float64]

_CELL: Final = 0.1  # [m] side of a cell; a line is that of the points in 3 × 3 cells
_LEAST_OF_LINE: Final = 5  # points
_THIN: Final = 0.25  # largest ratio of the variances across and along a line; 0.1 doubles the errors in small rooms
_ITERATIONS: Final = 8
_SCALE: Final = 0.03  # [m] from which on a distance counts less
_NOISE: Final = 0.02  # [m] of a point
_PRIOR: Final = (0.03, 0.01)  # [m], [rad] standard deviation of the guess, which holds where no line does
_LEAST_POINTS: Final = 20
_SMALL: Final = (1e-5, 1e-6)  # [m], [rad] of a step that ends the search


def refine(guess: PlanarPose, points: Floats, reference: Floats) -> PlanarPose:
    """Return the pose near a guess at which points lie best on the lines of other points.

    Args:
        guess: pose of the frame of the points.
        points: points of the scan [m], shape (n, 2).
        reference: points of other scans in the frame of the guess [m], shape (m, 2).
    """
    if len(reference) < _LEAST_OF_LINE or len(points) < _LEAST_POINTS:
        return guess
    lines, pose = _Lines(reference), guess
    for _ in range(_ITERATIONS):
        moved = pose.transform(points)
        distance, normal, is_line = lines.around(moved)
        if int(is_line.sum()) < _LEAST_POINTS:
            return guess
        weight = np.where(is_line, 1.0 / (1.0 + (distance / _SCALE) ** 2) ** 2, 0.0) / _NOISE**2
        arm = moved - np.array((pose.x, pose.y))
        turn = normal[:, 1] * arm[:, 0] - normal[:, 0] * arm[:, 1]
        step = _step(pose, guess, np.column_stack((normal, turn)), distance, weight)
        pose = PlanarPose(pose.x + step[0], pose.y + step[1], wrap_angle(pose.yaw + step[2]))
        if math.hypot(step[0], step[1]) < _SMALL[0] and abs(step[2]) < _SMALL[1]:
            break
    return pose


class _Lines:
    """Lines through the points in the cells of a grid and in their neighbours."""

    def __init__(self, points: Floats) -> None:
        self._corner = np.floor(points.min(axis=0) / _CELL) - 2.0
        self._size = (np.floor(points.max(axis=0) / _CELL) - self._corner + 3.0).astype(np.int64)
        numbers, (x, y) = self._numbers(points), points.T
        cells = int(self._size[0] * self._size[1])
        sums = [np.bincount(numbers, weights, cells) for weights in (x, y, x * x, x * y, y * y)]
        self._sums = np.column_stack((np.bincount(numbers, minlength=cells), *sums))

    def _numbers(self, points: Floats) -> npt.NDArray[np.int64]:
        """Return the number of the cell of each point; points outside have the cell at the border."""
        cells = np.clip((np.floor(points / _CELL) - self._corner).astype(np.int64), 1, self._size - 2)
        numbers: npt.NDArray[np.int64] = cells[:, 1] * self._size[0] + cells[:, 0]
        return numbers

    def around(self, points: Floats) -> tuple[Floats, Floats, npt.NDArray[np.bool_]]:
        """Return distance and normal of the line around each point, and whether there is one."""
        numbers, width = self._numbers(points), int(self._size[0])
        total = np.zeros((len(points), 6))
        for shift in (row * width + column for row in (-1, 0, 1) for column in (-1, 0, 1)):
            total += self._sums[numbers + shift]
        count = np.maximum(total[:, 0], 1.0)
        x, y, xx, xy, yy = (total[:, 1:] / count[:, None]).T
        xx, xy, yy = xx - x * x, xy - x * y, yy - y * y
        spread = np.sqrt((xx - yy) ** 2 + 4 * xy * xy)
        angle = 0.5 * arctan2(2 * xy, xx - yy)
        normal = np.column_stack((-np.sin(angle), np.cos(angle)))
        is_line = (total[:, 0] >= _LEAST_OF_LINE) & (xx + yy - spread < _THIN * (xx + yy + spread))
        distance: Floats = normal[:, 0] * (points[:, 0] - x) + normal[:, 1] * (points[:, 1] - y)
        return distance, normal, is_line


def _step(
    pose: PlanarPose, guess: PlanarPose, columns: Floats, distance: Floats, weight: Floats
) -> tuple[float, float, float]:
    """Return the solution of the normal equations; their sums go along the first axis, in the order of the points."""
    products = [columns[:, i] * columns[:, j] * weight for i in range(3) for j in range(i, 3)]
    products += [-columns[:, i] * distance * weight for i in range(3)]
    a, b, c, d, e, f, x, y, z = (float(number) for number in np.column_stack(products).sum(axis=0))
    near, straight = 1.0 / _PRIOR[0] ** 2, 1.0 / _PRIOR[1] ** 2
    a, d, f = a + near, d + near, f + straight
    x, y = x + near * (guess.x - pose.x), y + near * (guess.y - pose.y)
    z += straight * wrap_angle(guess.yaw - pose.yaw)
    determinant = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d)
    return (
        ((d * f - e * e) * x + (c * e - b * f) * y + (b * e - c * d) * z) / determinant,
        ((c * e - b * f) * x + (a * f - c * c) * y + (b * c - a * e) * z) / determinant,
        ((b * e - c * d) * x + (b * c - a * e) * y + (a * d - b * b) * z) / determinant,
    )
