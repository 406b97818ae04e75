"""The one type store: ROS 2 Jazzy from rosbags plus our extras, made at the first use."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError
from simkit.msgs.actions import ACTIONS, MESSAGES
from simkit.msgs.extras import DEFINITIONS
from simkit.msgs.services import SERVICES

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore


@cache
def _ros_store() -> Typestore:
    """The type store, at first with ROS's own types alone."""
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY)


@cache
def type_store() -> Typestore:
    """The type store with every message type that simkit knows; to read ours takes 20 ms."""
    from rosbags.typesys import get_types_from_msg

    store = _ros_store()
    extras: dict[str, Any] = {}
    for name, text in DEFINITIONS.items():
        extras.update(get_types_from_msg(text, name))
    store.register(extras)
    return store


@cache
def _register_interfaces() -> None:
    """Adds the messages of services and actions; done when the first of them is asked for."""
    from rosbags.typesys import get_types_from_msg

    found: dict[str, Any] = {}
    for name, text in MESSAGES.items():
        found.update(get_types_from_msg(text, name))
    for interfaces, parts in ((SERVICES, ("Request", "Response")), (ACTIONS, ("Goal", "Result", "Feedback"))):
        for name, text in interfaces.items():
            for part, fields in zip(parts, text.split("---\n"), strict=True):
                package, kind, short = name.split("/")
                # the parser takes every name for a message's
                parsed = get_types_from_msg(fields, f"{package}/msg/{short}_{part}")
                found.update({key.replace("/msg/", f"/{kind}/"): value for key, value in parsed.items()})
    type_store().register(found)


def full_name(type_name: str) -> str:
    """`sensor_msgs/Imu` and `sensor_msgs/msg/Imu` are the same type.

    Raises:
        MessageError: no such type is known; names the closest.
    """
    store = type_store()
    if "/srv/" in type_name or "/action/" in type_name or type_name in MESSAGES:
        _register_interfaces()
    if type_name in store.fielddefs:
        return type_name
    package, _, rest = type_name.partition("/")
    long = f"{package}/msg/{rest}"
    if long in store.fielddefs:
        return long
    hint = did_you_mean(type_name if "/msg/" in type_name else long, store.fielddefs)
    raise MessageError(f"no message type {type_name!r} is known; {hint}".rstrip("; "))


@cache
def type_of(type_name: str) -> type[Any]:
    """The dataclass of a message type; construct it directly where every microsecond counts."""
    known = _ros_store().types
    if type_name in known:
        return known[type_name]
    return type_store().types[full_name(type_name)]


@cache
def definition(type_name: str) -> str:
    """The `ros2msg` text of a type, with those of all types it uses."""
    return type_store().generate_msgdef(full_name(type_name), ros_version=2)[0]


@cache
def rihs(type_name: str) -> str:
    """The type hash as ROS 2 writes it (`RIHS01_…`)."""
    return type_store().hash_rihs01(full_name(type_name))
