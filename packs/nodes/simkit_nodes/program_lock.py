"""Lock of a program in a process of its own, and objects that its threads use one at a time."""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import TracebackType
from typing import Any, Final

_SHARED: Final = ("simkit_nodes.graph", "simkit_nodes.graph_services", "simkit_nodes.graph_actions")


class ProgramLock:
    """Lock that a thread may acquire several times, with a condition.

    Ctrl-C must not end an operation in the middle: a function of a signal handler waits until the main thread has
    released the lock.
    """

    def __init__(self) -> None:
        self._lock: Any = threading.RLock()
        self._condition = threading.Condition(self._lock)
        self._deferred: list[Callable[[], object]] = []

    def __enter__(self) -> ProgramLock:
        self._lock.acquire()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lock.release()
        if self._deferred and not self._lock._is_owned():
            self._call_deferred()

    def _call_deferred(self) -> None:
        if self._deferred and threading.current_thread() is threading.main_thread():
            self._deferred.pop(0)()

    def wait(self, timeout: float) -> None:
        """Release the lock until `notify`, or for a time [s], and acquire it again; the thread holds it once."""
        self._call_deferred()
        self._condition.wait(timeout)

    def notify(self) -> None:
        """End the waits of all threads."""
        with self:
            self._condition.notify_all()

    def call_when_free(self, function: Callable[[], object]) -> None:
        """Call a function now, or after the main thread, which calls this in a signal handler, has released the lock.

        The function may raise an exception for the main thread.
        """
        if self._lock._is_owned():
            self._deferred.append(function)
        else:
            function()


class _Locked:
    """Object whose attributes and methods are used under a lock."""

    __slots__ = ("_after", "_lock", "_target")

    def __init__(self, target: object, lock: ProgramLock, after: Callable[[], None]) -> None:
        object.__setattr__(self, "_target", target)
        object.__setattr__(self, "_lock", lock)
        object.__setattr__(self, "_after", after)

    def __getattr__(self, name: str) -> Any:
        target, lock, after = self._target, self._lock, self._after
        with lock:
            value = getattr(target, name)
        if not callable(value):
            return locked(value, lock, after)

        def call(*args: object, **kwargs: object) -> Any:
            with lock:
                result = value(*args, **kwargs)
                after()
            return locked(result, lock, after)

        return call

    @property  # type: ignore[misc]
    def __class__(self) -> type:
        """Class of the object, for `isinstance`."""
        return type(self._target)

    def __setattr__(self, name: str, value: object) -> None:
        with self._lock:
            setattr(self._target, name, value)

    def __eq__(self, other: object) -> bool:
        return type(other) is _Locked and self._target is other._target

    def __hash__(self) -> int:
        return hash(self._target)


def locked(value: object, lock: ProgramLock, after: Callable[[], None]) -> Any:
    """Return an object of the graph as one that threads use one at a time; other values are returned as they are.

    Args:
        value: object.
        lock: lock.
        after: function that is called after each method, under the lock.
    """
    kind = type(value)
    is_shared = any(each.__module__ in _SHARED for each in kind.__mro__) and not hasattr(kind, "__dataclass_fields__")
    return _Locked(value, lock, after) if is_shared else value
