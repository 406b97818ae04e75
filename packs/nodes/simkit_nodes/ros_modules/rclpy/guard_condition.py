"""Guard conditions: callbacks that a program triggers itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit_nodes.ros_modules.rclpy.executors import await_or_execute
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import Handle
from simkit_nodes.ros_modules.rclpy.waitable import ExecutorEntity

if TYPE_CHECKING:
    from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup
    from simkit_nodes.ros_modules.rclpy.context import Context

__all__ = ["GuardCondition"]


class GuardCondition(ExecutorEntity):
    """Callback that an executor calls after `trigger`.

    Args:
        callback: function or coroutine function without arguments.
        callback_group: callback group.
        context: has no effect.
    """

    def __init__(
        self, callback: Callable[[], object] | None, callback_group: CallbackGroup, context: Context | None = None
    ) -> None:
        self.callback, self.callback_group = callback, callback_group
        self._handle = Handle()
        self._is_triggered = False
        self._wake: Callable[[], None] = lambda: None

    @property
    def handle(self) -> Handle:
        """State of the guard condition."""
        return self._handle

    def trigger(self) -> None:
        """Have the callback called once."""
        with self._handle:
            self._is_triggered = True
            self._wake()

    def destroy(self) -> None:
        """Destroy the guard condition."""
        self._handle.destroy()

    def _is_ready(self) -> bool:
        return self._is_triggered and bool(self._handle)

    def _take(self) -> Any:
        self._is_triggered = False
        return () if self._handle and self.callback is not None else None

    async def _execute(self, data: object) -> None:
        assert self.callback is not None
        await await_or_execute(self.callback)
