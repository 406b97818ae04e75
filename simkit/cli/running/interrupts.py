"""Ctrl-C without a torn file: the first one asks the loop to stop, the second one stops at once.

So does the end of the terminal (SIGHUP), unless somebody has it ignored (nohup).
"""

from __future__ import annotations

import os
import signal
import stat
import threading
from collections.abc import Callable
from contextlib import suppress
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
            hang_up = getattr(signal, "SIGHUP", None)  # Windows has none
            if hang_up is not None and signal.getsignal(hang_up) is signal.SIG_DFL:
                self._before[hang_up] = signal.signal(hang_up, self._hang_up)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _hang_up(self, number: int, frame: FrameType | None) -> None:
        """The terminal is gone: what would still be written to it goes nowhere."""
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for file in (1, 2):
            with suppress(OSError):
                if stat.S_ISCHR(os.fstat(file).st_mode):  # isatty says no of a terminal that is gone
                    os.dup2(nowhere, file)
        os.close(nowhere)
        self._note(number, frame)

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self.exit_code:
            found = describe(frame)
            raise KeyboardInterrupt(f"in the middle of {found[1]}" if found else "")
        self.exit_code = 128 + number
        if self._noted is not None:
            self._noted()
