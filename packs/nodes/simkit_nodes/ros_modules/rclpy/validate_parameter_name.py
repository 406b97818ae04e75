"""Check of the name of a parameter."""

from __future__ import annotations

from typing import Literal

from simkit_nodes.ros_modules.rclpy.exceptions import InvalidParameterException

__all__ = ["validate_parameter_name"]


def validate_parameter_name(name: str) -> Literal[True]:
    """Check the name of a parameter.

    Raises:
        InvalidParameterException: the name is empty.
    """
    if not name:
        raise InvalidParameterException(name)
    return True
