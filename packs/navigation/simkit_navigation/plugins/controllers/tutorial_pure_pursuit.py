"""Pure pursuit as in Nav2's tutorial, `nav2_pure_pursuit_controller`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from simkit import Params
from simkit.extend import Options, number, without_effect
from simkit_navigation.plugins.controllers.pure_pursuit import Speeds
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit_navigation.plugins.controllers.controller_node import ControllerNode


class PurePursuitControllerOptions(Options):
    """Options of `PurePursuitController`."""

    desired_linear_vel: float = number(0.2, "m/s")
    lookahead_dist: float = number(0.4, "m", minimum=0)
    max_angular_vel: float = number(1.0, "rad/s")
    transform_tolerance: bool = without_effect()  # the newest transform is used, however old it is


class PurePursuitController:
    """Drives on the arc through a pose of the path (`nav2_pure_pursuit_controller::PurePursuitController`).

    The pose is the first one at `<lookahead_dist>` or more, with the coordinates (x, y) in the frame of the robot. The
    arc has the curvature 2·y/(x² + y²). If x is not positive, the robot turns on the spot to the left. The speed is
    constant, and there is no check for obstacles.
    """

    def configure(self, node: ControllerNode, params: Params) -> None:
        """Read the parameters."""
        self._options = PurePursuitControllerOptions(params).read_all()
        self._path: Floats = np.zeros((0, 3))

    def set_plan(self, path: Floats) -> None:
        """Follow another path: x, y [m] and yaw [rad] of each pose, shape (n, 3)."""
        self._path = path

    def compute_velocity_commands(self, pose: PlanarPose, velocity: Speeds, grid: CostGrid | None) -> Speeds:
        """Return forward speed [m/s] and turning rate [rad/s]; the poses before the nearest one are forgotten."""
        options = self._options
        places = pose.inverse().transform(self._path[:, :2])
        distances = np.hypot(*places.T)
        nearest = int(distances.argmin())
        self._path, places, distances = self._path[nearest:], places[nearest:], distances[nearest:]
        if grid is not None:  # the poses beyond the costmap are not looked at
            outside = np.flatnonzero(distances > max(grid.cells.shape) * grid.resolution / 2)
            if len(outside):
                count = max(int(outside[0]), 1)
                places, distances = places[:count], distances[:count]
        beyond = np.flatnonzero(distances >= options.lookahead_dist)
        x, y = places[int(beyond[0]) if len(beyond) else -1].tolist()
        largest = abs(options.max_angular_vel)
        if x <= 0:
            return 0.0, min(max(options.max_angular_vel, -largest), largest)
        turning = options.desired_linear_vel * 2.0 * y / (x * x + y * y)
        return options.desired_linear_vel, math.copysign(min(abs(turning), largest), turning)
