"""ROS 2 messages: dataclasses from the package rosbags, built from plain values and serialised as CDR.

    msgs.make("geometry_msgs/msg/Twist", linear={"x": 0.2})
    msgs.type_of("sensor_msgs/msg/Imu")  # the class itself; calling it is faster than `make`
    msgs.header(sim.time_ns, "imu_link")
    msgs.add("my_msgs/msg/Num", "int64 num")  # a type of one's own
    msgs.image(message)  # a NumPy array; also `points`, `pose` and `yaw`

This package builds, encodes and decodes messages, and formats messages and definitions as text. It does not depend on
topics, simulations or bags. `import simkit.msgs` imports neither rosbags nor NumPy.
"""

from __future__ import annotations

import importlib
import struct
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Protocol, overload

from simkit.argument_checks import checked_integer
from simkit.errors import ArgumentTypeError, MessageError, NoMessageError
from simkit.msgs.cdr_serializer import SizeMismatch, make_serializer
from simkit.msgs.message_types import (
    M,
    Message,
    class_names,
    definition,
    full_name,
    message_class,
    named_type,
    type_of,
    type_store,
    types_of,
)
from simkit.msgs.own_interfaces import add
from simkit.msgs.topic_names import absolute_name, valid_topic
from simkit.msgs.type_hashes import rihs

if TYPE_CHECKING:
    from simkit.msgs import message_classes
    from simkit.msgs.image_arrays import image, image_message
    from simkit.msgs.message_builder import MessageBuilder
    from simkit.msgs.message_classes import *  # noqa: F403
    from simkit.msgs.message_classes import Duration, Header, Time
    from simkit.msgs.message_types import FieldValue
    from simkit.msgs.point_arrays import points
    from simkit.msgs.pose_messages import pose, pose_message, yaw

__all__ = [
    "Message",
    "absolute_name",
    "add",
    "definition",
    "deserialize",
    "duration",
    "from_dict",
    "full_name",
    "header",
    "headers",
    "image",
    "image_message",
    "make",
    "points",
    "pose",
    "pose_message",
    "rihs",
    "serialize",
    "stamp",
    "stamp_ns",
    "time",
    "type_name",
    "type_of",
    "type_store",
    "types_of",
    "valid_topic",
    "yaw",
]
if TYPE_CHECKING:
    __all__ += message_classes.__all__


class _Timed(Protocol):
    """Simulation, or another object with a simulated time."""

    @property
    def time_ns(self) -> int:
        """Simulated time [ns]."""


_NS = 1_000_000_000
_SERIALIZERS: dict[type[Message], Callable[[Message], bytes]] = {}  # by class: the fastest way to find one

_CONVERSIONS = {
    "image": "simkit.msgs.image_arrays",
    "image_message": "simkit.msgs.image_arrays",
    "points": "simkit.msgs.point_arrays",
    "pose": "simkit.msgs.pose_messages",
    "pose_message": "simkit.msgs.pose_messages",
    "yaw": "simkit.msgs.pose_messages",
}
"""Modules of the functions that convert messages; they need NumPy."""

if not TYPE_CHECKING:  # hidden from type checkers, so that they report unknown classes

    def __getattr__(name: str) -> type[Message] | Callable[..., object]:
        # stored as a global, because each lookup through this function would take 2 µs
        module = _CONVERSIONS.get(name)
        value = message_class(name) if module is None else getattr(importlib.import_module(module), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*__all__, *class_names()})


@cache
def _builder_of() -> Callable[[str], MessageBuilder]:
    """Return `message_builder.builder_of`. It is imported late, because reading a simulation's state needs no NumPy."""
    from simkit.msgs.message_builder import builder_of

    return builder_of


def _serializer_of(message: Message) -> Callable[[Message], bytes]:
    """Return the serialiser of a message, and keep it for messages of the same class."""
    serializer = make_serializer(full_name(type_name(message)))
    if hasattr(type(message), "__msgtype__"):
        _SERIALIZERS[type(message)] = serializer
    return serializer


@overload
def make(type_name: type[M], /, **fields: FieldValue) -> M: ...


@overload
def make(type_name: str, /, **fields: FieldValue) -> Message: ...


def make(type_name: str | type, /, **fields: FieldValue) -> Message:
    """Build a message. Missing fields are zero (a quaternion's w is 1), dicts become messages, numbers become arrays.

    Args:
        type_name: type, such as `geometry_msgs/msg/Twist`, or class, such as `msgs.Twist`.
        fields: values of fields by name.

    Raises:
        MessageError: the type or a field is unknown (the message suggests the closest name), or a value does not match.
    """
    if not isinstance(type_name, str):
        if not isinstance(type_name, type):
            raise NoMessageError(f"the type of a message must be a text or a class, got {type_name!r:.60}")
        type_name = named_type(type_name)
    return _builder_of()(type_name).build(fields)


