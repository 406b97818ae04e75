"""Errors, states and functions that rclpy takes from its C implementation."""

from __future__ import annotations

import sys
from types import ModuleType

from simkit_nodes.ros_modules.rclpy.impl.logging_severity import LoggingSeverity
from simkit_nodes.ros_modules.rclpy.impl.rcutils_logger import effective_level, write

__all__ = [
    "InvalidHandle",
    "NodeNameNonExistentError",
    "RCLError",
    "RCLInvalidROSArgsError",
    "UnknownROSArgsError",
    "UnsupportedEventTypeError",
    "rclpy_implementation",
]


class RCLError(RuntimeError):
    """Error of ROS's client library, such as a message that is published after the shutdown."""


class RCLInvalidROSArgsError(RCLError):
    """Argument after `--ros-args` that cannot be read."""


class UnknownROSArgsError(RuntimeError):
    """Unknown argument after `--ros-args`."""


class UnsupportedEventTypeError(RCLError):
    """Event that does not exist."""


class NodeNameNonExistentError(RCLError):
    """Question about a node that does not exist."""


class InvalidHandle(Exception):
    """Use of a destroyed publisher, subscription, timer, node or similar object."""


class Handle:
    """State of an object that can be destroyed.

    Attributes:
        is_destroyed: True after `destroy`.
    """

    __slots__ = ("is_destroyed",)

    def __init__(self) -> None:
        self.is_destroyed = False

    @property
    def pointer(self) -> int:
        """Number that distinguishes the object from others."""
        return id(self)

    def __bool__(self) -> bool:
        return not self.is_destroyed

    def __enter__(self) -> Handle:
        if self.is_destroyed:
            raise InvalidHandle("cannot use Destroyable because destruction was requested")
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def destroy(self) -> None:
        """Mark the object as destroyed; a further call does nothing."""
        self.is_destroyed = True

    destroy_when_not_in_use = destroy


def rclpy_logging_rcutils_log(
    severity: int, name: str, message: str, function_name: str, file_name: str, line_number: int
) -> None:
    """Write a message to the log, if the level of its logger allows it."""
    if severity >= effective_level(name):
        write(LoggingSeverity(severity), name, message, file_name, function_name, line_number)


rclpy_implementation: ModuleType = sys.modules[__name__]
"""This module: programs read some errors and functions from it."""
