"""Parameters of ROS 1 from YAML files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from simkit.input_file import read_input_text
from simkit_nodes import ros1_names as names
from simkit_nodes.ros1_modules.rospy.client import delete_param, get_param, get_param_names, set_param
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node

__all__ = [
    "RosParamException",
    "delete_param",
    "get_param",
    "list_params",
    "load_file",
    "load_str",
    "set_param",
    "upload_params",
]


class RosParamException(Exception):
    """A file of parameters cannot be read."""


def load_file(
    filename: str, default_namespace: str | None = None, verbose: bool = False
) -> list[tuple[dict[str, Any], str]]:
    """Return the parameters of a YAML file, and their namespace.

    Args:
        filename: path of the file.
        default_namespace: namespace of parameters without one of their own; None for that of the program.
        verbose: accepted as in ROS.

    Raises:
        RosParamException: the file does not exist or is no YAML file.
    """
    file = Path(filename)
    if not file.is_file():
        raise RosParamException(f"file [{filename}] does not exist")
    return load_str(read_input_text(file), filename, default_namespace, verbose)


def load_str(
    text: str, filename: str, default_namespace: str | None = None, verbose: bool = False
) -> list[tuple[dict[str, Any], str]]:
    """Return the parameters of a YAML text, and their namespace; see `load_file`."""
    namespace = ros_node().namespace if default_namespace is None else default_namespace
    result = []
    try:
        documents = list(yaml.safe_load_all(text))
    except yaml.YAMLError as error:
        raise RosParamException(f"{filename}: {error}") from None
    for document in documents:
        inner = document.pop("_ns", "") if isinstance(document, dict) else ""
        result.append((document, names.ns_join(namespace, inner) if inner else namespace))
    return result


def upload_params(ns: str, values: object, verbose: bool = False) -> None:
    """Set the parameters of a dictionary below a namespace; others there stay."""
    if not isinstance(values, dict):
        set_param(ns, values)
        return
    for name, value in values.items():
        set_param(names.ns_join(ns, name), value)


def list_params(ns: str) -> list[str]:
    """Return the sorted names of the parameters below a namespace."""
    prefix = names.make_global_ns(ros_node().resolve(ns))
    return sorted(name for name in get_param_names() if name.startswith(prefix))
