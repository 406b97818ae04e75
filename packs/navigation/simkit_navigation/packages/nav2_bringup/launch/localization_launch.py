"""Map server and AMCL of Nav2 with their lifecycle manager."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare
from nav2_common.launch import RewrittenYaml

TRANSFORMS = [("/tf", "tf"), ("/tf_static", "tf_static")]
MANAGED = ["map_server", "amcl"]


def _nodes(context):
    def value(name):
        return LaunchConfiguration(name).perform(context)

    parameters = RewrittenYaml(
        source_file=value("params_file"), root_key=value("namespace"), param_rewrites={}, convert_types=True
    )
    clock = {"use_sim_time": value("use_sim_time").lower() == "true"}
    shared = {
        "output": "screen",
        "respawn": value("use_respawn").lower() == "true",
        "respawn_delay": 2.0,
        "arguments": ["--ros-args", "--log-level", value("log_level")],
        "remappings": TRANSFORMS,
    }
    file = {"yaml_filename": value("map")} if value("map") else {}
    map_parameters = [parameters, clock, *([file] if file else [])]
    manager = {"autostart": value("autostart").lower() == "true", "node_names": MANAGED}
    return [
        Node(
            package="nav2_map_server", executable="map_server", name="map_server", parameters=map_parameters, **shared
        ),
        Node(package="nav2_amcl", executable="amcl", name="amcl", parameters=[parameters, clock], **shared),
        Node(
            package="nav2_lifecycle_manager",
            executable="lifecycle_manager",
            name="lifecycle_manager_localization",
            output="screen",
            parameters=[clock, manager],
        ),
    ]


def generate_launch_description():
    """Return the launch description."""
    parameters = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "params", "nav2_params.yaml"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the nodes"),
            DeclareLaunchArgument("map", default_value="", description="YAML file of the map"),
            DeclareLaunchArgument("use_sim_time", default_value="false", description="Time of the simulation"),
            DeclareLaunchArgument("params_file", default_value=parameters, description="File of parameters"),
            DeclareLaunchArgument("autostart", default_value="true", description="Activate the nodes at the start"),
            DeclareLaunchArgument("use_composition", default_value="False", description="No effect here"),
            DeclareLaunchArgument("container_name", default_value="nav2_container", description="No effect here"),
            DeclareLaunchArgument("use_respawn", default_value="False", description="Start ended nodes again"),
            DeclareLaunchArgument("log_level", default_value="info", description="Level of the log"),
            OpaqueFunction(function=_nodes),
        ]
    )
