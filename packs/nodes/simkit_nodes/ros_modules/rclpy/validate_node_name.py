"""Check of the name of a node."""

from __future__ import annotations

from typing import Literal

from simkit_nodes.names import node_name_error
from simkit_nodes.ros_modules.rclpy.exceptions import InvalidNodeNameException

__all__ = ["validate_node_name"]


def validate_node_name(node_name: str) -> Literal[True]:
    """Check the name of a node.

    Raises:
        InvalidNodeNameException: the name is invalid.
    """
    error = node_name_error(node_name)
    if error is not None:
        raise InvalidNodeNameException(node_name, *error)
    return True
