"""Navigate: a costmap layer, two planners and a controller. A solution."""

from __future__ import annotations

import heapq
import math

import numpy as np
from scipy.ndimage import distance_transform_edt

FREE, INSCRIBED, LETHAL = 0, 253, 254  # costs

STEPS = [(up, right) for up in (-1, 0, 1) for right in (-1, 0, 1) if up or right]  # to the eight neighbours


class GradientLayer:
    """Costs that fall linearly with the distance from the obstacles."""

    def on_initialize(self, node, params):
        self.robot_radius = params.number("robot_radius")  # [m]
        self.gradient_radius = params.number("gradient_radius")  # [m]

    def update_costs(self, grid, robot):
        distance = grid.resolution * distance_transform_edt(grid.cells != LETHAL)  # [m], of each cell
        share = (self.gradient_radius - distance) / (self.gradient_radius - self.robot_radius)
        costs = np.where(distance <= self.robot_radius, INSCRIBED, np.clip(252 * share, 0, 252))
        costs = np.where(grid.cells == LETHAL, LETHAL, costs)
        grid.cells[:] = np.maximum(grid.cells, costs.astype(np.uint8))


class StraightLine:
    """The straight line from the start to the goal, if it is free."""

    def configure(self, node, params):
        self.step = params.number("interpolation_resolution")  # [m]

    def create_plan(self, grid, start, goal):
        length = math.hypot(goal.x - start.x, goal.y - start.y)
        count = max(2, math.ceil(length / self.step) + 1)
        points = np.linspace((start.x, start.y), (goal.x, goal.y), count)
        return [] if (grid.costs(points) >= INSCRIBED).any() else points


class AStar:
    """The cheapest path along the cells of the grid."""

    def create_plan(self, grid, start, goal):
        begin, end = grid.to_cell(start.x, start.y), grid.to_cell(goal.x, goal.y)
        if begin is None or end is None:
            return []
        costs = grid.cells.tolist()
        rows, columns = grid.cells.shape
        reached, before, done = {begin: 0.0}, {}, set()
        queue = [(0.0, begin)]
        while queue:
            _, cell = heapq.heappop(queue)
            if cell == end:
                break
            if cell in done:
                continue
            done.add(cell)
            row, column = cell
            for up, right in STEPS:
                other = row + up, column + right
                if not (0 <= other[0] < rows and 0 <= other[1] < columns) or other in done:
                    continue
                cost = costs[other[0]][other[1]]
                if cost >= INSCRIBED:
                    continue
                way = reached[cell] + math.hypot(up, right) * (1 + cost / 50)
                if way < reached.get(other, math.inf):
                    reached[other], before[other] = way, cell
                    ahead = math.hypot(end[0] - other[0], end[1] - other[1])
                    heapq.heappush(queue, (way + ahead, other))
        if end not in reached:
            return []
        cells = [end]
        while cells[-1] != begin:
            cells.append(before[cells[-1]])
        points = grid.centres(*zip(*reversed(cells), strict=True))
        points[-1] = goal.x, goal.y
        return points


class PurePursuit:
    """The arc through a point of the path ahead of the robot."""

    def configure(self, node, params):
        self.lookahead = params.number("lookahead")  # [m]
        self.speed = params.number("speed")  # [m/s]
        self.turning_speed = params.number("turning_speed")  # [rad/s]

    def set_plan(self, path):
        self.path = path  # a row (x, y, yaw) for each pose

    def compute_velocity_commands(self, pose, velocity, grid):
        distances = np.hypot(self.path[:, 0] - pose.x, self.path[:, 1] - pose.y)
        if distances[-1] < 0.04:
            return 0.0, self.turn(self.path[-1, 2] - pose.yaw)
        nearest = distances.argmin()
        beyond = np.flatnonzero(distances[nearest:] >= self.lookahead)
        carrot = self.path[nearest + beyond[0]] if len(beyond) else self.path[-1]
        direction = math.remainder(math.atan2(carrot[1] - pose.y, carrot[0] - pose.x) - pose.yaw, math.tau)
        if abs(direction) > 0.8:
            return 0.0, self.turn(direction)
        distance = math.hypot(carrot[0] - pose.x, carrot[1] - pose.y)
        forward = min(self.speed, distances[-1] + 0.02)
        return forward, forward * 2 * math.sin(direction) / distance  # curvature 2 y / L², with y = L sin

    def turn(self, angle):
        """Return a turning speed [rad/s] towards an angle [rad]."""
        return float(np.clip(2.0 * math.remainder(angle, math.tau), -self.turning_speed, self.turning_speed))
