"""Navigate: a costmap layer, two planners and a controller. Your file: complete it, and run `simkit lab grade .`

simkit calls the methods of these classes; navigation.sdf names them, with their parameters.

    grid.cells             costs, an array of uint8; row 0 has the lowest y, column 0 the lowest x
    grid.resolution        side of a cell [m]
    grid.to_cell(x, y)     row and column of a point [m]; None outside of the grid
    grid.centres(r, c)     centres of cells [m]: an array with a row (x, y) for each cell
    grid.costs(points)     costs at an array of points [m]
    pose.x .y .yaw         a pose [m, m, rad]; start, goal and robot have these parts, too
"""

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
        """Change grid.cells. At the call, the cells of obstacles are LETHAL, and all others are FREE."""
        distance = distance_transform_edt(grid.cells != LETHAL)  # of each cell from the nearest obstacle, in cells
        # Exercise: write the costs to grid.cells; the formula is in the README.


class StraightLine:
    """The straight line from the start to the goal, if it is free."""

    def configure(self, node, params):
        self.step = params.number("interpolation_resolution")  # [m]

    def create_plan(self, grid, start, goal):
        """Return the points (x, y) [m] of a path; an empty list if there is none."""
        # Exercise: points on the line from start to goal, self.step apart. Is each of them free?
        return []


class AStar:
    """The cheapest path along the cells of the grid."""

    def create_plan(self, grid, start, goal):
        """Return the points (x, y) [m] of a path; an empty list if there is none."""
        begin, end = grid.to_cell(start.x, start.y), grid.to_cell(goal.x, goal.y)
        if begin is None or end is None:
            return []
        costs = grid.cells.tolist()  # costs[row][column]; a list is faster than an array here
        reached = {begin: 0.0}  # cell -> length of the shortest way from the start that is known so far
        before = {}  # cell -> cell before it on this way
        queue = [(0.0, begin)]  # heapq.heappush and heappop keep the smallest estimate in front
        # Exercise: take cells from the queue until the end is reached; then follow `before` back to the start.
        return []


class PurePursuit:
    """The arc through a point of the path ahead of the robot."""

    def configure(self, node, params):
        self.lookahead = params.number("lookahead")  # [m]
        self.speed = params.number("speed")  # [m/s]
        self.turning_speed = params.number("turning_speed")  # [rad/s]

    def set_plan(self, path):
        self.path = path  # an array with a row (x, y, yaw) for each pose of the path [m, m, rad]

    def compute_velocity_commands(self, pose, velocity, grid):
        """Return forward speed [m/s] and turning speed [rad/s]; called 20 times a second."""
        # Exercise: find the point at the lookahead distance, and return the speeds of the arc through it.
        return 0.0, 0.0

    def turn(self, angle):
        """Return a turning speed [rad/s] towards an angle [rad]: proportional and limited."""
        return float(np.clip(2.0 * math.remainder(angle, math.tau), -self.turning_speed, self.turning_speed))
