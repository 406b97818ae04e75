"""Worlds and files of parameters for the nodes of Nav2."""

from __future__ import annotations

import re
from pathlib import Path

import rooms as world_of_rooms

import simkit
from simkit import Simulation
from simkit_navigation.plugins.maps.map_saver import write_map

COSTMAP = """
      robot_base_frame: base_footprint
      resolution: 0.05
      robot_radius: 0.15
      publish_frequency: 2.0
      inflation_layer: {plugin: "nav2_costmap_2d::InflationLayer", inflation_radius: 0.4, cost_scaling_factor: 5.0}
"""
PARAMETERS = f"""
amcl:
  ros__parameters:
    base_frame_id: base_footprint
    laser_model_type: likelihood_field_prob
    max_beams: 30
    update_min_d: 0.1
    update_min_a: 0.1
    max_speed: 0.5
    set_initial_pose: true
    initial_pose: {{x: 1.0, y: 1.0, z: 0.0, yaw: 0.5}}
bt_navigator:
  ros__parameters: {{robot_base_frame: base_footprint}}
behavior_server:
  ros__parameters: {{robot_base_frame: base_footprint}}
planner_server:
  ros__parameters:
    planner_plugins: [GridBased]
    GridBased: {{plugin: "nav2_smac_planner/SmacPlanner2D", tolerance: 0.3}}
controller_server:
  ros__parameters:
    goal_checker_plugins: [checker]
    checker: {{plugin: "nav2_controller::SimpleGoalChecker", xy_goal_tolerance: 0.08, yaw_goal_tolerance: 0.1}}
    controller_plugins: [FollowPath]
    FollowPath: {{plugin: "teb_local_planner::TebLocalPlannerROS", max_vel_x: 0.4, max_vel_theta: 1.2}}
local_costmap:
  local_costmap:
    ros__parameters:{COSTMAP}
      global_frame: odom
      rolling_window: true
      width: 3
      height: 3
      plugins: [voxel_layer, inflation_layer]
      voxel_layer:
        plugin: "nav2_costmap_2d::VoxelLayer"
        observation_sources: scan camera
        scan: {{topic: /scan, data_type: LaserScan, clearing: true, max_obstacle_height: 2.0}}
        camera: {{topic: /points, data_type: PointCloud2, min_obstacle_height: 0.05, max_obstacle_height: 2.0}}
global_costmap:
  global_costmap:
    ros__parameters:{COSTMAP}
      plugins: [static_layer, inflation_layer]
      static_layer: {{plugin: "nav2_costmap_2d::StaticLayer"}}
velocity_smoother:
  ros__parameters: {{max_velocity: [0.4, 0.0, 1.5], min_velocity: [-0.4, 0.0, -1.5], max_accel: [1.0, 0.0, 3.0]}}
"""
SERVERS = ("planner_server", "controller_server", "behavior_server", "bt_navigator")


def rooms() -> str:
    """Return the world with three rooms and a robot, without plugins for navigation."""
    return re.sub(r'<plugin filename="libsimkit_.*?(</plugin>|/>)', "", world_of_rooms.rooms())


def write_files(folder: Path) -> None:
    """Write a file of parameters, and the map of the rooms."""
    (folder / "nav2.yaml").write_text(PARAMETERS)
    with simkit.load(world_of_rooms.rooms()) as sim:
        maps = sim.subscribe("/map", keep=1)
        write_map(maps.latest, folder / "rooms", "trinary", "pgm", (0.25, 0.65))


def add_server(sim: Simulation, executable: str, **options: object) -> object:
    """Add a node of Nav2 with the file of parameters."""
    words = ("--ros-args", "--params-file", "nav2.yaml")
    return sim.add_node(executable, args=words, **options)  # type: ignore[arg-type]


def add_navigation(sim: Simulation, *more: str) -> None:
    """Add the servers, and a lifecycle manager of them and of more nodes."""
    package = {"planner_server": "planner", "controller_server": "controller", "behavior_server": "behaviors"}
    for name in SERVERS:
        add_server(sim, f"nav2_{package.get(name, name)}/{name}")
    params = {"autostart": True, "node_names": [*more, *SERVERS]}
    sim.add_node("nav2_lifecycle_manager/lifecycle_manager", params=params)
