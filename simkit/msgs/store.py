"""The one type store: ROS 2 Jazzy from rosbags plus our extras, made at the first use."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError
from simkit.msgs.actions import ACTIONS, MESSAGES
from simkit.msgs.controller_manager import MESSAGES as CONTROL_MESSAGES
from simkit.msgs.extras import DEFINITIONS
from simkit.msgs.monitors import MESSAGES as MONITOR_MESSAGES
from simkit.msgs.services import SERVICES
from simkit.msgs.world import MESSAGES as WORLD_MESSAGES

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore


_MESSAGES = {**MESSAGES, **CONTROL_MESSAGES, **WORLD_MESSAGES, **MONITOR_MESSAGES}
_SERVICE_ENDS, _ACTION_ENDS = ("Request", "Response"), ("Goal", "Result", "Feedback")
_USED = re.compile(r"^(\w+/\w+)", re.MULTILINE)


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
def _register(name: str) -> None:
    """Adds one of our messages, or those of one service or action, with its parts; done when it is first asked for."""
    from rosbags.typesys import get_types_from_msg

    if name in _MESSAGES:
        texts = {name: _MESSAGES[name]}
    else:
        interfaces, ends = (SERVICES, _SERVICE_ENDS) if "/srv/" in name else (ACTIONS, _ACTION_ENDS)
        parts = interfaces[name].split("---\n")
        texts = {f"{name}_{end}": part for end, part in zip(ends, parts, strict=True)}
    found: dict[str, Any] = {}
    for full, text in texts.items():
        package, kind, short = full.split("/")
        # the parser takes every name for a message's
        parsed = get_types_from_msg(text, f"{package}/msg/{short}")
        found.update({key.replace("/msg/", f"/{kind}/"): value for key, value in parsed.items()})
        for used in _USED.findall(text):
            if (part := used.replace("/", "/msg/", 1)) in _MESSAGES:
                _register(part)
    type_store().register(found)


def _register_if_ours(type_name: str) -> None:
    if type_name in _MESSAGES:
        _register(type_name)
    elif "/srv/" in type_name or "/action/" in type_name:
        whole, _, end = type_name.rpartition("_")
        if end in (*_SERVICE_ENDS, *_ACTION_ENDS) and (whole in SERVICES or whole in ACTIONS):
            _register(whole)


def full_name(type_name: str) -> str:
    """`sensor_msgs/Imu` and `sensor_msgs/msg/Imu` are the same type.

    Raises:
        MessageError: no such type is known; names the closest.
    """
    store = type_store()
    package, _, rest = type_name.partition("/")
    long = f"{package}/msg/{rest}"
    for name in (type_name, long):
        _register_if_ours(name)
        if name in store.fielddefs:
            return name
    ours = [*_MESSAGES, *(f"{s}_{end}" for s in SERVICES for end in _SERVICE_ENDS)]
    ours += [f"{a}_{end}" for a in ACTIONS for end in _ACTION_ENDS]
    is_long = any(f"/{kind}/" in type_name for kind in ("msg", "srv", "action"))
    hint = did_you_mean(type_name if is_long else long, [*store.fielddefs, *ours])
    raise MessageError(f"no message type {type_name!r} is known; {hint}".rstrip("; "))


@cache
def type_of(type_name: str) -> type[Any]:
    """The dataclass of a message type; construct it directly where every microsecond counts."""
    known = _ros_store().types
    if type_name in known:
        return known[type_name]
    return type_store().types[full_name(type_name)]


@cache
def types_of(*type_names: str) -> tuple[type[Any], ...]:
    """The dataclasses of several types. The first one there ever was takes 0.2 s: ask when a message is to be made."""
    return tuple(map(type_of, type_names))


@cache
def definition(type_name: str) -> str:
    """The `ros2msg` text of a type, with those of all types it uses."""
    return type_store().generate_msgdef(full_name(type_name), ros_version=2)[0]


@cache
def rihs(type_name: str) -> str:
    """The type hash as ROS 2 writes it (`RIHS01_…`)."""
    return type_store().hash_rihs01(full_name(type_name))
