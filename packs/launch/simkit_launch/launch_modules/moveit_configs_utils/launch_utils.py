"""Parts of launch files of MoveIt."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from simkit_launch.launch_modules.launch.actions import DeclareLaunchArgument
from simkit_launch.launch_modules.launch.launch_description import LaunchDescription
from simkit_launch.launch_modules.launch_ros.actions import Node

__all__ = ["DeclareBooleanLaunchArg", "add_debuggable_node"]


class DeclareBooleanLaunchArg(DeclareLaunchArgument):
    """Declaration of an argument that is true or false.

    Args:
        name: name.
        default_value: value if it is not given.
        description: description.
    """

    def __init__(self, name: str, *, default_value: Any = False, description: str | None = None, **kwargs: Any) -> None:
        choices = ["true", "false", "True", "False"]
        super().__init__(name, default_value=str(default_value), description=description, choices=choices, **kwargs)


def add_debuggable_node(
    ld: LaunchDescription,
    package: str,
    executable: str,
    condition_name: str = "debug",
    commands_file: str | None = None,
    extra_debug_args: Iterable[str] | None = None,
    **kwargs: Any,
) -> None:
    """Add a node to a launch description; it does not run in a debugger here."""
    del condition_name, commands_file, extra_debug_args
    ld.add_action(Node(package=package, executable=executable, **kwargs))
