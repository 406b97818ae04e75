"""Nodes of Nav2 and robot_localization without ROS: they work as soon as the lifecycle manager activates them."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import pytest
from nav2_files import add_navigation, add_server, rooms, write_files
from navigation_worlds import pose, run_until_done

import simkit
from simkit import Simulation


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder with the files, which is the working folder."""
    monkeypatch.chdir(tmp_path)
    write_files(tmp_path)
    return tmp_path


def warnings(sim: Simulation, code: str) -> list[str]:
    return [item.message for item in sim.diagnostics if item.code == code]


def distance(sim: Simulation, x: float, y: float) -> float:
    found = sim.model("robot").pose.position
    return math.hypot(found[0] - x, found[1] - y)


@pytest.mark.slow  # two drives
def test_a_robot_reaches_goals_with_the_nodes_and_parameter_file_of_nav2(folder: Path) -> None:
    with simkit.load(rooms(), seed=3) as sim:
        sim.add_node("nav2_map_server/map_server", params={"yaml_filename": str(folder / "rooms.yaml")})
        add_server(sim, "nav2_amcl/amcl")
        sim.add_node("nav2_waypoint_follower/waypoint_follower")
        add_navigation(sim, "map_server", "amcl", "waypoint_follower")
        sim.run(2.0)
        task = sim.send_goal("/navigate_to_pose", {"pose": pose(4.2, 1.0, 0.0)})
        run_until_done(sim, task)
        assert task.status.name == "SUCCEEDED" and distance(sim, 4.2, 1.0) < 0.25
        walk = sim.send_goal("/follow_waypoints", {"poses": [pose(3.0, 3.0, 3.0), pose(1.0, 3.2, 3.0)]})
        run_until_done(sim, walk)
        assert walk.status.name == "SUCCEEDED" and not walk.result.missed_waypoints
        assert distance(sim, 1.0, 3.2) < 0.25
        sim.check_nodes()


def test_each_replaced_class_and_each_parameter_without_effect_is_told_once(folder: Path) -> None:
    with simkit.load(rooms()) as sim:
        add_server(sim, "nav2_amcl/amcl")
        add_navigation(sim, "amcl")
        sim.run(0.5)
        told = "\n".join(warnings(sim, "SK-NAV-001"))
        assert "voxel_layer" not in told
        assert "RegulatedPurePursuitController replaces teb_local_planner::TebLocalPlannerROS" in told
        assert "GridBased" not in told
        assert warnings(sim, "SK-NAV-002") == ["/amcl: no effect here: max_speed"]
        assert not [item for item in sim.diagnostics if item.code in ("SK-PARAM-003", "SK-SERVICE-004")]


def test_the_speed_of_a_replaced_controller_stays(folder: Path) -> None:
    with simkit.load(rooms()) as sim:
        add_navigation(sim)
        sim.run(0.5)
        controller = sim.plugins["controller_server::controller_server"].parts["FollowPath"]
        assert controller._options.desired_linear_vel == 0.4
        assert controller._options.rotate_to_heading_angular_vel == 1.2


def test_a_server_works_only_while_it_is_active(folder: Path) -> None:
    with simkit.load(rooms()) as sim:
        add_server(sim, "nav2_planner/planner_server")
        sim.run(0.1)
        assert sim.call("/planner_server/get_state").current_state.label == "unconfigured"
        for transition, state, is_there in ((1, "inactive", False), (3, "active", True), (4, "inactive", False)):
            assert sim.call("/planner_server/change_state", {"transition": {"id": transition}}).success
            assert sim.call("/planner_server/get_state").current_state.label == state
            assert ("planner_server" in sim.models) == is_there
            sim.run(0.1)


def test_the_map_is_published_with_the_activation_and_can_be_replaced(folder: Path) -> None:
    with simkit.load(rooms()) as sim:
        maps = sim.subscribe("/map", keep=2)
        node = sim.add_node("nav2_map_server/map_server", params={"yaml_filename": str(folder / "rooms.yaml")})
        sim.run(0.1)
        sim.call("/map_server/change_state", {"transition": {"id": 1}})
        sim.run(0.1)
        assert maps.latest is None
        sim.call("/map_server/change_state", {"transition": {"id": 3}})
        sim.run(0.1)
        assert maps.latest.info.width > 100 and maps.latest.header.frame_id == "map"
        assert sim.call("/map_server/load_map", {"map_url": "nowhere.yaml"}).result == 1
        assert "there is no file nowhere.yaml" in node.log[-1]


