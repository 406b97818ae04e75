"""Keys from a terminal, one by one as they are pressed, without anybody waiting for them.

While keys are read the terminal shows none of them and gives each at once; Ctrl-C, Ctrl-Z and the like mean what they
always do. It is left as it was found: at the end, whenever the process is stopped with Ctrl-Z, and after an exception.
"""

from __future__ import annotations

import os
import select
import signal
import sys
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import IO, Any, Final

from simkit.cli.driving.keys import KeyDecoder, windows_keys

_MOST: Final = 1024  # [bytes] looked at at a time
_SHOW_CURSOR: Final = b"\x1b[?25h"


def keyboard_of(stream: IO[Any] | None) -> Keyboard | WindowsKeyboard | None:
    """Reads the keys of a terminal; None where `stream` is none."""
    try:
        if stream is None or not stream.isatty():
            return None
        file = stream.fileno()
    except (OSError, ValueError):  # closed, or no file at all
        return None
    return WindowsKeyboard() if sys.platform == "win32" else Keyboard(file)


class Keyboard:
    """The keys of a terminal; a context manager.

    A process in the background leaves the terminal alone, for the system would stop it (SIGTTIN, SIGTTOU); when it is
    brought to the foreground it reads keys again.

    Args:
        file: the terminal's file descriptor.

    Attributes:
        is_lost: whether the terminal is gone: no key will come any more.
    """

    def __init__(self, file: int) -> None:
        self._file = file
        self._decoder = KeyDecoder()
        self._before: list[Any] | None = None  # the terminal's modes, as they were found
        self._is_taken = False
        self._handlers: dict[int, Any] = {}
        self.is_lost = False

    def __enter__(self) -> Keyboard:
        if threading.current_thread() is threading.main_thread():
            for number, handler in ((signal.SIGTSTP, self._stop), (signal.SIGCONT, self._go_on)):
                if signal.getsignal(number) is signal.SIG_DFL:  # somebody ignores them, or has ideas of their own
                    self._handlers[number] = signal.signal(number, handler)
        self._take()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        self._handlers.clear()
        self._give_back(drop_keys=True)

    def read(self) -> list[str]:
        """The keys pressed since it was last asked, the oldest first; at once, and of a flood only the first ones."""
        if self.is_lost or not (self._is_taken or self._take()):
            return []
        try:
            if not self._is_in_front() or not select.select([self._file], [], [], 0)[0]:
                return []
            data = os.read(self._file, _MOST)
        except BlockingIOError:
            return []
        except OSError:
            data = b""
        if not data:
            self.is_lost = True
        return self._decoder.decode(data)

    # ------------------------------------------------------------------ the terminal's modes

    def _is_in_front(self) -> bool:
        """Whether the terminal is ours to use; one that controls no processes always is."""
        try:
            return os.tcgetpgrp(self._file) == os.getpgrp()
        except OSError:
            return True

    def _take(self) -> bool:
        """Has the terminal give keys; whether it does."""
        import termios

        if not self._is_in_front():
            return False
        try:
            modes = termios.tcgetattr(self._file)
            if self._before is None or modes[3] & termios.ICANON:
                self._before = modes
            modes = [*modes[:3], modes[3] & ~(termios.ICANON | termios.ECHO), *modes[4:6], list(modes[6])]
            modes[6][termios.VMIN], modes[6][termios.VTIME] = 1, 0
            termios.tcsetattr(self._file, termios.TCSANOW, modes)
        except termios.error:
            self.is_lost = True
            return False
        self._is_taken = True
        return True

    def _give_back(self, *, drop_keys: bool) -> None:
        import termios

        if not self._is_taken or self._before is None:
            return
        self._is_taken = False
        if not self._is_in_front():
            return
        try:
            if drop_keys:  # keys that nobody has taken are none of the shell's
                termios.tcflush(self._file, termios.TCIFLUSH)
            termios.tcsetattr(self._file, termios.TCSANOW, self._before)
        except termios.error:
            self.is_lost = True

    # ------------------------------------------------------------------ Ctrl-Z and fg

    def _stop(self, number: int, _: FrameType | None) -> None:
        """Ctrl-Z: leaves the terminal to the shell, with its cursor, and stops as it would have without us."""
        self._give_back(drop_keys=False)
        if sys.stdout is not None and _is_terminal(sys.stdout.fileno):
            os.write(sys.stdout.fileno(), _SHOW_CURSOR)
        before = signal.signal(number, signal.SIG_DFL)
        signal.pthread_kill(threading.get_ident(), number)  # of this thread, so that it stops here and not later
        signal.signal(number, before)

    def _go_on(self, _: int, __: FrameType | None) -> None:
        """fg or bg: the terminal's modes are looked at anew."""
        self._is_taken = False


def _is_terminal(fileno: Callable[[], int]) -> bool:
    try:
        return os.isatty(fileno())
    except (OSError, ValueError):
        return False


class WindowsKeyboard:
    """The same of a console on Windows, which has no modes to be changed."""

    is_lost = False

    def __enter__(self) -> WindowsKeyboard:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        pass

    def read(self) -> list[str]:
        """The keys pressed since it was last asked, the oldest first."""
        import msvcrt

        characters = ""
        console: Any = msvcrt
        while console.kbhit() and len(characters) < _MOST:
            characters += console.getwch()
        return windows_keys(characters)
