"""Ctrl-C and SIGTERM: a command ends within about a second, without a traceback, with exit code 130 or 143.

Before a command runs, while modules are imported, a signal ends the process at once. While the command runs, a signal
raises `Interrupted`, which `report_errors` turns into one line and the exit code. `simkit run` installs its own handler
for the time of the run.
"""

from __future__ import annotations

import _thread
import atexit
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

TYPE_CHECKING = False
if TYPE_CHECKING:
    from types import FrameType
    from typing import NoReturn

_LONGEST_CALL = 0.7  # [s] of wall time after which a call of the engine is no longer waited for
_CHECK = 0.2  # [s] of wall time between two checks whether the interrupt was lost
_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Interrupted(KeyboardInterrupt):
    """Interrupt of a command by a signal.

    Attributes:
        exit_code: exit code of the process, 128 + number of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__()
        self.exit_code = 128 + number


class _Handler:
    """Signal handler of the command line.

    Attributes:
        is_running: True while a command runs, so that its files and child processes need an orderly end.
        received: number of the received signal; 0 if none was received.
        before_exit: callbacks before the process ends at once.
    """

    def __init__(self) -> None:
        self.is_running = False
        self.received = 0
        self.before_exit: list[Callable[[], None]] = []
        self._is_check = False
        self._unanswered = _thread.allocate_lock()
        self._main_thread = 0

    def __call__(self, number: int, frame: FrameType | None) -> None:
        is_check, self._is_check = self._is_check, False
        if is_check and (not self.is_running or _is_unwinding()):
            return
        if not self.is_running:
            self._exit(number)
        if not self.received:
            self.received = number
            self._unanswered.release()
            _thread.start_new_thread(self._check, ())
        raise Interrupted(number)

    def watch(self) -> None:
        """Start a thread that ends the process if a signal finds the main thread in a long call of the engine.

        Python handles signals between two instructions only, but compiling a large model is one call into C.
        """
        self._unanswered.acquire(blocking=False)
        self._main_thread = _thread.get_ident()
        reader, writer = os.pipe()
        if hasattr(os, "set_blocking"):  # Windows has it since Python 3.12, and needs it for sockets only
            os.set_blocking(writer, False)
        signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
        _thread.start_new_thread(self._wait, (reader,))

    def _wait(self, pipe: int) -> None:
        while received := os.read(pipe, 1):
            number = received[0]
            is_first = number in _SIGNALS and not self.received and self._is_active(number)
            if is_first and not self._unanswered.acquire(timeout=_LONGEST_CALL):
                self._exit(number)

    def _check(self) -> None:
        """Raise the interrupt again if it was lost.

        Python ignores exceptions in `__del__`, and many libraries in C ignore them in the Python code that they call.
        """
        while self.is_running:
            time.sleep(_CHECK)
            if self.is_running and self._is_active(self.received):
                self._is_check = True
                if hasattr(signal, "pthread_kill"):  # a system call of the main thread then ends early
                    signal.pthread_kill(self._main_thread, self.received)
                else:
                    signal.raise_signal(self.received)

    def _is_active(self, number: int) -> bool:
        """Check whether this object handles a signal. `simkit run` replaces it for the time of the run."""
        handler: object = signal.getsignal(number)
        return handler is self

    def _exit(self, number: int) -> NoReturn:
        for callback in self.before_exit:
            with suppress(Exception):
                callback()
        with suppress(OSError):
            os.write(2, b"interrupted\n")
        os._exit(128 + number)


_handler = _Handler()
_is_installed = False


def install() -> None:
    """Handle Ctrl-C and SIGTERM in this process. A signal that the process ignores stays ignored (`nohup`, `&`)."""
    global _is_installed
    for number in _SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _handler)
            _is_installed = True
    atexit.register(_ignore_signals)


@contextmanager
def running_command() -> Iterator[None]:
    """Raise `Interrupted` for a signal while a command runs. Without `install`, nothing changes."""
    if not _is_installed or _handler.is_running:
        yield
        return
    _handler.watch()
    sys.unraisablehook = _hide_lost_interrupt
    _handler.is_running = True
    try:
        yield
    except Exception:
        if _handler.received:  # MuJoCo reports an interrupt of its import as an ImportError
            raise Interrupted(_handler.received) from None
        raise
    finally:
        _handler.is_running = False


def exit_if_interrupted() -> None:
    """End the process after an interrupted command, without waiting for threads."""
    if _handler.received:
        for stream in (sys.stdout, sys.stderr):
            with suppress(OSError, ValueError, AttributeError):
                stream.flush()
        atexit._run_exitfuncs()  # without it, semaphores of child processes would be reported as lost
        os._exit(128 + _handler.received)


def before_exit(callback: Callable[[], None]) -> None:
    """Call a function if a signal ends the process at once."""
    _handler.before_exit.append(callback)


def _ignore_signals() -> None:
    """Ignore signals while the interpreter ends, which would restore the default: an end by the signal."""
    for number in _SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def _hide_lost_interrupt(unraisable: sys.UnraisableHookArgs) -> None:
    if not isinstance(unraisable.exc_value, Interrupted):
        sys.__unraisablehook__(unraisable)


def _is_unwinding() -> bool:
    """Check whether the main thread is handling an interrupt, for example in a `finally` block."""
    error = sys.exc_info()[1]
    while error is not None and not isinstance(error, Interrupted):
        error = error.__context__
    return error is not None
