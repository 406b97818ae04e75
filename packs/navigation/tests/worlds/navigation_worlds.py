"""Worlds with the plugins of navigation, and messages for them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import simkit
from simkit import msgs

WALL = """<model name="wall"><static>true</static><pose>2 0 0.5 0 0 0</pose><link name="l"><collision name="c">
  <geometry><box><size>0.1 4 1</size></box></geometry></collision></link></model>"""
POST = """<model name="{0}"><static>true</static><pose>{1} 0.5 0 0 0</pose><link name="l"><collision name="c">
  <geometry><box><size>0.1 0.1 1</size></box></geometry></collision></link></model>"""
POSTS = POST.format("post_1", "-2.5 -3.5") + POST.format("post_2", "3.5 3.5")  # the map reaches from one to the other
SERVERS = """
<plugin filename="libsimkit_map_server.so" name="map_server"/>
<plugin filename="libsimkit_fake_localization.so" name="fake_localization"/>
<plugin filename="libsimkit_costmap_2d.so" name="global_costmap">
  <robot_radius>0.24</robot_radius><update_frequency>1</update_frequency>
  <inflation_layer><cost_scaling_factor>3</cost_scaling_factor></inflation_layer>{layer}</plugin>
<plugin filename="libsimkit_costmap_2d.so" name="local_costmap">
  <global_frame>odom</global_frame><rolling_window>true</rolling_window><width>3</width><height>3</height>
  <resolution>0.05</resolution><robot_radius>0.24</robot_radius><publish_frequency>5</publish_frequency>
  <plugins>obstacle_layer inflation_layer</plugins></plugin>
<plugin filename="libsimkit_planner_server.so" name="planner_server">{planner}</plugin>
<plugin filename="libsimkit_controller_server.so" name="controller_server">
  <robot_radius>0.24</robot_radius><general_goal_checker><xy_goal_tolerance>0.05</xy_goal_tolerance>
  <yaw_goal_tolerance>0.03</yaw_goal_tolerance></general_goal_checker>{controller}</plugin>
<plugin filename="libsimkit_behavior_server.so" name="behavior_server"/>
<plugin filename="libsimkit_bt_navigator.so" name="bt_navigator"><number_of_retries>2</number_of_retries>
  <wait_duration>1</wait_duration></plugin>
"""
DRIVE = "<FollowPath><desired_linear_vel>0.26</desired_linear_vel></FollowPath>"
ROBOT = "<include><name>turtlebot3</name><uri>model://turtlebot3</uri></include>"
PHYSICS = '<physics type="ode"><max_step_size>0.002</max_step_size></physics>'  # half of the steps, for speed
GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
  </collision></link></model><light name="sun" type="directional"><direction>0.3 0.2 -1</direction></light>"""


def world(folder: Path, layer: str = "", planner: str = "", controller: str = DRIVE, models: str = WALL) -> Path:
    """Write a world with a TurtleBot3, a wall and all servers."""
    file = folder / "navigation.sdf"
    servers = SERVERS.format(layer=layer, planner=planner, controller=controller)
    text = f'<sdf version="1.9"><world name="w">{PHYSICS}{GROUND}{POSTS}{models}{ROBOT}{servers}</world></sdf>'
    file.write_text(text, "utf-8")
    return file


def pose(x: float, y: float, yaw: float = 0.0, frame: str = "map") -> dict[str, Any]:
    """Return the fields of a stamped pose."""
    turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    return {"header": {"frame_id": frame}, "pose": {"position": {"x": x, "y": y}, "orientation": turn}}


def place(sim: simkit.Simulation, x: float = 0.0, y: float = 0.0, frame: str = "base_footprint") -> None:
    """Publish the pose of a frame in the map."""
    transform = {"translation": {"x": x, "y": y}, "rotation": {"w": 1.0}}
    stamped = {"header": msgs.header(sim.time_ns, "map"), "child_frame_id": frame, "transform": transform}
    sim.advertise("/tf", "tf2_msgs/msg/TFMessage").publish({"transforms": [stamped]})


def run_until_done(sim: simkit.Simulation, goal: Any, most: float = 60.0) -> None:
    """Run until a goal has ended."""
    end = sim.time + most
    while not goal.is_done and sim.time < end:
        sim.run(0.25)
