"""Base classes of messages of ROS 1, and their text format."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from simkit_nodes.interfaces import ProgramMessage
from simkit_nodes.interfaces.ros1_message import (
    DeserializationError,
    Message,
    MessageException,
    SerializationError,
    check_type,
    strify_message,
)
from simkit_nodes.interfaces.ros1_messages import message_of_type
from simkit_nodes.interfaces.ros1_time import TVal

__all__ = [
    "DeserializationError",
    "Message",
    "MessageException",
    "ROSMessageException",
    "SerializationError",
    "check_type",
    "fill_message_args",
    "strify_message",
]


class ROSMessageException(MessageException):
    """Values do not fit the fields of a message."""


def fill_message_args(msg: ProgramMessage, msg_args: Any, keys: Mapping[str, Any] | None = None) -> None:
    """Set the fields of a message from values as in a YAML text.

    Args:
        msg: message.
        msg_args: dictionary of fields, or list of the values of all fields.
        keys: values for words such as `now` in place of a time.

    Raises:
        ROSMessageException: a field is unknown, or the number of values is wrong.
    """
    if len(msg_args) == 1 and isinstance(msg_args, (list, tuple)) and isinstance(msg_args[0], dict):
        msg_args = msg_args[0]
    _fill(msg, msg_args, keys or {})


def _fill(message: ProgramMessage, values: Any, keys: Mapping[str, Any]) -> None:
    slots = list(message.__slots__)
    if not isinstance(values, dict):
        if len(values) != len(slots):
            raise ROSMessageException(f"{len(slots)} values are needed for {slots}, but there are {len(values)}")
        values = dict(zip(slots, values, strict=True))
    types = dict(zip(slots, message._get_types(), strict=True))
    for name, value in values.items():
        if name not in types:
            raise ROSMessageException(f"No field name [{name}] in {message._type}; it has {slots}")
        setattr(message, name, _filled(getattr(message, name), types[name], value, keys))


def _filled(present: Any, kind: str, value: Any, keys: Mapping[str, Any]) -> Any:
    """Return the value of a field."""
    if isinstance(value, str) and value in keys and not isinstance(present, str):
        return keys[value]
    if isinstance(present, TVal) and isinstance(value, dict):
        return type(present)(value.get("secs", 0), value.get("nsecs", 0))
    if isinstance(present, TVal):
        return value if isinstance(value, TVal) else type(present)(value)
    if isinstance(present, Message):
        _fill(present, value, keys)
        return present
    item = kind.partition("[")[0]
    if "/" in item:  # a list of messages
        messages = [message_of_type(item) for _ in value]
        for message, fields in zip(messages, value, strict=True):
            _fill(message, fields, keys)
        return messages
    return value
