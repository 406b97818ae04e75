"""Server of Gazebo classic with a world."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction, Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.substitutions import FindPackageShare

_SWITCHES = ("version", "verbose", "lockstep", "help", "pause", "record", "minimal_comms")
_OPTIONS = (
    "initial_sim_time",
    "physics",
    "play",
    "record_encoding",
    "record_path",
    "record_period",
    "record_filter",
    "seed",
    "iters",
    "profile",
)
_WITHOUT_EFFECT = {"gdb": "false", "valgrind": "false", "init": "true", "factory": "true", "force_system": "true"}


def _server(context):
    def value(name):
        return LaunchConfiguration(name).perform(context)

    words = ["gzserver", value("world")]
    words += [f"--{name}" for name in _SWITCHES if value(name).lower() == "true"]
    words += [word for name in _OPTIONS if value(name) for word in (f"--{name}", value(name))]
    if value("params_file"):
        words += ["--ros-args", "--params-file", value("params_file"), "--"]
    words += value("extra_gazebo_args").split()
    on_exit = Shutdown() if value("server_required").lower() == "true" else None
    return [ExecuteProcess(cmd=words, output="screen", on_exit=on_exit)]


def generate_launch_description():
    """Return the launch description."""
    empty = [FindPackageShare("gazebo_ros"), "/worlds/empty.world"]
    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value=empty, description="File of the world"),
            *(DeclareLaunchArgument(name, default_value="false") for name in _SWITCHES),
            *(DeclareLaunchArgument(name, default_value="") for name in _OPTIONS),
            DeclareLaunchArgument("extra_gazebo_args", default_value="", description="More words of the command line"),
            DeclareLaunchArgument("params_file", default_value="", description="File with parameters of ROS 2"),
            DeclareLaunchArgument("server_required", default_value="false", description="End all with the server"),
            *(
                DeclareLaunchArgument(name, default_value=value, description="No effect here")
                for name, value in _WITHOUT_EFFECT.items()
            ),
            OpaqueFunction(function=_server),
        ]
    )
