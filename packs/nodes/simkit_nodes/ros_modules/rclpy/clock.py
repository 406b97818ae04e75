"""Clocks. In lock-step, all of them show simulated time."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from simkit_nodes.host import current_host
from simkit_nodes.ros_modules.rclpy.clock_type import ClockType
from simkit_nodes.ros_modules.rclpy.duration import Duration
from simkit_nodes.ros_modules.rclpy.exceptions import NotInitializedException
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle
from simkit_nodes.ros_modules.rclpy.time import Time
from simkit_nodes.ros_modules.rclpy.utilities import get_default_context

if TYPE_CHECKING:
    from simkit_nodes.host import Host
    from simkit_nodes.ros_modules.rclpy.context import Context

__all__ = ["Clock", "ClockChange", "ClockType", "JumpHandle", "JumpThreshold", "ROSClock", "TimeJump"]


class ClockChange(IntEnum):
    """Change of the time source of a clock."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


class JumpThreshold:
    """Smallest jumps that are reported.

    Args:
        min_forward: positive duration, or None.
        min_backward: negative duration, or None.
        on_clock_change: True if a change of the time source is reported.
    """

    def __init__(
        self, *, min_forward: Duration | None, min_backward: Duration | None, on_clock_change: bool = True
    ) -> None:
        if min_forward is not None and min_forward.nanoseconds <= 0:
            raise ValueError("min_forward must be a positive non-zero duration")
        if min_backward is not None and min_backward.nanoseconds >= 0:
            raise ValueError("min_backward must be a negative non-zero duration")
        if min_forward is None and min_backward is None and not on_clock_change:
            raise ValueError("At least one jump threshold must be enabled")
        self.min_forward, self.min_backward, self.on_clock_change = min_forward, min_backward, on_clock_change


class TimeJump:
    """Jump of a clock.

    Args:
        clock_change: change of the time source.
        delta: new time minus old time.
    """

    def __init__(self, clock_change: ClockChange, delta: Duration) -> None:
        if not isinstance(clock_change, ClockChange):
            raise TypeError("clock_change must be an instance of rclpy.clock.ClockChange")
        self._clock_change, self._delta = clock_change, delta

    @property
    def clock_change(self) -> ClockChange:
        """Change of the time source."""
        return self._clock_change

    @property
    def delta(self) -> Duration:
        """New time minus old time."""
        return self._delta


class JumpHandle:
    """Callbacks for the jumps of a clock; see `Clock.create_jump_callback`."""

    def __init__(
        self,
        *,
        clock: Clock,
        threshold: JumpThreshold,
        pre_callback: Callable[[], object] | None,
        post_callback: Callable[[TimeJump], object] | None,
    ) -> None:
        if pre_callback is None and post_callback is None:
            raise ValueError("One of pre_callback or post_callback must be callable")
        if pre_callback is not None and not callable(pre_callback):
            raise ValueError("pre_callback must be callable if given")
        if post_callback is not None and not callable(post_callback):
            raise ValueError("post_callback must be callable if given")
        self._clock: Clock | None = clock
        self._threshold, self.pre_callback, self.post_callback = threshold, pre_callback, post_callback
        clock._jump_handles.append(self)

    def reports(self, change: ClockChange, delta_ns: int) -> bool:
        """Check whether a jump is as large as the threshold."""
        if change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED):
            return self._threshold.on_clock_change
        forward, backward = self._threshold.min_forward, self._threshold.min_backward
        if delta_ns > 0:
            return forward is not None and delta_ns >= forward.nanoseconds
        return backward is not None and delta_ns <= backward.nanoseconds

    def unregister(self) -> None:
        """Remove the callbacks."""
        if self._clock is not None:
            self._clock._jump_handles.remove(self)
            self._clock = None

    def __enter__(self) -> JumpHandle:
        return self

    def __exit__(self, *_: object) -> None:
        self.unregister()


