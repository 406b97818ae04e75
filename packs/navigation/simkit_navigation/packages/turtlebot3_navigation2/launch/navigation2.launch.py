"""Nav2 for a TurtleBot3, with the map of a file."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the launch description."""
    nav2 = FindPackageShare("nav2_bringup")
    parameters = PathJoinSubstitution([nav2, "params", "nav2_params.yaml"])
    names = ("map", "use_sim_time", "params_file")
    bringup = IncludeLaunchDescription(
        PathJoinSubstitution([nav2, "launch", "bringup_launch.py"]),
        launch_arguments=[(name, LaunchConfiguration(name)) for name in names],
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("map", description="YAML file of the map"),
            DeclareLaunchArgument("params_file", default_value=parameters, description="File of parameters"),
            DeclareLaunchArgument("use_sim_time", default_value="false", description="Time of the simulation"),
            bringup,
            Node(package="rviz2", executable="rviz2", name="rviz2"),
        ]
    )
