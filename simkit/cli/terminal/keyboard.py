"""Read keys from a terminal without waiting for them, and decode the sequences that a terminal sends."""

from __future__ import annotations

import os
import select
import signal
import sys
import threading
from collections.abc import Callable
from types import FrameType
from typing import IO, Any, Final

UP, DOWN, LEFT, RIGHT = "up", "down", "left", "right"
_LONGEST_SEQUENCE: Final = 32  # [bytes] of a sequence: what is longer is none
_ESCAPE: Final = 0x1B
_ARROWS: Final = {"A": UP, "B": DOWN, "C": RIGHT, "D": LEFT}
_WINDOWS_ARROWS: Final = {"H": UP, "P": DOWN, "M": RIGHT, "K": LEFT}


class KeyDecoder:
    """Splits what comes from a terminal into keys; a sequence may come in pieces.

    Arrows with a modifier count as arrows; other keys that are sequences (Home, F5, the mouse, the marks around what is
    pasted) are none.
    """

    def __init__(self) -> None:
        self._rest = b""

    def decode(self, data: bytes) -> list[str]:
        """The keys in `data`, after what was left of the data before."""
        data, self._rest = self._rest + data, b""
        keys: list[str] = []
        at = 0
        while at < len(data):
            if data[at] != _ESCAPE:
                if data[at] < 0x80:  # the rest of Unicode is no command
                    keys.append(chr(data[at]))
                at += 1
                continue
            end = _end_of_sequence(data, at)
            if end is None:
                if len(data) - at < _LONGEST_SEQUENCE:
                    self._rest = data[at:]
                    break
                end = at + 1
            elif chr(data[end - 1]) in _ARROWS and end - at > 2:
                keys.append(_ARROWS[chr(data[end - 1])])
            at = end
        return keys


def _end_of_sequence(data: bytes, at: int) -> int | None:
    """Return the end of the sequence that begins at `at`; None where more is to come (ECMA-48: CSI, SS3)."""
    if at + 1 >= len(data):
        return None
    kind = data[at + 1]
    if kind == ord("O"):
        return at + 3 if at + 2 < len(data) else None
    if kind != ord("["):
        return at + 1  # the key Esc, and then another
    for end in range(at + 2, min(len(data), at + _LONGEST_SEQUENCE)):
        if 0x40 <= data[end] <= 0x7E:
            return end + 1
        if not 0x20 <= data[end] <= 0x3F:
            return end  # broken off
    return None


def windows_keys(characters: str) -> list[str]:
    """The keys of what `msvcrt.getwch` gave: an arrow is two characters, the first of them "\\x00" or "\\xe0"."""
    keys: list[str] = []
    found = iter(characters)
    for character in found:
        if character not in "\x00\xe0":
            keys.append(character)
        elif (name := _WINDOWS_ARROWS.get(next(found, ""))) is not None:
            keys.append(name)
    return keys


_READ_BYTES: Final = 1024  # [bytes] looked at at a time
_SHOW_CURSOR: Final = b"\x1b[?25h"


def open_keyboard(stream: IO[str] | None) -> Keyboard | WindowsKeyboard | None:
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
        self._original_modes: list[int | list[bytes | int]] | None = None  # the terminal's modes, as they were found
        self._is_key_mode = False
        self._handlers: dict[int, Any] = {}
        self.is_lost = False

    def __enter__(self) -> Keyboard:
        if threading.current_thread() is threading.main_thread():
            for number, handler in ((signal.SIGTSTP, self._suspend), (signal.SIGCONT, self._continue)):
                if signal.getsignal(number) is signal.SIG_DFL:  # somebody ignores them, or has ideas of their own
                    self._handlers[number] = signal.signal(number, handler)
        self._enter_key_mode()
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        self._handlers.clear()
        self._restore_modes(drop_keys=True)

    def read(self) -> list[str]:
        """The keys pressed since it was last asked, the oldest first; at once, and of a flood only the first ones."""
        if self.is_lost or not (self._is_key_mode or self._enter_key_mode()):
            return []
        try:
            if not self._is_foreground() or not select.select([self._file], [], [], 0)[0]:
                return []
            data = os.read(self._file, _READ_BYTES)
        except BlockingIOError:
            return []
        except OSError:
            data = b""
        if not data:
            self.is_lost = True
        return self._decoder.decode(data)

    # ------------------------------------------------------------------ the terminal's modes

    def _is_foreground(self) -> bool:
        """Check whether this process is in the terminal's foreground; a terminal without job control counts as such."""
        try:
            return os.tcgetpgrp(self._file) == os.getpgrp()
        except OSError:
            return True

    def _enter_key_mode(self) -> bool:
        """Switch the terminal to single keys without echo; return whether it did."""
        import termios

        if not self._is_foreground():
            return False
        try:
            modes = termios.tcgetattr(self._file)
            if self._original_modes is None or modes[3] & termios.ICANON:
                self._original_modes = modes
            modes = [*modes[:3], modes[3] & ~(termios.ICANON | termios.ECHO), *modes[4:6], list(modes[6])]
            modes[6][termios.VMIN], modes[6][termios.VTIME] = 1, 0
            termios.tcsetattr(self._file, termios.TCSANOW, modes)
        except termios.error:
            self.is_lost = True
            return False
        self._is_key_mode = True
        return True

    def _restore_modes(self, *, drop_keys: bool) -> None:
        import termios

        if not self._is_key_mode or self._original_modes is None:
            return
        self._is_key_mode = False
        if not self._is_foreground():
            return
        try:
            if drop_keys:  # keys that nobody has taken are none of the shell's
                termios.tcflush(self._file, termios.TCIFLUSH)
            termios.tcsetattr(self._file, termios.TCSANOW, self._original_modes)
        except termios.error:
            self.is_lost = True

    # ------------------------------------------------------------------ Ctrl-Z and fg

    def _suspend(self, number: int, _: FrameType | None) -> None:
        """Ctrl-Z: leaves the terminal to the shell, with its cursor, and stops as it would have without us."""
        self._restore_modes(drop_keys=False)
        if sys.stdout is not None and _is_terminal(sys.stdout.fileno):
            os.write(sys.stdout.fileno(), _SHOW_CURSOR)
        before = signal.signal(number, signal.SIG_DFL)
        signal.pthread_kill(threading.get_ident(), number)  # of this thread, so that it stops here and not later
        signal.signal(number, before)

    def _continue(self, _: int, __: FrameType | None) -> None:
        """fg or bg: the terminal's modes are looked at anew."""
        self._is_key_mode = False


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

    def __exit__(self, *_: object) -> None:
        pass

    def read(self) -> list[str]:
        """The keys pressed since it was last asked, the oldest first."""
        import msvcrt

        characters = ""
        console: Any = msvcrt
        while console.kbhit() and len(characters) < _READ_BYTES:
            characters += console.getwch()
        return windows_keys(characters)
