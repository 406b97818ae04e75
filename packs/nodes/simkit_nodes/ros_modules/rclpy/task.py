"""Futures, and tasks of executors."""

from __future__ import annotations

import inspect
import sys
import threading
import warnings
from collections.abc import Callable, Coroutine, Generator, Mapping, Sequence
from enum import Enum
from typing import TYPE_CHECKING, Any
from weakref import ref

if TYPE_CHECKING:
    from simkit_nodes.ros_modules.rclpy.executors import Executor

__all__ = ["Future", "FutureState", "Task"]


class FutureState(Enum):
    """State of a future."""

    PENDING = "PENDING"
    CANCELLED = "CANCELLED"
    FINISHED = "FINISHED"


class Future:
    """Result that is set later.

    Args:
        executor: executor that calls the callbacks of `add_done_callback`; None if `set_result` calls them.
    """

    def __init__(self, *, executor: Executor | None = None) -> None:
        self._state, self._exception_fetched = FutureState.PENDING, False
        self._result: Any = None
        self._exception: Exception | None = None
        self._callbacks: list[Callable[[Any], object]] = []
        self._spinning: list[Executor] = []
        self._lock = threading.Lock()  # threads of a program in its own process run at the same time
        self._executor: Callable[[], Executor | None] = lambda: None
        self._set_executor(executor)

    def __del__(self) -> None:
        if self._exception is not None and not self._exception_fetched:
            sys.stderr.write(f"The following exception was never retrieved: {self._exception}\n")

    def __await__(self) -> Generator[None, None, Any]:
        while self._pending():
            yield
        return self.result()

    def _pending(self) -> bool:
        return self._state is FutureState.PENDING

    def cancel(self) -> None:
        """Mark the future as cancelled, unless it is done."""
        with self._lock:
            if not self._pending():
                return
            self._state = FutureState.CANCELLED
        self._call_back()

    def cancelled(self) -> bool:
        """Check whether the future was cancelled."""
        return self._state is FutureState.CANCELLED

    def done(self) -> bool:
        """Check whether the future has a result or an exception."""
        return self._state is FutureState.FINISHED

    def result(self) -> Any:
        """Return the result; None before it is set. Raise the exception if there is one."""
        exception = self.exception()
        if exception is not None:
            raise exception
        return self._result

    def exception(self) -> Exception | None:
        """Return the exception, or None."""
        self._exception_fetched = True
        return self._exception

    def set_result(self, result: object) -> None:
        """Set the result."""
        with self._lock:
            self._result = result
            self._state = FutureState.FINISHED
        self._call_back()

    def set_exception(self, exception: Exception) -> None:
        """Set an exception instead of a result."""
        with self._lock:
            self._exception, self._exception_fetched = exception, False
            self._state = FutureState.FINISHED
        self._call_back()

    def _call_back(self) -> None:
        executor = self._executor()
        with self._lock:
            callbacks, self._callbacks = self._callbacks, []
            spinning, self._spinning = self._spinning, []
        for spins in spinning:
            spins.wake()
        for callback in callbacks:
            if executor is not None:
                executor.create_task(callback, self)
                continue
            try:
                callback(self)
            except Exception as error:  # noqa: BLE001 - a program may raise anything, and the others must be called
                warnings.warn(f"Unhandled exception in done callback: {error}", stacklevel=2)

    def _wake_when_done(self, executor: Executor) -> None:
        """Wake an executor that spins until the future is done.

        A done callback would do the same, but every `spin_once` would leave a task for the executor.
        """
        with self._lock:
            if executor not in self._spinning:
                self._spinning.append(executor)

    def _set_executor(self, executor: Executor | None) -> None:
        """Set the executor that calls the callbacks."""
        self._executor = (lambda: None) if executor is None else ref(executor)

    def add_done_callback(self, callback: Callable[[Any], object]) -> None:
        """Call a function with the future when it is done; at once, or by the executor, if it is done already."""
        executor = self._executor()
        with self._lock:
            if self._pending():
                self._callbacks.append(callback)
                return
        if executor is not None:
            executor.create_task(callback, self)
        else:
            callback(self)

    def remove_done_callback(self, callback: Callable[[Any], object]) -> bool:
        """Remove a callback of `add_done_callback`; return False if it is not there any more."""
        with self._lock:
            if callback not in self._callbacks:
                return False
            self._callbacks.remove(callback)
            return True


class Task(Future):
    """Function or coroutine that an executor runs.

    Args:
        handler: function, function that returns a coroutine, or coroutine.
        args: arguments.
        kwargs: keyword arguments.
        executor: executor that calls the callbacks of `add_done_callback`.
    """

    def __init__(
        self,
        handler: Callable[..., object] | Coroutine[Any, Any, Any],
        args: Sequence[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        executor: Executor | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._args: Sequence[Any] = args or ()
        self._kwargs: Mapping[str, Any] = kwargs or {}
        self._handler: Any = handler
        if not inspect.iscoroutine(handler) and inspect.iscoroutinefunction(handler):
            self._handler = handler(*self._args, **self._kwargs)
        self._executing = False

    def __call__(self) -> None:
        """Run the function, or continue the coroutine until it waits."""
        with self._lock:
            if not self._pending() or self._executing:
                return
            self._executing = True
        try:
            if inspect.iscoroutine(self._handler):
                try:
                    self._handler.send(None)
                    return
                except StopIteration as end:
                    result = end.value
            else:
                result = self._handler(*self._args, **self._kwargs)
        except Exception as error:  # noqa: BLE001 - a program may raise anything
            self.set_exception(error)
            self._handler = None
            return
        finally:
            self._executing = False
        self.set_result(result)
        self._handler = None

    def cancel(self) -> None:
        """Close the coroutine, and mark the task as cancelled, unless it is done."""
        if self._pending() and inspect.iscoroutine(self._handler):
            self._handler.close()
        super().cancel()

    def executing(self) -> bool:
        """Check whether a thread runs the task now."""
        return self._executing
