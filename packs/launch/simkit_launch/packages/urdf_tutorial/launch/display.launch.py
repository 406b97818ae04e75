"""Robot of a file of URDF or xacro, with joints that can be moved."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    """Return the launch description."""
    description = ParameterValue(Command(["xacro ", LaunchConfiguration("model")]), value_type=str)
    gui = LaunchConfiguration("gui")
    return LaunchDescription(
        [
            DeclareLaunchArgument("model", description="File of the robot"),
            DeclareLaunchArgument("gui", default_value="true", choices=["true", "false"]),
            DeclareLaunchArgument("rvizconfig", default_value="", description="File of rviz2"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": description}],
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
