"""Builder of parameters, as the ROS 2 package `launch_param_builder`."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from simkit.input_file import read_input_text
from simkit_launch.planner import current_planner

__all__ = [
    "ParameterBuilder",
    "ParameterBuilderFileNotFoundError",
    "get_path",
    "load_file",
    "load_xacro",
    "load_yaml",
]


class ParameterBuilderFileNotFoundError(KeyError):
    """A file of parameters is not there."""


def _existing(file_path: str | os.PathLike[str]) -> Path | None:
    """Return the path of a file; None, with a warning, if it is not there."""
    planner = current_planner()
    file: Path | None = planner.parameter_file(Path(file_path), planner.calling_place())
    return file


def load_file(file_path: str | os.PathLike[str], mappings: Mapping[str, Any] | None = None) -> str:
    """Return the text of a file; an empty text, with a warning, if it is not there."""
    path = _existing(file_path)
    text = "" if path is None else read_input_text(path)
    for name, value in (mappings or {}).items():
        text = text.replace(f"{{{{{name}}}}}", str(value)).replace(f"{{{{ {name} }}}}", str(value))
    return text


def load_yaml(file_path: str | os.PathLike[str], mappings: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Return the content of a YAML file; an empty table, with a warning, if it is not there."""
    data = yaml.safe_load(load_file(file_path, mappings))
    return data if isinstance(data, dict) else {}


def load_xacro(file_path: str | os.PathLike[str], mappings: Mapping[str, Any] | None = None) -> str:
    """Return the expanded text of a xacro file; an empty text, with a warning, if it cannot be expanded."""
    words = [f"{name}:={value}" for name, value in (mappings or {}).items()]
    planner = current_planner()
    return planner.command_output(["xacro", str(planner.source_of(Path(file_path))), *words])


def get_path(package_name: str, file_path: str) -> str:
    """Return the path of a file of a package."""
    return str(current_planner().share_folder(package_name) / file_path)


class ParameterBuilder:
    """Builder of the parameters of a node.

    Args:
        package_name: package with the files.
    """

    def __init__(self, package_name: str) -> None:
        self._package_path = current_planner().share_folder(package_name)
        self._parameters: dict[str, Any] = {}

    def yaml(
        self,
        file_path: str | os.PathLike[str],
        parameter_namespace: str | None = None,
        mappings: Mapping[str, Any] | None = None,
    ) -> ParameterBuilder:
        """Add the parameters of a YAML file, in a namespace."""
        values = load_yaml(self._package_path / file_path, mappings)
        target = self._parameters
        if parameter_namespace:
            target = target.setdefault(parameter_namespace, {})
        target.update(values)
        return self

    def file_parameter(self, parameter_name: str, file_path: str | os.PathLike[str]) -> ParameterBuilder:
        """Add a parameter whose value is the text of a file."""
        self._parameters[parameter_name] = load_file(self._package_path / file_path)
        return self

    def xacro_parameter(
        self, parameter_name: str, file_path: str | os.PathLike[str], mappings: Mapping[str, Any] | None = None
    ) -> ParameterBuilder:
        """Add a parameter whose value is the expanded text of a xacro file."""
        self._parameters[parameter_name] = load_xacro(self._package_path / file_path, mappings)
        return self

    def parameter(self, parameter_name: str, parameter_value: Any) -> ParameterBuilder:
        """Add a parameter."""
        self._parameters[parameter_name] = parameter_value
        return self

    def to_dict(self) -> dict[str, Any]:
        """Return all parameters."""
        return self._parameters