def test_the_manager_goes_on_without_a_node_that_does_not_exist(folder: Path) -> None:
    with simkit.load(rooms()) as sim:
        sim.add_node("nav2_route/route_server")
        params = {"autostart": True, "node_names": ["ghost", "route_server"]}
        sim.add_node("nav2_lifecycle_manager/lifecycle_manager", params=params)
        sim.run(6.0)
        assert warnings(sim, "SK-NAV-003") == [
            "/lifecycle_manager: no node 'ghost' after 5 s; the others are managed without it"
        ]
        assert "there are no routes on a graph" in warnings(sim, "SK-NAV-004")[0]
        assert sim.call("/route_server/get_state").current_state.label == "active"
        assert sim.call("/lifecycle_manager/is_active").success
        sim.call("/lifecycle_manager/manage_nodes", {"command": 1}, on_done=lambda _: None)  # PAUSE
        sim.run(0.2)
        assert sim.call("/route_server/get_state").current_state.label == "inactive"


SERVER = """
import sys

import rclpy
from rclpy.lifecycle import LifecycleNode

rclpy.init()
node = LifecycleNode("server")
while node.get_clock().now().nanoseconds < float(sys.argv[1]) * 1e9:
    rclpy.spin_once(node, timeout_sec=0.1)
"""


def test_the_manager_takes_all_nodes_down_when_one_ends_and_starts_them_when_it_is_back(folder: Path) -> None:
    file = folder / "server.py"
    file.write_text(SERVER)
    with simkit.load(rooms()) as sim:
        sim.add_node("nav2_waypoint_follower/waypoint_follower")
        sim.add_node(str(file), args=("1.0",))
        names = ["waypoint_follower", "server"]
        params = {"autostart": True, "node_names": names, "bond_timeout": 1.0}
        sim.add_node("nav2_lifecycle_manager/lifecycle_manager", params=params)

        def states() -> list[str]:
            return [sim.call(f"/{name}/get_state").current_state.label for name in names]

        sim.run(0.5)
        assert states() == ["active", "active"]
        sim.run(4.0)
        assert sim.call("/waypoint_follower/get_state").current_state.label == "unconfigured"
        sim.add_node(str(file), args=("99.0",))
        sim.run(2.0)
        assert states() == ["active", "active"]


def test_a_parameter_that_is_not_valid_ends_the_activation_with_the_reason(folder: Path) -> None:
    with simkit.load(rooms()) as sim:
        node = sim.add_node("nav2_amcl/amcl", params={"laser_model_type": "sonar"})
        sim.run(0.1)
        sim.call("/amcl/change_state", {"transition": {"id": 1}})
        assert not sim.call("/amcl/change_state", {"transition": {"id": 3}}).success
        assert any("sonar" in line and "likelihood_field" in line for line in node.log)
        assert sim.call("/amcl/get_state").current_state.label == "inactive"


def test_names_of_a_node_change_the_names_of_its_topics_and_model(folder: Path) -> None:
    with simkit.load(rooms()) as sim:
        remap = {"scan": "/front/scan"}
        sim.add_node("nav2_amcl/amcl", name="localiser", namespace="robot", remap=remap)
        sim.run(0.1)
        for transition in (1, 3):
            sim.call("/robot/localiser/change_state", {"transition": {"id": transition}})
        assert "robot_localiser" in sim.models
        assert "/robot/amcl_pose" in sim.topics()
        assert sim.plugins["robot_localiser::localiser"].ros.topic("scan") == "/front/scan"


def test_parameters_of_amcl_can_change_while_it_is_active(folder: Path) -> None:
    with simkit.load(rooms()) as sim:
        sim.add_node("nav2_amcl/amcl", params={"alpha1": 0.3})
        sim.run(0.1)
        for transition in (1, 3):
            sim.call("/amcl/change_state", {"transition": {"id": transition}})
        value = sim.call("/amcl/get_parameters", {"names": ["alpha1"]}).values[0].double_value
        assert value == 0.3


