"""Server and window of Gazebo classic."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir


def _included(file, condition):
    source = PythonLaunchDescriptionSource([ThisLaunchFileDir(), "/", file])
    return IncludeLaunchDescription(source, condition=IfCondition(LaunchConfiguration(condition)))


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("gui", default_value="true", description="false: no window"),
            DeclareLaunchArgument("server", default_value="true", description="false: no server"),
            _included("gzserver.launch.py", "server"),
            _included("gzclient.launch.py", "gui"),
        ]
    )
