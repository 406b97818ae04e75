"""Module `_thread` of a program: its threads are tasks, and its locks wait in simulated time.

Python's own module `threading`, executed anew over this one, gives a program all the rest.
"""

from __future__ import annotations

import _thread
import time
from collections.abc import Callable, Mapping, Sequence
from types import TracebackType
from typing import Any, Final

from simkit_nodes.host import current_program
from simkit_nodes.tasks import ProgramEnd, ProgramStuck, Task, current_task

__all__ = [
    "LockType",
    "RLock",
    "_ThreadHandle",
    "_excepthook",
    "_get_main_thread_ident",
    "_is_main_interpreter",
    "_make_thread_handle",
    "_set_sentinel",
    "_shutdown",
    "allocate",
    "allocate_lock",
    "daemon_threads_allowed",
    "get_ident",
    "get_native_id",
    "interrupt_main",
    "lock",
    "start_joinable_thread",
    "start_new",
    "start_new_thread",
]

_FOREIGN_WAIT: Final = 10.0  # [s] of wall time that a thread which is no task waits for a lock of a task


def wait_for(is_ready: Callable[[], bool], timeout: float, waits_for: Callable[[], Task | None] | None = None) -> bool:
    """Wait for a condition at most for a duration [s] of simulated time, without a limit if it is negative.

    Returns:
        Result of the condition at the end.
    """
    if is_ready():
        return True
    task = current_task()
    if task is None:
        return _wait_outside(is_ready, timeout)
    host = task.program.host
    end = None if timeout < 0 else host.now_ns() + max(1, round(timeout * 1e9))
    task.waits_for = waits_for if end is None else None
    try:
        while not is_ready():
            host.wait(end, is_ready)
            if end is not None and host.now_ns() >= end:
                break
    finally:
        task.waits_for = None
    return is_ready()


def _wait_outside(is_ready: Callable[[], bool], timeout: float) -> bool:
    """Wait in wall time: a thread of a compiled library, or a finalizer, calls code of a program."""
    end = time.monotonic() + (_FOREIGN_WAIT if timeout < 0 else timeout)
    while not is_ready() and time.monotonic() < end:
        time.sleep(0.0005)
    return is_ready()


class LockType:
    """Lock that waits in simulated time."""

    def __init__(self) -> None:
        self._is_locked = False
        self._holder: Task | None = None

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Acquire the lock; wait for it at most for a duration [s] of simulated time."""
        if not blocking and timeout != -1:
            raise ValueError("can't specify a timeout for a non-blocking call")
        if timeout < 0 and timeout != -1:
            raise ValueError("timeout value must be a non-negative number")
        if self._is_locked:
            if not blocking or timeout == 0:
                _poll()
                return False
            if not wait_for(self._is_free, timeout, self._holding_task):
                return False
        self._is_locked = True
        self._holder = current_task()
        return True

    def release(self) -> None:
        """Release the lock; any thread may do so."""
        if not self._is_locked:
            raise RuntimeError("release unlocked lock")
        self._is_locked = False
        self._holder = None

    def locked(self) -> bool:
        """Return whether the lock is locked."""
        _poll()
        return self._is_locked

    def _is_owned(self) -> bool:
        """Return whether the lock is locked; a condition otherwise tries to acquire it, as a loop of questions does."""
        return self._is_locked

    def _is_free(self) -> bool:
        return not self._is_locked

    def _holding_task(self) -> Task | None:
        return self._holder

    def _at_fork_reinit(self) -> None:
        self.__init__()  # type: ignore[misc]

    acquire_lock, release_lock, locked_lock, __enter__ = acquire, release, locked, acquire

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()

    def __repr__(self) -> str:
        return f"<{'locked' if self._is_locked else 'unlocked'} _thread.lock>"


lock = LockType


class _Sentinel(LockType):
    """Lock that is released at the end of a thread.

    Python's `threading` asks all of them at each start of a thread: these questions are no loop of the program.
    """

    def locked(self) -> bool:
        """Return whether the thread has not ended."""
        return self._is_locked


class RLock:
    """Lock that one thread may acquire several times."""

    def __init__(self) -> None:
        self._lock = LockType()
        self._owner, self._count = 0, 0

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Acquire the lock, also again."""
        ident = get_ident()
        if self._owner == ident:
            self._count += 1
            return True
        if not self._lock.acquire(blocking, timeout):
            return False
        self._owner, self._count = ident, 1
        return True

    def release(self) -> None:
        """Release the lock once."""
        if self._owner != get_ident():
            raise RuntimeError("cannot release un-acquired lock")
        self._count -= 1
        if not self._count:
            self._owner = 0
            self._lock.release()

    def locked(self) -> bool:
        """Return whether a thread has the lock."""
        return self._count > 0

    def _is_owned(self) -> bool:
        return self._owner == get_ident()

    def _recursion_count(self) -> int:
        return self._count if self._is_owned() else 0

    def _release_save(self) -> tuple[int, int]:
        state = self._count, self._owner
        self._count = self._owner = 0
        self._lock.release()
        return state

    def _acquire_restore(self, state: tuple[int, int]) -> None:
        self._lock.acquire()
        self._count, self._owner = state

    def _at_fork_reinit(self) -> None:
        self.__init__()  # type: ignore[misc]

    __enter__ = acquire

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()

    def __repr__(self) -> str:
        return f"<{'locked' if self._count else 'unlocked'} _thread.RLock count={self._count}>"


