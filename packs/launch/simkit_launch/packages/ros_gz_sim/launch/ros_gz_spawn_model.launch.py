"""Model that is spawned into the world of Gazebo, and a bridge for its topics."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

_TEXTS = ("world", "file", "model_string", "topic", "entity_name")
_POSE = ("x", "y", "z", "R", "P", "Y")
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
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the bridge"),
            DeclareLaunchArgument("use_composition", default_value="False", description="No effect here"),
            DeclareLaunchArgument("use_respawn", default_value="False", description="Start the bridge again"),
            DeclareLaunchArgument("log_level", default_value="info", description="No effect here"),
            *(DeclareLaunchArgument(name, default_value="", description="Of the model") for name in _TEXTS),
            DeclareLaunchArgument("allow_renaming", default_value="False", description="Change a name that is used"),
            *(DeclareLaunchArgument(name, default_value="0.0", description="Pose, m or rad") for name in _POSE),
            _included("ros_gz_bridge", "ros_gz_bridge.launch.py", _BRIDGE),
            _included("ros_gz_sim", "gz_spawn_model.launch.py", (*_TEXTS, "allow_renaming", *_POSE)),
        ]
    )
