"""Bridge with the topics of a file."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("bridge_name", description="Name of the bridge"),
            DeclareLaunchArgument("config_file", description="File with the topics of the bridge"),
            DeclareLaunchArgument("container_name", default_value="ros_gz_container", description="No effect here"),
            DeclareLaunchArgument("create_own_container", default_value="False", description="No effect here"),
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the bridge"),
            DeclareLaunchArgument("use_composition", default_value="False", description="No effect here"),
            DeclareLaunchArgument("use_respawn", default_value="False", description="Start the bridge again"),
            DeclareLaunchArgument("log_level", default_value="info", description="No effect here"),
            DeclareLaunchArgument("bridge_params", default_value="", description="No effect here"),
            Node(
                package="ros_gz_bridge",
                executable="parameter_bridge",
                name=LaunchConfiguration("bridge_name"),
                namespace=LaunchConfiguration("namespace"),
                output="screen",
                respawn=LaunchConfiguration("use_respawn"),
                respawn_delay=2.0,
                parameters=[{"config_file": LaunchConfiguration("config_file")}],
            ),
        ]
    )
