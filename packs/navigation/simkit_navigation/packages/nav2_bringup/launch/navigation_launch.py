"""Servers of Nav2 with their lifecycle manager."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare
from nav2_common.launch import RewrittenYaml

SERVERS = {
    "controller_server": ("nav2_controller", {"cmd_vel": "cmd_vel_nav"}),
    "smoother_server": ("nav2_smoother", {}),
    "planner_server": ("nav2_planner", {}),
    "behavior_server": ("nav2_behaviors", {"cmd_vel": "cmd_vel_nav"}),
    "bt_navigator": ("nav2_bt_navigator", {}),
    "waypoint_follower": ("nav2_waypoint_follower", {}),
    "velocity_smoother": ("nav2_velocity_smoother", {"cmd_vel": "cmd_vel_nav"}),
    "collision_monitor": ("nav2_collision_monitor", {}),
}
"""Package and remappings of each server."""
MANAGED = list(SERVERS)
TRANSFORMS = [("/tf", "tf"), ("/tf_static", "tf_static")]


def _nodes(context):
    def value(name):
        return LaunchConfiguration(name).perform(context)

    parameters = RewrittenYaml(
        source_file=value("params_file"),
        root_key=value("namespace"),
        param_rewrites={"autostart": value("autostart")},
        convert_types=True,
    )
    shared = {
        "output": "screen",
        "respawn": value("use_respawn").lower() == "true",
        "respawn_delay": 2.0,
        "arguments": ["--ros-args", "--log-level", value("log_level")],
    }
    clock = {"use_sim_time": value("use_sim_time").lower() == "true"}
    nodes = [
        Node(
            package=package,
            executable=name,
            name=name,
            parameters=[parameters, clock],
            remappings=[*TRANSFORMS, *remappings.items()],
            **shared,
        )
        for name, (package, remappings) in SERVERS.items()
    ]
    manager = Node(
        package="nav2_lifecycle_manager",
        executable="lifecycle_manager",
        name="lifecycle_manager_navigation",
        output="screen",
        parameters=[clock, {"autostart": value("autostart").lower() == "true", "node_names": MANAGED}],
    )
    return [*nodes, manager]


def generate_launch_description():
    """Return the launch description."""
    parameters = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "params", "nav2_params.yaml"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the nodes"),
            DeclareLaunchArgument("use_sim_time", default_value="false", description="Time of the simulation"),
            DeclareLaunchArgument("params_file", default_value=parameters, description="File of parameters"),
            DeclareLaunchArgument("autostart", default_value="true", description="Activate the servers at the start"),
            DeclareLaunchArgument("use_composition", default_value="False", description="No effect here"),
            DeclareLaunchArgument("container_name", default_value="nav2_container", description="No effect here"),
            DeclareLaunchArgument("use_respawn", default_value="False", description="Start ended servers again"),
            DeclareLaunchArgument("log_level", default_value="info", description="Level of the log"),
            OpaqueFunction(function=_nodes),
        ]
    )