def allocate_lock() -> LockType:
    """Return a new lock."""
    return LockType()


allocate = allocate_lock


def get_ident() -> int:
    """Return the identifier of the calling thread: the number of its task."""
    task = current_task()
    return _thread.get_ident() if task is None else task.number


get_native_id = get_ident


def start_new_thread(
    function: Callable[..., object], args: Sequence[Any] = (), kwargs: Mapping[str, Any] | None = None
) -> int:
    """Start a thread and return its identifier."""
    return _start(lambda: function(*args, **(kwargs or {})), getattr(function, "__name__", "thread")).number


start_new = start_new_thread


def _start(function: Callable[[], object], name: str) -> Task:
    task: Task = current_program().host.start_thread(function, name)
    return task


def _set_sentinel() -> LockType:
    """Return a lock that is released at the end of the calling thread."""
    sentinel = _Sentinel()
    task = current_task()

    def release() -> None:
        if sentinel._is_locked:
            sentinel.release()

    if task is not None:
        task.on_end.append(release)
    return sentinel


class _ThreadHandle:
    """Thread that other threads can wait for; since Python 3.13."""

    def __init__(self) -> None:
        self.ident = 0
        self._is_done = False

    def is_done(self) -> bool:
        """Return whether the thread has ended."""
        return self._is_done

    def _set_done(self) -> None:
        self._is_done = True

    def join(self, timeout: float | None = None) -> None:
        """Wait for the end of the thread, at most for a duration [s] of simulated time."""
        task = current_task()
        if task is not None and task.number == self.ident and not self._is_done:
            raise RuntimeError("Cannot join current thread")
        wait_for(self.is_done, -1.0 if timeout is None else max(0.0, timeout))


def start_joinable_thread(
    function: Callable[[], object], handle: _ThreadHandle | None = None, daemon: bool = True
) -> _ThreadHandle:
    """Start a thread and return its handle; since Python 3.13."""
    handle = handle or _ThreadHandle()
    task = _start(function, getattr(function, "__name__", "thread"))
    handle.ident = task.number
    task.on_end.append(handle._set_done)
    if not daemon:
        task.program.data.setdefault(__name__, []).append(handle)
    return handle


def _make_thread_handle(ident: int) -> _ThreadHandle:
    handle = _ThreadHandle()
    handle.ident = ident
    return handle


def _shutdown() -> None:
    """Wait for the end of all threads that are no daemons; since Python 3.13."""
    handles: list[_ThreadHandle] = current_program().data.setdefault(__name__, [])
    while handles:
        handles.pop(0).join()


def _get_main_thread_ident() -> int:
    return current_program().main_task.number


def _is_main_interpreter() -> bool:
    return True


def daemon_threads_allowed() -> bool:
    """Return whether threads may be daemons."""
    return True


def interrupt_main(signum: int = 2) -> None:
    """Raise KeyboardInterrupt in the main thread, where it waits."""
    program = current_program()
    program.main_task.is_asked_to_end = True
    program.main_task.until_ns = program.host.now_ns()


def _excepthook(args: Any) -> None:
    """Store the exception that has ended a thread, and print its traceback."""
    task = current_task()
    if task is not None and not issubclass(args.exc_type, (SystemExit, ProgramEnd, ProgramStuck)):
        error = args.exc_value if args.exc_value is not None else args.exc_type()
        task.program.meet(task, error)


def _poll() -> None:
    task = current_task()
    if task is not None:
        task.poll()
