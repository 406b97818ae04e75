"""SLAM for a TurtleBot3."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return the launch description."""
    clock = {"use_sim_time": LaunchConfiguration("use_sim_time")}
    resolution = {"resolution": LaunchConfiguration("resolution")}
    period = {"map_update_interval": LaunchConfiguration("publish_period_sec")}
    is_shown = IfCondition(LaunchConfiguration("use_rviz"))
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="false", description="Time of the simulation"),
            DeclareLaunchArgument("use_rviz", default_value="true", description="Start RViz"),
            DeclareLaunchArgument("resolution", default_value="0.05", description="Side of a cell of the map, m"),
            DeclareLaunchArgument("publish_period_sec", default_value="1.0", description="Time between two maps, s"),
            DeclareLaunchArgument("cartographer_config_dir", default_value="", description="No effect here"),
            DeclareLaunchArgument("configuration_basename", default_value="", description="No effect here"),
            Node(
                package="cartographer_ros",
                executable="cartographer_node",
                name="cartographer_node",
                output="screen",
                parameters=[clock, resolution, period],
            ),
            Node(package="rviz2", executable="rviz2", name="rviz2", condition=is_shown),
        ]
    )
