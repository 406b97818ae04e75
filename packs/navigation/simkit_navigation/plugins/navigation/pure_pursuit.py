"""Controller that pursues a point of its path, as Nav2's `nav2_regulated_pure_pursuit_controller`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.extend import Options, boolean, number
from simkit.linear_algebra import matmul
from simkit.pose import wrap_angle
from simkit_navigation.plugins.navigation.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.navigation.nodes import ControllerNode

Speeds = tuple[float, float]
"""Forward speed [m/s] and turning rate [rad/s]."""

_SMALL: Final = 1e-6


class PurePursuitOptions(Options):
    """Options of `PurePursuit`."""

    desired_linear_vel: float = number(0.5, "m/s", minimum=0)
    lookahead_dist: float = number(0.6, "m", minimum=0.01)
    min_lookahead_dist: float = number(0.3, "m", minimum=0.01)
    max_lookahead_dist: float = number(0.9, "m", minimum=0.01)
    lookahead_time: float = number(1.5, "s", minimum=0)
    use_velocity_scaled_lookahead_dist: bool = boolean(False)
    min_approach_linear_velocity: float = number(0.05, "m/s", minimum=0)
    approach_velocity_scaling_dist: float = number(0.6, "m", minimum=0)
    use_collision_detection: bool = boolean(True)
    max_allowed_time_to_collision_up_to_carrot: float = number(1.0, "s", minimum=0)
    use_regulated_linear_velocity_scaling: bool = boolean(True)
    regulated_linear_scaling_min_radius: float = number(0.9, "m", minimum=0)
    regulated_linear_scaling_min_speed: float = number(0.25, "m/s", minimum=0)
    use_rotate_to_heading: bool = boolean(True)
    rotate_to_heading_min_angle: float = number(0.785, "rad", minimum=0)
    rotate_to_heading_angular_vel: float = number(1.8, "rad/s", minimum=0)
    max_angular_accel: float = number(3.2, "rad/s^2", minimum=0.001)


class PurePursuit:
    """Drives on the arc through a point of the path at the lookahead distance (regulated pure pursuit).

    The point has the coordinates (x, y) in the frame of the robot. The arc has the curvature 2·y/(x² + y²). The speed
    decreases in sharp turns and near the goal. The robot turns on the spot if the point is far aside, and at the goal.
    """

    def configure(self, node: ControllerNode, params: Params) -> None:
        """Read the parameters."""
        self._node, self._options = node, PurePursuitOptions(params).read_all()
        self._path: Floats = np.zeros((0, 3))

    def set_plan(self, path: Floats) -> None:
        """Follow another path: x, y [m] and yaw [rad] of each pose, shape (n, 3)."""
        self._path = path

    def compute_velocity_commands(self, pose: PlanarPose, velocity: Speeds, grid: CostGrid | None) -> Speeds | None:
        """Return forward speed [m/s] and turning rate [rad/s]; None if the robot would touch an obstacle."""
        options = self._options
        speeds = self._speeds(pose, velocity)
        if options.use_collision_detection and grid is not None:
            time, footprint = options.max_allowed_time_to_collision_up_to_carrot, self._node.footprint
            if footprint.collides_ahead(grid, pose, speeds, time):
                return None
        return speeds

    def _speeds(self, pose: PlanarPose, velocity: Speeds) -> Speeds:
        options = self._options
        places = pose.inverse().transform(self._path[:, :2])
        distances = np.hypot(*places.T)
        nearest = _nearest(distances)
        remaining = float(distances[-1]) if nearest == len(places) - 1 else _length(places[nearest:])
        if self._node.is_at_goal_position:
            return 0.0, self._turning(float(self._path[-1, 2]) - pose.yaw, velocity[1])
        lookahead = options.lookahead_dist
        if options.use_velocity_scaled_lookahead_dist:
            wanted = abs(velocity[0]) * options.lookahead_time
            lookahead = min(max(wanted, options.min_lookahead_dist), options.max_lookahead_dist)
        x, y = _carrot(places[nearest:], distances[nearest:], lookahead)
        aside = math.atan2(y, x)
        if options.use_rotate_to_heading and abs(aside) > options.rotate_to_heading_min_angle:
            return 0.0, self._turning(aside, velocity[1])
        curvature = 2.0 * y / max(x * x + y * y, _SMALL)
        speed = options.desired_linear_vel
        if options.use_regulated_linear_velocity_scaling and abs(curvature) > _SMALL:
            regulated = speed * min(
                1.0, 1.0 / (abs(curvature) * max(options.regulated_linear_scaling_min_radius, _SMALL))
            )
            speed = max(regulated, min(options.regulated_linear_scaling_min_speed, speed))
        if remaining < options.approach_velocity_scaling_dist:
            approach = options.desired_linear_vel * remaining / options.approach_velocity_scaling_dist
            speed = min(speed, max(approach, options.min_approach_linear_velocity))
        return speed, speed * curvature

    def _turning(self, angle: float, present: float) -> float:
        """Return the turning rate [rad/s] towards an angle [rad], with limited acceleration and without overshoot."""
        angle, options = wrap_angle(angle), self._options
        wanted = math.copysign(
            min(options.rotate_to_heading_angular_vel, math.sqrt(2.0 * options.max_angular_accel * abs(angle)) / 2),
            angle,
        )
        change = options.max_angular_accel / self._node.controller_frequency
        return min(max(wanted, present - change), present + change)


def _nearest(distances: Floats) -> int:
    """Return the index of the nearest pose of a path."""
    return int(distances.argmin())


def _length(points: Floats) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def _carrot(places: Floats, distances: Floats, lookahead: float) -> tuple[float, float]:
    """Return the first point of a path at the lookahead distance [m]; the last point of a shorter path.

    Args:
        places: points of the path from the nearest one on, in the frame of the robot, shape (n, 2).
        distances: their distances from the robot [m].
        lookahead: lookahead distance [m].
    """
    beyond = np.flatnonzero(distances >= lookahead)
    if not len(beyond):
        x, y = places[-1].tolist()
        return x, y
    at = int(beyond[0])
    if at == 0:
        x, y = places[0].tolist()
        return x, y
    inner, step = places[at - 1], places[at] - places[at - 1]
    a, b, c = float(matmul(step, step)), float(matmul(2 * inner, step)), float(matmul(inner, inner)) - lookahead**2
    part = (-b + math.sqrt(max(b * b - 4 * a * c, 0.0))) / (2 * a)  # where the segment crosses the circle
    x, y = (inner + part * step).tolist()
    return x, y
