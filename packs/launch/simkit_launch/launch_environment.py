"""Environment variables that launch files read: their values, and those for variables that are not set."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import Final

from simkit.extend import Diagnostics, Where
from simkit_launch.launch_packages import LaunchPackages

DEFAULT_VARIABLE: Final = "SK-LAUNCH-021"

SEARCH_VARIABLES: Final = (
    "GZ_SIM_RESOURCE_PATH",
    "IGN_GAZEBO_RESOURCE_PATH",
    "GAZEBO_MODEL_PATH",
    "GAZEBO_RESOURCE_PATH",
    "GAZEBO_PLUGIN_PATH",
    "GZ_SIM_SYSTEM_PLUGIN_PATH",
    "IGN_GAZEBO_SYSTEM_PLUGIN_PATH",
    "LD_LIBRARY_PATH",
    "ROS_PACKAGE_PATH",
    "AMENT_PREFIX_PATH",
    "SDF_PATH",
)
"""Variables with lists of folders; an installation of ROS and Gazebo sets them, so that they are empty if not set."""

MODEL_VARIABLES: Final = (
    "GZ_SIM_RESOURCE_PATH",
    "IGN_GAZEBO_RESOURCE_PATH",
    "GAZEBO_MODEL_PATH",
    "GAZEBO_RESOURCE_PATH",
    "SDF_PATH",
)
"""Variables with the folders of models and worlds."""

USUAL_VALUES: Final = {"TURTLEBOT3_MODEL": "waffle"}
"""Values of variables that are not set, by name; a note says that they are used."""


def variable(
    name: str, where: Where, diagnostics: Diagnostics, packages: LaunchPackages, *, is_ros1: bool = False
) -> str | None:
    """Return an environment variable; None if it is not set and has no usual value.

    A usual value is noted, unless an installation of ROS, of Gazebo or of the workspace sets the variable.
    """
    if name in os.environ:
        return os.environ[name]
    if name in packages.variables:
        return packages.variables[name]
    ros = {"ROS_DISTRO": "noetic" if is_ros1 else "jazzy", "ROS_VERSION": "1" if is_ros1 else "2"}
    if name in ros or name in SEARCH_VARIABLES:
        return ros.get(name, "")
    if name in USUAL_VALUES:
        note_usual_value(name, USUAL_VALUES[name], where, diagnostics)
        return USUAL_VALUES[name]
    return None


def environment_folders(environment: Iterable[tuple[str, str]]) -> Iterator[str]:
    """Yield the folders in variables of the environment for models and worlds.

    Args:
        environment: pairs of a name and a value.
    """
    for name, value in environment:
        if name in MODEL_VARIABLES:
            yield from (folder for folder in value.split(os.pathsep) if folder)


def note_usual_value(name: str, value: str, where: Where, diagnostics: Diagnostics) -> None:
    """Note that a variable is not set, and that a usual value is used."""
    message = f"the environment variable {name} is not set; {value!r} is used"
    diagnostics.note(DEFAULT_VARIABLE, message, where, f"choose another value: {name}=… simkit launch …")
