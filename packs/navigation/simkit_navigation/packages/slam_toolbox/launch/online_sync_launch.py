"""SLAM: each scan is used."""

from pathlib import Path

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the launch description."""
    parameters = PathJoinSubstitution([FindPackageShare("slam_toolbox"), "config", "mapper_params_online_sync.yaml"])
    node = str(Path(__file__).with_name("slam_node.launch.py"))
    return LaunchDescription(
        [
            DeclareLaunchArgument("slam_params_file", default_value=parameters, description="File of parameters"),
            IncludeLaunchDescription(node, launch_arguments=[("slam_executable", "sync_slam_toolbox_node")]),
        ]
    )
