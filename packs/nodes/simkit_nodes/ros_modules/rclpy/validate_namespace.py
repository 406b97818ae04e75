"""Check of an absolute namespace."""

from __future__ import annotations

from typing import Literal

from simkit_nodes.names import namespace_error
from simkit_nodes.ros_modules.rclpy.exceptions import InvalidNamespaceException

__all__ = ["validate_namespace"]


def validate_namespace(namespace: str) -> Literal[True]:
    """Check an absolute namespace.

    Raises:
        InvalidNamespaceException: the name is invalid.
    """
    error = namespace_error(namespace)
    if error is not None:
        raise InvalidNamespaceException(namespace, *error)
    return True
