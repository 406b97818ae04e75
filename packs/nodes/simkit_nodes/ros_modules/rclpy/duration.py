"""Durations."""

from __future__ import annotations

from functools import total_ordering
from typing import Any

from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.rclpy.constants import S_TO_NS

__all__ = ["Duration", "Infinite"]

_Message = ROS2.message_class("builtin_interfaces/msg/Duration")


@total_ordering
class Duration:
    """Length of time.

    Args:
        seconds: seconds; a fraction counts.
        nanoseconds: further nanoseconds; a fraction is dropped.
    """

    def __init__(self, *, seconds: float = 0, nanoseconds: int = 0) -> None:
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if not -(2**63) <= total < 2**63:
            raise OverflowError("Total nanoseconds value is too large to store in C duration.")
        self._nanoseconds = total

    @property
    def nanoseconds(self) -> int:
        """Length [ns]."""
        return self._nanoseconds

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self._nanoseconds})"

    def __str__(self) -> str:
        return "Infinite" if self == Infinite else f"{self._nanoseconds} nanoseconds"

    def __eq__(self, other: object) -> bool:
        return self._nanoseconds == other._nanoseconds if isinstance(other, Duration) else NotImplemented

    def __lt__(self, other: object) -> bool:
        return self._nanoseconds < other._nanoseconds if isinstance(other, Duration) else NotImplemented

    def to_msg(self) -> Any:
        """Return the message `builtin_interfaces.msg.Duration`."""
        seconds, nanoseconds = divmod(self._nanoseconds, S_TO_NS)
        return _Message(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: object) -> Duration:
        """Return the duration of a message.

        Raises:
            TypeError: the object is no `builtin_interfaces.msg.Duration`.
        """
        if not isinstance(msg, _Message):
            raise TypeError("Must pass a builtin_interfaces.msg.Duration object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)


Infinite = Duration(nanoseconds=2**63 - 1)
