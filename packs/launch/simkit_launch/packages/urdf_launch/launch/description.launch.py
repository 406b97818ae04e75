"""Robot of a file of URDF or xacro in a package, published with its frames."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the launch description."""
    folder = FindPackageShare(LaunchConfiguration("urdf_package"))
    file = PathJoinSubstitution([folder, LaunchConfiguration("urdf_package_path")])
    description = ParameterValue(Command(["xacro ", file]), value_type=str)
    return LaunchDescription(
        [
            DeclareLaunchArgument("urdf_package", description="Package of the robot"),
            DeclareLaunchArgument("urdf_package_path", description="File of the robot in its package"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": description}],
            ),
        ]
    )
