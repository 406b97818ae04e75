"""Server of Gazebo and a bridge."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

_SERVER = ("world_sdf_file", "world_sdf_string", "container_name", "create_own_container", "use_composition")
_BRIDGE = ("bridge_name", "config_file", "namespace", "use_respawn")


def _included(package, file, names):
    path = PathJoinSubstitution([FindPackageShare(package), "launch", file])
    return IncludeLaunchDescription(path, launch_arguments=[(name, LaunchConfiguration(name)) for name in names])


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
            DeclareLaunchArgument("bridge_log_level", default_value="info", description="No effect here"),
            DeclareLaunchArgument("world_sdf_file", default_value="", description="File of the world"),
            DeclareLaunchArgument("world_sdf_string", default_value="", description="Text of the world"),
            _included("ros_gz_sim", "gz_server.launch.py", _SERVER),
            _included("ros_gz_bridge", "ros_gz_bridge.launch.py", _BRIDGE),
        ]
    )
