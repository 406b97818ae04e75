"""Classes of messages and services by the name of their type."""

from __future__ import annotations

from typing import Any

from simkit.errors import MessageError
from simkit_nodes.interfaces import ROS1
from simkit_nodes.interfaces.interface_classes import ros1_service
from simkit_nodes.interfaces.ros1_message import Message, SerializationError, strify_message
from simkit_nodes.ros1_modules.genpy.message import fill_message_args

__all__ = [
    "Message",
    "SerializationError",
    "fill_message_args",
    "get_message_class",
    "get_service_class",
    "strify_message",
]


def get_message_class(message_type: str, reload_on_error: bool = False) -> type[Any] | None:
    """Return the class of a message type such as `std_msgs/String`; None for an unknown type."""
    package, _, short = message_type.partition("/")
    try:
        return ROS1.message_class(f"{package or 'std_msgs'}/msg/{short or package}")
    except MessageError:
        return None


def get_service_class(service_type: str, reload_on_error: bool = False) -> type[Any] | None:
    """Return the class of a service type such as `std_srvs/Empty`; None for an unknown type."""
    package, _, short = service_type.partition("/")
    try:
        return ros1_service(f"{package}/srv/{short}")
    except MessageError:
        return None
