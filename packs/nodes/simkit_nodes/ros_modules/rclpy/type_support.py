"""Checks of the classes of messages and services, with rclpy's errors."""

from __future__ import annotations

from simkit.errors import ArgumentTypeError
from simkit_nodes.interfaces import type_name_of

__all__ = ["check_for_type_support", "check_is_valid_msg_type", "check_is_valid_srv_type"]


def check_for_type_support(msg_or_srv_type: object) -> None:
    """Check whether a class is one of a message, a service or an action of ROS 2.

    Raises:
        AttributeError: it is another class.
    """
    try:
        type_name_of(msg_or_srv_type)
    except ArgumentTypeError:
        raise AttributeError(
            f"type object '{type(msg_or_srv_type).__name__}' has no attribute '_TYPE_SUPPORT' This might be a ROS 1 "
            "message type but it should be a ROS 2 message type. Make sure to source your ROS 2 workspace after your "
            "ROS 1 workspace."
        ) from None


def check_is_valid_msg_type(msg_type: object) -> None:
    """Check whether a class is one of a message.

    Raises:
        AttributeError: it is no class of ROS 2.
        RuntimeError: it is the class of a service or an action.
    """
    check_for_type_support(msg_type)
    if hasattr(msg_type, "Request") or hasattr(msg_type, "Goal"):
        text = f"The message type provided is not valid ({msg_type}), this might be a service or action"
        raise RuntimeError(text)


def check_is_valid_srv_type(srv_type: object) -> None:
    """Check whether a class is one of a service.

    Raises:
        AttributeError: it is no class of ROS 2.
        RuntimeError: it is the class of a message or an action.
    """
    check_for_type_support(srv_type)
    if not (hasattr(srv_type, "Request") and hasattr(srv_type, "Response")):
        text = f"The service type provided is not valid ({srv_type}), this might be a message or action"
        raise RuntimeError(text)