def from_dict(type_names: Sequence[str], values: Mapping[str, FieldValue]) -> Message:
    """Build a message of the first type that the values match.

    Raises:
        MessageError: the values match no type; the message has the error of the first type and the other types' names.
    """
    first: MessageError | None = None
    for name in type_names:
        try:
            return _builder_of()(name).build(values)
        except MessageError as error:
            first = first or error
    if first is None:
        raise MessageError("this topic accepts no message type")
    others = f" (also tried: {', '.join(type_names[1:])})" if len(type_names) > 1 else ""
    raise MessageError(f"{first}{others}")


def type_name(message: Message) -> str:
    """Return the ROS type name of a message object, such as `sensor_msgs/msg/Imu`.

    Raises:
        MessageError: the object is not a message.
    """
    name = getattr(message, "__msgtype__", None)
    if not isinstance(name, str):
        raise NoMessageError(
            f"{type(message).__name__} is not a message; use simkit.msgs.make(...) or a dict of its fields"
        )
    return name


@cache
def _stamp_types() -> tuple[type[Time], type[Duration], type[Header]]:
    return (
        type_of("builtin_interfaces/msg/Time"),
        type_of("builtin_interfaces/msg/Duration"),
        type_of("std_msgs/msg/Header"),
    )


def time(ns: int) -> Time:
    """Return a `builtin_interfaces/msg/Time` of `ns` nanoseconds."""
    return _stamp_types()[0](*divmod(ns if type(ns) is int else checked_integer(ns, "ns"), _NS))


def duration(ns: int) -> Duration:
    """Return a `builtin_interfaces/msg/Duration` of `ns` nanoseconds."""
    return _stamp_types()[1](*divmod(ns if type(ns) is int else checked_integer(ns, "ns"), _NS))


def header(time_ns: int, frame_id: str) -> Header:
    """Return a `std_msgs/msg/Header` stamped with `time_ns` [ns]."""
    stamp, _, header_type = _stamp_types()
    return header_type(stamp(time_ns // _NS, time_ns % _NS), frame_id)


def headers(time_ns: int) -> Callable[[str], Header]:
    """Return a function that makes headers with one time for different frames; faster than `header`."""
    stamp, _, header_type = _stamp_types()
    seconds, rest = divmod(time_ns, _NS)
    return lambda frame_id: header_type(stamp(seconds, rest), frame_id)


def stamp(sim: _Timed) -> Time:
    """Return the time of a simulation as a `builtin_interfaces/msg/Time`, for the header of a message.

    Raises:
        ArgumentTypeError: the value is not a simulation.
    """
    now = getattr(sim, "time_ns", None)
    if not isinstance(now, int):
        raise ArgumentTypeError(f"a stamp needs a simulation, got {type(sim).__name__}; for nanoseconds use msgs.time")
    return time(now)


def stamp_ns(stamp: Time | Duration) -> int:
    """Return the nanoseconds of a Time or Duration message."""
    return int(stamp.sec) * _NS + int(stamp.nanosec)


def serialize(message: Message) -> bytes:
    """Serialise a message as little-endian CDR, as ROS 2 sends it.

    Raises:
        MessageError: the value of a field does not match its type.
    """
    serializer = _SERIALIZERS.get(type(message)) or _serializer_of(message)
    try:
        return serializer(message)
    except SizeMismatch as error:
        raise MessageError(f"{type_name(message)} cannot be serialised: {error}") from None
    except (struct.error, TypeError, ValueError, AttributeError, OverflowError):
        raise MessageError(f"{type_name(message)} cannot be serialised: {_field_fault(message)}") from None


def _field_fault(message: Message) -> str:
    """Return which field of a message has a value that does not match its type."""
    from simkit.msgs.message_text import message_to_dict

    try:
        _builder_of()(type_name(message)).build(message_to_dict(message))
    except MessageError as error:
        return str(error)
    except Exception:  # noqa: BLE001 - a field may hold any object
        pass
    return "a field has a value that does not match its type"


@overload
def deserialize(data: bytes | memoryview, type_name: type[M]) -> M: ...


@overload
def deserialize(data: bytes | memoryview, type_name: str) -> Message: ...


def deserialize(data: bytes | memoryview, type_name: str | type) -> Message:
    """Decode a message that `serialize` encoded; its type is given by name or by class.

    Raises:
        MessageError: the type is unknown.
    """
    return type_store().deserialize_cdr(data, full_name(named_type(type_name)))
