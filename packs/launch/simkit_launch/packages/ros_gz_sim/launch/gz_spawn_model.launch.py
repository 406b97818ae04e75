"""Model that is spawned into the world of Gazebo."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

_TEXTS = {"world": "world", "file": "file", "model_string": "string", "topic": "topic", "entity_name": "name"}
_NUMBERS = ("x", "y", "z", "R", "P", "Y")


def generate_launch_description():
    """Return the launch description."""
    parameters = {
        **{new: ParameterValue(LaunchConfiguration(old), value_type=str) for old, new in _TEXTS.items()},
        **{name: ParameterValue(LaunchConfiguration(name), value_type=float) for name in _NUMBERS},
        "allow_renaming": ParameterValue(LaunchConfiguration("allow_renaming"), value_type=bool),
    }
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="", description="Name of the world"),
            DeclareLaunchArgument("file", default_value="", description="File of the model"),
            DeclareLaunchArgument("model_string", default_value="", description="Text of the model"),
            DeclareLaunchArgument("topic", default_value="", description="Topic with the text of the model"),
            DeclareLaunchArgument("entity_name", default_value="", description="Name of the model in the world"),
            DeclareLaunchArgument("allow_renaming", default_value="False", description="Change a name that is used"),
            *(DeclareLaunchArgument(name, default_value="0.0", description="Pose, m or rad") for name in _NUMBERS),
            Node(package="ros_gz_sim", executable="create", output="screen", parameters=[parameters]),
        ]
    )
