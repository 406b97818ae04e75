"""Critics of the MPPI controller: costs of the samples.

The formulas are those of `nav2_mppi_controller/src/critics/*.cpp` (Jazzy), whose names the classes have.
"""

from __future__ import annotations

import math
from typing import Any, Final, Protocol

import numpy as np
import numpy.typing as npt

from simkit import Params
from simkit.elementary_functions import arctan2
from simkit.pose import wrap_angle
from simkit_navigation.plugins.controllers import mppi_options as options
from simkit_navigation.plugins.controllers.footprint_costs import costs_of_cells, footprint_costs
from simkit_navigation.plugins.controllers.mppi_samples import Floats32, Samples
from simkit_navigation.plugins.controllers.sample_arithmetic import sum_over_steps, wrapped
from simkit_navigation.plugins.costmaps.cost_grid import INSCRIBED, LETHAL, UNKNOWN, Cells
from simkit_navigation.plugins.costmaps.footprint import edge_points

Mask = npt.NDArray[np.bool_]


class InflatedCostmap(Protocol):
    """Parameters of the costmap's inflation layer that the critics need.

    Attributes:
        cost_scaling_factor: decay of the costs [1/m].
        inflation_radius: distance from an obstacle up to which there are costs [m].
    """

    cost_scaling_factor: float
    inflation_radius: float


class Critic:
    """Critic; `score` adds to the costs of the samples.

    Args:
        params: block of parameters of the critic.
        controller: options of the controller.
        costmap: inflation of the costmap.
    """

    kind: type[options.CriticOptions]

    def __init__(self, params: Params, controller: options.MppiOptions, costmap: InflatedCostmap) -> None:
        self.options: Any = self.kind(params).read_all()
        self.controller, self.costmap = controller, costmap

    def add(self, samples: Samples, values: npt.NDArray[Any], weight: float | None = None) -> None:
        """Add values, multiplied by the weight and raised to the power of the critic."""
        weighted = values * np.float32(self.options.cost_weight if weight is None else weight)
        power = weighted
        for _ in range(1, self.options.cost_power):
            power = power * weighted
        samples.costs += power

    def score(self, samples: Samples) -> None:
        """Add the costs of the critic."""
        raise NotImplementedError


class ConstraintCritic(Critic):
    """Costs of speeds beyond the limits, and of turns that are too tight for a car."""

    kind = options.ConstraintOptions

    def score(self, samples: Samples) -> None:
        limits = self.controller
        aside = limits.vy_max if samples.is_holonomic else 0.0
        high = np.float32(math.hypot(limits.vx_max, aside))
        low = np.float32(math.copysign(math.hypot(limits.vx_min, aside), limits.vx_min or -1.0))
        speed = samples.speeds["vx"]
        if samples.is_holonomic:
            total = np.sqrt(speed * speed + samples.speeds["vy"] * samples.speeds["vy"])
            speed = np.where(speed > 0, total, -total)
        beyond = np.maximum(speed - high, 0)
        beyond += np.maximum(low - speed, 0)
        if samples.motion_model == "Ackermann":
            turning = np.maximum(np.abs(samples.speeds["wz"]), np.float32(1e-9))
            radius = np.abs(speed) / turning
            beyond += np.maximum(np.float32(limits.AckermannConstraints.min_turning_r) - radius, 0)
        self.add(samples, sum_over_steps(beyond) * np.float32(samples.model_dt))


class _ObstacleCritic(Critic):
    """Base class of the two critics that look up the costmap."""

    def costs(self, samples: Samples, stride: int) -> tuple[Cells, Cells, Mask, Mask]:
        """Look up the costmap at each `stride`-th step.

        Returns:
            Costs at the centre of the robot, costs that the collision check uses, where these are of the outline, and
            where the robot collides.
        """
        grid = samples.grid
        x, y = samples.x[::stride], samples.y[::stride]
        costs = costs_of_cells(grid.cells, grid.resolution, x, y)
        outline = samples.footprint
        has_outline = self.options.consider_footprint and not outline.is_round
        looked_up = np.zeros(costs.shape, np.bool_)
        checked = costs
        if has_outline:
            looked_up = (costs >= max(1.0, self._least_cost(samples))) & (costs != UNKNOWN)
            places = [array[::stride][looked_up] for array in (samples.x, samples.y, samples.cos, samples.sin)]
            checked = costs.copy()
            checked[looked_up] = footprint_costs(grid, edge_points(outline.corners, grid.resolution), *places)
        collides = checked == LETHAL
        if not has_outline:
            collides |= checked == INSCRIBED
        if not samples.is_unknown_free:
            collides |= checked == UNKNOWN
        return costs, checked, looked_up, collides

    def _least_cost(self, samples: Samples) -> float:
        """Return the cost at the circumscribed radius, below which the outline touches nothing; 1 if not known."""
        outline, inflation = samples.footprint, self.costmap
        if inflation.inflation_radius < outline.circumscribed_radius:
            return 1.0
        beyond = outline.circumscribed_radius - outline.inscribed_radius
        return math.floor((INSCRIBED - 1) * math.exp(-inflation.cost_scaling_factor * beyond))


