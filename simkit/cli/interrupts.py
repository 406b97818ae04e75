"""Ctrl-C without a torn file: the first one asks the loop to stop, the second one stops at once."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any

from simkit.sinks.blocked import describe


class Interrupts:
    """While entered, an interrupt is noted instead of raised.

    Args:
        noted: called when one is.

    Attributes:
        exit_code: 0, or what the process is to return for the signal that came.
    """

    def __init__(self, noted: Callable[[], None] | None = None) -> None:
        self.exit_code = 0
        self._noted = noted
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Interrupts:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                self._before[number] = signal.signal(number, self._note)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self.exit_code:
            found = describe(frame)
            raise KeyboardInterrupt(f"in the middle of {found[1]}" if found else "")
        self.exit_code = 128 + number
        if self._noted is not None:
            self._noted()
