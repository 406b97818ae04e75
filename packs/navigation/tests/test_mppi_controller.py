"""MPPI controller: the samples, the critics, limits and the random numbers."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from controller_nodes import controller_node, empty_grid, straight_path

from simkit import Params
from simkit.diagnostics import Diagnostics
from simkit_navigation.plugins.controllers.local_path import LocalPath, first_inversion
from simkit_navigation.plugins.controllers.mppi_controller import MppiController
from simkit_navigation.plugins.controllers.mppi_samples import AxisLimits, trajectories
from simkit_navigation.plugins.controllers.sample_arithmetic import cosine, sine, sum_over_samples, wrapped
from simkit_navigation.plugins.costmaps.cost_grid import LETHAL, CostGrid
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

CRITICS = (
    "ConstraintCritic CostCritic GoalCritic GoalAngleCritic PathAlignCritic PathFollowCritic PathAngleCritic "
    "PreferForwardCritic"
)


def mppi(node: Any = None, path: Any = None, **options: Any) -> MppiController:
    found = MppiController()
    values = {"critics": CRITICS, "batch_size": 300, "regenerate_noises": "true", **options}
    found.configure(node or controller_node(), Params.from_dict(values))
    found.set_plan(straight_path() if path is None else np.asarray(path, np.float64))
    return found


def drive(controller: MppiController, node: Any, grid: CostGrid, cycles: int, pose: PlanarPose) -> list[Any]:
    """Drive a robot that obeys at once; return its poses and the commands."""
    found, speeds = [], (0.0, 0.0)
    for _ in range(cycles):
        node.sim.time_ns += 50_000_000
        around = replace(grid, origin=grid.origin.compose(PlanarPose(0.0, 0.0, 0.0)))
        command = controller.compute_velocity_commands(pose, speeds, around)
        assert command is not None
        forward, aside, rate = command
        pose = pose.compose(PlanarPose(forward * 0.05, aside * 0.05, rate * 0.05))
        speeds, node.lateral_speed = (forward, rate), aside
        found.append((pose, command))
    return found


def test_sines_and_sums_are_exact_and_keep_the_type() -> None:
    angles = np.linspace(-20.0, 20.0, 4001)
    assert np.abs(sine(angles) - np.sin(angles)).max() < 6e-8
    assert np.abs(cosine(angles) - np.cos(angles)).max() < 6e-8
    narrow = angles.astype(np.float32)
    assert sine(narrow).dtype == np.float32 and np.abs(sine(narrow) - np.sin(angles)).max() < 3e-6
    assert np.abs(wrapped(angles)).max() <= math.pi + 1e-9
    for count in (1, 2, 7, 1000):
        values = np.arange(3 * count, dtype=np.float64).reshape(3, count)
        assert sum_over_samples(values).tolist() == values.sum(axis=1).tolist()


def test_a_sample_keeps_the_acceleration_limits_and_follows_its_arc() -> None:
    limits = AxisLimits(-0.35, 0.5, -0.05, 0.15)
    controls = np.full((4, 1), 0.5, np.float32)
    assert limits.reachable(controls, 0.1)[:, 0].tolist() == pytest.approx([0.1, 0.25, 0.4, 0.5])
    assert controls[:, 0].tolist() == pytest.approx([0.25, 0.4, 0.5, 0.5])  # the controls are clipped, too
    controls = np.zeros((3, 1), np.float32)
    assert limits.reachable(controls, 0.12)[:, 0].tolist() == pytest.approx([0.12, 0.07, 0.02])
    speeds = {"vx": np.full((40, 1), 0.5, np.float32), "wz": np.full((40, 1), 1.0, np.float32)}
    x, y, yaw, _, _ = trajectories(speeds, PlanarPose(0.0, 0.0, 0.0), 0.05, False)
    assert yaw[-1, 0] == pytest.approx(2.0, abs=1e-5)
    assert math.hypot(x[-1, 0], y[-1, 0] - 0.5) == pytest.approx(0.5, abs=0.02)  # a circle of 0.5 m


def test_the_robot_accelerates_along_a_straight_path_and_stops_at_its_end() -> None:
    node = controller_node()
    poses = drive(mppi(node, straight_path(2.0)), node, empty_grid(6.0), 160, PlanarPose(0.0, 0.0, 0.0))
    speeds = [command[0] for _, command in poses]
    assert 0.4 < max(speeds) <= 0.5 + 1e-6
    assert max(abs(pose.y) for pose, _ in poses) < 0.08
    assert abs(poses[-1][0].x - 2.0) < 0.2 and abs(speeds[-1]) < 0.15


def test_the_robot_drives_around_an_obstacle_on_its_path() -> None:
    node, grid = controller_node(), empty_grid(6.0)
    rows, columns = np.indices(grid.cells.shape)
    x, y = (columns + 0.5) * 0.05 - 3.0, (rows + 0.5) * 0.05 - 3.0
    distance = np.maximum(np.hypot(x - 1.0, y - 0.25) - 0.1, 0.0)
    costs = np.where(distance < 0.2, 253, 252 * np.exp(-3.0 * (distance - 0.2)))
    grid.cells[:] = np.where(distance == 0.0, LETHAL, np.where(distance < 0.7, costs, 0)).astype(np.uint8)
    poses = drive(mppi(node), node, grid, 110, PlanarPose(0.0, 0.0, 0.0))
    nearest = min(math.hypot(pose.x - 1.0, pose.y - 0.25) - 0.1 for pose, _ in poses)
    assert nearest > 0.2 and poses[-1][0].x > 1.4


def test_a_surrounded_robot_has_no_valid_command() -> None:
    grid = empty_grid()
    grid.cells[:] = LETHAL
    assert mppi().compute_velocity_commands(PlanarPose(0.0, 0.0, 0.0), (0.0, 0.0), grid) is None


def test_a_robot_that_moves_sideways_goes_to_a_goal_beside_it() -> None:
    node = controller_node()
    path = np.column_stack((np.zeros(41), np.arange(41) * 0.05, np.zeros(41)))
    poses = drive(mppi(node, path, motion_model="Omni"), node, empty_grid(6.0), 100, PlanarPose(0.0, 0.0, 0.0))
    assert max(command[1] for _, command in poses) > 0.3
    assert poses[-1][0].y > 1.5


def test_a_car_keeps_its_turning_radius() -> None:
    node = controller_node()
    options = {"motion_model": "Ackermann", "AckermannConstraints": {"min_turning_r": 0.5}}
    poses = drive(mppi(node, [(0.0, 0.1 * i, 1.57) for i in range(20)], **options), node, empty_grid(6.0), 50,
                  PlanarPose(0.0, 0.0, 0.0))  # fmt: skip
    assert max(abs(command[2]) for _, command in poses) > 0.3
    # the smoothing, which follows as in Nav2, changes the radius by a few per cent
    assert all(abs(command[2]) * 0.5 <= abs(command[0]) + 0.05 for _, command in poses)


def test_a_speed_limit_holds_until_it_is_lifted() -> None:
    node = controller_node()
    controller = mppi(node, straight_path(8.0))
    grid = empty_grid(20.0)
    controller.set_speed_limit(40.0, True)
    poses = drive(controller, node, grid, 40, PlanarPose(0.0, 0.0, 0.0))
    assert poses[-1][1][0] == pytest.approx(0.2, abs=0.02)
    controller.set_speed_limit(0.3, False)
    poses = drive(controller, node, grid, 40, poses[-1][0])
    assert poses[-1][1][0] == pytest.approx(0.3, abs=0.03)
    controller.set_speed_limit(0.0, False)
    assert drive(controller, node, grid, 40, poses[-1][0])[-1][1][0] > 0.4


def test_the_noise_depends_on_the_seed_and_the_number_of_the_cycle_only() -> None:
    def commands(seed: int) -> list[Any]:
        node = controller_node()
        node.sim.seed = seed
        return [command for _, command in drive(mppi(node), node, empty_grid(6.0), 5, PlanarPose(0.0, 0.1, 0.0))]

    assert commands(0) == commands(0)
    one = mppi()
    first = one._noise.values(0, 3)["vx"].copy()
    one._noise.values(0, 4)
    assert (one._noise.values(0, 3)["vx"] == first).all()
    assert first.std() == pytest.approx(0.2, rel=0.05)


@pytest.mark.parametrize(
    ("options", "told"),
    [({"critics": "CostCritic MyCritic"}, "found 'MyCritic'"), ({"model_dt": 0.02}, "shorter than the control period")],
)
def test_unknown_critics_and_too_short_steps_are_errors(options: dict[str, Any], told: str) -> None:
    diagnostics = Diagnostics()
    MppiController().configure(controller_node(), Params.from_dict(options, "FollowPath", diagnostics))
    assert any(told in item.message for item in diagnostics)


def test_a_path_is_pruned_and_stops_at_an_inversion() -> None:
    poses = np.array([*((0.1 * i, 0.0, 0.0) for i in range(11)), *((1.0 - 0.1 * i, 0.02, 0.0) for i in range(1, 11))])
    assert first_inversion(poses) == 11
    local = LocalPath(poses, True)
    near = local.advance(PlanarPose(0.32, 0.0, 0.0), 5.0, 0.25, None)
    assert near[:, 0].tolist() == pytest.approx([0.3, 0.4, 0.5])
    assert local.advance(PlanarPose(0.5, 0.0, 0.0), 5.0, 9.0, None)[-1, 0] == pytest.approx(1.0)
    local.advance(PlanarPose(0.95, 0.0, 0.0), 5.0, 9.0, None)
    back = local.advance(PlanarPose(0.9, 0.0, 0.0), 5.0, 9.0, None)
    assert back[-1, 0] == pytest.approx(0.0) and (back[:, 1] == 0.02).all()
