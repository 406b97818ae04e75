"""Robot of the environment variable TURTLEBOT3_MODEL, spawned into the world of Gazebo."""

import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from simkit.loaders.resources.bundled_models import find_bundled_model


def generate_launch_description():
    """Return the launch description."""
    robot = os.environ.get("TURTLEBOT3_MODEL") or "waffle"
    file = find_bundled_model(f"turtlebot3_{robot}")
    pose = ["-x", LaunchConfiguration("x_pose"), "-y", LaunchConfiguration("y_pose"), "-z", "0.01"]
    return LaunchDescription(
        [
            DeclareLaunchArgument("x_pose", default_value="0.0", description="x of the robot, m"),
            DeclareLaunchArgument("y_pose", default_value="0.0", description="y of the robot, m"),
            Node(package="ros_gz_sim", executable="create", arguments=["-name", robot, "-file", str(file), *pose]),
        ]
    )
