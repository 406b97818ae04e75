"""Sources of launch descriptions, and functions that read launch files."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

from simkit_launch.launch_modules.launch.launch_description_source import (
    AnyLaunchDescriptionSource,
    FrontendLaunchDescriptionSource,
    PythonLaunchDescriptionSource,
)
from simkit_launch.planner import current_planner

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_description import LaunchDescription

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "InvalidLaunchFileError",
    "InvalidPythonLaunchFileError",
    "PythonLaunchDescriptionSource",
    "get_launch_description_from_any_launch_file",
    "get_launch_description_from_frontend_launch_file",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]


class InvalidLaunchFileError(Exception):
    """A launch file cannot be read."""


class InvalidPythonLaunchFileError(Exception):
    """A launch file in Python has no function `generate_launch_description`."""


def load_python_launch_file_as_module(python_launch_file_path: str) -> ModuleType:
    """Return a launch file in Python as a module."""
    return current_planner().load_module(python_launch_file_path)


def get_launch_description_from_any_launch_file(launch_file_path: str, **options: object) -> LaunchDescription:
    """Return the launch description of a file in Python, XML or YAML."""
    del options
    description: LaunchDescription = current_planner().description_of(launch_file_path)
    return description


get_launch_description_from_python_launch_file = get_launch_description_from_any_launch_file
get_launch_description_from_frontend_launch_file = get_launch_description_from_any_launch_file
