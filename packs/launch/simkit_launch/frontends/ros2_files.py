"""Launch files of ROS 2 in XML and YAML: their launch descriptions."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from simkit.errors import LoadError
from simkit.extend import Diagnostics
from simkit_launch.frontends.launch_actions import read_actions
from simkit_launch.frontends.launch_element import xml_launch_element, yaml_launch_element
from simkit_launch.launch_modules.launch.launch_description import LaunchDescription

_YAML: Final = (".yaml", ".yml")


def read_description(file: Path) -> LaunchDescription:
    """Return the launch description of a file; its name ends with `.yaml` or `.yml` if it is YAML.

    Raises:
        LoadError: with all errors of the file.
    """
    diagnostics = Diagnostics()
    root = (yaml_launch_element if file.suffix in _YAML else xml_launch_element)(file, diagnostics)
    actions = [] if root is None else read_actions(root, diagnostics)
    if root is None or diagnostics.has_errors:
        raise LoadError(tuple(diagnostics))
    return LaunchDescription(actions, deprecated_reason=root.values.get("deprecated"))
