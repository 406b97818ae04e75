"""Module `signal` of a program: it stores handlers; the end of the run is the signal SIGINT."""

from __future__ import annotations

import signal as _python
from collections.abc import Callable
from types import FrameType
from typing import Final, NoReturn

from simkit_nodes.host import current_program
from simkit_nodes.tasks import ProgramEnd, current_task

__all__ = [
    "alarm",
    "getsignal",
    "pause",
    "raise_signal",
    "set_wakeup_fd",
    "setitimer",
    "siginterrupt",
    "signal",
]

_IGNORED: Final = ("SIGCHLD", "SIGWINCH", "SIGURG", "SIGCONT")  # signals that do nothing without a handler

Handler = Callable[[int, FrameType | None], object] | int | None


def signal(number: int, handler: Handler) -> Handler:
    """Store the handler of a signal and return the one before; possible in any thread."""
    if not callable(handler) and handler not in (_python.SIG_DFL, _python.SIG_IGN):
        raise TypeError("signal handler must be signal.SIG_IGN, signal.SIG_DFL, or a callable object")
    handlers = current_program().signal_handlers
    before = getsignal(number)
    handlers[int(number)] = handler
    return before


def getsignal(number: int) -> Handler:
    """Return the handler of a signal."""
    default: Handler = _python.default_int_handler if number == _python.SIGINT else _python.SIG_DFL
    return current_program().signal_handlers.get(int(number), default)


def deliver(number: int) -> None:
    """Call the handler of a signal in the calling thread; without a handler, the program ends."""
    handler = getsignal(number)
    if callable(handler):
        task = current_task()
        handler(number, None if task is None else task.frame)
    elif handler != _python.SIG_IGN and _python.Signals(number).name not in _IGNORED:
        current_program().is_exiting = True
        raise ProgramEnd


raise_signal = deliver


def pause() -> None:
    """Wait for a signal."""
    current_program().host.wait()


def setitimer(which: int, seconds: float, interval: float = 0.0) -> NoReturn:
    """Raise OSError: timers of the process would follow wall time."""
    raise OSError("a program in lock-step has no signal of a timer; use threading.Timer")


def alarm(seconds: int) -> NoReturn:
    """Raise OSError: timers of the process would follow wall time."""
    setitimer(0, seconds)


def set_wakeup_fd(fd: int, *, warn_on_full_buffer: bool = True) -> int:
    """Do nothing: signals of the process do not reach the program."""
    return -1


def siginterrupt(number: int, flag: bool) -> None:
    """Do nothing: waits of the program are not calls of the operating system."""
