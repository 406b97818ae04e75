"""Node of slam_toolbox, for the other launch files of the package."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("autostart", default_value="true", description="No effect here"),
            DeclareLaunchArgument("use_lifecycle_manager", default_value="false", description="No effect here"),
            DeclareLaunchArgument("use_sim_time", default_value="true", description="Time of the simulation"),
            DeclareLaunchArgument("params_file", default_value="", description="No effect here"),
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the node"),
            Node(
                package="slam_toolbox",
                executable=LaunchConfiguration("slam_executable"),
                name="slam_toolbox",
                namespace=LaunchConfiguration("namespace"),
                output="screen",
                parameters=[
                    LaunchConfiguration("slam_params_file"),
                    {"use_sim_time": LaunchConfiguration("use_sim_time")},
                ],
            ),
        ]
    )
