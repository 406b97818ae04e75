"""Waits and timers of rospy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from simkit_nodes.interfaces import ros1_time
from simkit_nodes.ros1_modules.rospy.ros_node import ros_node
from simkit_nodes.ros1_modules.rospy.rostime import Duration, Time, get_rostime, nanoseconds

__all__ = ["Rate", "Timer", "TimerEvent", "sleep"]

_NANOSECONDS: Final = 1_000_000_000


def sleep(duration: float | ros1_time.Duration) -> None:
    """Wait for a duration [s].

    Raises:
        ROSInterruptException: the node was shut down.
    """
    ros_node().sleep(nanoseconds(duration))


class Rate:
    """Clock of a loop.

    Args:
        hz: rate of the loop [Hz].
        reset: accepted as in rospy; simulated time does not jump back while a program runs.

    Attributes:
        last_time: time at which the present turn of the loop began.
        sleep_dur: duration of a turn.
    """

    def __init__(self, hz: float, reset: bool = False) -> None:
        self.last_time: Time = get_rostime()
        self.sleep_dur = Duration(0, int(_NANOSECONDS / hz))

    def remaining(self) -> Duration:
        """Return the time until the end of the turn; negative after it."""
        return self._remaining(get_rostime())

    def _remaining(self, now: Time) -> Duration:
        if self.last_time > now:
            self.last_time = now
        passed: Duration = now - self.last_time
        return self.sleep_dur - passed

    def sleep(self) -> None:
        """Wait for the end of the turn.

        After a turn of more than twice the duration, the next one begins anew instead of catching up.

        Raises:
            ROSInterruptException: the node was shut down.
        """
        now = get_rostime()
        sleep(self._remaining(now))
        self.last_time += self.sleep_dur
        if now - self.last_time > self.sleep_dur * 2:
            self.last_time = now


@dataclass
class TimerEvent:
    """Times of a call of a timer's function.

    Attributes:
        last_expected: time at which the call before was due; None at the first call.
        last_real: time at which the call before was made.
        current_expected: time at which this call is due.
        current_real: time at which this call is made.
        last_duration: duration of the call before [s].
    """

    last_expected: Time | None
    last_real: Time | None
    current_expected: Time
    current_real: Time
    last_duration: float | None


class Timer:
    """Function that a thread calls again and again, for the first time after one period.

    Args:
        period: time between the calls.
        callback: function of a `TimerEvent`.
        oneshot: True for a single call.
        reset: accepted as in rospy.
    """

    def __init__(
        self,
        period: ros1_time.Duration,
        callback: Callable[[TimerEvent], object],
        oneshot: bool = False,
        reset: bool = False,
    ) -> None:
        self._period, self._callback, self._oneshot = Duration(period.secs, period.nsecs), callback, oneshot
        self._is_stopped = False
        self.daemon = True
        self.name = f"timer {getattr(callback, '__name__', '')}".strip()
        self._thread: Any = ros_node().start_thread(self.run, self.name)

    def shutdown(self) -> None:
        """Stop the calls."""
        self._is_stopped = True

    def is_alive(self) -> bool:
        """Check whether calls may follow."""
        return not self._thread.is_done

    def join(self, timeout: float | None = None) -> None:
        """Wait for the end of the calls, at most for a time [s]."""
        node = ros_node()
        until = None if timeout is None else node.host.now_ns() + nanoseconds(timeout)
        node.wait(until, lambda: bool(self._thread.is_done))

    def _has_ended(self) -> bool:
        return self._is_stopped or ros_node().is_shutdown

    def run(self) -> None:
        """Call the function until the timer is stopped; the function of the thread."""
        rate = Rate(1.0 / self._period.to_sec())
        expected = get_rostime() + self._period
        last_expected: Time | None = None
        last_real: Time | None = None
        last_duration: float | None = None
        while not self._has_ended():
            rate.sleep()
            if self._has_ended():
                break
            real = get_rostime()
            self._callback(TimerEvent(last_expected, last_real, expected, real, last_duration))
            if self._oneshot:
                break
            last_duration = (get_rostime() - real).to_sec()
            last_expected, last_real = expected, real
            expected += self._period
