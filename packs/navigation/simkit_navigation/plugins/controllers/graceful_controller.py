"""Controller with a smooth control law, as Nav2's `nav2_graceful_controller`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.extend import Options, boolean, number, without_effect
from simkit.pose import wrap_angle
from simkit_navigation.plugins.controllers.local_path import LocalPath, distances_along
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.controllers.controller_node import ControllerNode

_LEAST: Final = 1e-6
_AT_ROBOT = PlanarPose(0.0, 0.0, 0.0)


class GracefulOptions(Options):
    """Options of `GracefulController`, with the defaults of Jazzy."""

    min_lookahead: float = number(0.25, "m", minimum=0)
    max_lookahead: float = number(1.0, "m", minimum=0)
    max_robot_pose_search_dist: float = number(-1.0, "m", description="negative for half of the costmap's side")
    k_phi: float = number(2.0)
    k_delta: float = number(1.0)
    beta: float = number(0.4, minimum=0)
    lambda_: float = number(2.0, element="lambda")
    v_linear_min: float = number(0.1, "m/s", minimum=0)
    v_linear_max: float = number(0.5, "m/s", minimum=0)
    v_angular_max: float = number(1.0, "rad/s", minimum=0)
    v_angular_min_in_place: float = number(0.25, "rad/s", minimum=0)
    slowdown_radius: float = number(1.5, "m", minimum=_LEAST)
    initial_rotation: bool = boolean(True)
    initial_rotation_tolerance: float = number(0.75, "rad", minimum=0)
    prefer_final_rotation: bool = boolean(True)
    rotation_scaling_factor: float = number(0.5, minimum=0)
    allow_backward: bool = boolean(False)
    in_place_collision_resolution: float = number(0.1, "rad", minimum=1e-3)
    use_collision_detection: bool = boolean(True)
    transform_tolerance: bool = without_effect()


class GracefulController:
    """Drives to the furthest pose of the path to which its control law leads without a collision.

    The curvature is −(k_δ·(δ − atan(−k_φ·φ)) + (1 + k_φ/(1 + (k_φ·φ)²))·sin δ) / r. The distance of the pose is r, and
    φ and δ are the angles of the pose and of the robot to the line of sight. The formulas are those of
    `nav2_graceful_controller/src` (Jazzy).
    """

    needs_costmap = True
    topics = ("transformed_global_plan", "local_plan")

    def configure(self, node: ControllerNode, params: Params) -> None:
        """Read the parameters."""
        self._node, self._options = node, GracefulOptions(params).read_all()
        self._path = LocalPath(np.zeros((1, 3)))
        self._is_there, self._turns_first = False, True
        self._most = self._options.v_linear_max, self._options.v_angular_max

    def set_plan(self, path: Floats) -> None:
        """Follow another path: x, y [m] and yaw [rad] of each pose, shape (n, 3)."""
        self._path = LocalPath(path)
        self._is_there, self._turns_first = False, True

    def set_speed_limit(self, limit: float, is_percentage: bool) -> None:
        """Reduce all speeds.

        Args:
            limit: largest forward speed [m/s], or percentage of it; 0 for no limit.
            is_percentage: True for a percentage.
        """
        options = self._options
        most = 100.0 if is_percentage else options.v_linear_max
        share = limit / most if limit and most else 1.0
        self._most = max(options.v_linear_max * share, options.v_linear_min), options.v_angular_max * share

    def compute_velocity_commands(
        self, pose: PlanarPose, velocity: tuple[float, float], grid: CostGrid | None
    ) -> tuple[float, float] | None:
        """Return forward speed [m/s] and turning rate [rad/s]; None if the robot would touch an obstacle."""
        if grid is None:
            return None
        options = self._options
        half = max(grid.cells.shape) * grid.resolution / 2
        search = options.max_robot_pose_search_dist
        near = self._path.advance(pose, half if search < 0 else search, half, grid)
        if not len(near):
            return None
        self._node.publish_path("transformed_global_plan", near)
        to_robot = pose.inverse()
        path = np.column_stack((to_robot.transform(near[:, :2]), near[:, 2] - pose.yaw))
        remaining = float(distances_along(path)[-1])
        if self._is_there or remaining < self._node.goal_tolerance:
            self._is_there = True
            turn = self._final_turn(wrap_angle(float(path[-1, 2])), pose, grid)
            if turn is not None:
                return turn
        return self._drive(path, remaining, pose, grid)

    def _drive(self, path: Floats, remaining: float, pose: PlanarPose, grid: CostGrid) -> tuple[float, float] | None:
        options = self._options
        along = distances_along(path) + math.hypot(*path[0, :2].tolist())
        for (x, y, yaw), distance in zip(reversed(path.tolist()), reversed(along.tolist()), strict=True):
            if distance > options.max_lookahead:
                continue
            if remaining < options.max_lookahead:
                if options.prefer_final_rotation:
                    yaw = math.atan2(y, x)
            elif distance < options.min_lookahead:
                break
            is_back = options.allow_backward and x < 0.0
            target = PlanarPose(x, y, yaw + math.pi if is_back else yaw)
            command = self._simulate(target, pose, grid, is_back)
            if command is not None:
                return command
        return None

    def _final_turn(self, angle: float, pose: PlanarPose, grid: CostGrid) -> tuple[float, float] | None:
        count = max(1, int(abs(angle) / self._options.in_place_collision_resolution))
        for step in range(1, count + 1):
            if self._collides(grid, pose.compose(PlanarPose(0.0, 0.0, angle * step / count))):
                return None
        return 0.0, self._turning(angle)

    def _turning(self, angle: float) -> float:
        options = self._options
        rate = options.rotation_scaling_factor * angle * self._most[1]
        return math.copysign(max(abs(rate), options.v_angular_min_in_place), rate)

    def _collides(self, grid: CostGrid, pose: PlanarPose) -> bool:
        return self._options.use_collision_detection and self._node.footprint.collides(grid, pose)

    def _simulate(
        self, target: PlanarPose, pose: PlanarPose, grid: CostGrid, is_back: bool
    ) -> tuple[float, float] | None:
        """Return the first command of the motion to a pose in the robot's frame; None if the motion collides."""
        options = self._options
        towards = math.atan2(target.y, target.x)
        turns = self._turns_first and options.initial_rotation
        if abs(towards) < options.initial_rotation_tolerance:
            turns = self._turns_first = False
        period = grid.resolution / self._most[0] if self._most[0] > 0.0 else 0.0
        most = int(3 * math.hypot(target.x, target.y) / grid.resolution)
        now, command = _AT_ROBOT, (0.0, 0.0)
        poses: list[PlanarPose] = []
        while True:
            if turns:
                rate = self._turning(towards - now.yaw)
                speeds = 0.0, rate
                turns = abs(towards - now.yaw) >= options.initial_rotation_tolerance
            else:
                speeds = self._law(target, now, is_back)
            command = command if poses else speeds
            way = speeds[0] * period
            now = PlanarPose(
                now.x + way * math.cos(now.yaw), now.y + way * math.sin(now.yaw), now.yaw + speeds[1] * period
            )
            placed = pose.compose(now)
            poses.append(placed)
            if self._collides(grid, placed):
                return None
            if math.hypot(target.x - now.x, target.y - now.y) <= grid.resolution or len(poses) >= most:
                self._node.publish_path("local_plan", np.array(poses))
                return command

    def _law(self, target: PlanarPose, now: PlanarPose, is_back: bool) -> tuple[float, float]:
        """Return the speeds of the control law."""
        options, (fastest, quickest) = self._options, self._most
        x, y = target.x - now.x, target.y - now.y
        sight = math.atan2(-y, x) + (math.pi if is_back else 0.0)
        distance = max(math.hypot(x, y), _LEAST)
        phi, delta = wrap_angle(target.yaw + sight), wrap_angle(now.yaw + sight)
        proportional = options.k_delta * (delta - math.atan(-options.k_phi * phi))
        feedback = (1.0 + options.k_phi / (1.0 + (options.k_phi * phi) ** 2)) * math.sin(delta)
        curvature = -(proportional + feedback) / distance
        curvature = -curvature if is_back else curvature
        speed = fastest / (1.0 + options.beta * math.pow(abs(curvature), options.lambda_))
        speed = min(fastest * distance / options.slowdown_radius, speed)
        speed = max(min(speed, fastest), options.v_linear_min)
        speed = -speed if is_back else speed
        rate = max(-quickest, min(curvature * speed, quickest))
        return (rate / curvature if curvature else speed), rate