def drive(sim: Simulation, seconds: float, forward: float, turning: float) -> None:
    for _ in range(round(seconds / 0.1)):
        sim.publish("/cmd_vel", {"linear": {"x": forward}, "angular": {"z": turning}})
        sim.run(0.1)


EKF = """
ekf_filter_node:
  ros__parameters:
    frequency: 30.0
    two_d_mode: true
    base_link_frame: base_footprint
    publish_tf: false
    use_control: false
    odom0: odom
    odom0_config: [false, false, false, false, false, false, true, true, false,
                   false, false, true, false, false, false]
    process_noise_covariance: [0.05, 0.05, 0.06, 0.03, 0.03, 0.06, 0.025, 0.025, 0.04,
                               0.01, 0.01, 0.02, 0.01, 0.01, 0.015]
"""


def test_the_filter_reads_the_file_of_robot_localization_and_follows_the_robot(tmp_path: Path) -> None:
    (tmp_path / "ekf.yaml").write_text(EKF)
    with simkit.load(rooms()) as sim:
        words = ("--ros-args", "--params-file", str(tmp_path / "ekf.yaml"), "-r", "odometry/filtered:=odom/filtered")
        sim.add_node("robot_localization/ekf_node", args=words)
        filtered = sim.subscribe("/odom/filtered", keep=1)
        start = sim.model("robot").pose
        drive(sim, 4.0, 0.2, 0.4)
        true = start.inverse() @ sim.model("robot").pose
        place = filtered.latest.pose.pose.position
        assert math.hypot(*true.position[:2]) > 0.6
        assert math.hypot(place.x - true.position[0], place.y - true.position[1]) < 0.02
        assert warnings(sim, "SK-NAV-002") == ["/ekf_filter_node: no effect here: use_control"]


def test_the_velocity_smoother_limits_the_acceleration(folder: Path) -> None:
    with simkit.load(rooms()) as sim:
        add_server(sim, "nav2_velocity_smoother/velocity_smoother", remap={"cmd_vel": "cmd_vel_nav"})
        sim.add_node("nav2_collision_monitor/collision_monitor")
        params = {"autostart": True, "node_names": ["velocity_smoother", "collision_monitor"]}
        sim.add_node("nav2_lifecycle_manager/lifecycle_manager", params=params)
        sim.run(0.2)
        sent = sim.subscribe("/cmd_vel", keep=100)
        for _ in range(20):
            sim.publish("/cmd_vel_nav", {"linear": {"x": 0.9}})
            sim.run(0.05)
        speeds = [message.linear.x for message in sent.messages]
        assert speeds[0] == pytest.approx(0.05) and speeds[-1] == pytest.approx(0.4)
        assert max(b - a for a, b in itertools.pairwise(speeds)) <= 0.05 + 1e-9


def test_the_map_saver_writes_the_map_of_slam_while_the_robot_moves(folder: Path) -> None:
    with simkit.load(rooms()) as sim:
        params: dict[str, Any] = {
            "base_frame": "base_footprint",
            "minimum_travel_heading": 0.2,
            "map_update_interval": 0.5,
        }
        sim.add_node("slam_toolbox/async_slam_toolbox_node", params=params)
        sim.tf.open()
        sim.run(0.5)
        drive(sim, 6.0, 0.05, 0.6)
        known, true = (
            sim.tf.lookup("map", "base_footprint"),
            sim.model("robot").pose,
        )  # the odometry begins at the world
        assert math.hypot(*(known.position - true.position)[:2]) < 0.03
        assert abs(math.degrees(known.rpy[2] - true.rpy[2])) < 2.5  # the odometry is up to 0.05 s old
        saver = sim.add_node("nav2_map_server/map_saver_cli", args=("-f", "found"))
        sim.run(1.0)
        assert saver.exit_code == 0 and (folder / "found.yaml").is_file() and (folder / "found.pgm").is_file()
