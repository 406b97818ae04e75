"""Exceptions of rospy."""

from __future__ import annotations

__all__ = [
    "ROSException",
    "ROSInitException",
    "ROSInternalException",
    "ROSInterruptException",
    "ROSSerializationException",
    "ROSTimeMovedBackwardsException",
    "TransportException",
    "TransportInitError",
    "TransportTerminated",
]


class ROSException(Exception):
    """Base of the exceptions of rospy."""


class ROSSerializationException(ROSException):
    """A field of a message has a value that its type does not have."""


class ROSInitException(ROSException):
    """`init_node` was not called, or cannot be executed."""


class ROSInterruptException(ROSException, KeyboardInterrupt):
    """The node was shut down during a wait."""


class ROSTimeMovedBackwardsException(ROSInterruptException):
    """The time has jumped back during a wait.

    Args:
        time: size of the jump [s].
    """

    def __init__(self, time: float) -> None:
        self.time = time
        super().__init__("ROS time moved backwards")


class ROSInternalException(Exception):
    """Base of the exceptions of rospy's internals."""


class TransportException(ROSInternalException):
    """Fault of a connection."""


class TransportTerminated(TransportException):
    """The connection has ended."""


class TransportInitError(TransportException):
    """The connection cannot be opened."""
