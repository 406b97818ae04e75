"""The wall time of a run: once it is over the run ends, and what keeps it from that is told, interrupted, and left."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from types import FrameType
from typing import Final

from simkit.cli.terminal.blocked_plugins import describe_blocking_plugin

GRACE_SECONDS: Final = 2.0
"""[s] after which what does not come to its end is interrupted."""
ABORT_SECONDS: Final = 8.0
"""[s] after which a process that cannot be interrupted is ended."""
SignalHandler = Callable[[int, FrameType | None], object] | int | None
"""What `signal.signal` takes and returns."""
_ALARM: Final = getattr(signal, "SIGALRM", None)  # Windows has none


class WallTimeExceeded(KeyboardInterrupt):
    """Raised within what did not come to its end."""


class WallTimeLimit:
    """While entered, watches the clock; entered by the thread that runs the simulation.

    Args:
        seconds: wall time from now on [s]; None for as long as it takes.
        say: gets a line about what keeps the run.
        give_up: called, on another thread, before the process is ended; gives the exit code.

    Attributes:
        is_over: whether the time is.
        blocked_by: what had to be interrupted; empty for nothing.
    """

    def __init__(self, seconds: float | None, say: Callable[[str], None], give_up: Callable[[], int]) -> None:
        self.seconds, self.is_over, self.blocked_by = seconds, False, ""
        self._say, self._give_up = say, give_up
        self._thread_id = threading.get_ident()
        self._ended = threading.Event()
        self._before: SignalHandler = None
        self._may_alarm = _ALARM is not None and threading.current_thread() is threading.main_thread()

    def __enter__(self) -> WallTimeLimit:
        if self.seconds is not None:
            if self._may_alarm:
                self._before = signal.signal(_ALARM, self._interrupt)  # type: ignore[arg-type]
            threading.Thread(target=self._watch, name="simkit wall time", daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self.end()
        if self.seconds is not None and self._may_alarm:
            signal.signal(_ALARM, self._before)  # type: ignore[arg-type]

    def end(self) -> None:
        """Says that the run has ended."""
        self._ended.set()

    def _watch(self) -> None:
        assert self.seconds is not None
        if self._ended.wait(self.seconds):
            return
        self.is_over = True
        if self._ended.wait(GRACE_SECONDS):
            return
        found = self._at_work()
        what = self.blocked_by = found[1] if found else "something that is no plugin's"
        self._say(f"the wall time of {self.seconds:g} s is over, and the run waits for {what}: it is interrupted")
        deadline, is_first = time.monotonic() + ABORT_SECONDS, True
        while time.monotonic() < deadline:
            now = self._at_work()
            if self._may_alarm and (is_first or (found and now and found[0] is now[0])):  # one may swallow the first
                signal.pthread_kill(self._thread_id, _ALARM)  # type: ignore[arg-type]
            is_first = False
            if self._ended.wait(1.0):
                return
        self._say(f"{what} cannot be interrupted: the process ends here; simkit bag recover mends a recording")
        code = self._give_up()
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
        os._exit(code)

    def _at_work(self) -> tuple[FrameType, str] | None:
        """What plugin the run is in: the frame of the call, and which in words."""
        return describe_blocking_plugin(sys._current_frames().get(self._thread_id))

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        if not self._ended.is_set():
            raise WallTimeExceeded
