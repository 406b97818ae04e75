"""Window of Gazebo classic."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess

_SWITCHES = ("version", "verbose", "help", "gdb", "valgrind", "gui_required")


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value="false", description="No effect here") for name in _SWITCHES),
            DeclareLaunchArgument("extra_gazebo_args", default_value="", description="No effect here"),
            ExecuteProcess(cmd=["gzclient"], output="screen"),
        ]
    )
