"""The thread that draws: one for the process, since there is one OpenGL context; Ctrl-C waits until a picture
is complete.
"""

from __future__ import annotations

import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from simkit.errors import RenderError

ReceivedSignals = list[tuple[int, FrameType | None]]


@contextmanager
def defer_interrupts() -> Iterator[ReceivedSignals]:
    """Lets an interrupt wait until the block is left; gives those that have come in.

    Amid a call of the graphics library it would come out as a fault of that, which ctypes makes of every exception
    there, and amid a wait for a lock as one that nobody holds.
    """
    received: ReceivedSignals = []
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(before):
        yield received
        return
    signal.signal(signal.SIGINT, lambda number, frame: received.append((number, frame)))
    try:
        yield received
    finally:
        signal.signal(signal.SIGINT, before)
        for number, frame in received:
            before(number, frame)


_MAX_WAITING = 8  # a picture is two of them: drawing it, and making messages of it
_WAIT_INTERVAL = 0.05  # [s] between two looks whether there was an interrupt


class RenderJob:
    """Something that is done on another thread, or was done at once.

    Args:
        do: gives the result, or raises.
        is_at_once: whether it is done where it is asked for.
    """

    __slots__ = ("_do", "_done", "_error", "_owner", "_result", "is_at_once")

    def __init__(self, do: Callable[[], object], is_at_once: bool = False) -> None:
        self.is_at_once = is_at_once
        self._do: Callable[[], object] | None = do
        self._owner, self._done = _thread, threading.Event()
        self._result: object = None
        self._error: BaseException | None = None

    @property
    def is_done(self) -> bool:
        return self._done.is_set()

    def wait(self) -> None:
        """Until it is done, whether it went well or not; not where the thread that does it asks itself."""
        if not self._done.is_set() and threading.get_ident() != _thread.number:
            if self._owner is not _thread:
                raise RenderError("this process was forked while the picture was being drawn", "SK-RENDER-011")
            while not self._done.is_set():
                with defer_interrupts() as received:
                    while not received and not self._done.wait(_WAIT_INTERVAL):
                        pass

    def result(self) -> Any:
        """What it gave, once it is done; raises what it raised."""
        self.wait()
        if self._error is not None:
            raise self._error
        return self._result

    def run(self) -> None:
        """Does it, here and now."""
        do, self._do = self._do, None
        assert do is not None
        try:
            self._result = do()
        except BaseException as error:  # raised where the result is asked for
            self._error = error
            if not isinstance(error, Exception) and threading.get_ident() != _thread.number:
                raise  # an interrupt is heard where it comes
        finally:
            self._done.set()


class _RenderThread:
    """The thread and what waits for it.

    Attributes:
        number: of the thread; None while there is none.
    """

    def __init__(self) -> None:
        self.number: int | None = None
        self._waiting: deque[RenderJob] = deque()
        self._changed = threading.Condition()
        self._thread: threading.Thread | None = None
        self._is_busy = self._is_ended = False

    def submit(self, work: RenderJob) -> None:
        if threading.get_ident() == self.number:
            work.run()  # who draws must not wait for room
            return
        self._wait_while(lambda: len(self._waiting) >= _MAX_WAITING and not self._is_ended)
        with defer_interrupts(), self._changed:
            if not self._is_ended:
                self._waiting.append(work)
                if self._thread is None:
                    self._start()
                self._changed.notify_all()
                return
        work.run()

    def drain(self) -> None:
        if threading.get_ident() == self.number or self._thread is None:
            return
        self._wait_while(lambda: bool(self._waiting) or self._is_busy)

    def _wait_while(self, is_so: Callable[[], bool]) -> None:
        """Until something is no more; an interrupt is heard meanwhile."""
        goes_on = True
        while goes_on:
            with defer_interrupts() as received, self._changed:
                while (goes_on := is_so()) and not received:
                    self._changed.wait(_WAIT_INTERVAL)

    def end(self) -> None:
        """Does what waits, then stops; later work is done where it is asked for."""
        with self._changed:
            self._is_ended = True
            self._changed.notify_all()
        if self._thread is not None:
            self._thread.join()

    def _start(self) -> None:
        # a daemon: at exit the interpreter waits for all others before anybody could tell them to stop
        self._thread = threading.Thread(target=self._work, name="simkit-render", daemon=True)
        self._thread.start()

    def _work(self) -> None:
        self.number = threading.get_ident()
        while True:
            with self._changed:
                self._is_busy = False
                self._changed.notify_all()
                while not self._waiting:
                    if self._is_ended:
                        return
                    self._changed.wait()
                work = self._waiting.popleft()
                self._is_busy = True
                self._changed.notify_all()
            work.run()
            del work  # what it was made of is not held while nothing is to be done


_thread = _RenderThread()


def submit(do: Callable[[], object]) -> RenderJob:
    """Has the render thread do something after all that was submitted before; waits while too much is waiting."""
    work = RenderJob(do)
    _thread.submit(work)
    return work


def run_now(do: Callable[[], object]) -> RenderJob:
    """Does something here, after all that was submitted before."""
    _thread.drain()
    work = RenderJob(do, is_at_once=True)
    work.run()
    work.result()
    return work


def drain() -> None:
    """Waits until all that was submitted is done; not on the render thread itself."""
    _thread.drain()


def end() -> None:
    """Lets the render thread finish, and starts none again."""
    _thread.end()


def usable_cores() -> int:
    """Processor cores that this process may run on."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _after_fork() -> None:
    """A forked child has no render thread; what waited for it there is not to be drawn."""
    global _thread
    _thread = _RenderThread()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)
