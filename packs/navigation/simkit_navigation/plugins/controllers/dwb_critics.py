"""Critics of the DWB controller: costs of trajectories, and which of them are not allowed.

The formulas are those of `nav2_dwb_controller/dwb_critics/src` (Jazzy), whose names the classes have.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from simkit_navigation.plugins.controllers.dwb_options import DwbCriticOptions
from simkit_navigation.plugins.controllers.footprint_costs import costs_of_cells, footprint_costs
from simkit_navigation.plugins.controllers.sample_arithmetic import cosine, sine, wrapped
from simkit_navigation.plugins.controllers.velocity_samples import Speeds3, Trajectories
from simkit_navigation.plugins.costmaps.cost_grid import INSCRIBED, LETHAL, UNKNOWN, CostGrid
from simkit_navigation.plugins.costmaps.footprint import Footprint, edge_points
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

Mask = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.int64]

_SLACK: Final = 1e-6  # cells by which the distance of two poses may exceed one


@dataclass
class Situation:
    """Robot, path and costs of a cycle, in the frame of the cells of the costmap.

    Attributes:
        pose: pose of the robot.
        speeds: measured speeds.
        goal: last pose of the whole path.
        path: near part of the path, shape (n, 3).
        grid: costs.
        footprint: outline of the robot.
        time_ns: time [ns].
    """

    pose: PlanarPose
    speeds: Speeds3
    goal: PlanarPose
    path: Floats
    grid: CostGrid
    footprint: Footprint
    time_ns: int
    _path_cells: Indices | None = field(default=None, repr=False)
    _path_distances: Indices | None = field(default=None, repr=False)

    @property
    def path_cells(self) -> Indices:
        """Cells of the path up to where it leaves the costmap."""
        if self._path_cells is None:
            self._path_cells = _known_cells(self, self.path)
        return self._path_cells

    @property
    def path_distances(self) -> Indices | None:
        """Distance of each cell from the path; None without a pose in the costmap."""
        if self._path_distances is None:
            self._path_distances = _distances(self.grid.cells.shape, self.path_cells)
        return self._path_distances

    def cells(self, x: Floats, y: Floats) -> tuple[Indices, Mask]:
        """Return the indices of the cells at points, and which of the points are in the costmap."""
        height, width = self.grid.cells.shape
        columns, rows = np.floor(x / self.grid.resolution), np.floor(y / self.grid.resolution)
        inside = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
        return np.where(inside, rows * width + columns, 0).astype(np.int64), inside


class DwbCritic:
    """Critic.

    Args:
        options: options of the critic.
    """

    def __init__(self, options: DwbCriticOptions) -> None:
        self.options = options

    def reset(self) -> None:
        """Begin with another path."""

    def prepare(self, situation: Situation) -> None:
        """Begin a cycle."""

    def factor(self, situation: Situation) -> float:
        """Return the factor of the scores."""
        return self.options.scale

    def score(self, situation: Situation, samples: Trajectories) -> tuple[Floats, Mask]:
        """Return the scores of the trajectories, and which of them are allowed."""
        raise NotImplementedError

    def debrief(self, situation: Situation, command: Speeds3) -> None:
        """Learn the velocity that was chosen."""


def _all(samples: Trajectories) -> Mask:
    return np.ones(len(samples.counts), np.bool_)


def _last_or_sum(costs: npt.NDArray[Any], samples: Trajectories, adds: bool) -> Floats:
    """Return the last row, or the sum of the rows of each trajectory.

    Nav2 rates the pose at the begin, that after each step, and the last one again.
    """
    total: Floats = costs[-1].astype(np.float64)
    if not adds:
        return total
    for step, row in enumerate(costs):
        total += np.where(step <= samples.counts, row, 0.0)
    return total


class BaseObstacleCritic(DwbCritic):
    """Cost of the cell under the last pose; trajectories over an obstacle are not allowed."""

    def score(self, situation: Situation, samples: Trajectories) -> tuple[Floats, Mask]:
        costs = costs_of_cells(situation.grid.cells, situation.grid.resolution, samples.x, samples.y)
        is_blocked: Mask = np.logical_or.reduce(costs >= INSCRIBED, axis=0)
        return _last_or_sum(costs, samples, self.options.sum_scores), ~is_blocked


class ObstacleFootprintCritic(BaseObstacleCritic):
    """Largest cost under the outline at the last pose; trajectories over an obstacle are not allowed."""

    def score(self, situation: Situation, samples: Trajectories) -> tuple[Floats, Mask]:
        grid, shape = situation.grid, samples.x.shape
        yaw = samples.yaw.reshape(-1)
        costs = footprint_costs(
            grid,
            edge_points(situation.footprint.corners, grid.resolution),
            samples.x.reshape(-1),
            samples.y.reshape(-1),
            cosine(yaw),
            sine(yaw),
        ).reshape(shape)
        is_blocked: Mask = np.logical_or.reduce(costs >= LETHAL, axis=0)
        return _last_or_sum(costs, samples, self.options.sum_scores), ~is_blocked


class _MapGridCritic(DwbCritic):
    """Distance in cells from the nearest of some cells, along rows and columns.

    `stops_outside` is True if a trajectory must not leave the costmap.
    """

    stops_outside = True
    distance = 0.0  # [m] between the robot's origin and the point that is rated, ahead of it

    def distances(self, situation: Situation) -> Indices | None:
        """Return the distance of each cell; None if no pose of the path is in the costmap."""
        raise NotImplementedError

    def prepare(self, situation: Situation) -> None:
        self._distances = self.distances(situation)

    def factor(self, situation: Situation) -> float:
        return situation.grid.resolution * 0.5 * self.options.scale

    def score(self, situation: Situation, samples: Trajectories) -> tuple[Floats, Mask]:
        how = self.options.aggregation_type.lower()
        first = 0 if self.stops_outside or how in ("sum", "product") else -1
        x, y, yaw = samples.x[first:], samples.y[first:], samples.yaw[first:]
        if self.distance:
            x, y = x + self.distance * cosine(yaw), y + self.distance * sine(yaw)
        index, inside = situation.cells(x, y)
        if self._distances is None:  # no pose of the path is in the costmap
            cells = situation.grid.cells.size + 1.0
            return np.full(len(samples.counts), cells), np.full(len(samples.counts), not self.stops_outside)
        found = self._distances[index]
        is_inside: Mask = np.logical_and.reduce(inside, axis=0)
        if how == "product":
            scores = np.ones(len(samples.counts))
            for step, row in enumerate(found):
                scores *= np.where((step <= samples.counts) & (scores > 0), row, 1.0)
            return scores, is_inside
        return _last_or_sum(found, samples, how == "sum"), is_inside


def _distances(shape: tuple[int, ...], sources: Indices) -> Indices | None:
    """Return for each cell the distance from the nearest source along rows and columns; None without a source."""
    if not len(sources):
        return None
    row, column = np.indices(shape)
    if len(sources) == 1:
        distances: Indices = np.abs(row - sources[0] // shape[1]) + np.abs(column - sources[0] % shape[1])
        return distances.reshape(-1)
    is_far = np.ones(shape, np.bool_)
    is_far.reshape(-1)[sources] = False
    from scipy.ndimage import distance_transform_edt  # 40 ms

    rows, columns = distance_transform_edt(is_far, return_distances=False, return_indices=True)
    distances = np.abs(rows - row) + np.abs(columns - column)
    return distances.reshape(-1)


def _distance_of_goal(situation: Situation, path_cells: Indices) -> Indices | None:
    """Return for each cell the distance from the last cell of a path, along rows and columns and around obstacles.

    Nav2 measures through obstacles, so its robot may stop where a path goes around the end of a wall. The distances are
    those of Nav2 where no obstacle is between, and everywhere if the goal is enclosed.
    """
    grid = situation.grid
    straight = _distances(grid.cells.shape, path_cells[-1:])
    robot = grid.to_cell(*grid.origin.compose(situation.pose)[:2])
    blocked = grid.cells >= INSCRIBED
    if straight is None or robot is None or not blocked.any():
        return straight
    distances = np.full(grid.cells.shape, -1, np.int64)
    front = np.zeros(grid.cells.shape, np.bool_)
    front.reshape(-1)[path_cells[-1]] = True
    is_open, distance = ~blocked, 0
    while front.any():
        distances[front] = distance
        wider = np.zeros_like(front)
        wider[1:] |= front[:-1]
        wider[:-1] |= front[1:]
        wider[:, 1:] |= front[:, :-1]
        wider[:, :-1] |= front[:, 1:]
        front = wider & is_open & (distances < 0)
        distance += 1
    if distances[robot] < 0:
        return straight
    distances[distances < 0] = distance
    return distances.reshape(-1)


def _known_cells(situation: Situation, path: Floats) -> Indices:
    """Return the cells of a path up to where it leaves the costmap, with poses at most one cell apart."""
    dense = _dense(path[:, :2], situation.grid.resolution)
    index, inside = situation.cells(dense[:, 0], dense[:, 1])
    inside &= situation.grid.cells.reshape(-1)[index] != UNKNOWN
    begins = np.flatnonzero(inside)
    if not len(begins):
        return index[:0]
    ends = np.flatnonzero(~inside[begins[0] :])
    return index[begins[0] : begins[0] + ends[0] if len(ends) else None]


def _dense(points: Floats, resolution: float) -> Floats:
    """Return points of a path and points between them, so that neighbours are at most a distance apart."""
    steps = np.diff(points, axis=0)
    counts = np.ceil(np.sqrt(steps[:, 0] ** 2 + steps[:, 1] ** 2) / resolution - _SLACK).astype(np.int64)
    if (counts <= 1).all():
        return points
    parts = [points[:1]]
    for begin, step, count in zip(points[:-1], steps, np.maximum(counts, 1).tolist(), strict=True):
        parts.append(begin + (np.arange(1, count + 1) / count)[:, None] * step)
    return np.concatenate(parts)


class PathDistCritic(_MapGridCritic):
    """Distance of the robot from the path."""

    def distances(self, situation: Situation) -> Indices | None:
        return situation.path_distances


class GoalDistCritic(_MapGridCritic):
    """Distance of the robot from the last path pose in the costmap."""

    def distances(self, situation: Situation) -> Indices | None:
        return _distance_of_goal(situation, situation.path_cells)


class PathAlignCritic(PathDistCritic):
    """Distance of a point ahead of the robot from the path; no cost near the goal."""

    stops_outside = False

    def prepare(self, situation: Situation) -> None:
        self.distance = self.options.forward_point_distance
        x, y = situation.pose.x - situation.goal.x, situation.pose.y - situation.goal.y
        self._is_near = x * x + y * y <= self.distance**2
        if not self._is_near:
            super().prepare(situation)

    def factor(self, situation: Situation) -> float:
        return 0.0 if self._is_near else super().factor(situation)


class GoalAlignCritic(GoalDistCritic):
    """Distance of a point ahead of the robot from a point behind the last path pose."""

    stops_outside = False

    def distances(self, situation: Situation) -> Indices | None:
        self.distance = self.options.forward_point_distance
        path, goal, pose = situation.path.copy(), situation.goal, situation.pose
        angle = math.atan2(goal.y - pose.y, goal.x - pose.x)
        path[-1, 0] += self.distance * math.cos(angle)
        path[-1, 1] += self.distance * math.sin(angle)
        return _distance_of_goal(situation, _known_cells(situation, path))


class PreferForwardCritic(DwbCritic):
    """Penalty for driving backwards or slowly, and a cost of the turning rate otherwise."""

    def score(self, situation: Situation, samples: Trajectories) -> tuple[Floats, Mask]:
        given, x, rate = self.options, samples.velocities[:, 0], np.abs(samples.velocities[:, 2])
        is_bad = (x < 0.0) | ((x < given.strafe_x) & (rate < given.strafe_theta))
        return np.where(is_bad, given.penalty, rate * given.theta_scale), _all(samples)


class TwirlingCritic(DwbCritic):
    """Cost of the turning rate."""

    def score(self, situation: Situation, samples: Trajectories) -> tuple[Floats, Mask]:
        return np.abs(samples.velocities[:, 2]), _all(samples)


class RotateToGoalCritic(DwbCritic):
    """Angle to the heading of the goal, once the robot is there: first it brakes, then it may only turn."""

    def __init__(self, options: DwbCriticOptions) -> None:
        super().__init__(options)
        self.reset()

    def reset(self) -> None:
        self._is_there = self._turns = False

    def prepare(self, situation: Situation) -> None:
        given, pose, goal = self.options, situation.pose, situation.goal
        x, y = pose.x - goal.x, pose.y - goal.y
        self._is_there = self._is_there or x * x + y * y <= given.xy_goal_tolerance**2
        self._square = situation.speeds[0] ** 2 + situation.speeds[1] ** 2
        self._turns = self._turns or (self._is_there and self._square <= given.trans_stopped_velocity**2)

    def score(self, situation: Situation, samples: Trajectories) -> tuple[Floats, Mask]:
        if not self._is_there:
            return np.zeros(len(samples.counts)), _all(samples)
        time = self.options.lookahead_time
        yaw = samples.yaw[-1] if time < 0.0 else samples.yaw_at(time)
        angles = np.abs(wrapped(situation.goal.yaw - yaw))
        x, y = samples.velocities[:, 0], samples.velocities[:, 1]
        if self._turns:
            return angles, (x == 0.0) & (y == 0.0)
        squares = x * x + y * y
        return squares * self.options.slowing_factor + angles, squares < self._square


class _Trend:
    """Sign of the last velocity, and the only sign that is allowed after it has changed."""

    def __init__(self) -> None:
        self.sign = self.only = 0

    def update(self, velocity: float) -> bool:
        """Learn a velocity; return True if its sign has changed."""
        sign = (velocity > 0.0) - (velocity < 0.0)
        has_changed = sign * self.sign < 0
        if has_changed:
            self.only = sign
        self.sign = sign or self.sign
        return has_changed

    def allowed(self, velocities: Floats) -> Mask:
        """Return which velocities do not have the other sign."""
        allowed: Mask = velocities * self.only >= 0.0
        return allowed


class OscillationCritic(DwbCritic):
    """Does not allow a velocity to change its sign again before the robot has moved."""

    def __init__(self, options: DwbCriticOptions) -> None:
        super().__init__(options)
        self._begin: tuple[PlanarPose, int] = PlanarPose(0.0, 0.0, 0.0), 0
        self.reset()

    def reset(self) -> None:
        self._trends = [_Trend() for _ in range(3)]

    def score(self, situation: Situation, samples: Trajectories) -> tuple[Floats, Mask]:
        allowed = _all(samples)
        for axis, trend in enumerate(self._trends):
            allowed &= trend.allowed(samples.velocities[:, axis])
        return np.zeros(len(allowed)), allowed

    def debrief(self, situation: Situation, command: Speeds3) -> None:
        limit = self.options.x_only_threshold
        changed = [self._trends[0].update(command[0])]
        if limit < 0.0 or abs(command[0]) <= limit:
            changed += [trend.update(speed) for trend, speed in zip(self._trends[1:], command[1:], strict=True)]
        # the grid moves with the robot, so places are compared in the frame of the path
        pose = situation.grid.origin.compose(situation.pose)
        if any(changed):
            self._begin = pose, situation.time_ns
        if any(trend.only for trend in self._trends) and self._has_moved(pose, situation.time_ns):
            self.reset()

    def _has_moved(self, pose: PlanarPose, time_ns: int) -> bool:
        given, (before, begin) = self.options, self._begin
        distance, angle, time = (
            given.oscillation_reset_dist,
            given.oscillation_reset_angle,
            given.oscillation_reset_time,
        )
        return (
            (distance >= 0.0 and math.hypot(pose.x - before.x, pose.y - before.y) > distance)
            or (angle >= 0.0 and abs(pose.yaw - before.yaw) > angle)
            or (time >= 0.0 and time_ns - begin > time * 1e9)
        )


CRITICS: Final[dict[str, type[DwbCritic]]] = {
    critic.__name__: critic
    for critic in (
        RotateToGoalCritic,
        OscillationCritic,
        BaseObstacleCritic,
        ObstacleFootprintCritic,
        GoalAlignCritic,
        PathAlignCritic,
        PathDistCritic,
        GoalDistCritic,
        PreferForwardCritic,
        TwirlingCritic,
    )
}
"""Critics by the name of their class in Nav2."""
