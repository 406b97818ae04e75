"""Robot of a file of URDF or xacro in a package, with joints that can be moved."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the launch description."""
    gui = LaunchConfiguration("jsp_gui")
    names = ("urdf_package", "urdf_package_path")
    return LaunchDescription(
        [
            DeclareLaunchArgument("jsp_gui", default_value="true", choices=["true", "false"]),
            DeclareLaunchArgument("rviz_config", default_value="", description="File of rviz2"),
            IncludeLaunchDescription(
                PathJoinSubstitution([FindPackageShare("urdf_launch"), "launch", "description.launch.py"]),
                launch_arguments=[(name, LaunchConfiguration(name)) for name in names],
            ),
            Node(package="joint_state_publisher", executable="joint_state_publisher", condition=UnlessCondition(gui)),
            Node(
                package="joint_state_publisher_gui",
                executable="joint_state_publisher_gui",
                condition=IfCondition(gui),
            ),
            Node(package="rviz2", executable="rviz2", output="screen"),
        ]
    )
