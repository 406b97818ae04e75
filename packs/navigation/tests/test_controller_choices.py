"""Controllers, goal checkers and progress checkers by name, with the parameters of Nav2's node."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from controller_nodes import controller_node, empty_grid
from navigation_worlds import pose, run_until_done, world

import simkit
from simkit import Params
from simkit_navigation.plugins.controllers.controller_parameters import controller_parameters
from simkit_navigation.plugins.controllers.goal_checkers import (
    PositionGoalChecker,
    SimpleGoalChecker,
    StoppedGoalChecker,
)
from simkit_navigation.plugins.controllers.graceful_controller import GracefulController
from simkit_navigation.plugins.controllers.progress_checkers import PoseProgressChecker, SimpleProgressChecker
from simkit_navigation.plugins.controllers.pure_pursuit import PurePursuit
from simkit_navigation.plugins.controllers.rotation_shim import RotationShim
from simkit_navigation.plugins.costmaps.cost_grid import LETHAL
from simkit_navigation.plugins.navigation.node_values import nested
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

BEGIN, STOPPED = PlanarPose(0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
PURSUIT = "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController"
SHIM = "nav2_rotation_shim_controller::RotationShimController"


def line(angle: float, length: float = 2.0) -> Any:
    along = np.arange(round(length / 0.05) + 1) * 0.05
    return np.column_stack((along * math.cos(angle), along * math.sin(angle), np.full_like(along, angle)))


def made(cls: type[Any], path: Any, node: Any = None, **options: Any) -> Any:
    found = cls()
    found.configure(node or controller_node(), Params.from_dict(options))
    found.set_plan(path)
    return found


def test_goal_checkers_check_position_yaw_and_speed() -> None:
    near, turned = PlanarPose(0.2, 0.0, 0.0), PlanarPose(0.2, 0.0, math.pi)
    for cls, reached in ((PositionGoalChecker, True), (SimpleGoalChecker, False), (StoppedGoalChecker, False)):
        assert cls(Params.from_dict({})).is_reached(turned, BEGIN, STOPPED, 0.2) is reached
    symmetric = SimpleGoalChecker(Params.from_dict({"symmetric_yaw_tolerance": "true"}))
    assert symmetric.is_reached(turned, BEGIN, STOPPED, 0.2)
    stopped = StoppedGoalChecker(Params.from_dict({}))
    assert not stopped.is_reached(near, BEGIN, (0.3, 0.0, 0.0), 0.2) and stopped.is_reached(near, BEGIN, STOPPED, 0.2)
    for is_stateful in ("true", "false"):
        checker = SimpleGoalChecker(Params.from_dict({"stateful": is_stateful}))
        checker.is_reached(turned, BEGIN, STOPPED, 0.2)
        assert checker.is_reached(PlanarPose(0.3, 0.0, 0.0), BEGIN, STOPPED, 0.3) is (is_stateful == "true")
    round_trip = PositionGoalChecker(Params.from_dict({"path_length_tolerance": 1.0}))
    assert not round_trip.is_reached(near, BEGIN, STOPPED, 8.0)  # the goal is at the begin of the path


def test_turning_on_the_spot_is_progress_for_one_of_the_checkers() -> None:
    for cls, expected in ((SimpleProgressChecker, False), (PoseProgressChecker, True)):
        checker = cls(Params.from_dict({"movement_time_allowance": 5.0}))
        assert checker.makes_progress(BEGIN, 0)
        assert checker.makes_progress(PlanarPose(0.0, 0.0, 1.0), 4 * 10**9)
        assert checker.makes_progress(PlanarPose(0.0, 0.0, 1.0), 6 * 10**9) is expected


def test_the_shim_turns_to_a_new_path_and_then_the_primary_controller_drives() -> None:
    node, grid = controller_node(), empty_grid()
    shim = made(RotationShim, line(2.0), node, primary_controller=PURSUIT, use_rotate_to_heading="false")
    assert shim.compute_velocity_commands(BEGIN, (0.0, 0.0), grid) == (0.0, pytest.approx(3.2 / 20))
    assert shim.compute_velocity_commands(BEGIN, (0.0, 1.79), grid) == (0.0, pytest.approx(1.8))
    # it goes on below the angle at which it begins (0.785 rad), and brakes
    assert shim.compute_velocity_commands(PlanarPose(0.0, 0.0, 1.4), (0.0, 1.0), grid)[0] == 0.0
    assert shim.compute_velocity_commands(PlanarPose(0.0, 0.0, 1.7), (0.0, 0.5), grid)[0] > 0.2
    assert shim.compute_velocity_commands(BEGIN, (0.0, 0.0), grid)[0] > 0.0  # no more turns before the next path
    grid.cells[30:34, 33:36] = LETHAL  # 0.2 m ahead, where the outline of 0.2 m touches it
    shim.set_plan(line(2.0))
    assert shim.compute_velocity_commands(BEGIN, (0.0, 0.0), grid) is None or not shim._is_turning


def test_the_graceful_controller_drives_on_a_smooth_curve_and_turns_at_the_goal() -> None:
    grid = empty_grid(6.0)
    forward, rate = made(GracefulController, line(0.0)).compute_velocity_commands(BEGIN, (0.0, 0.0), grid)
    assert 0.3 < forward <= 0.5 and rate == pytest.approx(0.0)
    forward, rate = made(GracefulController, line(0.5)).compute_velocity_commands(BEGIN, (0.0, 0.0), grid)
    assert forward > 0.1 and rate > 0.1
    at_goal = np.array([(0.0, 0.0, 0.0), (0.1, 0.0, 1.0)])
    assert made(GracefulController, at_goal).compute_velocity_commands(BEGIN, (0.0, 0.0), grid) == (0.0, 0.5)
    grid.cells[:, 66:70] = LETHAL
    assert made(GracefulController, line(0.0)).compute_velocity_commands(BEGIN, (0.0, 0.0), grid)[0] > 0.0
    grid.cells[:] = LETHAL
    assert made(GracefulController, line(0.0)).compute_velocity_commands(BEGIN, (0.0, 0.0), grid) is None


def test_pure_pursuit_slows_down_near_obstacles_and_drives_back_on_a_path_behind_it() -> None:
    grid = empty_grid()
    slow = {"regulated_linear_scaling_min_speed": 0.1}
    assert made(PurePursuit, line(0.0), **slow).compute_velocity_commands(BEGIN, (0.0, 0.0), grid)[0] == 0.5
    grid.cells[:] = 126  # with the factor 3, this is the cost at 0.2 m + ln(253 / 126) / 3 = 0.43 m
    found = made(PurePursuit, line(0.0), **slow).compute_velocity_commands(BEGIN, (0.0, 0.0), grid)
    assert found[0] == pytest.approx(0.5 * (0.2 + math.log(253 / 126) / 3) / 0.6)
    back = {"allow_reversing": "true", "use_rotate_to_heading": "false"}
    found = made(PurePursuit, line(math.pi), **back).compute_velocity_commands(BEGIN, (0.0, 0.0), None)
    assert found[0] == -0.5 and abs(found[1]) < 1e-9
    limited = made(PurePursuit, line(0.0))
    limited.set_speed_limit(60.0, True)
    assert limited.compute_velocity_commands(BEGIN, (0.0, 0.0), None)[0] == pytest.approx(0.3)


def test_the_parameters_of_humble_keep_controller_critics_and_checkers() -> None:
    values = nested(
        {
            "progress_checker_plugin": "progress_checker",
            "goal_checker_plugins": ["precise", "coarse"],
            "precise.plugin": "nav2_controller/StoppedGoalChecker",
            "controller_plugins": ["FollowPath", "Other", "Own"],
            "FollowPath.plugin": "dwb_core/DWBLocalPlanner",
            "FollowPath.critics": ["RotateToGoal", "PathDist", "Mine"],
            "FollowPath.PathDist.scale": 32.0,
            "Other": {"plugin": SHIM, "primary_controller": "teb_local_planner::TebLocalPlannerROS", "max_vel_x": 0.4},
            "Own.plugin": "my_controllers::Creep",
        }
    )
    costmap = {"plugins": ["inflation"], "inflation": {"plugin": "nav2_costmap_2d::InflationLayer",
               "inflation_radius": 0.7}, "robot_radius": 0.22, "robot_base_frame": "base_link"}  # fmt: skip
    found = controller_parameters(values, costmap)
    assert found.values["FollowPath"] == {**values["FollowPath"], "critics": ["RotateToGoal", "PathDist"]}
    assert found.values["Other"] == {"plugin": SHIM, "primary_controller": PURSUIT, "desired_linear_vel": 0.4}
    assert found.values["Own"] == {"plugin": "my_controllers::Creep"}
    assert found.values["inflation_layer"] == {"inflation_radius": 0.7} and found.values["robot_radius"] == 0.22
    assert found.values["goal_checker_plugins"] == ["precise", "coarse"]
    assert found.values["precise"] == {"plugin": "nav2_controller::StoppedGoalChecker"}
    assert found.values["progress_checker"] == {"plugin": "nav2_controller::SimpleProgressChecker"}
    assert found.told == [
        "FollowPath: the critic Mine is left out",
        f"Other: the primary controller {PURSUIT} replaces teb_local_planner::TebLocalPlannerROS",
    ]


def test_the_path_handler_and_the_motion_model_of_rolling_are_those_of_the_controller() -> None:
    mppi = {"plugin": "nav2_mppi_controller::MPPIController", "motion_model": "car", "critics": ["GoalCritic"]}
    values: dict[str, Any] = {
        "path_handler_plugins": ["PathHandler"],
        "PathHandler": {
            "plugin": "nav2_controller::FeasiblePathHandler",
            "prune_distance": 2.0,
            "reject_unit_path": True,
        },
        "controller_plugins": ["FollowPath"],
        "FollowPath": {**mppi, "car": {"plugin": "mppi::AckermannMotionModel", "min_turning_r": 0.4}},
    }
    found = controller_parameters(values, {})
    own = {"motion_model": "Ackermann", "AckermannConstraints": {"min_turning_r": 0.4}, "prune_distance": 2.0}
    assert found.values["FollowPath"] == {**mppi, **own}
    assert "PathHandler" not in found.values and found.told == ["PathHandler: reject_unit_path has no effect"]


MPPI = """<controller_plugins>FollowPath</controller_plugins>
<FollowPath><plugin>nav2_mppi_controller/MPPIController</plugin>
<batch_size>200</batch_size><regenerate_noises>true</regenerate_noises><vx_max>0.26</vx_max><visualize>true</visualize>
<critics>ConstraintCritic CostCritic GoalCritic GoalAngleCritic PathAlignCritic PathFollowCritic PreferForwardCritic
</critics></FollowPath>
<goal_checker_plugins>near far</goal_checker_plugins><near><xy_goal_tolerance>0.1</xy_goal_tolerance></near>
<far><plugin>nav2_controller::PositionGoalChecker</plugin><xy_goal_tolerance>0.6</xy_goal_tolerance></far>"""


def test_mppi_repeats_after_a_restore_shows_its_work_and_keeps_the_speed_limit(tmp_path: Path) -> None:
    """A goal selects its goal checker; an unknown one is reported."""
    with simkit.load(world(tmp_path, controller=MPPI)) as sim:
        sim.run(0.5)
        route = {"header": {"frame_id": "map"}, "poses": [pose(0.05 * i, 0.0) for i in range(19)]}
        unknown = sim.send_goal("/follow_path", {"path": route, "goal_checker_id": "none"})
        sim.step(2)
        assert unknown.result.error_code == 100 and "there are: near, far" in unknown.reason
        goal = sim.send_goal("/follow_path", {"path": route, "goal_checker_id": "far"})
        sim.run(0.5)
        before = sim.snapshot()
        sim.run(0.3)
        first = sim.model("turtlebot3").pose
        sim.restore(before)
        sim.run(0.3)
        assert sim.model("turtlebot3").pose == first and first.position[0] > 0.02
        topics = {name: sim.subscribe(name, keep=1) for name in ("/optimal_trajectory", "/trajectories")}
        sim.run(0.05)
        assert topics["/optimal_trajectory"].latest.header.frame_id == "odom"
        assert len(topics["/optimal_trajectory"].latest.poses) == 56
        assert len(topics["/trajectories"].latest.markers) == 40 * 19 + 56
        for subscription in topics.values():
            subscription.close()
        limit = {"percentage": False, "speed_limit": 0.1}
        sim.advertise("/speed_limit", "nav2_msgs/msg/SpeedLimit").publish(limit)
        sim.run(0.6)
        assert sim.link("turtlebot3::base_footprint").linear_velocity[0] == pytest.approx(0.1, abs=0.02)
        run_until_done(sim, goal)
        assert goal.status.name == "SUCCEEDED"
        assert 0.28 < sim.model("turtlebot3").pose.position[0] < 0.45  # the end is at 0.9 m