class Clock:
    """Clock.

    Args:
        clock_type: kind of the clock; `ROS_TIME` makes a `ROSClock`.
    """

    _clock_type: ClockType
    _handle: Handle
    _jump_handles: list[JumpHandle]
    _host: Host

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> Clock:
        """Make a clock of a kind."""
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        self: Clock = super().__new__(ROSClock if clock_type is ClockType.ROS_TIME else cls)
        self._clock_type, self._handle, self._jump_handles = clock_type, Handle(), []
        self._host = current_host()
        return self

    @property
    def clock_type(self) -> ClockType:
        """Kind of the clock."""
        return self._clock_type

    @property
    def handle(self) -> Handle:
        """State of the clock."""
        return self._handle

    def __repr__(self) -> str:
        return f"Clock(clock_type={self._clock_type.name})"

    def _now_ns(self) -> int:
        return self._host.now_ns()

    def _host_ns(self, time_ns: int) -> int | None:
        """Return the time of the host at which the clock shows a time [ns]; None if that is unknown."""
        return time_ns

    def now(self) -> Time:
        """Return the time."""
        self._host.poll()
        return Time(nanoseconds=self._now_ns(), clock_type=self._clock_type)

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], object] | None = None,
        post_callback: Callable[[TimeJump], object] | None = None,
    ) -> JumpHandle:
        """Call functions before and after a jump of the clock; keep the returned object.

        Args:
            threshold: smallest jumps.
            pre_callback: function that is called before the jump.
            post_callback: function that receives the jump.
        """
        return JumpHandle(clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=post_callback)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Wait until a time of this clock.

        Returns:
            True at that time; False if the context has ended before.

        Raises:
            NotInitializedException: the context has not begun or has ended.
            ValueError: the time belongs to another kind of clock.
        """
        context = get_default_context() if context is None else context
        if not context.is_valid:
            raise NotInitializedException
        if until.clock_type != self._clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        host = self._host
        is_over = False

        def has_come() -> bool:
            return is_over or not context.is_valid or self._now_ns() >= until.nanoseconds

        def on_jump(jump: TimeJump) -> None:
            nonlocal is_over
            is_over = True
            host.wake()

        threshold = JumpThreshold(min_forward=None, min_backward=None, on_clock_change=True)
        with self.create_jump_callback(threshold, post_callback=on_jump):
            while not has_come():
                host.wait(self._host_ns(until.nanoseconds), has_come)
        return context.is_valid and not is_over

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Wait for a duration; see `sleep_until`."""
        return self.sleep_until(self.now() + rel_time, context)


class ROSClock(Clock):
    """Clock of a node: the time of `/clock` if the parameter `use_sim_time` is true.

    In lock-step, it shows 0 until the first message of `/clock`, and the exact simulated time from then on.
    """

    _is_active: bool
    _override_ns: int
    _is_exact: bool

    def __new__(cls) -> ROSClock:
        """Make a clock that follows the host."""
        self: Any = super().__new__(cls, clock_type=ClockType.ROS_TIME)
        self._is_active, self._override_ns, self._is_exact = False, 0, False
        return self  # type: ignore[no-any-return]

    @property
    def ros_time_is_active(self) -> bool:
        """True if the clock shows the time of `/clock`."""
        return self._is_active

    def _now_ns(self) -> int:
        return self._override_ns if self._is_active and not self._is_exact else self._host.now_ns()

    def _host_ns(self, time_ns: int) -> int | None:
        return None if self._is_active and not self._is_exact else time_ns

    def _set_ros_time_is_active(self, enabled: bool) -> None:
        if enabled != self._is_active:
            change = ClockChange.ROS_TIME_ACTIVATED if enabled else ClockChange.ROS_TIME_DEACTIVATED
            before = self._now_ns()
            self._before_jump(change, 0)
            self._is_active = enabled
            self._after_jump(change, self._now_ns() - before)

    def _follow_host(self) -> None:
        """Show the time of the host from now on, although the clock is active."""
        if not self._is_exact:
            delta = self._host.now_ns() - self._now_ns()
            self._before_jump(ClockChange.ROS_TIME_NO_CHANGE, delta)
            self._is_exact = True
            self._after_jump(ClockChange.ROS_TIME_NO_CHANGE, delta)

    def set_ros_time_override(self, time: Time) -> None:
        """Set the time of an active clock."""
        if not isinstance(time, Time):
            raise TypeError(f"Time must be specified as rclpy.time.Time. Received type: {type(time)}")
        delta = time.nanoseconds - self._override_ns
        if self._is_active and delta:
            self._before_jump(ClockChange.ROS_TIME_NO_CHANGE, delta)
        self._override_ns, self._is_exact = time.nanoseconds, False
        if self._is_active and delta:
            self._after_jump(ClockChange.ROS_TIME_NO_CHANGE, delta)

    def _before_jump(self, change: ClockChange, delta_ns: int) -> None:
        for handle in tuple(self._jump_handles):
            if handle.pre_callback is not None and handle.reports(change, delta_ns):
                handle.pre_callback()

    def _after_jump(self, change: ClockChange, delta_ns: int) -> None:
        for handle in tuple(self._jump_handles):
            if handle.post_callback is not None and handle.reports(change, delta_ns):
                handle.post_callback(TimeJump(change, Duration(nanoseconds=delta_ns)))
