"""Server of Gazebo with a world from a file or a text."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return the launch description."""
    world = {name: LaunchConfiguration(name) for name in ("world_sdf_file", "world_sdf_string")}
    return LaunchDescription(
        [
            DeclareLaunchArgument("world_sdf_file", default_value="", description="File of the world"),
            DeclareLaunchArgument("world_sdf_string", default_value="", description="Text of the world"),
            DeclareLaunchArgument("container_name", default_value="ros_gz_container", description="No effect here"),
            DeclareLaunchArgument("create_own_container", default_value="False", description="No effect here"),
            DeclareLaunchArgument("use_composition", default_value="False", description="No effect here"),
            Node(package="ros_gz_sim", executable="gzserver", output="screen", parameters=[world]),
        ]
    )
