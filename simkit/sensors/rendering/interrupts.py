"""Ctrl-C while something is under way that must not be cut in two."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

Heard = list[tuple[int, FrameType | None]]


@contextmanager
def interrupts_later() -> Iterator[Heard]:
    """Lets an interrupt wait until the block is left; gives those that have come in.

    Amid a call of the graphics library it would come out as a fault of that, which ctypes makes of every exception
    there, and amid a wait for a lock as one that nobody holds.
    """
    heard: Heard = []
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(before):
        yield heard
        return
    signal.signal(signal.SIGINT, lambda number, frame: heard.append((number, frame)))
    try:
        yield heard
    finally:
        signal.signal(signal.SIGINT, before)
        for number, frame in heard:
            before(number, frame)
