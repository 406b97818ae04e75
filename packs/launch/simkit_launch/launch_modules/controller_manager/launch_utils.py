"""Functions that make the launch description of a spawner."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from simkit_launch.launch_modules.launch import LaunchDescription
from simkit_launch.launch_modules.launch.actions import DeclareLaunchArgument
from simkit_launch.launch_modules.launch.substitutions import LaunchConfiguration, PythonExpression
from simkit_launch.launch_modules.launch_ros.actions import Node

__all__ = [
    "generate_controllers_spawner_launch_description",
    "generate_controllers_spawner_launch_description_from_dict",
    "generate_load_controller_launch_description",
    "generate_spawner_launch_description",
]

_MANAGER = "controller_manager_name"
_UNLOAD = "unload_on_kill"


def generate_controllers_spawner_launch_description(
    controller_names: Sequence[Any], controller_params_files: Sequence[Any] | None = None, extra_spawner_args: Any = ()
) -> LaunchDescription:
    """Return the description of one spawner for several controllers.

    Args:
        controller_names: names of the controllers.
        controller_params_files: files of parameters of the controllers.
        extra_spawner_args: further words of the spawner's command line.
    """
    words = [*controller_names, "--controller-manager", LaunchConfiguration(_MANAGER)]
    for file in filter(None, controller_params_files or ()):
        words += ["--param-file", file]
    flag = PythonExpression(['"--unload-on-kill" if "true" == "', LaunchConfiguration(_UNLOAD), '" else ""'])
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                _MANAGER, default_value="controller_manager", description="name of the manager's node"
            ),
            DeclareLaunchArgument(_UNLOAD, default_value="false", description="unload the controllers at the end"),
            Node(package="controller_manager", executable="spawner", arguments=[*words, flag, *extra_spawner_args]),
        ]
    )


def generate_controllers_spawner_launch_description_from_dict(
    controller_info_dict: Mapping[str, Any], extra_spawner_args: Any = ()
) -> LaunchDescription:
    """Return the description of one spawner for several controllers.

    Args:
        controller_info_dict: file of parameters, or files, or None, by the name of the controller.
        extra_spawner_args: further words of the spawner's command line.
    """
    files: list[Any] = []
    for value in controller_info_dict.values():
        files += value if isinstance(value, list) else [value] if value else []
    return generate_controllers_spawner_launch_description(list(controller_info_dict), files, extra_spawner_args)


def generate_load_controller_launch_description(
    controller_name: Any,
    controller_params_file: Any = None,
    extra_spawner_args: Any = (),
    controller_type: Any = None,
) -> LaunchDescription:
    """Return the description of a spawner for one controller.

    Args:
        controller_name: name of the controller.
        controller_params_file: file of its parameters; None for no file.
        extra_spawner_args: further words of the spawner's command line.
        controller_type: type of the controller, an argument of the function in Humble; None for the type in the file.
    """
    words = [] if controller_type is None else ["--controller-type", controller_type]
    return generate_controllers_spawner_launch_description(
        [controller_name], [controller_params_file], [*words, *extra_spawner_args]
    )


def generate_spawner_launch_description(
    controller_info_dict: Mapping[str, Mapping[str, Any]], extra_spawner_args: Any = ()
) -> LaunchDescription:
    """Return the description of one spawner with options for each controller.

    Args:
        controller_info_dict: options `param_file`, `load_only`, `inactive`, `ros_args` by the controller's name.
        extra_spawner_args: further words of the spawner's command line.
    """
    words: list[Any] = []
    for name, options in controller_info_dict.items():
        words += ["--controller", name]
        files = options.get("param_file") or ()
        for file in files if isinstance(files, list) else [files] if files else ():
            words += ["--param-file", file]
        words += [flag for key, flag in (("load_only", "--load-only"), ("inactive", "--inactive")) if options.get(key)]
        if "ros_args" in options:
            words += ["--controller-ros-args", options["ros_args"]]
    return LaunchDescription(
        [Node(package="controller_manager", executable="spawner", arguments=[*words, *extra_spawner_args])]
    )
