"""Times and durations of rospy."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ros1_time
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node

__all__ = [
    "Duration",
    "Time",
    "get_rostime",
    "get_time",
    "is_rostime_initialized",
    "is_wallclock",
    "wallsleep",
]


class Duration(ros1_time.Duration):
    """Difference of two times; may be negative."""

    __slots__ = ()

    def __repr__(self) -> str:
        return f"rospy.Duration[{self.to_nsec()}]"


class Time(ros1_time.Time):
    """Time of the clock; in lock-step the simulated time."""

    __slots__ = ()

    def __repr__(self) -> str:
        return f"rospy.Time[{self.to_nsec()}]"

    @staticmethod
    def now() -> Time:
        """Return the present time.

        Raises:
            ROSInitException: the program has not called `init_node`.
        """
        return get_rostime()

    @classmethod
    def from_seconds(cls, float_secs: float) -> Time:
        """Return the time of a number of seconds."""
        return cls.from_sec(float_secs)


def get_rostime() -> Time:
    """Return the present time.

    Raises:
        ROSInitException: the program has not called `init_node`.
    """
    node = ros_node()
    node.check_is_initialized()
    node.poll()
    return Time(0, node.host.now_ns())


def get_time() -> float:
    """Return the present time [s]."""
    return get_rostime().to_sec()


def is_rostime_initialized() -> bool:
    """Check whether the program has called `init_node`."""
    return ros_node().is_initialized


def is_wallclock() -> bool:
    """Check whether the clock is that of the wall."""
    return not ros_node().parameters.has("/use_sim_time")


def wallsleep(duration: float) -> None:
    """Wait for a duration [s]; in lock-step of simulated time."""
    node = ros_node()
    node.wait(node.host.now_ns() + nanoseconds(duration))


def nanoseconds(duration: Any) -> int:
    """Return a duration of a program, a `Duration` or seconds, in nanoseconds."""
    if isinstance(duration, ros1_time.TVal):
        return duration.to_nsec()
    return ros1_time.Duration.from_sec(duration).to_nsec()


def limit_ns(timeout: object) -> int | None:
    """Return the time at which a wait of a program ends [ns]; None for a timeout that is None."""
    return None if timeout is None else ros_node().host.now_ns() + nanoseconds(timeout)
