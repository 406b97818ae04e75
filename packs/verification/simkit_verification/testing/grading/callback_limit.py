"""Limit of the time for which a callback of a hand-in may run without any progress of the run.

The judge notices that the stream has stopped, and asks for the stack of the other process. The callback is stopped if
the hand-in is on the stack for the limit of wall time, and has also computed for the limit of processor time, or waits.
So a busy machine stops no callback that would end on an idle one. A library that the hand-in imports gets more time.
"""

from __future__ import annotations

import faulthandler
import linecache
import os
import re
import signal
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TextIO

DEFAULT_LIMIT: Final = 5.0  # [s]
_IMPORT_FACTOR: Final = 6.0  # an import may take so many times the limit
_LONGEST_FACTOR: Final = 3.0  # a callback is stopped after so many times the limit, however busy the machine is
_WAITING_SHARE: Final = 0.1  # a process that computes for a smaller share of the time waits
_STACK_SIGNAL: Final = getattr(signal, "SIGUSR2", None)
_ANSWER_WAIT: Final = 0.5  # [s] longest wait for a stack
_FRAME: Final = re.compile(r'^  File "(.*)", line (\d+) in (.*)$')
_IMPORTER: Final = "<frozen importlib"


def is_debugged() -> bool:
    """Check whether a debugger traces this process."""
    if sys.gettrace() is not None or "debugpy" in sys.modules:
        return True
    monitoring = getattr(sys, "monitoring", None)  # from Python 3.12 on
    return monitoring is not None and monitoring.get_tool(monitoring.DEBUGGER_ID) is not None


def write_stacks_to(file: TextIO) -> None:
    """Let the judge ask for the stack of this process, even in the middle of a function in C.

    Windows has no signals for this; there, a thread writes the stack every second, when it gets the interpreter.
    """
    if _STACK_SIGNAL is not None:
        faulthandler.register(_STACK_SIGNAL, file, all_threads=False, chain=False)
        return

    def write() -> None:
        while True:
            time.sleep(1.0)
            faulthandler.dump_traceback(file, all_threads=True)

    threading.Thread(target=write, name="simkit writes stacks", daemon=True).start()


@dataclass(frozen=True)
class CallbackPosition:
    """Position of a hand-in on a stack.

    Attributes:
        callback: Function of the hand-in that simkit called; `<module>` while a file is imported.
        file: File of the line that runs.
        line: Number of the line.
        imports: True if the line imports a module.
    """

    callback: str
    file: str
    line: int
    imports: bool

    @property
    def callback_text(self) -> str:
        """Name of the callback for a message."""
        return "the import of the hand-in" if self.callback == "<module>" else f"the callback {self.callback}"

    @property
    def text(self) -> str:
        """Position and text of the line."""
        line = linecache.getline(self.file, self.line).strip()
        return f"{Path(self.file).name}:{self.line}" + (f": {line[:120]}" if line else "")


def callback_position(stack: str, is_of_hand_in: Callable[[str], bool]) -> CallbackPosition | None:
    """Return the position of a hand-in on a stack of `faulthandler`; None if it is not on the stack.

    Args:
        stack: Text with the innermost frame first.
        is_of_hand_in: Function that checks the name of a file.
    """
    frames = [match.groups() for match in map(_FRAME.match, stack.splitlines()) if match is not None]
    in_hand_in = [at for at, (file, _, _) in enumerate(frames) if is_of_hand_in(file)]
    if not in_hand_in:
        return None
    file, line, _ = frames[in_hand_in[0]]
    name = frames[in_hand_in[-1]][2]
    imports = any(inner.startswith(_IMPORTER) for inner, _, _ in frames[: in_hand_in[0]])
    return CallbackPosition(name, file, int(line), imports)


class CallbackLimit:
    """Limit of the time of one callback in another process.

    Args:
        process: Number of the process.
        stacks: File to which the process writes its stack.
        limit: Limit [s]; 0 for none.
        is_of_hand_in: Function that checks whether a file belongs to the hand-in.
    """

    def __init__(self, process: int, stacks: Path, limit: float, is_of_hand_in: Callable[[str], bool]) -> None:
        self._process, self._stacks, self._is_of_hand_in = process, stacks, is_of_hand_in
        self.limit = limit
        self.note_progress()

    def note_progress(self) -> None:
        """Begin again, because the run has gone on."""
        self._since = self._sampled = time.monotonic()
        self._is_measured = False  # reading the processor time after every chunk would take too long
        self._callback, self._callback_since = "", 0.0

    @property
    def idle_time(self) -> float:
        """Wall time since the last progress [s]."""
        return time.monotonic() - self._since

    def exceeded(self) -> CallbackPosition | None:
        """Return the position of a callback that is over the limit; None if there is none."""
        now = time.monotonic()
        elapsed = now - self._since
        if not self._is_measured:
            self._computed, self._is_measured = _processor_time(self._process), True
        if not self.limit or elapsed < 0.5 * self.limit or now - self._sampled < 0.2 * self.limit:
            return None
        self._sampled = now
        position = callback_position(self._stack(), self._is_of_hand_in)
        if position is None or position.callback != self._callback:
            self._callback, self._callback_since = ("", 0.0) if position is None else (position.callback, now)
            return None
        limit = self.limit * (_IMPORT_FACTOR if position.imports else 1.0)
        is_over = elapsed >= limit and now - self._callback_since >= 0.4 * self.limit
        return position if is_over and self._computes_or_waits(elapsed, limit) else None

    def _computes_or_waits(self, elapsed: float, limit: float) -> bool:
        """Check that the callback had the processor for the limit, or does not need it."""
        if self._computed is None or elapsed >= _LONGEST_FACTOR * limit:
            return True
        computed = (_processor_time(self._process) or 0.0) - self._computed
        return computed >= limit or computed <= _WAITING_SHARE * elapsed

    def _stack(self) -> str:
        """Ask the process for its stack."""
        try:
            before = self._stacks.stat().st_size
            if _STACK_SIGNAL is None:
                before = max(0, before - (1 << 16))
            else:
                os.kill(self._process, _STACK_SIGNAL)
            size, deadline = before, time.monotonic() + _ANSWER_WAIT
            while time.monotonic() < deadline:
                time.sleep(0.02)
                grown = self._stacks.stat().st_size
                if grown == size > before:
                    break
                size = grown
            with self._stacks.open("rb") as file:
                file.seek(before)
                return file.read(1 << 20).decode("utf-8", "replace")
        except OSError:  # the process has ended, or removed the file
            return ""


def _processor_time(process: int) -> float | None:
    """Return the processor time of a process so far [s]; None if the operating system does not tell it."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    except (OSError, ValueError, IndexError, AttributeError):
        return None
