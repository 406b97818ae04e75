"""Frames of the robot of the environment variable TURTLEBOT3_MODEL."""

import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from simkit.loaders.resources.bundled_models import find_bundled_model


def generate_launch_description():
    """Return the launch description."""
    robot = os.environ.get("TURTLEBOT3_MODEL") or "waffle"
    file = find_bundled_model(f"turtlebot3_{robot}.urdf")
    description = file.read_text(encoding="utf-8") if file else ""
    parameters = [{"use_sim_time": LaunchConfiguration("use_sim_time"), "robot_description": description}]
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="true", description="No effect here"),
            DeclareLaunchArgument("frame_prefix", default_value="", description="Begin of the names of all frames"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                output="screen",
                parameters=[*parameters, {"frame_prefix": LaunchConfiguration("frame_prefix")}],
            ),
        ]
    )
