"""Check of the name of a topic or service as a program writes it."""

from __future__ import annotations

from typing import Literal

from simkit_nodes.names import topic_name_error
from simkit_nodes.ros_modules.rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException

__all__ = ["TOPIC_SEPARATOR_STRING", "validate_topic_name"]

TOPIC_SEPARATOR_STRING = "/"


def validate_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Check the name of a topic or service as a program writes it.

    Args:
        name: name of a topic or service.
        is_service: True for the exception of a service.

    Raises:
        InvalidTopicNameException, InvalidServiceNameException: the name is invalid.
    """
    error = topic_name_error(name)
    if error is not None:
        raise (InvalidServiceNameException if is_service else InvalidTopicNameException)(name, *error)
    return True