class CostCritic(_ObstacleCritic):
    """Costs of the cells under the trajectories."""

    kind = options.CostOptions

    def score(self, samples: Samples) -> None:
        given = self.options
        stride = given.trajectory_point_step
        centre, _, _, collides = self.costs(samples, stride)
        count = samples.x.shape[0] // stride or 1
        collides = collides[:count]
        table = np.arange(256, dtype=np.float32)
        if samples.is_near_goal(given.near_goal_distance):
            table[:] = 0
        table[max(given.near_collision_cost, 1) :] = given.critical_cost
        repulsive = sum_over_steps(table[centre[:count]])
        hits = collides.any(axis=0)
        repulsive[hits] = given.collision_cost
        self.add(samples, repulsive, given.cost_weight / 254.0 / count)
        samples.all_collide = bool(hits.all())


class ObstaclesCritic(_ObstacleCritic):
    """Costs of small distances from obstacles, which follow from the costs of the inflation layer."""

    kind = options.ObstaclesOptions

    def score(self, samples: Samples) -> None:
        given = self.options
        factor = given.cost_scaling_factor or self.costmap.cost_scaling_factor
        radius = given.inflation_radius or self.costmap.inflation_radius
        _, costs, looked_up, collides = self.costs(samples, 1)
        count = samples.costs.shape[0]
        critical, repulsive = np.zeros(count, np.float32), np.zeros(count, np.float32)
        if factor > 0 and radius > 0:
            near = not samples.is_near_goal(given.near_goal_distance)
            inside = samples.footprint.inscribed_radius
            from_edge = np.array([math.inf, *(math.log(253.0 / cost) / factor + inside for cost in range(1, 256))])
            margins, pushes = [], []
            for distances in (from_edge - inside, from_edge):
                margins.append(np.maximum(given.collision_margin_distance - distances, 0.0).astype(np.float32))
                push = radius - distances
                push[0] = 0.0
                pushes.append(push.astype(np.float32))
            alive = np.ones(count, np.bool_)
            for row, outlined, hit in zip(costs, looked_up, collides, strict=True):
                alive &= ~hit
                margin = np.where(outlined, margins[1][row], margins[0][row])
                critical += np.where(alive, margin, np.float32(0))
                if near:
                    push_row = np.where(outlined, pushes[1][row], pushes[0][row])
                    repulsive += np.where(alive, push_row, np.float32(0))
        hits = collides.any(axis=0)
        critical[hits] = given.collision_cost
        repulsive = (repulsive - repulsive.min()) / np.float32(samples.x.shape[0])
        values = np.float32(given.critical_weight) * critical + np.float32(given.repulsion_weight) * repulsive
        self.add(samples, values, 1.0)
        samples.all_collide = bool(hits.all())


class GoalCritic(Critic):
    """Costs of the mean distance from the goal."""

    kind = options.GoalOptions

    def score(self, samples: Samples) -> None:
        if samples.is_near_goal(self.options.threshold_to_consider):
            across, along = samples.x - np.float32(samples.goal.x), samples.y - np.float32(samples.goal.y)
            distances = np.sqrt(across * across + along * along)
            self.add(samples, sum_over_steps(distances) / np.float32(len(distances)))


class GoalAngleCritic(Critic):
    """Costs of the mean angle to the heading of the goal."""

    kind = options.GoalAngleOptions

    def score(self, samples: Samples) -> None:
        if samples.is_near_goal(self.options.threshold_to_consider):
            yaw = float(samples.path[-1, 2])
            angles = np.abs(wrapped(np.float32(yaw) - samples.yaw))
            if self.options.symmetric_yaw_tolerance:
                angles = np.minimum(angles, np.abs(wrapped(np.float32(wrap_angle(yaw + math.pi)) - samples.yaw)))
            self.add(samples, sum_over_steps(angles) / np.float32(len(angles)))


class PathAlignCritic(Critic):
    """Costs of the mean distance between trajectory and path, at equal distances along both."""

    kind = options.PathAlignOptions

    def score(self, samples: Samples) -> None:
        given = self.options
        count = samples.furthest
        if samples.is_near_goal(given.threshold_to_consider) or count < max(given.offset_from_furthest, 1):
            return
        is_free = samples.is_free[:count]
        blocked = np.arange(1, int((~is_free).sum()) + 1)
        at = np.flatnonzero(~is_free)
        if len(at) and bool(((blocked / count > given.max_path_occupancy_ratio) & (blocked > 2)).any()):
            return
        path = samples.path[:count]
        along = np.zeros(count, np.float32)
        for place in range(1, count):
            right, up = (path[place, :2] - path[place - 1, :2]).tolist()
            along[place] = along[place - 1] + np.float32(math.sqrt(right * right + up * up))
        stride = given.trajectory_point_step
        x, y, yaw = samples.x[::stride], samples.y[::stride], samples.yaw[::stride]
        driven = np.zeros(samples.costs.shape, np.float32)
        total: Floats32 = np.zeros_like(driven)
        counted: Floats32 = np.zeros_like(driven)
        for step in range(1, len(x)):
            across, ahead = x[step] - x[step - 1], y[step] - y[step - 1]
            driven += np.sqrt(across * across + ahead * ahead)
            index = _closest(along, driven)
            across, ahead = path[index, 0] - x[step], path[index, 1] - y[step]
            squares = across * across + ahead * ahead
            if given.use_path_orientations:
                angles = wrapped(yaw[step] - path[index, 2])
                squares += angles * angles
            free = is_free[index]
            total += np.where(free, np.sqrt(squares), np.float32(0))
            counted += free
        self.add(samples, total / np.maximum(counted, np.float32(1)))


