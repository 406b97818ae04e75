"""Keyboard of a terminal: reads keys without waiting, and decodes the escape sequences of the terminal."""

from __future__ import annotations

import os
import select
import signal
import sys
import threading
from collections.abc import Callable
from types import FrameType
from typing import IO, Any, Final

from simkit.bridges.teleop import DOWN, LEFT, RIGHT, UP

_LONGEST_SEQUENCE: Final = 32  # [bytes]; longer byte strings are not a sequence
_ESCAPE: Final = 0x1B
_ARROWS: Final = {"A": UP, "B": DOWN, "C": RIGHT, "D": LEFT}
_WINDOWS_ARROWS: Final = {"H": UP, "P": DOWN, "M": RIGHT, "K": LEFT}


class KeyDecoder:
    """Splitter of terminal input into keys. An escape sequence may arrive in pieces.

    Arrows with a modifier count as arrows. Other escape sequences (Home, F5, the mouse, the marks around pasted text)
    are ignored.
    """

    def __init__(self) -> None:
        self._rest = b""

    def decode(self, data: bytes) -> list[str]:
        """Return the keys in `data`, including a sequence that began in earlier data."""
        data, self._rest = self._rest + data, b""
        keys: list[str] = []
        at = 0
        while at < len(data):
            if data[at] != _ESCAPE:
                if data[at] < 0x80:  # no command is outside ASCII
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
    """Return the end of the sequence that begins at `at`; None if the sequence is incomplete (ECMA-48: CSI, SS3)."""
    if at + 1 >= len(data):
        return None
    kind = data[at + 1]
    if kind == ord("O"):
        return at + 3 if at + 2 < len(data) else None
    if kind != ord("["):
        return at + 1  # the key Esc, followed by another key
    for end in range(at + 2, min(len(data), at + _LONGEST_SEQUENCE)):
        if 0x40 <= data[end] <= 0x7E:
            return end + 1
        if not 0x20 <= data[end] <= 0x3F:
            return end  # interrupted sequence
    return None


def windows_keys(characters: str) -> list[str]:
    """Return the keys in the output of `msvcrt.getwch`.

    An arrow is two characters; the first is NUL or 0xE0.
    """
    keys: list[str] = []
    remaining = iter(characters)
    for character in remaining:
        if character not in "\x00\xe0":
            keys.append(character)
        elif (name := _WINDOWS_ARROWS.get(next(remaining, ""))) is not None:
            keys.append(name)
    return keys


_READ_BYTES: Final = 1024  # [bytes] per read
_SHOW_CURSOR: Final = b"\x1b[?25h"


def open_keyboard(stream: IO[str] | None) -> Keyboard | WindowsKeyboard | None:
    """Open the keyboard of a terminal; return None if `stream` is not a terminal."""
    try:
        if stream is None or not stream.isatty():
            return None
        file = stream.fileno()
    except (OSError, ValueError):  # the stream is closed, or has no file descriptor
        return None
    return WindowsKeyboard() if sys.platform == "win32" else Keyboard(file)


class Keyboard:
    """Keyboard of a terminal; a context manager.

    A background process must not touch the terminal, or the system stops the process (SIGTTIN, SIGTTOU). Reading
    resumes when the process comes to the foreground.

    Args:
        file: file descriptor of the terminal.

    Attributes:
        is_lost: True after the terminal has closed; no more keys can arrive.
    """

    def __init__(self, file: int) -> None:
        self._file = file
        self._decoder = KeyDecoder()
        self._original_modes: list[int | list[bytes | int]] | None = None  # modes before key mode
        self._is_key_mode = False
        self._handlers: dict[int, Any] = {}
        self.is_lost = False

    def __enter__(self) -> Keyboard:
        if threading.current_thread() is threading.main_thread():
            for number, handler in ((signal.SIGTSTP, self._suspend), (signal.SIGCONT, self._continue)):
                if signal.getsignal(number) is signal.SIG_DFL:  # do not replace a handler that is already set
                    self._handlers[number] = signal.signal(number, handler)
        self._enter_key_mode()
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        self._handlers.clear()
        self._restore_modes(drop_keys=True)

    def read(self) -> list[str]:
        """Return the keys pressed since the last call, the oldest first, without waiting.

        One call reads at most 1024 bytes.
        """
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
        """Switch the terminal to single keys without echo; return True if the switch was made."""
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
            if drop_keys:  # unread keys must not reach the shell
                termios.tcflush(self._file, termios.TCIFLUSH)
            termios.tcsetattr(self._file, termios.TCSANOW, self._original_modes)
        except termios.error:
            self.is_lost = True

    # ------------------------------------------------------------------ Ctrl-Z and fg

    def _suspend(self, number: int, _: FrameType | None) -> None:
        """Restore the terminal and its cursor for the shell, then stop the process as Ctrl-Z does."""
        self._restore_modes(drop_keys=False)
        if sys.stdout is not None and _is_terminal(sys.stdout.fileno) and os.environ.get("TERM") != "dumb":
            os.write(sys.stdout.fileno(), _SHOW_CURSOR)
        before = signal.signal(number, signal.SIG_DFL)
        signal.pthread_kill(
            threading.get_ident(), number
        )  # signal this thread, so that the process stops here and not later
        signal.signal(number, before)

    def _continue(self, _: int, __: FrameType | None) -> None:
        """Read the terminal's modes again after the shell's `fg` or `bg`."""
        self._is_key_mode = False


def _is_terminal(fileno: Callable[[], int]) -> bool:
    try:
        return os.isatty(fileno())
    except (OSError, ValueError):
        return False


class WindowsKeyboard:
    """Keyboard of a Windows console, which has no modes to change."""

    is_lost = False

    def __enter__(self) -> WindowsKeyboard:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def read(self) -> list[str]:
        """Return the keys pressed since the last call, the oldest first."""
        import msvcrt

        characters = ""
        console: Any = msvcrt
        while console.kbhit() and len(characters) < _READ_BYTES:
            characters += console.getwch()
        return windows_keys(characters)
