"""SLAM and the saver of its map."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def _nodes(context):
    def value(name):
        return LaunchConfiguration(name).perform(context)

    clock = {"use_sim_time": value("use_sim_time").lower() == "true"}
    manager = {"autostart": value("autostart").lower() == "true", "node_names": ["map_saver"]}
    slam = PathJoinSubstitution([FindPackageShare("slam_toolbox"), "launch", "online_sync_launch.py"])
    arguments = {"use_sim_time": value("use_sim_time"), "slam_params_file": value("params_file")}
    with open(value("params_file"), encoding="utf-8") as file:
        if "slam_toolbox:" not in file.read():
            del arguments["slam_params_file"]
    return [
        Node(
            package="nav2_map_server",
            executable="map_saver_server",
            name="map_saver",
            output="screen",
            parameters=[value("params_file"), clock],
        ),
        Node(
            package="nav2_lifecycle_manager",
            executable="lifecycle_manager",
            name="lifecycle_manager_slam",
            output="screen",
            parameters=[clock, manager],
        ),
        IncludeLaunchDescription(slam, launch_arguments=arguments.items()),
    ]


def generate_launch_description():
    """Return the launch description."""
    parameters = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "params", "nav2_params.yaml"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the nodes"),
            DeclareLaunchArgument("params_file", default_value=parameters, description="File of parameters"),
            DeclareLaunchArgument("use_sim_time", default_value="True", description="Time of the simulation"),
            DeclareLaunchArgument("autostart", default_value="True", description="Activate the nodes at the start"),
            DeclareLaunchArgument("use_respawn", default_value="False", description="No effect here"),
            DeclareLaunchArgument("log_level", default_value="info", description="No effect here"),
            OpaqueFunction(function=_nodes),
        ]
    )
