"""Render thread: one per process, because there is one OpenGL context; interrupts wait until an image is complete."""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from simkit.errors import RenderError
from simkit.interrupts import defer_interrupts

_MAX_WAITING = 8  # an image needs two jobs: drawing it, and making its messages
_WAIT_INTERVAL = 0.05  # [s] interval of the checks for an interrupt


class RenderJob:
    """Job for the render thread, or a job that the submitting thread runs at once.

    Args:
        do: function that returns the result or raises.
        is_at_once: True if the submitting thread runs the job.
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
        """Wait until the job has succeeded or failed; return at once if this thread is the render thread."""
        if not self._done.is_set() and threading.get_ident() != _thread.number:
            if self._owner is not _thread:
                raise RenderError("SK-RENDER-011", "this process was forked while the image was being drawn")
            while not self._done.is_set():
                with defer_interrupts() as received:
                    while not received and not self._done.wait(_WAIT_INTERVAL):
                        pass

    def result(self) -> Any:
        """Wait for the job and return its result, or raise its error."""
        self.wait()
        if self._error is not None:
            raise self._error
        return self._result

    def run(self) -> None:
        """Run the job in this thread."""
        do, self._do = self._do, None
        assert do is not None
        try:
            self._result = do()
        except BaseException as error:  # `result` raises this error again
            self._error = error
            if not isinstance(error, Exception) and threading.get_ident() != _thread.number:
                raise  # an interrupt must also stop the thread that received it
        finally:
            self._done.set()


class _RenderThread:
    """Render thread and its queue of jobs.

    Attributes:
        number: identifier of the thread; None before the thread starts.
    """

    def __init__(self) -> None:
        self.number: int | None = None
        self._queue: deque[RenderJob] = deque()
        self._changed = threading.Condition()
        self._thread: threading.Thread | None = None
        self._is_busy = self._is_ended = False

    def submit(self, work: RenderJob) -> None:
        if threading.get_ident() == self.number:
            work.run()  # the render thread must not wait until its own queue has room
            return
        self._wait_while(lambda: len(self._queue) >= _MAX_WAITING and not self._is_ended)
        with defer_interrupts(), self._changed:
            if not self._is_ended:
                self._queue.append(work)
                if self._thread is None:
                    self._start()
                self._changed.notify_all()
                return
        work.run()

    def drain(self) -> None:
        if threading.get_ident() == self.number or self._thread is None:
            return
        self._wait_while(lambda: bool(self._queue) or self._is_busy)

    def _wait_while(self, condition: Callable[[], bool]) -> None:
        """Wait while a condition holds; interrupts are handled in between."""
        must_wait = True
        while must_wait:
            with defer_interrupts() as received, self._changed:
                while (must_wait := condition()) and not received:
                    self._changed.wait(_WAIT_INTERVAL)

    def end(self) -> None:
        """Finish the queued jobs and stop the thread; a later job runs in the thread that submits it."""
        with self._changed:
            self._is_ended = True
            self._changed.notify_all()
        if self._thread is not None:
            self._thread.join()

    def _start(self) -> None:
        # a daemon thread, because at exit the interpreter waits for other threads before `end` is called
        self._thread = threading.Thread(target=self._work, name="simkit-render", daemon=True)
        self._thread.start()

    def _work(self) -> None:
        self.number = threading.get_ident()
        while True:
            with self._changed:
                self._is_busy = False
                self._changed.notify_all()
                while not self._queue:
                    if self._is_ended:
                        return
                    self._changed.wait()
                work = self._queue.popleft()
                self._is_busy = True
                self._changed.notify_all()
            work.run()
            del work  # free the job's data while the thread is idle


_thread = _RenderThread()


def submit(do: Callable[[], object]) -> RenderJob:
    """Run a function on the render thread after all earlier jobs; wait while the queue is full."""
    work = RenderJob(do)
    _thread.submit(work)
    return work


def run_now(do: Callable[[], object]) -> RenderJob:
    """Run a function in this thread after all submitted jobs."""
    _thread.drain()
    work = RenderJob(do, is_at_once=True)
    work.run()
    work.result()
    return work


def drain() -> None:
    """Wait until all submitted jobs are done; return at once on the render thread itself."""
    _thread.drain()


def end() -> None:
    """Finish the queued jobs and stop the render thread permanently."""
    _thread.end()


def usable_cores() -> int:
    """Return the number of processor cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _after_fork() -> None:
    """Replace the render thread in a forked child, where neither the thread nor its jobs exist."""
    global _thread
    _thread = _RenderThread()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)
