"""Launch files that start Nav2, SLAM and the navigation of ROS 1: the robot reaches a goal by `simkit launch` alone."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from nav2_files import rooms, write_files
from navigation_worlds import pose, run_until_done

import simkit
from simkit import Simulation
from simkit.testing import open_scenario

HEAD = """
from launch import LaunchDescription
from launch.actions import ExecuteProcess, IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import ComposableNodeContainer, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.substitutions import FindPackageShare


def included(package, file, **arguments):
    path = PathJoinSubstitution([FindPackageShare(package), "launch", file])
    return IncludeLaunchDescription(path, launch_arguments=arguments.items())


def generate_launch_description():
    return LaunchDescription([
"""
ROOMS = '        ExecuteProcess(cmd=["gz", "sim", "-r", "rooms.sdf"]),\n'

Launch = Callable[..., Simulation]


@pytest.fixture
def launched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Launch:
    """Function that writes a launch file beside a world, a map and parameters, and returns its simulation."""
    monkeypatch.chdir(tmp_path)
    write_files(tmp_path)
    (tmp_path / "rooms.sdf").write_text(rooms())

    def launch(body: str, name: str = "robot.launch.py", **arguments: str) -> Simulation:
        text = f"{HEAD}{body}    ])\n" if name.endswith(".py") else body
        (tmp_path / name).write_text(text)
        return open_scenario(simkit.launch(tmp_path / name, arguments))

    return launch


def distance(sim: Simulation, robot: str, x: float, y: float) -> float:
    found = sim.model(robot).pose.position
    return math.hypot(found[0] - x, found[1] - y)


def place(sim: Simulation, x: float, y: float, yaw: float) -> None:
    """Tell AMCL where the robot is."""
    turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    covariance = [0.05] + [0.0] * 6 + [0.05] + [0.0] * 27 + [0.05]
    known = {"pose": {"position": {"x": x, "y": y}, "orientation": turn}, "covariance": covariance}
    sim.publish("/initialpose", {"header": {"frame_id": "map"}, "pose": known})


def active_nodes(sim: Simulation, *names: str) -> list[str]:
    """Return those of some nodes that are active."""
    states = {name: sim.call(f"{name}/get_state").current_state.label for name in names}
    return [name for name, label in states.items() if label == "active"]


@pytest.mark.slow  # a drive
def test_a_turtlebot_reaches_a_goal_with_the_launch_files_of_nav2(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The map is the one that `simkit map` writes."""
    from typer.testing import CliRunner

    from simkit.cli import app

    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TURTLEBOT3_MODEL", "waffle")
    assert CliRunner().invoke(app, ["map", "turtlebot3_world", "-o", "arena"]).exit_code == 0
    (tmp_path / "nav.launch.py").write_text(
        f"""{HEAD}
        included("turtlebot3_gazebo", "turtlebot3_world.launch.py"),
        included("nav2_bringup", "bringup_launch.py", map="{tmp_path / "arena.yaml"}", use_sim_time="true"),
        included("nav2_bringup", "rviz_launch.py"),
    ])
"""
    )
    with open_scenario(simkit.launch(tmp_path / "nav.launch.py")) as sim:
        sim.run(1.0)
        start = sim.model("waffle" if "waffle" in sim.models else "turtlebot3").pose
        robot = "waffle" if "waffle" in sim.models else "turtlebot3"
        place(sim, float(start.position[0]), float(start.position[1]), float(start.rpy[2]))
        sim.run(2.0)
        task = sim.send_goal("/navigate_to_pose", {"pose": pose(-1.6, 0.6, 0.0)})
        run_until_done(sim, task)
        assert task.status.name == "SUCCEEDED", task.reason
        assert distance(sim, robot, -1.6, 0.6) < 0.35  # 0.25 m of the goal checker, and the error of AMCL
        sim.check_nodes()


@pytest.mark.slow
def test_all_nodes_of_the_bringup_are_active_at_once(launched: Launch, tmp_path: Path) -> None:
    body = ROOMS + f'        included("nav2_bringup", "bringup_launch.py", map="{tmp_path / "rooms.yaml"}"),\n'
    with launched(body) as sim:
        sim.run(0.5)
        names = ("/map_server", "/amcl", "/controller_server", "/planner_server", "/bt_navigator", "/waypoint_follower")
        assert active_nodes(sim, *names) == [*names]
        assert {"/map", "/cmd_vel_nav", "/cmd_vel_smoothed", "/global_costmap/costmap"} <= set(sim.topics())
        sim.check_nodes()


@pytest.mark.slow
def test_a_namespace_is_that_of_all_nodes(launched: Launch, tmp_path: Path) -> None:
    arguments = f'map="{tmp_path / "rooms.yaml"}", namespace="robot1", use_namespace="True"'
    with launched(ROOMS + f'        included("nav2_bringup", "bringup_launch.py", {arguments}),\n') as sim:
        sim.run(0.5)
        names = ("/robot1/map_server", "/robot1/amcl", "/robot1/controller_server")
        assert active_nodes(sim, *names) == [*names]
        assert {"/robot1/map", "/robot1/local_costmap/costmap"} <= set(sim.topics())
        controller = sim.plugins["robot1_controller_server::controller_server"].parts["FollowPath"]
        assert controller._options.desired_linear_vel == 0.26  # of the file, below the namespace


@pytest.mark.slow
def test_slam_in_place_of_a_map(launched: Launch) -> None:
    with launched(ROOMS + '        included("nav2_bringup", "bringup_launch.py", slam="True"),\n') as sim:
        maps = sim.subscribe("/map", keep=1)
        sim.tf.open()
        sim.run(1.0)
        assert maps.latest.info.resolution == pytest.approx(0.05) and "amcl" not in sim.models
        known, true = (
            sim.tf.lookup("map", "base_footprint"),
            sim.model("robot").pose,
        )  # odometry and map begin at the world
        assert math.hypot(*(known.position - true.position)[:2]) < 0.02
        assert active_nodes(sim, "/map_saver", "/bt_navigator") == ["/map_saver", "/bt_navigator"]


def test_components_in_a_container_are_the_same_nodes(launched: Launch) -> None:
    body = (
        ROOMS
        + """
        ComposableNodeContainer(
            name="nav2_container", namespace="", package="rclcpp_components", executable="component_container_isolated",
            composable_node_descriptions=[
                ComposableNode(package="nav2_map_server", plugin="nav2_map_server::MapServer", name="map_server",
                               parameters=[{"yaml_filename": "rooms.yaml"}]),
                ComposableNode(package="nav2_amcl", plugin="nav2_amcl::AmclNode", name="amcl",
                               parameters=["nav2.yaml"]),
                ComposableNode(package="nav2_lifecycle_manager", plugin="nav2_lifecycle_manager::LifecycleManager",
                               name="manager", parameters=[{"autostart": True, "node_names": ["map_server", "amcl"]}]),
            ]),
"""
    )
    with launched(body) as sim:
        poses = sim.subscribe("/amcl_pose", keep=1)
        sim.run(1.0)
        assert active_nodes(sim, "/map_server", "/amcl") == ["/map_server", "/amcl"]
        assert poses.latest.pose.pose.position.x == pytest.approx(1.0, abs=0.1)


ROS1 = """<launch>
  <arg name="map_file" default="rooms.yaml"/>
  <node pkg="gazebo_ros" type="gzserver" name="gazebo" args="rooms.sdf"/>
  <node pkg="map_server" type="map_server" name="map_server" args="$(arg map_file)"/>
  <node pkg="amcl" type="amcl" name="amcl">
    <param name="initial_pose_x" value="1.0"/>
    <param name="initial_pose_y" value="1.0"/>
    <param name="initial_pose_a" value="0.5"/>
    <param name="base_frame_id" value="base_footprint"/>
  </node>
  <node pkg="move_base" type="move_base" name="move_base" output="screen">
    <rosparam file="$(dirname)/costmap.yaml" command="load" ns="global_costmap"/>
    <rosparam file="$(dirname)/costmap.yaml" command="load" ns="local_costmap"/>
    <param name="global_costmap/static_map" value="true"/>
    <param name="local_costmap/global_frame" value="odom"/>
    <param name="local_costmap/rolling_window" value="true"/>
    <param name="base_local_planner" value="dwa_local_planner/DWAPlannerROS"/>
    <param name="DWAPlannerROS/max_vel_x" value="0.3"/>
  </node>
</launch>"""
COSTMAP = """robot_base_frame: base_footprint
robot_radius: 0.15
inflation_radius: 0.4
observation_sources: scan
scan: {data_type: LaserScan, topic: scan, marking: true, clearing: true}
"""


def test_a_launch_file_of_ros_1_starts_move_base_with_its_parameters(launched: Launch, tmp_path: Path) -> None:
    (tmp_path / "costmap.yaml").write_text(COSTMAP)
    with launched(ROS1, "robot.launch") as sim:
        poses = sim.subscribe("/amcl_pose", keep=1)
        sim.run(1.0)
        assert poses.latest.pose.pose.position.x == pytest.approx(1.0, abs=0.1)
        server = sim.plugins["move_base::controller_server"].parts["FollowPath"]
        assert server._options.desired_linear_vel == 0.3
        assert {"/move_base/goal", "/move_base/global_costmap/costmap"} <= set(sim.topics())
        sim.check_nodes()


@pytest.mark.slow
def test_the_launch_files_of_turtlebot3_start_slam_and_nav2(launched: Launch, tmp_path: Path) -> None:
    with launched(ROOMS + '        included("turtlebot3_cartographer", "cartographer.launch.py"),\n') as sim:
        maps = sim.subscribe("/map", keep=1)
        sim.run(1.0)
        assert maps.latest.info.width > 40
    body = f'included("turtlebot3_navigation2", "navigation2.launch.py", map="{tmp_path / "rooms.yaml"}"),\n'
    with launched(f"{ROOMS}        {body}") as sim:
        sim.run(0.5)
        assert active_nodes(sim, "/amcl", "/bt_navigator") == ["/amcl", "/bt_navigator"]
