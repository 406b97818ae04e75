"""Gazebo, under its old name, with the words of a command line: `ign_args:='-r world.sdf'`."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    """Return the launch description."""
    words = LaunchConfiguration("ign_args")
    return LaunchDescription(
        [
            DeclareLaunchArgument("ign_args", default_value="", description="Words of the command line of Gazebo"),
            DeclareLaunchArgument("gz_args", default_value="", description="New name of ign_args"),
            DeclareLaunchArgument("ign_version", default_value="", description="No effect here"),
            DeclareLaunchArgument("gz_version", default_value="", description="No effect here"),
            ExecuteProcess(
                cmd=["ign gazebo", words, LaunchConfiguration("gz_args")], name="gazebo", output="screen", shell=True
            ),
        ]
    )
