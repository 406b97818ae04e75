"""Gazebo with the words of a command line: `gz_args:='-r world.sdf'`."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction, Shutdown
from launch.substitutions import LaunchConfiguration


def _gazebo(context):
    values = {name: LaunchConfiguration(name).perform(context) for name in ("gz_args", "ign_args", "on_exit_shutdown")}
    on_exit = None if values["on_exit_shutdown"].lower() in ("", "false", "0") else Shutdown()
    words = values["gz_args"] or values["ign_args"]
    return [ExecuteProcess(cmd=["gz sim", words], name="gazebo", output="screen", shell=True, on_exit=on_exit)]


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("gz_args", default_value="", description="Words of the command line of Gazebo"),
            DeclareLaunchArgument("gz_version", default_value="", description="No effect here"),
            DeclareLaunchArgument("ign_args", default_value="", description="Old name of gz_args"),
            DeclareLaunchArgument("ign_version", default_value="", description="No effect here"),
            DeclareLaunchArgument("debugger", default_value="false", description="No effect here"),
            DeclareLaunchArgument("on_exit_shutdown", default_value="false", description="End all with Gazebo"),
            OpaqueFunction(function=_gazebo),
        ]
    )
