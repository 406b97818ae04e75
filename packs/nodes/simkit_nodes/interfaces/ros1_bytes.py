"""Bytes of ROS 1 messages: numbers in little-endian order without gaps, and texts and sequences after their length."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, Final

from simkit_nodes.interfaces.ros1_message import DeserializationError, Message, SerializationError
from simkit_nodes.interfaces.ros1_time import Duration, Time

_CODES: Final = {
    "bool": "?",
    "byte": "b",
    "char": "B",
    "int8": "b",
    "uint8": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}
_OCTETS: Final = ("uint8", "char")


def message_bytes(message: Message) -> bytes:
    """Return the bytes of a message.

    Raises:
        SerializationError: a field has a value that its type does not have.
    """
    parts: list[bytes] = []
    try:
        _write(parts, message)
    except (struct.error, TypeError, ValueError, AttributeError) as error:
        message._check_types(error)
        raise SerializationError(str(error)) from None
    return b"".join(parts)


def _write(parts: list[bytes], message: Message) -> None:
    for name, kind in zip(message.__slots__, message._get_types(), strict=True):
        _write_value(parts, kind, getattr(message, name))


def _write_value(parts: list[bytes], kind: str, value: Any) -> None:
    item, is_list, size = kind.partition("[")
    if is_list:
        if size == "]":
            parts.append(struct.pack("<I", len(value)))
        if item in _CODES:
            parts.append(bytes(value) if item in _OCTETS else struct.pack(f"<{len(value)}{_CODES[item]}", *value))
        else:
            for entry in value:
                _write_value(parts, item, entry)
    elif kind in _CODES:
        parts.append(struct.pack(f"<{_CODES[kind]}", value))
    elif kind == "string":
        data = value if isinstance(value, bytes) else value.encode()
        parts.append(struct.pack("<I", len(data)) + data)
    elif kind in ("time", "duration"):
        parts.append(struct.pack("<II" if kind == "time" else "<ii", value.secs, value.nsecs))
    else:
        _write(parts, value)


MakeMessage = Callable[[str], Message]
"""Function that returns a new message of a type such as `geometry_msgs/Point`."""


def fill_message(message: Message, data: bytes, make_message: MakeMessage) -> None:
    """Set the fields of a message to those that its bytes have.

    Args:
        message: message.
        data: bytes.
        make_message: function that creates the messages in it.

    Raises:
        DeserializationError: the bytes are no message of this type.
    """
    try:
        end = _read(message, data, 0, make_message)
    except (struct.error, UnicodeDecodeError) as error:
        raise DeserializationError(str(error)) from None
    if end > len(data):
        raise DeserializationError(f"the message has {end} bytes or more, but there are {len(data)}")


def _read(message: Any, data: bytes, offset: int, make_message: MakeMessage) -> int:
    """Set the fields of a message, and return the offset of the first byte after it."""
    for name, kind in zip(message.__slots__, message._get_types(), strict=True):
        value, offset = _read_value(data, offset, kind, make_message)
        setattr(message, name, value)
    return offset


def _read_value(data: bytes, offset: int, kind: str, make_message: MakeMessage) -> tuple[Any, int]:
    item, is_list, size = kind.partition("[")
    if is_list:
        count = int(size[:-1] or -1)
        if count < 0:
            (count,) = struct.unpack_from("<I", data, offset)
            offset += 4
        if item in _OCTETS:
            return data[offset : offset + count], offset + count
        if item in _CODES:
            form = f"<{count}{_CODES[item]}"
            return struct.unpack_from(form, data, offset), offset + struct.calcsize(form)
        values = []
        for _ in range(count):
            value, offset = _read_value(data, offset, item, make_message)
            values.append(value)
        return values, offset
    if kind in _CODES:
        (value,) = struct.unpack_from(f"<{_CODES[kind]}", data, offset)
        return value, offset + struct.calcsize(_CODES[kind])
    if kind == "string":
        (count,) = struct.unpack_from("<I", data, offset)
        offset += 4
        return data[offset : offset + count].decode(), offset + count
    if kind in ("time", "duration"):
        value = Time() if kind == "time" else Duration()
        value.set(*struct.unpack_from("<II" if kind == "time" else "<ii", data, offset))
        return value, offset + 8
    value = make_message(kind)
    return value, _read(value, data, offset, make_message)
