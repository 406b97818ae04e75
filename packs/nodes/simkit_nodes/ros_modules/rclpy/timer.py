"""Timers and rates."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit_nodes.host import current_host
from simkit_nodes.ros_modules.rclpy.exceptions import InvalidHandle, ROSInterruptException
from simkit_nodes.ros_modules.rclpy.executors import await_or_execute
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle, RCLError
from simkit_nodes.ros_modules.rclpy.waitable import ExecutorEntity

if TYPE_CHECKING:
    from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup
    from simkit_nodes.ros_modules.rclpy.clock import Clock
    from simkit_nodes.ros_modules.rclpy.context import Context

__all__ = ["Rate", "Timer"]


class Timer(ExecutorEntity):
    """Callback at a period.

    The first call is after one period. If the executor was busy for several periods, one call makes up for all of
    them, and the next ones are at the old multiples of the period.

    Args:
        callback: function or coroutine function without arguments.
        callback_group: callback group.
        timer_period_ns: period [ns].
        clock: clock of the period.
        context: has no effect.
        autostart: False for a timer that begins with `reset`.
    """

    def __init__(
        self,
        callback: Callable[[], object] | None,
        callback_group: CallbackGroup,
        timer_period_ns: int,
        clock: Clock,
        *,
        context: Context | None = None,
        autostart: bool = True,
    ) -> None:
        if timer_period_ns < 0:
            raise RCLError("failed to create timer: timer period must be non-negative, at ./src/rcl/timer.c:149")
        self.callback, self.callback_group, self._clock = callback, callback_group, clock
        self._period_ns, self._handle = int(timer_period_ns), Handle()
        self._is_canceled = not autostart
        self._last_ns = clock._now_ns()
        self._next_ns = self._last_ns + self._period_ns
        self._wake: Callable[[], None] = lambda: None

    @property
    def handle(self) -> Handle:
        """State of the timer."""
        return self._handle

    @property
    def clock(self) -> Clock:
        """Clock of the period."""
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        """Period [ns]; a new period begins with the next call."""
        return self._period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, value: float) -> None:
        with self._handle:
            self._period_ns = int(value)

    def _follow_jump(self) -> int:
        """Return the time of the clock [ns]; begin a new period if the clock has jumped back."""
        now = self._clock._now_ns()
        if now < self._last_ns:
            self._last_ns, self._next_ns = now, now + self._period_ns
        return now

    def is_ready(self) -> bool:
        """Check whether the callback is due."""
        with self._handle:
            return self._is_ready()

    def is_canceled(self) -> bool:
        """Check whether the timer is cancelled."""
        with self._handle:
            return self._is_canceled

    def cancel(self) -> None:
        """Make no calls until `reset`."""
        with self._handle:
            self._is_canceled = True

    def reset(self) -> None:
        """Begin a new period now."""
        with self._handle:
            self._is_canceled = False
            self._next_ns = self._follow_jump() + self._period_ns
            self._wake()

    def time_since_last_call(self) -> int:
        """Return the time since the last call, or since the beginning [ns]."""
        with self._handle:
            return self._follow_jump() - self._last_ns

    def time_until_next_call(self) -> int | None:
        """Return the time until the next call [ns]; None for a cancelled timer."""
        with self._handle:
            return None if self._is_canceled else self._next_ns - self._follow_jump()

    def destroy(self) -> None:
        """Destroy the timer; its node may still have it, and never calls it again."""
        self._handle.destroy()
        self._is_canceled = True

    @property
    def _due_ns(self) -> int | None:
        """Time of the host at which the callback is due [ns]; None if that is unknown."""
        self._follow_jump()
        return None if self._is_canceled else self._clock._host_ns(self._next_ns)

    def _is_ready(self) -> bool:
        return not self._is_canceled and self._follow_jump() >= self._next_ns

    def _take(self) -> Any:
        if not self._handle or self.callback is None:
            return None
        now = self._follow_jump()
        self._last_ns = now
        self._next_ns += self._period_ns
        if self._next_ns < now:
            late = now - self._next_ns
            self._next_ns = (
                now if not self._period_ns else self._next_ns + -(-late // self._period_ns) * self._period_ns
            )
        return ()

    async def _execute(self, data: object) -> None:
        assert self.callback is not None
        await await_or_execute(self.callback)


class Rate:
    """Waits that end at a fixed rate; see `Node.create_rate`.

    An executor has to spin in another thread, because the rate is a timer.

    Args:
        timer: timer.
        context: context, whose end ends the waits.
    """

    def __init__(self, timer: Timer, *, context: Context) -> None:
        self._timer = timer
        self._is_shutdown = self._is_destroyed = False
        self._has_fired = False
        self._num_sleepers = 0
        self._host = current_host()
        self._timer.callback = self._fire
        context.on_shutdown(self._on_shutdown)

    def _fire(self) -> None:
        self._has_fired = True
        self._host.wake()

    def _on_shutdown(self) -> None:
        self._is_shutdown = True
        self.destroy()

    def destroy(self) -> None:
        """End all waits."""
        self._is_destroyed = True
        self._fire()

    def sleep(self) -> None:
        """Wait for the next call of the timer.

        Raises:
            ROSInterruptException: the context has ended.
        """
        self._check_context()
        if self._is_destroyed:
            raise RuntimeError("Rate cannot sleep because it has been destroyed")
        if not self._timer.handle:
            self.destroy()
            raise InvalidHandle("Rate cannot sleep because the timer has been destroyed")
        self._num_sleepers += 1
        try:
            while not self._has_fired:
                self._host.wait(None, lambda: self._has_fired)
        finally:
            self._num_sleepers -= 1
            if self._num_sleepers == 0:
                self._has_fired = False
        self._check_context()

    def _check_context(self) -> None:
        if self._is_shutdown:
            raise ROSInterruptException
