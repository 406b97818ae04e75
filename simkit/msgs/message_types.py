"""Message types: types of ROS 2 Jazzy from rosbags, and types in `definitions/`, which are read at first use.

The definition of a simkit type is the file `definitions/<package>/<msg, srv or action>/<Name>.<msg, srv or action>`,
with the published fields in the published order. The hash of a definition depends on field names, types and order, and
not on constants. A service or action is several message types, which `---` separates in the file:
`<package>/srv/<Name>_Request` and `…_Response`, `<package>/action/<Name>_Goal`, `…_Result` and `…_Feedback`.
"""

from __future__ import annotations

import os
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

_FOLDER: Final = os.path.join(os.path.dirname(__file__), "definitions")  # noqa: PTH118, PTH120 (pathlib takes 3 ms)
BASE, NAME, ARRAY, SEQUENCE = 1, 2, 3, 4
"""Kinds of field nodes in the type store: `rosbags.interfaces.Nodetype`, whose import would load all of rosbags."""
_PARTS: Final = {"msg": ("",), "srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}


@cache
def definition_files() -> dict[str, str]:
    """Return the path of each definition file by the full name of its message, service or action."""
    return {
        f"{package.name}/{kind.name}/{file.name.removesuffix(f'.{kind.name}')}": file.path
        for package in os.scandir(_FOLDER)
        for kind in os.scandir(package.path)
        for file in os.scandir(kind.path)
    }


@cache
def definition_text(interface_name: str) -> str:
    """Return the text of the definition file of a message, service or action in `definitions/`."""
    with open(definition_files()[interface_name], encoding="utf-8") as file:
        return file.read()


@cache
def _message_sources() -> dict[str, tuple[str, int]]:
    """Return the interface of each message type in `definitions/`, and the index of the type's part in the file."""
    return {
        f"{interface}{part}": (interface, index)
        for interface in definition_files()
        for index, part in enumerate(_PARTS[interface.split("/")[1]])
    }


# Message of any type: an object of a dataclass that rosbags creates at run time.
Message = Any
# Value of a message's field: a number, a text, an array, a message or a list of these.
FieldValue = Any
# Type of a field in the type store: its kind (`BASE`, `NAME`, `ARRAY`, `SEQUENCE`) and the details of that kind.
FieldNode = tuple[int, Any]
_Entry = Any  # entry of the type store: a class, or its constants and fields


class _ReadOnDemand(dict[str, _Entry]):
    """Table of the type store that also contains the types of `definitions/`, each registered on first access."""

    def __contains__(self, type_name: object) -> bool:
        return super().__contains__(type_name) or type_name in _message_sources()

    def __missing__(self, type_name: str) -> _Entry:
        _register(type_name)
        return self[type_name]


@cache
def type_store() -> Typestore:
    """Return the type store of all message types that simkit knows."""
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    store.fielddefs, store.types = _ReadOnDemand(store.fielddefs), _ReadOnDemand(store.types)
    return store


def _register(type_name: str) -> None:
    """Read the definition of one message type of `definitions/` into the type store.

    Raises:
        KeyError: the type is not in `definitions/`.
    """
    from rosbags.typesys import get_types_from_msg

    interface, part = _message_sources()[type_name]
    package, kind, name = type_name.split("/")
    text = definition_text(interface).split("---\n")[part]
    # rosbags' parser has no services; it parses every definition as a message
    (definition,) = get_types_from_msg(text, f"{package}/msg/{name}").values()
    type_store().register({f"{package}/{kind}/{name}": definition})


def message_type_names() -> list[str]:
    """Return the full name of every message type, including the parts of services and actions."""
    return sorted({*type_store().fielddefs, *_message_sources()})


def full_name(type_name: str) -> str:
    """Return the full name of a message type: `sensor_msgs/Imu` is `sensor_msgs/msg/Imu`.

    Raises:
        MessageError: the type is unknown; the message suggests the closest name.
    """
    known = type_store().fielddefs
    package, _, rest = type_name.partition("/")
    long = f"{package}/msg/{rest}"
    for name in (type_name, long):
        if name in known:
            return name
    is_long = any(f"/{kind}/" in type_name for kind in _PARTS)
    hint = did_you_mean(type_name if is_long else long, [*known, *_message_sources()])
    raise MessageError(f"unknown message type {type_name!r}; {hint}".rstrip("; "))


@cache
def type_of(type_name: str) -> type[Message]:
    """Return the dataclass of a message type. In code that must be fast, call the class directly."""
    return type_store().types[full_name(type_name)]


@cache
def class_names() -> dict[str, str]:
    """Return the type name of each message class by the class's name in `simkit.msgs`.

    The name of a class is the last part of its type name: `LaserScan`. If several types have the same last part, ROS's
    own type has the short name. The other types have their full name: `gazebo_msgs__srv__SpawnEntity_Request`.
    """
    names = message_type_names()
    candidates: dict[str, list[str]] = {}
    for name in sorted(names, key=_message_sources().__contains__):  # ROS's own types first
        candidates.setdefault(name.rpartition("/")[2], []).append(name)
    found = {}
    for name in names:
        short = name.rpartition("/")[2]
        first, *others = candidates[short]
        is_ambiguous = bool(others) and (first in _message_sources()) == (others[0] in _message_sources())
        found[short if name == first and not is_ambiguous else name.replace("/", "__")] = name
    return found


def message_class(class_name: str) -> type[Message]:
    """Return a message class by its name in `simkit.msgs`.

    Raises:
        AttributeError: the name is unknown; the message suggests the closest name.
    """
    # a lower-case name is a submodule or a typing error; it must not load the type store
    if class_name[:1].isupper() or "__" in class_name.strip("_"):
        names = class_names()
        if class_name in names:
            return type_of(names[class_name])
        raise AttributeError(f"simkit.msgs has no {class_name!r}; {did_you_mean(class_name, names)}".rstrip("; "))
    raise AttributeError(f"simkit.msgs has no {class_name!r}")


@cache
def types_of(*type_names: str) -> tuple[type[Message], ...]:
    """Return the dataclasses of several types. The first call of a process loads the type store, which takes 0.2 s."""
    return tuple(map(type_of, type_names))


@cache
def definition(type_name: str) -> str:
    """Return the definition of a type as `ros2msg` text, with the definitions of all types that it uses."""
    return type_store().generate_msgdef(full_name(type_name), ros_version=2)[0]


@cache
def rihs(type_name: str) -> str:
    """Return the type hash as ROS 2 writes it (`RIHS01_…`)."""
    return type_store().hash_rihs01(full_name(type_name))
