"""Multiplexer of velocity commands with its files of topics, locks and joystick."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def _nodes(context):
    def value(name):
        return LaunchConfiguration(name).perform(context)

    files = [value(name) for name in ("config_locks", "config_topics", "config_joy") if value(name)]
    clock = {"use_sim_time": value("use_sim_time").lower() == "true"}
    stamped = {"use_stamped": value("use_stamped").lower() == "true"} if value("use_stamped") else {}
    output = [("cmd_vel_out", value("cmd_vel_out"))]
    return [
        Node(
            package="twist_mux",
            executable="twist_mux",
            output="screen",
            remappings=output,
            parameters=[*files, clock, stamped],
        )
    ]


def generate_launch_description():
    """Return the launch description."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("config_locks", default_value="", description="File of the locks"),
            DeclareLaunchArgument("config_topics", default_value="", description="File of the sources of commands"),
            DeclareLaunchArgument("config_joy", default_value="", description="File of the joystick"),
            DeclareLaunchArgument("cmd_vel_out", default_value="twist_mux/cmd_vel", description="Topic of the result"),
            DeclareLaunchArgument("use_sim_time", default_value="False", description="Time of the simulation"),
            DeclareLaunchArgument("use_stamped", default_value="", description="Commands have a stamp"),
            OpaqueFunction(function=_nodes),
        ]
    )
