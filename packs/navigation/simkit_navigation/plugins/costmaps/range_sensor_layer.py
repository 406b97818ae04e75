"""Layer with the obstacles that sonars and infrared sensors see (`nav2_costmap_2d::RangeSensorLayer`)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, msgs
from simkit.elementary_functions import arctan2, each
from simkit.extend import Options, boolean, choice, number, texts
from simkit_navigation.plugins.costmaps.cost_grid import FREE, LETHAL, UNKNOWN, Cells, CostGrid, Mask
from simkit_navigation.plugins.costmaps.observation_buffer import find_pose
from simkit_navigation.plugins.costmaps.obstacle_layer import shifted
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.costmaps.costmap_node import CostmapNode

_RANGE: Final = "sensor_msgs/msg/Range"
_HIT: Final = 233  # cost that Nav2 writes at the end of a reading before it updates the cone
_REACH: Final = 1.2  # share of the range up to which a reading changes the cells
_UNDECIDED: Final = 127  # 254 · 0.5


class RangeSensorLayerOptions(Options):
    """Options of `RangeSensorLayer`."""

    enabled: bool = boolean(True)
    topics: tuple[str, ...] = texts()
    phi: float = number(1.2, "m")
    inflate_cone: float = number(1.0, minimum=0, maximum=1)
    no_readings_timeout: float = number(0.0, "s", minimum=0)
    clear_threshold: float = number(0.2, minimum=0, maximum=1)
    mark_threshold: float = number(0.8, minimum=0, maximum=1)
    clear_on_max_reading: bool = boolean(False)
    input_sensor_type: str = choice(("ALL", "VARIABLE", "FIXED"), "ALL")


class RangeSensorLayer:
    """Obstacles in `sensor_msgs/msg/Range` (`nav2_costmap_2d::RangeSensorLayer`).

    Each cell has a probability p, stored as 254 p, which begins with 0.5. Each reading multiplies the odds of the cells
    in its cone. At the distance φ from a sensor, at the angle θ from its axis, its weight is
    λ = (1 - (1 + tanh(2 (φ - `<phi>`))) / 2) (1 - (θ / θ_max)²), with half the field of view θ_max.
    """

    def on_initialize(self, node: CostmapNode, params: Params) -> None:
        self._options, self._node = RangeSensorLayerOptions(params).read_all(), node
        self._readings: list[msgs.Message] = []
        self._last_ns, self._has_told = node.sim.time_ns, False
        self._odds: Cells = np.zeros((0, 0), np.uint8)
        self._origin = PlanarPose(0.0, 0.0, 0.0)
        topics = [topic for listed in self._options.topics for topic in listed.replace(",", " ").split()]
        if not topics:
            node.report_once("topics of range sensors", "a RangeSensorLayer without <topics> sees nothing")
        for topic in topics if self._options.enabled else ():
            node.receive(topic, _RANGE, "topics", self.add_reading)

    def add_reading(self, message: msgs.Message) -> None:
        """Store a reading until the next update."""
        self._readings.append(message)

    def update_costs(self, grid: CostGrid, robot: PlanarPose) -> None:
        """Update the probabilities by the new readings, and write obstacles and free cells."""
        self._match(grid)
        readings, self._readings = self._readings, []
        for reading in readings:
            self._add(grid, reading)
        self._check_timeout()
        options, odds = self._options, self._odds
        if not options.enabled:
            return
        mark, clear = (int(share * LETHAL) for share in (options.mark_threshold, options.clear_threshold))
        costs = np.where(odds > mark, np.uint8(LETHAL), np.uint8(FREE))
        is_decided = (odds != UNKNOWN) & ((odds > mark) | (odds < clear))
        np.copyto(grid.cells, costs, where=is_decided & ((grid.cells == UNKNOWN) | (grid.cells < costs)))

    def _match(self, grid: CostGrid) -> None:
        if self._odds.shape != grid.cells.shape:
            self._odds = np.full(grid.cells.shape, _UNDECIDED, np.uint8)
        elif grid.origin != self._origin:
            right = round((grid.origin.x - self._origin.x) / grid.resolution)
            up = round((grid.origin.y - self._origin.y) / grid.resolution)
            known = shifted(self._odds, up, right)
            self._odds = np.where(known == UNKNOWN, np.uint8(_UNDECIDED), known)
        self._origin = grid.origin

    def _check_timeout(self) -> None:
        late = (self._node.sim.time_ns - self._last_ns) * 1e-9
        if 0 < self._options.no_readings_timeout < late and not self._has_told:
            self._has_told = True
            text = "no range reading for %.2f s; no_readings_timeout is %.2f s"
            self._node.log.warning(text, late, self._options.no_readings_timeout)

    # ------------------------------------------------------------------ readings

    def _add(self, grid: CostGrid, reading: msgs.Message) -> None:
        """Update the cells in the cone of a reading, as Nav2's `RangeSensorLayer::updateCostmap`."""
        distance = self._distance(reading)
        if distance is None:
            return
        placed = find_pose(self._node, grid.frame, reading)
        if placed is None:
            return
        length, is_cleared = distance
        ends = np.array([placed[0].position[:2], placed[0].transform((length, 0.0, 0.0))[:2]])
        (at_x, at_y), (end_x, end_y) = grid.origin.inverse().transform(ends).tolist()
        self._last_ns, self._has_told = self._node.sim.time_ns, False
        side, (rows, columns) = grid.resolution, grid.cells.shape
        row, column = math.floor(end_y / side), math.floor(end_x / side)
        if 0 <= row < rows and 0 <= column < columns:
            self._odds[row, column] = _HIT
        half = reading.field_of_view / 2
        axis, reach = math.atan2(end_y - at_y, end_x - at_x), math.hypot(end_x - at_x, end_y - at_y) * _REACH
        corners = [(at_x, at_y)]
        corners += [
            (at_x + math.cos(axis + turn) * reach, at_y + math.sin(axis + turn) * reach) for turn in (-half, half)
        ]
        cells = [(math.floor(x / side), math.floor(y / side)) for x, y in corners]
        low_x, high_x = (max(min(x for x, _ in cells), 0), min(max(x for x, _ in cells), columns - 1))
        low_y, high_y = (max(min(y for _, y in cells), 0), min(max(y for _, y in cells), rows - 1))
        if low_x > high_x or low_y > high_y:
            return
        row_at, column_at = (axis.ravel() for axis in np.mgrid[low_y : high_y + 1, low_x : high_x + 1])
        if self._options.inflate_cone < 1.0:
            inside = _in_cone(cells, column_at, row_at, self._options.inflate_cone)
            row_at, column_at = row_at[inside], column_at[inside]
        right, up = (column_at + 0.5) * side - at_x, (row_at + 0.5) * side - at_y
        angle = arctan2(up, right) - axis
        angle = angle - math.tau * np.rint(angle / math.tau)
        away = np.sqrt(right * right + up * up)
        occupied = np.zeros(len(away)) if is_cleared else self._model(length, away, angle, half, side)
        prior = self._odds[row_at, column_at] / LETHAL
        whole = occupied * prior + (1 - occupied) * (1 - prior)
        share = np.where(whole > 0, occupied * prior / np.where(whole > 0, whole, 1.0), prior)
        self._odds[row_at, column_at] = (share * LETHAL).astype(np.uint8)

    def _distance(self, reading: msgs.Message) -> tuple[float, bool] | None:
        """Return the range of a reading [m], and whether it clears its cone; None for one that changes nothing."""
        options, kind = self._options, self._options.input_sensor_type
        is_fixed = kind == "FIXED" or (kind == "ALL" and reading.min_range == reading.max_range)
        if not math.isfinite(reading.field_of_view + reading.min_range + reading.max_range):
            return None
        if not is_fixed:
            if not reading.min_range <= reading.range <= reading.max_range:
                return None
            return float(reading.range), reading.range >= reading.max_range and options.clear_on_max_reading
        if not math.isinf(reading.range):
            text = "a range sensor with min_range = max_range sent %g; only -inf (object) and inf (none) are valid"
            self._node.report_once("fixed range", text % reading.range)
            return None
        if reading.range > 0 and not options.clear_on_max_reading:
            return None
        return float(reading.min_range), reading.range > 0

    def _model(self, length: float, away: Floats, angle: Floats, half: float, side: float) -> Floats:
        """Return the probability of an obstacle in cells, as Nav2's `RangeSensorLayer::sensor_model`.

        Args:
            length: range of the reading [m].
            away: distances of the cells from the sensor [m].
            angle: angles of the cells from the axis [rad].
            half: half of the field of view [rad].
            side: side of a cell; the width of the rising part of the model is this share of the range.
        """
        gamma = np.where(np.abs(angle) > half, 0.0, 1 - (angle / half) ** 2 if half > 0 else 0.0)
        weight = (1 - (1 + each(math.tanh, 2 * (away - self._options.phi))) / 2) * gamma
        width = side * length
        before = (1 - weight) * 0.5
        if width <= 0:
            return np.where(away < length, before, 0.5)
        rising = weight * 0.5 * ((away - (length - 2 * width)) / width) ** 2 + before
        falling = (length - away) / width
        peak = weight * ((1 - 0.5 * falling**2) - 0.5) + 0.5
        far = np.where(away < length + width, peak, 0.5)
        return np.where(away < length - 2 * width, before, np.where(away < length - width, rising, far))

    # ------------------------------------------------------------------ services

    def reset(self) -> None:
        """Forget all readings."""
        self._odds[:] = _UNDECIDED
        self._readings = []

    def clear_area(self, area: Mask) -> None:
        """Forget the readings in an area of the costmap."""
        if area.shape == self._odds.shape:
            self._odds[area] = UNKNOWN


def _in_cone(cells: list[tuple[int, int]], x: Floats, y: Floats, inflation: float) -> Mask:
    """Check which cells are in the triangle of sensor and cone, inflated by a share of its area."""
    (at_x, at_y), (right_x, right_y), (left_x, left_y) = cells

    def side_of(x1: int, y1: int, x2: int, y2: int) -> Floats:
        return (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1)

    doubled = abs((left_x - right_x) * (at_y - right_y) - (left_y - right_y) * (at_x - right_x))
    least = -inflation * doubled / 2
    edges = ((right_x, right_y, left_x, left_y), (left_x, left_y, at_x, at_y), (at_x, at_y, right_x, right_y))
    first, second, third = (side_of(*edge) >= least for edge in edges)
    inside: Mask = first & second & third
    return inside
