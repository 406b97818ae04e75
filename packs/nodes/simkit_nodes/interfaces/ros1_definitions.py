"""Definitions of ROS 1 in the form of ROS 2, which allows fewer names of types, fields and constants.

Programs of ROS 1 see the names of ROS 1: the tables here have those that differ.
"""

from __future__ import annotations

import re
from typing import Final

from simkit.msgs.definition_parser import BASIC_TYPES, PARTS, name_problem

field_names: Final[dict[str, dict[str, str]]] = {
    "sensor_msgs/msg/CameraInfo": {"d": "D", "k": "K", "r": "R", "p": "P"},
    "stereo_msgs/msg/DisparityImage": {"t": "T"},
}
"""Names of fields and constants in ROS 1, by the name of the message type and the name in ROS 2."""
type_names: Final[dict[str, str]] = {}
"""Last part of the name of an interface in ROS 1, by its full name in ROS 2."""

_LINE: Final = re.compile(r"(\s*)([\w/]+)((?:\[\d*\])?\s+)([A-Za-z]\w*)(\s*=)?(.*)", re.DOTALL)
_TYPES: Final = {"byte": "int8", "char": "uint8"}
_KNOWN_TYPES: Final = BASIC_TYPES | {"time", "duration"}


def ros2_name(interface_name: str) -> str:
    """Return a name that ROS 2 allows for an interface, and remember the name of ROS 1.

    Args:
        interface_name: full name with the type's name in ROS 1, such as `kortex_driver/msg/Action_type`.
    """
    if name_problem(interface_name) is None:
        return interface_name
    package, kind, short = interface_name.split("/")
    name = f"{package}/{kind}/{_camel_case(short)}"
    type_names[name] = short
    return name


def ros2_text(name: str, text: str) -> str:
    """Return a definition with types and names that ROS 2 allows, and remember the names of ROS 1.

    Args:
        name: full name of the interface in ROS 2.
        text: definition of ROS 1.
    """
    suffixes = PARTS[name.split("/")[1]]
    lines, part = [], 0
    for line in text.split("\n"):
        match = _LINE.fullmatch(line)
        if line.rstrip() == "---":
            part += 1
        elif match is not None:
            indent, kind, gap, field, equals, rest = match.groups()
            new = field.upper() if equals else _snake_case(field)
            if new != field and part < len(suffixes):
                field_names.setdefault(f"{name}{suffixes[part]}", {})[new] = field
            line = f"{indent}{_ros2_type(kind)}{gap}{new}{equals or ''}{rest}"
        lines.append(line)
    return "\n".join(lines)


def _ros2_type(name: str) -> str:
    """Return the type of a field in ROS 2."""
    package, slash, short = name.rpartition("/")
    if name in _KNOWN_TYPES:
        return _TYPES.get(name, name)
    return f"{package}{slash}{_camel_case(short)}"


def _camel_case(name: str) -> str:
    """Return the name of a type that ROS 2 allows: `Action_type` is `ActionType`."""
    return "".join(word[:1].upper() + word[1:] for word in name.split("_"))


def _snake_case(name: str) -> str:
    """Return the name of a field that ROS 2 allows: `maxSpeed` is `max_speed`."""
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
    return re.sub(r"_+", "_", words).strip("_")
