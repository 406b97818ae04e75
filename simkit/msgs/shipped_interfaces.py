"""Definitions of messages, services and actions of simkit and its packs, and of rosbags for ROS 2 Jazzy.

The definition of a simkit type is the file `definitions/<package>/<msg, srv or action>/<Name>.<msg, srv or action>`,
in this folder or in the folder `msgs` of a pack. It has the published fields, constants and default values in the
published order. The hash of a type depends on field names, types and order, and not on constants and defaults;
`tests/msgs/published_interfaces.py` compares these as well.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cache
from typing import Any, Final

from simkit.msgs.definition_parser import PARTS, MessageDefinition, parse_interface
from simkit.packs import foreign_packs, pack_folders

_FOLDER: Final = os.path.join(os.path.dirname(__file__), "definitions")  # noqa: PTH118, PTH120 (pathlib takes 3 ms)
PACKAGES_WITH_LONG_NAMES: Final = frozenset(
    (
        "example_interfaces",
        "kobuki_msgs",
        "nav2_msgs",
        "osrf_gear",
        "simulation_interfaces",
    )
)
"""Packages that repeat names of other packages, such as `Trigger`; a class of another package has the short name."""
NO_FIELD: Final = "structure_needs_at_least_one_member"
"""Name of the only field of a type that has no fields."""
_ROSBAGS_DEFAULTS: Final[dict[str, dict[str, Any]]] = {
    "geometry_msgs/msg/Quaternion": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
    "rcl_interfaces/msg/ParameterDescriptor": {"read_only": False, "dynamic_typing": False},
    "sensor_msgs/msg/NavSatStatus": {"status": -2},  # STATUS_UNKNOWN
    "type_description_interfaces/msg/FieldType": {"type_id": 0},
}
"""Published default values of the types in rosbags, by type and field: rosbags has the fields without them."""


@cache
def definition_files() -> dict[str, str]:
    """Return the path of each definition file by the full name of its message, service or action.

    A pack cannot replace a definition of the core.
    """
    folders = (*reversed(pack_folders("msgs/definitions")), _FOLDER)
    return {
        f"{package.name}/{kind.name}/{file.name.removesuffix(f'.{kind.name}')}": file.path
        for folder in folders
        for package in os.scandir(folder)
        for kind in os.scandir(package.path)
        for file in os.scandir(kind.path)
    }


@cache
def foreign_message_types() -> frozenset[str]:
    """Return the message types whose definitions are in packs of other distributions."""
    folders, files = tuple(pack.folder for pack in foreign_packs()), definition_files()
    return frozenset(name for name, file in shipped_message_types().items() if files[file].startswith(folders))


@cache
def definition_text(interface_name: str) -> str:
    """Return the text of the definition file of a message, service or action in `definitions/`."""
    with open(definition_files()[interface_name], encoding="utf-8") as file:
        return file.read()


@cache
def shipped_message_types() -> dict[str, str]:
    """Return the interface of each message type in `definitions/`."""
    return {f"{name}{part}": name for name in definition_files() for part in PARTS[name.split("/")[1]]}


@cache
def shipped_parts(interface_name: str) -> tuple[MessageDefinition, ...] | None:
    """Return the parts of an interface that is shipped with simkit or rosbags; None for any other."""
    if interface_name in definition_files():
        return tuple(parse_interface(interface_name, definition_text(interface_name))[0])
    if interface_name not in rosbags_types():
        return None
    constants, fields = rosbags_types()[interface_name]
    plain = [(name, (int(node[0]), node[1])) for name, node in fields if name != NO_FIELD]
    return (MessageDefinition("", list(constants), plain, rosbags_defaults(interface_name)),)


def rosbags_defaults(type_name: str) -> dict[str, Any]:
    """Return the published default values of a type in rosbags, by the name of the field."""
    return _ROSBAGS_DEFAULTS.get(type_name, {})


@cache
def rosbags_types() -> Mapping[str, Any]:
    """Return constants and fields of the message types that come with rosbags, by name."""
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY).fielddefs
