"""Messages as bytes."""

from __future__ import annotations

from typing import Any

from simkit import msgs
from simkit_nodes.interfaces import ROS2, type_name_of

__all__ = ["deserialize_message", "serialize_message"]


def serialize_message(message: object) -> bytes:
    """Return the bytes of a message, in CDR."""
    return msgs.serialize(ROS2.to_simkit(type_name_of(message))(message))


def deserialize_message(serialized_message: bytes, message_type: object) -> Any:
    """Return the message of bytes.

    Args:
        serialized_message: message in CDR.
        message_type: class of the message.
    """
    type_name = type_name_of(message_type)
    return ROS2.to_program(type_name)(msgs.deserialize(bytes(serialized_message), type_name))
