"""Check of the absolute name of a topic or service."""

from __future__ import annotations

from typing import Literal

from simkit_nodes.names import full_topic_name_error
from simkit_nodes.ros_modules.rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException

__all__ = ["validate_full_topic_name"]


def validate_full_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Check the absolute name of a topic or service.

    Args:
        name: name of a topic or service.
        is_service: True for the exception of a service.

    Raises:
        InvalidTopicNameException, InvalidServiceNameException: the name is invalid.
    """
    error = full_topic_name_error(name)
    if error is not None:
        raise (InvalidServiceNameException if is_service else InvalidTopicNameException)(name, *error)
    return True
