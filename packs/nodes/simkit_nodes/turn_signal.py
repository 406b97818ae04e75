"""Signals with which threads give the turn to each other."""

from __future__ import annotations

import _thread
import os
import select
import sys

if sys.platform == "linux":

    class TurnSignal:
        """Flag for which one thread waits; another thread sets it.

        It is an event counter of Linux: the waiting thread wakes on the processor of the other one, which takes a third
        of the time that a lock takes.
        """

        def __init__(self) -> None:
            self._file = os.eventfd(0, os.EFD_CLOEXEC)
            self._poll = select.poll()
            self._poll.register(self._file, select.POLLIN)

        def set(self) -> None:
            """Set the flag; the waiting thread continues."""
            os.eventfd_write(self._file, 1)

        def wait(self, timeout: float | None = None) -> bool:
            """Wait for the flag and clear it; return False after a wall time [s]."""
            if timeout is not None and not self._poll.poll(timeout * 1000.0):
                return False
            os.eventfd_read(self._file)
            return True

        def __del__(self) -> None:
            os.close(self._file)

else:

    class TurnSignal:
        """Flag for which one thread waits; another thread sets it."""

        def __init__(self) -> None:
            self._lock = _thread.allocate_lock()
            self._lock.acquire()

        def set(self) -> None:
            """Set the flag; the waiting thread continues."""
            self._lock.release()

        def wait(self, timeout: float | None = None) -> bool:
            """Wait for the flag and clear it; return False after a wall time [s]."""
            return self._lock.acquire(timeout=-1 if timeout is None else timeout)
