"""Threads that cast parts of a fan of rays; the bits do not depend on their number."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from typing import Final

from simkit.sensors.cameras.rendering.render_thread import usable_cores

_MOST_THREADS: Final = 8


class RayThreads:
    """Threads of this process, which start with the first fan that needs them."""

    def __init__(self) -> None:
        self._chosen = 0
        self._pool: ThreadPoolExecutor | None = None
        self._process = 0

    @property
    def count(self) -> int:
        """Number of threads for one fan, with that of the caller: the cores that this process may use, at most 8."""
        return self._chosen or min(_MOST_THREADS, usable_cores())

    @contextmanager
    def use(self, count: int) -> Iterator[None]:
        """Use a number of threads, at most 8, in a `with` block."""
        before, self._chosen = self._chosen, min(count, _MOST_THREADS)
        try:
            yield
        finally:
            self._chosen = before

    def run(self, jobs: Sequence[Callable[[], None]]) -> None:
        """Run jobs that do not depend on each other: the first in this thread, each other one in its own."""
        pending: list[Future[None]] = []
        try:
            with suppress(RuntimeError):  # an interpreter that is ending starts no thread
                for job in jobs[1:]:
                    pending.append(self._threads().submit(job))
            for job in (*jobs[:1], *jobs[1 + len(pending) :]):
                job()
        finally:  # also after an error or Ctrl-C, because the threads write into arrays that the next fan uses
            wait(pending)
        for result in pending:
            result.result()

    def _threads(self) -> ThreadPoolExecutor:
        if self._pool is None or self._process != os.getpid():  # a fork has no threads
            self._pool, self._process = ThreadPoolExecutor(_MOST_THREADS, "rays"), os.getpid()
        return self._pool


ray_threads = RayThreads()
