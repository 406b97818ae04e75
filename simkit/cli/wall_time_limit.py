"""Wall time limit of a run. A run that does not end in time is reported, interrupted, and finally terminated."""

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
"""Time between the limit and the interrupt of a blocked run [s], wall time."""
ABORT_SECONDS: Final = 8.0
"""Time between the interrupt and the end of a process that cannot be interrupted [s], wall time."""
SignalHandler = Callable[[int, FrameType | None], object] | int | None
"""Signal handler, as `signal.signal` accepts and returns it."""
_ALARM: Final = getattr(signal, "SIGALRM", None)  # Windows has no SIGALRM


class WallTimeExceeded(KeyboardInterrupt):
    """Interrupt of a run that did not end in time."""


class WallTimeLimit:
    """Context manager that limits the wall time of a run. The thread of the simulation must enter it.

    Args:
        seconds: wall time limit from the start of the context [s]; None for no limit.
        say: callback for a line about the blocked run.
        give_up: callback on another thread before the process is terminated; returns the exit code.

    Attributes:
        is_over: True after the limit.
        blocked_by: description of the interrupted plugin; empty if nothing was interrupted.
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
        """Stop the limit after the run has ended."""
        self._ended.set()

    def _watch(self) -> None:
        assert self.seconds is not None
        if self._ended.wait(self.seconds):
            return
        self.is_over = True
        if self._ended.wait(GRACE_SECONDS):
            return
        blocking = self._at_work()
        blocker = self.blocked_by = blocking[1] if blocking else "code outside plugins"
        self._say(f"the wall time of {self.seconds:g} s is over; interrupting {blocker}")
        deadline, is_first = time.monotonic() + ABORT_SECONDS, True
        while time.monotonic() < deadline:
            now = self._at_work()
            if self._may_alarm and (
                is_first or (blocking and now and blocking[0] is now[0])
            ):  # a plugin may catch the first interrupt
                signal.pthread_kill(self._thread_id, _ALARM)  # type: ignore[arg-type]
            is_first = False
            if self._ended.wait(1.0):
                return
        self._say(f"{blocker} cannot be interrupted; terminating (recover a recording with `simkit bag recover`)")
        code = self._give_up()
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
        os._exit(code)

    def _at_work(self) -> tuple[FrameType, str] | None:
        """Return the frame and the description of the plugin call that is active in the run."""
        return describe_blocking_plugin(sys._current_frames().get(self._thread_id))

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        if not self._ended.is_set():
            raise WallTimeExceeded
