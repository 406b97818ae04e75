"""Elements of launch files of ROS 1: their attributes and inner elements, and how they differ from those of ROS 2."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from simkit import Params
from simkit.extend import Diagnostics
from simkit.loaders.resources.xml_reader import parse_file

_NODE: Final = (
    *("pkg", "type", "name", "args", "machine", "respawn", "respawn_delay", "required", "ns", "clear_params"),
    *("output", "cwd", "launch-prefix"),
)
ATTRIBUTES: Final[Mapping[str, tuple[str, ...]]] = {
    "launch": ("deprecated",),
    "node": _NODE,
    "test": (*_NODE, "test-name", "time-limit", "retry"),
    "machine": ("name", "address", "env-loader", "ssh-port", "user", "password", "default", "timeout"),
    "include": ("file", "ns", "clear_params", "pass_all_args"),
    "remap": ("from", "to"),
    "env": ("name", "value"),
    "param": ("name", "value", "type", "textfile", "binfile", "command"),
    "rosparam": ("command", "file", "param", "ns", "subst_value"),
    "group": ("ns", "clear_params"),
    "arg": ("name", "default", "value", "doc"),
    "master": ("type", "uri", "auto"),
}
"""Attributes of each element; every element can also have `if` or `unless`."""

REQUIRED: Final[Mapping[str, tuple[str, ...]]] = {
    "node": ("pkg", "type", "name"),
    "test": ("pkg", "type", "test-name"),
    "machine": ("name", "address"),
    "include": ("file",),
    "remap": ("from", "to"),
    "env": ("name", "value"),
    "param": ("name",),
    "arg": ("name",),
}
"""Attributes that an element must have."""

CHILDREN: Final[Mapping[str, tuple[str, ...]]] = {
    "launch": tuple(name for name in ATTRIBUTES if name != "launch"),
    "group": tuple(name for name in ATTRIBUTES if name != "launch"),
    "node": ("remap", "param", "rosparam", "env"),
    "test": ("remap", "param", "rosparam", "env"),
    "include": ("arg", "env"),
}
"""Elements that each element can contain."""


def is_roslaunch_file(file: Path) -> bool:
    """Check whether a file is a launch file of ROS 1; a file that cannot be read is none."""
    if file.suffix not in (".launch", ".xml", ".test"):
        return False
    document = parse_file(file, Diagnostics())
    return document is not None and is_roslaunch(document.root, otherwise=file.suffix == ".launch")


def is_roslaunch(root: Params, *, otherwise: bool = False) -> bool:
    """Check whether the elements of a launch file in XML are those of ROS 1, and not those of ROS 2.

    Args:
        root: outermost element.
        otherwise: answer for elements that both have.
    """
    score = 0
    stack = [root]
    while stack:
        element = stack.pop()
        stack += element.children
        score += _score(element)
    return score > 0 or (score == 0 and otherwise)


def _score(element: Params) -> int:
    """Return a positive number for an element that only ROS 1 has, and a negative one for one that only ROS 2 has."""
    values = " ".join(element.attributes.values())
    names = set(element.attributes)
    score = values.count("$(find ") + values.count("$(arg ") + values.count("$(optenv ")
    score -= values.count("$(var ") + values.count("$(find-pkg-")
    score += 5 * (element.name in ("rosparam", "master", "machine", "test"))
    score += 5 * (element.name == "node" and "type" in names)
    inner = {child.name for child in element.children}
    score += 5 * (element.name in ("launch", "group") and bool({"param", "remap", "env"} & inner))
    score += 5 * (element.name == "param" and bool({"command", "textfile", "binfile"} & names))
    score += 5 * (element.name == "include" and bool({"pass_all_args", "clear_params"} & names))
    score -= 5 * (element.name == "node" and bool({"exec", "namespace"} & names))
    score -= 5 * (element.name in ("let", "executable", "set_env", "push_ros_namespace", "push-ros-namespace"))
    score -= 5 * (element.name in ("node_container", "load_composable_node", "composable_node", "set_parameter"))
    return score
