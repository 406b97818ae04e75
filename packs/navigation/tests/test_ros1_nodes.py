"""Navigation nodes of ROS 1: move_base, amcl and map_server as programs of ROS 1 use them."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from nav2_files import rooms, write_files

import simkit
from simkit_navigation.move_base_parameters import amcl_plugins, move_base_plugins, pose_ekf_plugins

CLIENT = """
import rospy, actionlib
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.srv import GetMap

rospy.init_node("client")
rospy.wait_for_service("static_map")
rospy.loginfo("width %d", rospy.ServiceProxy("static_map", GetMap)().map.info.width)
client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
client.wait_for_server()
rospy.sleep(2.0)
goal = MoveBaseGoal()
goal.target_pose.header.frame_id = "map"
goal.target_pose.pose.position.x, goal.target_pose.pose.position.y = 2.6, 1.6
goal.target_pose.pose.orientation.w = 1.0
client.send_goal(goal)
client.wait_for_result()
rospy.loginfo("state %d: %s", client.get_state(), client.get_goal_status_text())
"""
COSTMAP = {
    "robot_base_frame": "base_footprint",
    "robot_radius": 0.15,
    "inflation_radius": 0.4,
    "obstacle_range": 2.5,
    "raytrace_range": 3.0,
    "observation_sources": "scan",
    "scan": {"data_type": "LaserScan", "topic": "scan", "marking": True, "clearing": True},
}
MOVE_BASE = {
    "base_local_planner": "dwa_local_planner/DWAPlannerROS",
    "DWAPlannerROS": {"max_vel_trans": 0.4, "max_rot_vel": 1.2, "xy_goal_tolerance": 0.1},
    "global_costmap": {**COSTMAP, "global_frame": "/map", "static_map": True, "update_frequency": 1.0},
    "local_costmap": {**COSTMAP, "global_frame": "odom", "rolling_window": True, "width": 3.0, "height": 3.0},
}


@pytest.mark.slow  # a drive
def test_move_base_drives_a_robot_to_the_goal_of_a_client(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_files(tmp_path)
    (tmp_path / "client.py").write_text(CLIENT)
    with simkit.load(rooms(), seed=2) as sim:
        sim.add_node("map_server/map_server", args=("rooms.yaml",))
        pose = {"initial_pose_x": 1.0, "initial_pose_y": 1.0, "initial_pose_a": 0.5}
        sim.add_node("amcl/amcl", params={**pose, "base_frame_id": "base_footprint", "update_min_d": 0.1})
        sim.add_node("move_base/move_base", params=MOVE_BASE)
        client = sim.add_node("client.py")
        for _ in range(60):
            sim.run(0.5)
            if client.done:
                break
        assert "width" in client.log[0] and client.log[-1].endswith("state 3: Goal reached.")
        found = sim.model("robot").pose.position
        assert math.hypot(found[0] - 2.6, found[1] - 1.6) < 0.25
        assert "/move_base/global_costmap/costmap" in sim.topics()
        sim.check_nodes()


def test_a_costmap_without_a_list_of_layers_has_those_of_its_parameters() -> None:
    plugins = [plugin.parameters for plugin in move_base_plugins(dict(MOVE_BASE))]
    global_costmap, _, local_costmap, *_ = plugins
    assert global_costmap.values["plugins"] == ["static_layer", "obstacle_layer", "inflation_layer"]
    assert global_costmap.values["global_frame"] == "map"
    assert local_costmap.values["plugins"] == ["obstacle_layer", "inflation_layer"]
    layer = local_costmap.values["obstacle_layer"]
    assert isinstance(layer, dict) and layer["scan"]["obstacle_max_range"] == 2.5
    assert local_costmap.values["inflation_layer"]["inflation_radius"] == 0.4  # type: ignore[index]


def test_speeds_and_tolerances_of_the_local_planner_are_those_of_the_controller() -> None:
    controller = move_base_plugins(dict(MOVE_BASE))[3].parameters.values
    assert controller["FollowPath"]["desired_linear_vel"] == 0.4  # type: ignore[index]
    assert controller["general_goal_checker"]["xy_goal_tolerance"] == 0.1  # type: ignore[index]


def test_amcl_has_the_names_of_ros_1() -> None:
    values = {"odom_model_type": "diff-corrected", "odom_alpha1": 0.1, "laser_max_beams": 30, "initial_pose_a": 1.0}
    found = amcl_plugins(dict(values))[0].parameters.values
    assert found["robot_model_type"] == "nav2_amcl::DifferentialMotionModel"
    assert (found["alpha1"], found["max_beams"], found["initial_pose"]) == (0.1, 30, {"yaw": 1.0})
    assert found["set_initial_pose"] is True


def test_robot_pose_ekf_reads_odometry_and_imu() -> None:
    (plugin,) = pose_ekf_plugins({"freq": 20.0, "imu_used": False})
    values = plugin.parameters.values
    assert values["odom0"] == "odom" and "imu0" not in values and values["frequency"] == 20.0


def test_move_base_searches_as_its_planner() -> None:
    planner = {"allow_unknown": False, "use_dijkstra": False, "default_tolerance": 0.2}
    values = {**MOVE_BASE, "base_global_planner": "global_planner/GlobalPlanner", "GlobalPlanner": planner}
    settings = move_base_plugins(values)[1].parameters.values["GridBased"]
    expected = {"use_astar": True, "allow_unknown": False, "tolerance": 0.2}
    assert settings == {"plugin": "nav2_navfn_planner::NavfnPlanner", **expected}
    settings = move_base_plugins(dict(MOVE_BASE))[1].parameters.values["GridBased"]
    assert "use_astar" not in settings  # type: ignore[operator]
