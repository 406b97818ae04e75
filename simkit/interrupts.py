"""Signals that Python code turns into exceptions, deferred where an exception would be lost or do damage."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import Final

ReceivedSignals = list[tuple[int, FrameType | None]]
_stop_requests = [0]
_SIGNALS: Final = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGALRM") if hasattr(signal, name)]


def note_stop_request() -> None:
    """Count a request of the user to stop the run, so that waits for other programs end early."""
    _stop_requests[0] += 1


def stop_requests() -> int:
    """Return the number of requests to stop a run, in this process."""
    return _stop_requests[0]


@contextmanager
def defer_interrupts() -> Iterator[ReceivedSignals]:
    """Defer interrupts until the block ends, and yield the list of received interrupts.

    In a function that a C library calls, ctypes would drop the interrupt. Inside a call of the graphics library, ctypes
    would turn it into an error of that library. Inside a wait for a lock, it would appear as an error about a lock that
    no thread holds. Signals without a handler in Python are not deferred.
    """
    received: ReceivedSignals = []
    if threading.current_thread() is not threading.main_thread():
        yield received
        return
    handlers = [(number, handler) for number in _SIGNALS if callable(handler := signal.getsignal(number))]

    def note(number: int, frame: FrameType | None) -> None:
        received.append((number, frame))

    try:
        for number, _ in handlers:
            signal.signal(number, note)
        yield received
    finally:
        _restore(handlers)
        for number, frame in received:
            dict(handlers)[number](number, frame)


def _restore(handlers: Sequence[tuple[int, Callable[[int, FrameType | None], object]]]) -> None:
    """Set all handlers again, also if one that is already set raises."""
    if handlers:
        try:
            signal.signal(*handlers[0])
        finally:
            _restore(handlers[1:])
