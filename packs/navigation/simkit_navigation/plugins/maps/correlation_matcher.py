"""Correlative scan matching: the pose of a scan whose points agree best with the points of other scans.

The points of the other scans are drawn into a grid and smeared. All poses of a lattice are tried, first with double
steps, then with single ones (Olson: *Real-time correlative scan matching*, 2009). Parameters, penalties and the
covariance are those of Karto, the mapper of slam_toolbox. The responses are sums of integers, with the same bits on
every processor.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from simkit.elementary_functions import exp
from simkit.pose import wrap_angle
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
Field = npt.NDArray[np.uint16]
Covariance = tuple[float, float, float, float]
"""Variances xx, xy, yy [m²] and of the yaw [rad²]."""

_FULL: Final = 100  # value of a cell with a point
_MOST_POINTS: Final = 600  # of a scan; their sum stays below 2 ** 16
_FEW_POINTS: Final = 200  # of a scan in the search with double steps
_MOST_CELLS: Final = 3000  # between the sensor and a point that is matched; 30 m at 1 cm
_DISTANCE_GAIN: Final = 0.2  # of the penalties, as in Karto
_ANGLE_GAIN: Final = 0.2
_VARIANCE_BAND: Final = 0.1  # responses that are lower by less belong to the peak, as in Karto
_LARGEST_VARIANCE: Final = 500.0  # [m²] of a scan without points, as in Karto
_EXPANSION: Final = math.radians(20.0)  # by which the search of angles is widened, up to three times
_TIE: Final = 0.05  # by which a pose at the border of a search without penalties is worse


class Match(NamedTuple):
    """Result of a search."""

    pose: PlanarPose
    response: float  # mean value of the grid at the points, 0 to 1
    covariance: Covariance


@dataclass(frozen=True)
class SearchRules:
    """Parameters of slam_toolbox that all searches share."""

    distance_variance_penalty: float = 0.5
    angle_variance_penalty: float = 1.0
    fine_search_angle_offset: float = 0.00349
    coarse_search_angle_offset: float = 0.349
    coarse_angle_resolution: float = 0.0349
    minimum_angle_penalty: float = 0.9
    minimum_distance_penalty: float = 0.5
    use_response_expansion: bool = True


class CorrelationMatcher:
    """Search space around a pose.

    Args:
        dimension: side of the square in which the position is searched [m].
        resolution: side of a cell of the grid [m].
        smear: standard deviation by which points are smeared [m].
        rules: other parameters.
    """

    def __init__(self, dimension: float, resolution: float, smear: float, rules: SearchRules) -> None:
        self._reach = max(round(dimension / resolution / 4), 1)  # double steps from the centre
        self._resolution, self._rules = resolution, rules
        self._kernel = _kernel(smear / resolution)

    def match(self, guess: PlanarPose, points: Floats, reference: Floats, is_penalised: bool = True) -> Match:
        """Return the best pose near a guess.

        Args:
            guess: expected pose of the frame of the points.
            points: points of the scan [m], shape (n, 2).
            reference: points of other scans in the frame of the guess [m], shape (m, 2).
            is_penalised: whether poses far from the guess are worse.
        """
        rules, step = self._rules, self._resolution
        if not len(points) or not len(reference):
            return Match(guess, 0.0, (_LARGEST_VARIANCE, 0.0, _LARGEST_VARIANCE, 4 * rules.coarse_angle_resolution**2))
        is_near = np.hypot(points[:, 0], points[:, 1]) <= _MOST_CELLS * step
        points = points[is_near] if is_near.any() else points[:0]
        points = _thinned(points, _MOST_POINTS)
        few = _thinned(points, _FEW_POINTS)
        half = math.ceil(float(np.hypot(points[:, 0], points[:, 1]).max(initial=0.0)) / step) + 2 * self._reach + 4
        field = self._field(reference - np.array((guess.x, guess.y)), half)
        offset = rules.coarse_search_angle_offset
        for _ in range(4 if rules.use_response_expansion else 1):
            turns = _lattice(rules.coarse_angle_resolution, offset)
            coarse = _Lattice(field, half, few / step, guess.yaw, (0, 0), turns, 2, self._reach)
            scores = coarse.responses * self._penalties(coarse, is_penalised)
            index = int(scores.argmax())
            if scores.flat[index] > 0.0:
                break
            offset += _EXPANSION
        best = _place(index, scores)
        covariance = self._covariance(coarse, best)
        turns = turns[best[0]] + _lattice(rules.fine_search_angle_offset, 0.5 * rules.coarse_angle_resolution)
        fine = _Lattice(field, half, points / step, guess.yaw, coarse.shift(best), turns, 1, 3)
        scores = fine.responses * self._penalties(fine, is_penalised)
        scores = scores[:, 1:-1, 1:-1]
        turn, row, column = _place(int(scores.argmax()), scores)
        best = (turn, row + 1, column + 1)
        x, y, yaw = fine.peak(best)
        pose = PlanarPose(guess.x + x * step, guess.y + y * step, wrap_angle(guess.yaw + yaw))
        return Match(pose, float(fine.responses[best]), covariance)

    def _field(self, points: Floats, half: int) -> Field:
        """Return the smeared points in a grid of `2 half + 1` cells around the guess."""
        border = len(self._kernel) // 2
        each = 2 if border > 5 else 1  # where the kernel is wide, one point in four cells is enough
        cells = each * np.rint(points / (each * self._resolution)).astype(np.int64)
        cells = cells[(np.abs(cells) <= half).all(axis=1)] + half
        side = 2 * half + 1
        field: Field = np.zeros((side + 2 * border, side + 2 * border), np.uint16)
        kernel, width = self._kernel, len(self._kernel)
        for row, column in zip(
            *(k.tolist() for k in np.divmod(np.unique(cells[:, 1] * side + cells[:, 0]), side)), strict=True
        ):
            view = field[row : row + width, column : column + width]
            np.maximum(view, kernel, out=view)
        return field[border : side + border, border : side + border]

    def _penalties(self, lattice: _Lattice, is_penalised: bool) -> Floats:
        """Return the factor of each response of a lattice."""
        rules, step = self._rules, self._resolution
        squares = (lattice.columns**2 + lattice.rows[:, None] ** 2) * step**2
        if not is_penalised:
            widest = 2.0 * (2 * self._reach * step) ** 2
            return np.broadcast_to(1.0 - _TIE * squares / widest, lattice.responses.shape)
        distance = 1.0 - _DISTANCE_GAIN * squares / rules.distance_variance_penalty
        angle = 1.0 - _ANGLE_GAIN * lattice.turns**2 / rules.angle_variance_penalty
        near, straight = rules.minimum_distance_penalty, rules.minimum_angle_penalty
        factors: Floats = np.maximum(distance, near) * np.maximum(angle, straight)[:, None, None]
        return factors

    def _covariance(self, lattice: _Lattice, best: tuple[int, int, int]) -> Covariance:
        """Return the covariance of the peak of the responses, from exact sums of integers."""
        turn, row, column = best
        step, sums = self._resolution, lattice.sums.astype(np.int64)
        peak = int(sums[turn, row, column])
        least = peak - int(_VARIANCE_BAND * _FULL * lattice.count)
        response = max(peak / (_FULL * lattice.count), 1e-6)
        layer = np.where(sums[turn] >= least, sums[turn], 0)
        dx = (lattice.columns - lattice.columns[column]).astype(np.int64)
        dy = (lattice.rows - lattice.rows[row]).astype(np.int64)[:, None]
        total = max(int(layer.sum()), 1)
        xx, yy, xy = (int((layer * factor).sum()) / total * step**2 for factor in (dx * dx, dy * dy, dx * dy))
        floor = 0.1 * (2 * step) ** 2
        angles = np.where(sums[:, row, column] >= least, sums[:, row, column], 0)
        steps = np.arange(len(angles)) - turn
        spread = int((angles * steps * steps).sum()) / max(int(angles.sum()), 1)
        yaw = max(spread, 0.1) * self._rules.coarse_angle_resolution**2
        return max(xx, floor) / response, xy / response, max(yy, floor) / response, yaw


class _Lattice:
    """Responses for all turns and shifts of a lattice.

    Attributes:
        turns: turns from the guess [rad].
        rows, columns: shifts in y and x from the guess, in cells.
        count: number of points.
        sums: sums of the field at the points; shape (turns, rows, columns).
        responses: the same as shares of the largest sum.
    """

    def __init__(
        self,
        field: Field,
        half: int,
        points: Floats,
        yaw: float,
        centre: tuple[int, int],
        turns: Floats,
        step: int,
        reach: int,
    ) -> None:
        shifts = step * np.arange(-reach, reach + 1)
        self.turns, self.columns, self.rows = turns, shifts + centre[0], shifts + centre[1]
        self.count, self._step = len(points), step
        size = len(shifts)
        self.sums = np.zeros((len(turns), size, size), np.uint16)
        width = step * (size - 1) + 1
        first = half - step * reach
        for layer, turn in zip(self.sums, turns.tolist(), strict=True):
            cos, sin = math.cos(yaw + turn), math.sin(yaw + turn)
            x = np.rint(cos * points[:, 0] - sin * points[:, 1]).astype(np.int64) + (first + centre[0])
            y = np.rint(sin * points[:, 0] + cos * points[:, 1]).astype(np.int64) + (first + centre[1])
            for row, column in zip(y.tolist(), x.tolist(), strict=True):
                layer += field[row : row + width : step, column : column + width : step]
        self.responses: Floats = self.sums / (_FULL * self.count)

    def shift(self, index: tuple[int, int, int]) -> tuple[int, int]:
        """Return the shift in x and y of an index, in cells."""
        return int(self.columns[index[2]]), int(self.rows[index[1]])

    def peak(self, index: tuple[int, int, int]) -> tuple[float, float, float]:
        """Return x and y [cells] and turn [rad] of the peak of parabolas through the responses around an index."""
        turn, row, column = index
        sums = self.sums.astype(np.int64)
        x = self.columns[column] + self._step * _vertex(sums[turn, row, column - 1 : column + 2].tolist())
        y = self.rows[row] + self._step * _vertex(sums[turn, row - 1 : row + 2, column].tolist())
        angle = float(self.turns[turn])
        if 0 < turn < len(self.turns) - 1:
            spacing = float(self.turns[turn + 1] - self.turns[turn])
            angle += spacing * _vertex(sums[turn - 1 : turn + 2, row, column].tolist())
        return float(x), float(y), angle


def _thinned(points: Floats, most: int) -> Floats:
    """Return at most so many points, evenly over all."""
    return points[:: max(-(-len(points) // most), 1)]


def _place(index: int, scores: Floats) -> tuple[int, int, int]:
    """Return turn, row and column of an index of the flat scores."""
    turn, row, column = (int(k) for k in np.unravel_index(index, scores.shape))
    return turn, row, column


def _vertex(values: list[int]) -> float:
    """Return the place of the vertex of a parabola through three values at -1, 0 and 1; at most 0.5 away from 0."""
    left, middle, right = values
    curve = left - 2 * middle + right
    return min(max((left - right) / (2 * curve), -0.5), 0.5) if curve < 0 else 0.0


def _lattice(step: float, reach: float) -> Floats:
    """Return the multiples of a step from `-reach` to `reach`."""
    count = max(round(reach / step), 1)
    values: Floats = step * np.arange(-count, count + 1).astype(np.float64)
    return values


@cache
def _kernel(deviation: float) -> Field:
    """Return the values around a point, for a standard deviation in cells."""
    border = max(round(2.0 * deviation), 1)
    squares = np.arange(-border, border + 1) ** 2
    distances = (squares + squares[:, None]).astype(float)
    kernel: Field = np.rint(_FULL * exp(distances / (-2.0 * max(deviation, 0.1) ** 2))).astype(np.uint16)
    return kernel