def _closest(along: Floats32, driven: Floats32) -> npt.NDArray[np.int64]:
    """Return for each driven distance the index of the path pose at the nearest distance along the path."""
    after = np.minimum(np.searchsorted(along, driven, side="right"), len(along) - 1)
    before = np.maximum(after - 1, 0)
    index: npt.NDArray[np.int64] = np.where(driven - along[before] < along[after] - driven, before, after)
    return index


class PathFollowCritic(Critic):
    """Costs of the distance between the end of the trajectory and a path pose ahead."""

    kind = options.PathFollowOptions

    def score(self, samples: Samples) -> None:
        given, last = self.options, len(samples.path) - 1
        if last < 1 or samples.is_near_goal(given.threshold_to_consider):
            return
        index = min(samples.furthest + given.offset_from_furthest, last)
        while index < last - 1 and not samples.is_free[index]:
            index += 1
        across, along = samples.x[-1] - samples.path[index, 0], samples.y[-1] - samples.path[index, 1]
        self.add(samples, np.sqrt(across * across + along * along))


class PathAngleCritic(Critic):
    """Costs of the angle between the end of the trajectory and a path pose ahead, if the robot is turned away."""

    kind = options.PathAngleOptions

    def score(self, samples: Samples) -> None:
        given = self.options
        if samples.is_near_goal(given.threshold_to_consider):
            return
        mode = given.mode if given.forward_preference or given.mode else 1
        if mode == 1 and self.controller.vx_min >= 0.0:
            mode = 0  # without a preference of the direction, but the robot cannot drive back
        index = min(samples.furthest + given.offset_from_furthest, len(samples.path) - 1)
        x, y, yaw = samples.path[index].tolist()
        robot = samples.robot
        towards = math.atan2(y - robot.y, x - robot.x)
        if mode == 2 and abs(wrap_angle(yaw - towards)) > math.pi / 2:
            towards += math.pi
        angle = abs(wrap_angle(robot.yaw - towards))
        if mode == 1:
            angle = min(angle, math.pi - angle)
        if angle < given.max_angle_to_furthest:
            return
        between = arctan2(np.float32(y) - samples.y[-1], np.float32(x) - samples.x[-1]).astype(np.float32)
        last = samples.yaw[-1]
        if mode == 1:
            is_back = np.abs(wrapped(between - last)) >= np.float32(math.pi / 2)
            between = between + np.where(is_back, np.float32(math.pi), np.float32(0))
        elif mode == 2:
            is_back = np.abs(wrapped(np.float32(yaw) - between)) >= np.float32(math.pi / 2)
            between = between + np.where(is_back, np.float32(math.pi), np.float32(0))
        self.add(samples, np.abs(wrapped(between - last)))


class PreferForwardCritic(Critic):
    """Costs of driving backwards."""

    kind = options.PreferForwardOptions

    def score(self, samples: Samples) -> None:
        if not samples.is_near_goal(self.options.threshold_to_consider):
            backward = np.maximum(-samples.speeds["vx"], 0)
            self.add(samples, sum_over_steps(backward) * np.float32(samples.model_dt))


class TwirlingCritic(Critic):
    """Costs of the mean turning rate."""

    kind = options.TwirlingOptions

    def score(self, samples: Samples) -> None:
        if not samples.is_near_goal(samples.goal_tolerance):
            turning = np.abs(samples.speeds["wz"])
            self.add(samples, sum_over_steps(turning) / np.float32(len(turning)))


class VelocityDeadbandCritic(Critic):
    """Costs of speeds that are too small for the robot's drives."""

    kind = options.VelocityDeadbandOptions

    def score(self, samples: Samples) -> None:
        limits = self.options.deadband_velocities.replace(",", " ").split()
        total = np.zeros_like(samples.x)
        for axis, limit in zip(("vx", "vy", "wz"), limits, strict=False):
            if axis in samples.speeds:
                total += np.maximum(np.float32(abs(float(limit))) - np.abs(samples.speeds[axis]), 0)
        self.add(samples, sum_over_steps(total) * np.float32(samples.model_dt))


CRITICS: Final[dict[str, type[Critic]]] = {
    critic.__name__: critic
    for critic in (
        ConstraintCritic,
        CostCritic,
        ObstaclesCritic,
        GoalCritic,
        GoalAngleCritic,
        PathAlignCritic,
        PathFollowCritic,
        PathAngleCritic,
        PreferForwardCritic,
        TwirlingCritic,
        VelocityDeadbandCritic,
    )
}
"""Critics by their name in `<critics>`."""
