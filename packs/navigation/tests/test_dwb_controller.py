"""DWB controller: the velocities that are tried, their trajectories, and the critics."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from controller_nodes import controller_node, empty_grid, straight_path

from simkit import Params
from simkit_navigation.plugins.controllers.dwb_controller import DwbController
from simkit_navigation.plugins.controllers.dwb_critics import _distances
from simkit_navigation.plugins.controllers.dwb_options import DwbOptions
from simkit_navigation.plugins.controllers.velocity_samples import Axis, VelocitySampler
from simkit_navigation.plugins.costmaps.cost_grid import INSCRIBED
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

WAFFLE: dict[str, Any] = {
    "max_vel_x": 0.26,
    "max_speed_xy": 0.26,
    "max_vel_theta": 1.0,
    "acc_lim_x": 2.5,
    "decel_lim_x": -2.5,
    "acc_lim_theta": 3.2,
    "decel_lim_theta": -3.2,
    "linear_granularity": 0.05,
    "critics": "RotateToGoal Oscillation BaseObstacle GoalAlign PathAlign PathDist GoalDist",
    "BaseObstacle": {"scale": 0.02},
    "PathAlign": {"scale": 32.0, "forward_point_distance": 0.1},
    "GoalAlign": {"scale": 24.0, "forward_point_distance": 0.1},
    "PathDist": {"scale": 32.0},
    "GoalDist": {"scale": 24.0},
    "RotateToGoal": {"scale": 32.0},
}
BEGIN = PlanarPose(0.0, 0.0, 0.0)


def dwb(node: Any = None, path: Any = None, **options: Any) -> DwbController:
    found = DwbController()
    found.configure(node or controller_node(), Params.from_dict({**WAFFLE, **options}))
    found.set_plan(straight_path() if path is None else np.asarray(path, np.float64))
    return found


def test_velocities_are_those_of_the_window_with_zero_between_the_signs() -> None:
    axis = Axis(-0.2, 0.5, 1.0, -1.0, 4)
    assert axis.velocities(0.0, 0.1) == pytest.approx([-0.1, -0.1 + 0.2 / 3, 0.0, -0.1 + 0.4 / 3, 0.1])
    assert axis.velocities(0.0, 9.0) == pytest.approx([-0.2, 0.0, -0.2 + 0.7 / 3, -0.2 + 1.4 / 3, 0.5])
    assert Axis(0.0, 0.0, 0.0, 0.0, 5).velocities(0.0, 1.0) == [0.0]
    assert axis.velocities(0.9, 0.1)[-1] == 0.5  # a speed beyond the limits counts as the limit


def test_a_trajectory_accelerates_to_its_velocity_and_has_the_length_of_the_simulated_time() -> None:
    options = DwbOptions(Params.from_dict({**WAFFLE, "sim_time": 1.0}))
    samples = VelocitySampler(options, 0.05).trajectories(BEGIN, (0.0, 0.0, 0.0))
    straight = int(np.abs(samples.velocities - (0.26, 0.0, 0.0)).max(axis=1).argmin())
    rate = samples.velocities[straight, 2]
    assert samples.velocities[straight, 0] == pytest.approx(0.26) and abs(rate) < 0.06
    way = np.hypot(np.diff(samples.x[:, straight]), np.diff(samples.y[:, straight])).sum()
    assert 0.24 < way <= 0.26 + 1e-9
    assert samples.yaw_at(1.0)[straight] == pytest.approx(samples.yaw[-1, straight])
    limited = DwbOptions(
        Params.from_dict({**WAFFLE, "trajectory_generator_name": "dwb_plugins::LimitedAccelGenerator"})
    )
    tried = VelocitySampler(limited, 0.05).velocities((0.0, 0.0, 0.0))
    assert tried[:, 0].max() == pytest.approx(0.125)  # what 2.5 m/s² reach in a control period


def test_distances_are_counted_in_cells_from_the_nearest_source() -> None:
    found = _distances((4, 5), np.array([0, 19]))
    assert found is not None
    assert found.reshape(4, 5).tolist() == [[0, 1, 2, 3, 3], [1, 2, 3, 3, 2], [2, 3, 3, 2, 1], [3, 3, 2, 1, 0]]


def test_the_robot_drives_around_the_end_of_a_wall() -> None:
    """The local goal is behind the wall, and the distance through the wall grows on the first part of the path."""
    grid = empty_grid()
    grid.cells[36:40, :40] = INSCRIBED  # a wall 0.3 m to the left, which ends 0.5 m ahead
    corners = [(0.0, 0.0), (0.8, 0.2), (0.8, 0.8), (0.0, 0.9)]
    path = [
        (x + (u - x) * part / 10, y + (v - y) * part / 10, 0.0)
        for (x, y), (u, v) in itertools.pairwise(corners)
        for part in range(10)
    ]
    command = dwb(path=path).compute_velocity_commands(BEGIN, (0.1, 0.0), grid)
    assert command is not None and command[0] > 0.2


def test_the_robot_drives_straight_turns_to_a_path_beside_it_and_avoids_an_obstacle() -> None:
    grid = empty_grid()
    forward, aside, rate = dwb().compute_velocity_commands(BEGIN, (0.2, 0.0), grid) or (0.0, 0.0, 9.0)
    assert forward == pytest.approx(0.26, abs=0.02) and aside == 0.0 and abs(rate) < 0.06
    left = np.array([(0.0, 0.05 * i, math.pi / 2) for i in range(20)])
    assert (dwb(path=left).compute_velocity_commands(BEGIN, (0.0, 0.0), grid) or (0, 0, 0))[2] > 0.3
    grid.cells[:, 34:36] = INSCRIBED  # 0.2 m ahead: the robot would reach it in the simulated time
    slow = dwb().compute_velocity_commands(BEGIN, (0.0, 0.0), grid)
    assert slow is not None and slow[0] * 1.7 < 0.22
    grid.cells[:] = INSCRIBED
    assert dwb().compute_velocity_commands(BEGIN, (0.0, 0.0), grid) is None


def test_at_the_goal_the_robot_brakes_and_then_only_turns() -> None:
    grid, path = empty_grid(), [(-0.4, 0.0, 1.0), (0.1, 0.0, 1.0)]
    fast = dwb(path=path).compute_velocity_commands(BEGIN, (0.26, 0.0), grid)
    assert fast is not None and fast[0] < 0.26
    slow = dwb(path=path).compute_velocity_commands(BEGIN, (0.0, 0.0), grid)
    assert slow is not None and slow[0] == 0.0 and slow[2] > 0.3


def test_a_turn_does_not_change_its_direction_before_the_robot_has_moved() -> None:
    node = controller_node()
    controller = dwb(node, critics="Oscillation Twirling PreferForward", Twirling={"scale": 1.0})
    oscillation: Any = controller._critics[0]
    for rate in (0.5, -0.5):
        for trend, speed in zip(oscillation._trends, (0.0, 0.0, rate), strict=True):
            trend.update(speed)
    allowed = oscillation._trends[2].allowed(np.array([0.4, 0.0, -0.4]))
    assert allowed.tolist() == [False, True, True]


def test_a_speed_limit_reduces_the_velocities() -> None:
    controller, grid = dwb(), empty_grid()
    controller.set_speed_limit(50.0, True)
    assert (controller.compute_velocity_commands(BEGIN, (0.1, 0.0), grid) or (9, 0, 0))[0] == pytest.approx(
        0.13, abs=0.01
    )
    controller.set_speed_limit(0.0, False)
    assert (controller.compute_velocity_commands(BEGIN, (0.1, 0.0), grid) or (9, 0, 0))[0] == pytest.approx(
        0.26, abs=0.02
    )
