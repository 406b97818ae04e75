"""Points in time."""

from __future__ import annotations

from typing import Any, overload

from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.rclpy.clock_type import ClockType
from simkit_nodes.ros_modules.rclpy.constants import S_TO_NS
from simkit_nodes.ros_modules.rclpy.duration import Duration

__all__ = ["Time"]

_Message = ROS2.message_class("builtin_interfaces/msg/Time")


class Time:
    """Time of a clock.

    Args:
        seconds: seconds since the beginning of the clock; a fraction counts.
        nanoseconds: further nanoseconds.
        clock_type: kind of the clock; times of different kinds cannot be compared.
    """

    def __init__(
        self, *, seconds: float = 0, nanoseconds: int = 0, clock_type: ClockType = ClockType.SYSTEM_TIME
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if seconds < 0:
            raise ValueError("Seconds value must not be negative")
        if nanoseconds < 0:
            raise ValueError("Nanoseconds value must not be negative")
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if total >= 2**63:
            raise OverflowError("Total nanoseconds value is too large to store in C time point.")
        self._nanoseconds, self._clock_type = total, clock_type

    @property
    def nanoseconds(self) -> int:
        """Time since the beginning of the clock [ns]."""
        return self._nanoseconds

    @property
    def clock_type(self) -> ClockType:
        """Kind of the clock."""
        return self._clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Return the whole seconds and the further nanoseconds."""
        return divmod(self._nanoseconds, S_TO_NS)

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self._nanoseconds}, clock_type={self._clock_type.name})"

    def __add__(self, other: Duration) -> Time:
        if not isinstance(other, Duration):
            return NotImplemented
        try:
            return Time(nanoseconds=self._nanoseconds + other.nanoseconds, clock_type=self._clock_type)
        except OverflowError as error:
            raise OverflowError("Addition leads to overflow in C storage.") from error

    __radd__ = __add__

    @overload
    def __sub__(self, other: Time) -> Duration: ...

    @overload
    def __sub__(self, other: Duration) -> Time: ...

    def __sub__(self, other: Time | Duration) -> Time | Duration:
        if isinstance(other, Time):
            if self._clock_type != other._clock_type:
                raise TypeError("Can't subtract times with different clock types")
            return Duration(nanoseconds=self._nanoseconds - other._nanoseconds)
        if not isinstance(other, Duration):
            return NotImplemented
        try:
            return Time(nanoseconds=self._nanoseconds - other.nanoseconds, clock_type=self._clock_type)
        except ValueError as error:
            raise ValueError("Subtraction leads to negative time.") from error

    def _other_ns(self, other: Time) -> int:
        if self._clock_type != other._clock_type:
            raise TypeError("Can't compare times with different clock types")
        return other._nanoseconds

    def __eq__(self, other: object) -> bool:
        return self._nanoseconds == self._other_ns(other) if isinstance(other, Time) else NotImplemented

    def __lt__(self, other: object) -> bool:
        return self._nanoseconds < self._other_ns(other) if isinstance(other, Time) else NotImplemented

    def __le__(self, other: object) -> bool:
        return self._nanoseconds <= self._other_ns(other) if isinstance(other, Time) else NotImplemented

    def __gt__(self, other: object) -> bool:
        return self._nanoseconds > self._other_ns(other) if isinstance(other, Time) else NotImplemented

    def __ge__(self, other: object) -> bool:
        return self._nanoseconds >= self._other_ns(other) if isinstance(other, Time) else NotImplemented

    def to_msg(self) -> Any:
        """Return the message `builtin_interfaces.msg.Time`."""
        seconds, nanoseconds = self.seconds_nanoseconds()
        return _Message(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: object, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        """Return the time of a message.

        Args:
            msg: message `builtin_interfaces.msg.Time`, such as `header.stamp`.
            clock_type: kind of the clock.

        Raises:
            TypeError: the object is no such message.
        """
        if not isinstance(msg, _Message):
            raise TypeError("Must pass a builtin_interfaces.msg.Time object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)
