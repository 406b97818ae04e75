"""Arena with a TurtleBot3."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.substitutions import FindPackageShare


def _included(file, *names):
    path = PathJoinSubstitution([ThisLaunchFileDir(), file])
    return IncludeLaunchDescription(path, launch_arguments=[(name, LaunchConfiguration(name)) for name in names])


def generate_launch_description():
    """Return the launch description."""
    world = PathJoinSubstitution([FindPackageShare("turtlebot3_gazebo"), "worlds", "turtlebot3_world.world"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("use_sim_time", default_value="true", description="No effect here"),
            DeclareLaunchArgument("x_pose", default_value="-2.0", description="x of the robot, m"),
            DeclareLaunchArgument("y_pose", default_value="-0.5", description="y of the robot, m"),
            ExecuteProcess(cmd=["gz", "sim", "-r", world], name="gazebo", output="screen"),
            _included("robot_state_publisher.launch.py", "use_sim_time"),
            _included("spawn_turtlebot3.launch.py", "x_pose", "y_pose"),
        ]
    )
