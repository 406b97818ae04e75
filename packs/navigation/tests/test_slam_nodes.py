"""Nodes of slam_toolbox without ROS: topics, services, stored pose graphs, localisation, and parameters."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nav2_files import rooms

import simkit
from simkit import Simulation

ASYNC = "slam_toolbox/async_slam_toolbox_node"
QUICK: dict[str, Any] = {"minimum_travel_heading": 0.3, "minimum_travel_distance": 0.2, "minimum_time_interval": 0.2}


def warnings(sim: Simulation, code: str) -> list[str]:
    return [item.message for item in sim.diagnostics if item.code == code]


def drive(sim: Simulation, seconds: float, forward: float, turning: float) -> None:
    for _ in range(round(seconds / 0.1)):
        sim.publish("/cmd_vel", {"linear": {"x": forward}, "angular": {"z": turning}})
        sim.run(0.1)


def error(sim: Simulation) -> tuple[float, float]:
    """Return the error of the robot in the map [m], [rad]; odometry and map have the origin of the world here."""
    found = sim.tf.lookup("map", "odom") @ sim.tf.lookup("odom", "base_footprint")
    away = sim.model("robot").pose.inverse() @ found
    return math.hypot(*away.position[:2]), abs(float(away.rpy[2]))


def test_a_map_is_made_stored_and_used_to_localise(tmp_path: Path) -> None:
    name = str(tmp_path / "rooms")
    with simkit.load(rooms()) as sim:
        sim.add_node(ASYNC, params=QUICK | {"map_update_interval": 1.0})
        sim.tf.open()
        poses, graphs = sim.subscribe("/pose", keep=100), sim.subscribe("/slam_toolbox/graph_visualization", keep=1)
        sim.run(0.5)
        drive(sim, 4.0, 0.2, 0.6)
        assert error(sim)[0] < 0.03
        assert len(poses.messages) > 5 and poses.latest.header.frame_id == "map"
        assert 0.0 < poses.latest.pose.covariance[0] < 0.05
        kinds = [marker.ns for marker in graphs.latest.markers]
        assert kinds.count("slam_toolbox") >= 5 and "slam_toolbox_edges" in kinds
        assert sim.call("/slam_toolbox/save_map", {"name": {"data": name}}).result == 0
        assert (tmp_path / "rooms.yaml").is_file() and (tmp_path / "rooms.pgm").is_file()
        assert sim.call("/slam_toolbox/serialize_map", {"filename": name}).result == 0
        found = sim.call("/slam_toolbox/dynamic_map").map
    params = {"map_file_name": name, "map_start_pose": [1.4, 0.7, 0.7], "minimum_travel_heading": 0.3}
    with simkit.load(rooms()) as sim:  # the robot is at the start of the map, and not where the parameter says
        sim.add_node("slam_toolbox/localization_slam_toolbox_node", params=params)
        sim.tf.open()
        sim.run(0.5)
        away, turned = error(sim)
        assert away < 0.03 and turned < math.radians(1.0)
        drive(sim, 1.5, 0.2, 0.5)
        assert error(sim)[0] < 0.03
        assert np.array_equal(sim.call("/slam_toolbox/dynamic_map").map.data, found.data)
        assert sim.call("/slam_toolbox/serialize_map", {"filename": name}).result == 255
        assert not warnings(sim, "SK-NAV-002") and not warnings(sim, "SK-SLAM-002")


def test_services_pause_reset_and_continue_a_map(tmp_path: Path) -> None:
    name = str(tmp_path / "rooms")
    with simkit.load(rooms()) as sim:
        sim.add_node(ASYNC, params=QUICK | {"enable_interactive_mode": True})
        poses = sim.subscribe("/pose", keep=100)
        sim.run(0.1)
        assert sim.call("/slam_toolbox/save_map", {"name": {"data": name}}).result == 1  # no map yet
        drive(sim, 1.5, 0.2, 0.5)
        assert sim.call("/slam_toolbox/serialize_map", {"filename": name}).result == 0
        assert sim.call("/slam_toolbox/pause_new_measurements").status
        used = len(poses.messages)
        drive(sim, 1.5, 0.2, 0.5)
        assert len(poses.messages) == used
        assert sim.call("/slam_toolbox/reset", {"pause_new_measurements": False}).result == 0
        assert len(sim.call("/slam_toolbox/dynamic_map").map.data) == 0
        sim.run(0.5)
        assert len(poses.messages) == used + 1
        at = {"x": 1.0, "y": 1.0, "theta": 0.5}
        sim.call("/slam_toolbox/deserialize_map", {"filename": name, "match_type": 2, "initial_pose": at})
        assert len(sim.call("/slam_toolbox/dynamic_map").map.data) > 1000
        for service in ("clear_changes", "toggle_interactive_mode", "manual_loop_closure"):
            sim.call(f"/slam_toolbox/{service}")
        sim.check_nodes()


def test_a_node_that_a_user_moves_is_moved_back_by_the_edges() -> None:
    with simkit.load(rooms()) as sim:
        sim.add_node(ASYNC, params=QUICK | {"enable_interactive_mode": True, "map_update_interval": 0.5})
        markers = sim.subscribe("/slam_toolbox/update", keep=1)
        drive(sim, 2.0, 0.2, 0.5)
        before = markers.latest.markers
        moved = {"marker_name": "1", "event_type": 5, "pose": {"position": {"x": 5.0}}, "mouse_point_valid": True}
        sim.advertise("/slam_toolbox/feedback", "visualization_msgs/msg/InteractiveMarkerFeedback").publish(moved)
        sim.run(0.7)
        assert markers.latest.markers[1].pose.position.x == 5.0
        sim.call("/slam_toolbox/manual_loop_closure")
        sim.run(0.7)
        after = markers.latest.markers
        assert len(before) >= 3
        assert math.isclose(after[1].pose.position.x, before[1].pose.position.x, abs_tol=1e-3)


def test_invalid_and_unknown_parameters_and_a_missing_graph_are_told() -> None:
    params = {
        "resolution": -1.0,
        "map_start_pose": [1.0],
        "throttle_scan": 3,
        "coarse_angle_resolution": 1e-5,
        "coarse_search_angle_offset": 6,
        "map_file_name": "/no/map",
    }
    with simkit.load(rooms()) as sim:
        sim.add_node(ASYNC, params=params | {"solver_plugin": "solver_plugins::CeresSolver"})
        sim.run(0.5)
        assert warnings(sim, "SK-NAV-002") == ["/slam_toolbox: no effect here: throttle_scan"]
        told = warnings(sim, "SK-SLAM-001")
        assert "/slam_toolbox: resolution is -1.0; expected a number above 0; the default 0.05 is used" in told
        assert any("map_start_pose" in text for text in told) and len(told) == 3
        assert any("coarse_search_angle_offset is 6.0; expected at most 1000 times" in text for text in told)
        assert any("cannot read /no/map.posegraph" in text for text in warnings(sim, "SK-SLAM-002"))
        assert sim.call("/slam_toolbox/dynamic_map").map.info.resolution == pytest.approx(0.05)


@pytest.mark.parametrize(
    ("executable", "at"),
    [("gmapping/slam_gmapping", 1.0), ("cartographer_ros/cartographer_node", 0.0)],
)
def test_other_mappers_are_replaced_and_begin_where_they_do(executable: str, at: float) -> None:
    with simkit.load(rooms()) as sim:
        sim.add_node(executable, params={"base_frame": "base_footprint", "odom_frame": "odom"})
        maps = sim.subscribe("/map", keep=1)
        sim.tf.open()
        sim.run(0.5)
        assert sim.tf.lookup("map", "base_footprint").position[0] == pytest.approx(at, abs=1e-3)
        assert len(maps.latest.data) > 1000
        assert "replaces" in warnings(sim, "SK-NAV-001")[0]


def test_scans_whose_transforms_are_missing_are_told_once() -> None:
    with simkit.load(rooms()) as sim:
        sim.add_node(ASYNC, params={"base_frame": "base_link"})
        sim.run(2.5)
        (told,) = warnings(sim, "SK-SLAM-003")
        assert "no scan of the frame 'base_scan' is used" in told and "base_link" in told
