"""Nav2 with a map, or with SLAM."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import PushRosNamespace
from launch_ros.substitutions import FindPackageShare

SHARED = ("namespace", "use_sim_time", "autostart", "params_file", "use_respawn", "log_level")


def _included(file, *names, condition=None):
    path = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "launch", file])
    arguments = [(name, LaunchConfiguration(name)) for name in (*SHARED, *names)]
    return IncludeLaunchDescription(path, launch_arguments=arguments, condition=condition)


def _is_true(*names):
    """Return an expression that is true if all arguments are."""
    words = []
    for name in names:
        is_negated = name.startswith("not ")
        words += [" and " if words else "", "'", LaunchConfiguration(name.removeprefix("not ")), "'.lower()"]
        words += ["!= 'true'" if is_negated else "== 'true'"]
    return IfCondition(PythonExpression(words))


def generate_launch_description():
    """Return the launch description."""
    parameters = PathJoinSubstitution([FindPackageShare("nav2_bringup"), "params", "nav2_params.yaml"])
    group = [
        PushRosNamespace(condition=_is_true("use_namespace"), namespace=LaunchConfiguration("namespace")),
        _included("slam_launch.py", condition=_is_true("slam", "use_localization")),
        _included("localization_launch.py", "map", condition=_is_true("not slam", "use_localization")),
        _included("navigation_launch.py"),
    ]
    return LaunchDescription(
        [
            DeclareLaunchArgument("namespace", default_value="", description="Namespace of the nodes"),
            DeclareLaunchArgument("use_namespace", default_value="false", description="Put the nodes in the namespace"),
            DeclareLaunchArgument("slam", default_value="False", description="SLAM in place of a map"),
            DeclareLaunchArgument("map", default_value="", description="YAML file of the map"),
            DeclareLaunchArgument("use_localization", default_value="True", description="Map and AMCL, or SLAM"),
            DeclareLaunchArgument("use_sim_time", default_value="false", description="Time of the simulation"),
            DeclareLaunchArgument("params_file", default_value=parameters, description="File of parameters"),
            DeclareLaunchArgument("autostart", default_value="true", description="Activate the nodes at the start"),
            DeclareLaunchArgument("use_composition", default_value="True", description="No effect here"),
            DeclareLaunchArgument("container_name", default_value="nav2_container", description="No effect here"),
            DeclareLaunchArgument("use_respawn", default_value="False", description="Start ended nodes again"),
            DeclareLaunchArgument("log_level", default_value="info", description="Level of the log"),
            GroupAction(group),
        ]
    )
