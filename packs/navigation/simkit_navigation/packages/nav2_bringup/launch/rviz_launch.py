"""RViz, in whose place the page of `--web` shows the robot."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the launch description."""
    view = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "rviz", "nav2_default_view.rviz"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("namespace", default_value="navigation", description="Namespace of the robot"),
            DeclareLaunchArgument("use_namespace", default_value="false", description="No effect here"),
            DeclareLaunchArgument("use_sim_time", default_value="true", description="No effect here"),
            DeclareLaunchArgument("rviz_config", default_value=view, description="File of the view"),
            Node(package="rviz2", executable="rviz2", arguments=["-d", LaunchConfiguration("rviz_config")]),
        ]
    )
