"""Controller that turns towards a new path before another controller follows it, as `nav2_rotation_shim_controller`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import Params
from simkit.extend import Options, boolean, number, text
from simkit.pose import wrap_angle
from simkit_navigation.plugins.controllers.footprint_costs import footprint_costs
from simkit_navigation.plugins.controllers.primary_controllers import PRIMARY_CONTROLLERS
from simkit_navigation.plugins.controllers.pure_pursuit import PurePursuit
from simkit_navigation.plugins.controllers.sample_arithmetic import cosine, sine
from simkit_navigation.plugins.costmaps.cost_grid import LETHAL, UNKNOWN, CostGrid
from simkit_navigation.plugins.costmaps.footprint import edge_points
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.controllers.controller_node import ControllerNode


class RotationShimOptions(Options):
    """Options of `RotationShim`; those of the primary controller are in the same block."""

    primary_controller: str = text("")
    angular_dist_threshold: float = number(0.785, "rad", minimum=0)
    angular_disengage_threshold: float = number(0.3925, "rad", minimum=0)
    forward_sampling_distance: float = number(0.5, "m", minimum=0)
    rotate_to_heading_angular_vel: float = number(1.8, "rad/s", minimum=0)
    max_angular_accel: float = number(3.2, "rad/s^2", minimum=0)
    max_cost_threshold: float = number(float(LETHAL))
    simulate_ahead_time: float = number(1.0, "s", minimum=0, maximum=60)
    rotate_to_goal_heading: bool = boolean(False)
    rotate_to_heading_once: bool = boolean(False)
    closed_loop: bool = boolean(True)
    use_path_orientations: bool = boolean(False)


class RotationShim:
    """Turns on the spot to the direction of a new path; then the primary controller follows the path.

    The rules are those of `nav2_rotation_shim_controller.cpp` (Jazzy).
    """

    def configure(self, node: ControllerNode, params: Params) -> None:
        """Read the parameters, and make the primary controller."""
        self._node, self._options = node, RotationShimOptions(params).read_all()
        self._path: Floats = np.zeros((0, 3))
        self._is_new = self._is_turning = False
        self._last_rate = 0.0
        kind = node.find_class(params.name, self._options.primary_controller, params, PRIMARY_CONTROLLERS)
        if kind is None:
            kind = PurePursuit  # the error ends the load after all parameters are read
        self._primary: Any = kind()
        if callable(getattr(self._primary, "configure", None)):
            self._primary.configure(node, params)

    @property
    def topics(self) -> tuple[str, ...]:
        """Topics of the primary controller."""
        return tuple(getattr(self._primary, "topics", ()))

    @property
    def needs_costmap(self) -> bool:
        """True if the primary controller cannot work without a costmap."""
        return bool(getattr(self._primary, "needs_costmap", False))

    def set_plan(self, path: Floats) -> None:
        """Follow another path: x, y [m] and yaw [rad] of each pose, shape (n, 3)."""
        same_goal = len(self._path) > 0 and bool((self._path[-1] == path[-1]).all())
        self._is_new = not self._options.rotate_to_heading_once or self._is_turning or not same_goal
        self._path = path
        self._primary.set_plan(path)

    def set_speed_limit(self, limit: float, is_percentage: bool) -> None:
        """Pass a speed limit on to the primary controller."""
        if callable(getattr(self._primary, "set_speed_limit", None)):
            self._primary.set_speed_limit(limit, is_percentage)

    def reset(self) -> None:
        """Forget the last turning rate."""
        self._last_rate = 0.0
        if callable(getattr(self._primary, "reset", None)):
            self._primary.reset()

    def compute_velocity_commands(
        self, pose: PlanarPose, velocity: tuple[float, float], grid: CostGrid | None
    ) -> tuple[float, ...] | None:
        """Return the speeds of the turn, or those of the primary controller."""
        command: tuple[float, ...] | None = None
        if self._options.rotate_to_goal_heading and self._node.is_at_goal_position:
            command = self._turn(float(self._path[-1, 2]) - pose.yaw, pose, velocity, grid)
        elif self._is_new:
            angle = self._angle_to_path(pose)
            limits = self._options
            limit = limits.angular_disengage_threshold if self._is_turning else limits.angular_dist_threshold
            if angle is not None and abs(angle) > limit:
                command = self._turn(angle, pose, velocity, grid)
            self._is_new = self._is_turning = command is not None
        if command is None:
            self._is_turning = False
            command = self._primary.compute_velocity_commands(pose, velocity, grid)
        self._last_rate = 0.0 if command is None else float(command[-1])
        return command

    def _angle_to_path(self, pose: PlanarPose) -> float | None:
        """Return the angle to the path at the sampling distance [rad]; None for a path of one pose."""
        path, options = self._path, self._options
        if len(path) < 2:
            return None
        distances = np.hypot(path[1:, 0] - path[0, 0], path[1:, 1] - path[0, 1])
        far = np.flatnonzero(distances >= options.forward_sampling_distance)
        x, y, yaw = path[1 + int(far[0]) if len(far) else -1].tolist()
        if options.use_path_orientations:
            return wrap_angle(yaw - pose.yaw)
        return wrap_angle(math.atan2(y - pose.y, x - pose.x) - pose.yaw)

    def _turn(
        self, angle: float, pose: PlanarPose, velocity: tuple[float, float], grid: CostGrid | None
    ) -> tuple[float, float] | None:
        """Return the speeds of a turn by an angle [rad]; None if the robot would touch an obstacle."""
        angle, options = wrap_angle(angle), self._options
        present = velocity[1] if options.closed_loop else self._last_rate
        change = options.max_angular_accel / self._node.controller_frequency
        wanted = math.copysign(options.rotate_to_heading_angular_vel, angle)
        rate = min(max(wanted, present - change), present + change)
        most = math.sqrt(2.0 * options.max_angular_accel * abs(angle))
        if abs(rate) > most:
            rate = math.copysign(most, angle)
        return None if grid is not None and self._collides(grid, pose, angle, rate) else (0.0, rate)

    def _collides(self, grid: CostGrid, pose: PlanarPose, angle: float, rate: float) -> bool:
        """Check whether the outline touches an obstacle while the robot turns."""
        options, frequency = self._options, self._node.controller_frequency
        times = np.arange(1, math.ceil(options.simulate_ahead_time * frequency) + 1) / frequency
        turned = rate * times
        ends = np.flatnonzero(np.abs(turned) >= abs(angle) - options.angular_dist_threshold)
        turned = turned[: ends[0]] if len(ends) else turned
        if not len(turned):
            return False
        place = grid.origin.inverse().compose(pose)
        yaw = turned + place.yaw
        x, y = np.full(len(yaw), place.x), np.full(len(yaw), place.y)
        points = edge_points(self._node.footprint.corners, grid.resolution)
        costs = footprint_costs(grid, points, x, y, cosine(yaw), sine(yaw))
        is_unknown = costs == UNKNOWN
        hits = (costs >= options.max_cost_threshold) & ~is_unknown
        return bool(hits.any() or (is_unknown.any() and not self._node.tracks_unknown_space))


CONTROLLERS: Final[dict[str, type[Any]]] = {
    **PRIMARY_CONTROLLERS,
    "nav2_rotation_shim_controller::RotationShimController": RotationShim,
}
"""All controllers of simkit by their name in Nav2."""
