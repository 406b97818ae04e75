"""Controller that pursues a point of its path, as Nav2's `nav2_regulated_pure_pursuit_controller`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.extend import Options, boolean, number, without_effect
from simkit.linear_algebra import matmul
from simkit.pose import wrap_angle
from simkit_navigation.plugins.controllers.local_path import LocalPath, distances_along, first_inversion
from simkit_navigation.plugins.costmaps.cost_grid import FREE, INSCRIBED, UNKNOWN, CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.controllers.controller_node import ControllerNode

Speeds = tuple[float, float]
"""Forward speed [m/s] and turning rate [rad/s]."""

_SMALL: Final = 1e-6
_LEAST_SQUARE: Final = 0.001  # [m²] of the distance of a point that defines an arc


class PurePursuitOptions(Options):
    """Options of `PurePursuit`."""

    desired_linear_vel: float = number(0.5, "m/s", minimum=0)
    lookahead_dist: float = number(0.6, "m", minimum=0.01)
    min_lookahead_dist: float = number(0.3, "m", minimum=0.01)
    max_lookahead_dist: float = number(0.9, "m", minimum=0.01)
    lookahead_time: float = number(1.5, "s", minimum=0)
    use_velocity_scaled_lookahead_dist: bool = boolean(False)
    use_fixed_curvature_lookahead: bool = boolean(False)
    curvature_lookahead_dist: float = number(0.6, "m", minimum=0.01)
    interpolate_curvature_after_goal: bool = boolean(False)
    min_approach_linear_velocity: float = number(0.05, "m/s", minimum=0)
    approach_velocity_scaling_dist: float = number(0.6, "m", minimum=0)
    use_collision_detection: bool = boolean(True)
    max_allowed_time_to_collision_up_to_carrot: float = number(1.0, "s", minimum=0)
    use_regulated_linear_velocity_scaling: bool = boolean(True)
    use_cost_regulated_linear_velocity_scaling: bool = boolean(True)
    cost_scaling_dist: float = number(0.6, "m", minimum=0)
    cost_scaling_gain: float = number(1.0, minimum=0)
    inflation_cost_scaling_factor: float = number(3.0, minimum=1e-6)
    regulated_linear_scaling_min_radius: float = number(0.9, "m", minimum=0)
    regulated_linear_scaling_min_speed: float = number(0.25, "m/s", minimum=0)
    use_rotate_to_heading: bool = boolean(True)
    rotate_to_heading_min_angle: float = number(0.785, "rad", minimum=0)
    rotate_to_heading_angular_vel: float = number(1.8, "rad/s", minimum=0)
    max_angular_accel: float = number(3.2, "rad/s^2", minimum=0.001)
    allow_reversing: bool = boolean(False)
    max_robot_pose_search_dist: float = number(-1.0, "m", description="negative for half of the costmap's side")
    use_cancel_deceleration: bool = boolean(False)
    cancel_deceleration: float = number(3.2, "m/s^2", minimum=0.001)
    transform_tolerance: bool = without_effect()
    stateful: bool = without_effect()  # the goal checker has this state


class PurePursuit:
    """Drives on the arc through a point of the path at the lookahead distance (regulated pure pursuit).

    The point has the coordinates (x, y) in the frame of the robot. The arc has the curvature 2·y/(x² + y²). The speed
    decreases in sharp turns, near obstacles and near the goal. The robot turns on the spot if the point is far aside,
    and at the goal. The formulas are those of `nav2_regulated_pure_pursuit_controller/src` (Jazzy).
    """

    topics = ("received_global_plan", "lookahead_point")

    def configure(self, node: ControllerNode, params: Params) -> None:
        """Read the parameters."""
        self._node, self._options = node, PurePursuitOptions(params).read_all()
        self._path = LocalPath(np.zeros((1, 3)))
        self._speed = self._options.desired_linear_vel
        self.reset()

    def set_plan(self, path: Floats) -> None:
        """Follow another path: x, y [m] and yaw [rad] of each pose, shape (n, 3)."""
        self._path = LocalPath(path)

    def set_speed_limit(self, limit: float, is_percentage: bool) -> None:
        """Reduce the speed.

        Args:
            limit: largest speed [m/s], or percentage of the wanted one; 0 for no limit.
            is_percentage: True for a percentage.
        """
        wanted = self._options.desired_linear_vel
        self._speed = (wanted * limit / 100.0 if is_percentage else limit) if limit else wanted

    def reset(self) -> None:
        """End a deceleration."""
        self._is_canceled = self._has_stopped = False

    def cancel(self) -> bool:
        """Begin to decelerate; return True if the robot has stopped, or stops without deceleration."""
        self._is_canceled = True
        return self._has_stopped or not self._options.use_cancel_deceleration

    def compute_velocity_commands(self, pose: PlanarPose, velocity: Speeds, grid: CostGrid | None) -> Speeds | None:
        """Return forward speed [m/s] and turning rate [rad/s]; None if the robot would touch an obstacle."""
        options = self._options
        search = options.max_robot_pose_search_dist
        if search < 0:
            search = math.inf if grid is None else max(grid.cells.shape) * grid.resolution / 2
        near = self._path.advance(pose, search, math.inf, None)
        speeds, reach = self._speeds(near, pose, velocity, grid)
        if options.use_collision_detection and grid is not None:
            time, footprint = options.max_allowed_time_to_collision_up_to_carrot, self._node.footprint
            if speeds[0]:
                time = min(time, _arc(reach, speeds[1] / speeds[0]) / abs(speeds[0]))
            if footprint.collides_ahead(grid, pose, speeds, time):
                return None
        return speeds

    def _speeds(self, near: Floats, pose: PlanarPose, velocity: Speeds, grid: CostGrid | None) -> tuple[Speeds, float]:
        """Return the command, and the distance of the point that the robot drives to [m]."""
        options = self._options
        places = pose.inverse().transform(near[:, :2])
        distances = np.hypot(*places.T)
        if options.use_rotate_to_heading and self._node.is_at_goal_position:
            return (0.0, self._turning(self._path.goal.yaw - pose.yaw, velocity[1])), 0.0
        lookahead, fixed = self._lookahead(velocity), options.curvature_lookahead_dist
        if options.allow_reversing:
            inversion = first_inversion(near)
            if inversion < len(near):
                lookahead, fixed = min(lookahead, distances[inversion - 1]), min(fixed, distances[inversion - 1])
        x, y = _carrot(places, distances, lookahead)
        self._publish(near, pose, (x, y))
        direction = -1.0 if options.allow_reversing and x < 0.0 else 1.0
        turn_x, turn_y = x, y
        if options.use_fixed_curvature_lookahead:
            turn_x, turn_y = _carrot(places, distances, fixed, options.interpolate_curvature_after_goal)
        aside = wrap_angle(math.atan2(turn_y, turn_x) + (math.pi if direction < 0 else 0.0))
        if options.use_rotate_to_heading and abs(aside) > options.rotate_to_heading_min_angle:
            return (0.0, self._turning(aside, velocity[1])), 0.0
        square = turn_x * turn_x + turn_y * turn_y
        curvature = 2.0 * turn_y / square if square > _LEAST_SQUARE else 0.0
        cost = UNKNOWN if grid is None else grid.cost(pose.x, pose.y)
        speed = direction * self._limited(curvature, cost, _length(places), float(distances[-1]))
        if self._is_canceled and options.use_cancel_deceleration:
            slower = velocity[0] - direction * options.cancel_deceleration / self._node.controller_frequency
            speed = direction * max(direction * slower, 0.0)
            self._has_stopped = speed == 0.0
        return (speed, speed * curvature), math.hypot(x, y)

    def _lookahead(self, velocity: Speeds) -> float:
        options = self._options
        if not options.use_velocity_scaled_lookahead_dist:
            return options.lookahead_dist
        wanted = abs(velocity[0]) * options.lookahead_time
        return min(max(wanted, options.min_lookahead_dist), options.max_lookahead_dist)

    def _limited(self, curvature: float, cost: int, remaining: float, distance: float) -> float:
        """Return the speed [m/s], reduced in turns, near obstacles and near the end of the path.

        Args:
            curvature: curvature of the arc [1/m].
            cost: cost at the robot.
            remaining: length of the path that is not driven yet [m].
            distance: distance of the last pose of the path [m].
        """
        options = self._options
        in_turns = near_obstacles = self._speed
        radius = options.regulated_linear_scaling_min_radius
        if options.use_regulated_linear_velocity_scaling and abs(curvature) * radius > 1.0:
            in_turns = self._speed / (abs(curvature) * radius)
        if options.use_cost_regulated_linear_velocity_scaling and FREE < cost < UNKNOWN and options.cost_scaling_dist:
            inside, factor = self._node.footprint.inscribed_radius, options.inflation_cost_scaling_factor
            free = inside + math.log(INSCRIBED / cost) / factor
            if free < options.cost_scaling_dist:
                near_obstacles = self._speed * options.cost_scaling_gain * free / options.cost_scaling_dist
        speed = max(min(in_turns, near_obstacles), options.regulated_linear_scaling_min_speed)
        if remaining < options.approach_velocity_scaling_dist:
            approach = speed * distance / options.approach_velocity_scaling_dist
            speed = min(speed, max(approach, options.min_approach_linear_velocity))
        return min(abs(speed), self._speed)

    def _turning(self, angle: float, present: float) -> float:
        """Return the turning rate [rad/s] towards an angle [rad], with limited acceleration and without overshoot.

        Nav2 brakes with the whole acceleration, which overshoots by the delay of the odometry. Here it is a quarter.
        """
        angle, options = wrap_angle(angle), self._options
        wanted = math.copysign(
            min(options.rotate_to_heading_angular_vel, math.sqrt(2.0 * options.max_angular_accel * abs(angle)) / 2),
            angle,
        )
        change = options.max_angular_accel / self._node.controller_frequency
        return min(max(wanted, present - change), present + change)

    def _publish(self, near: Floats, pose: PlanarPose, carrot: tuple[float, float]) -> None:
        """Publish the rest of the path, and the point that the robot drives to."""
        self._node.publish_path("received_global_plan", near)
        self._node.publish_point("lookahead_point", pose.transform(np.array([carrot])))


def _arc(chord: float, curvature: float) -> float:
    """Return the length of an arc [m] with a chord [m] and a curvature [1/m]; that of half a circle at most."""
    part = abs(curvature) * chord / 2
    return chord if part < _SMALL else 2.0 * math.asin(min(part, 1.0)) / abs(curvature)


def _length(points: Floats) -> float:
    return float(distances_along(points)[-1])


def _carrot(places: Floats, distances: Floats, lookahead: float, extends: bool = False) -> tuple[float, float]:
    """Return the first point of a path at the lookahead distance [m]; the last point of a shorter path.

    Args:
        places: points of the path from the nearest one on, in the frame of the robot, shape (n, 2).
        distances: their distances from the robot [m].
        lookahead: lookahead distance [m].
        extends: extend a shorter path along its last segment.
    """
    if extends and len(places) > 1 and distances[-1] < lookahead:
        (x, y), length = (places[-1] - places[-2]).tolist(), float(np.hypot(*(places[-1] - places[-2])))
        if length > _SMALL:
            ahead = places[-1] + np.array((x, y)) * (2.0 * lookahead / length)
            places, distances = np.vstack((places[-1:], ahead)), np.array((distances[-1], np.hypot(*ahead)))
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
