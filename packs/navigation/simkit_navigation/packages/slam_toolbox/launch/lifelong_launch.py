"""SLAM: a map is extended."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the launch description."""
    parameters = PathJoinSubstitution([FindPackageShare("slam_toolbox"), "config", "mapper_params_lifelong.yaml"])
    node = str(Path(__file__).with_name("slam_node.launch.py"))
    return LaunchDescription(
        [
            DeclareLaunchArgument("slam_params_file", default_value=parameters, description="File of parameters"),
            IncludeLaunchDescription(node, launch_arguments=[("slam_executable", "lifelong_slam_toolbox_node")]),
        ]
    )
