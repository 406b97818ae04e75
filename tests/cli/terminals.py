"""A terminal to run commands in: what a person would type, and what they would see."""

from __future__ import annotations

import os
import re
import select
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from types import TracebackType

import pytest

_PATIENCE = 250.0  # [s] until a command that says nothing is given up: no test ends by it


def open_terminal() -> tuple[int, int]:
    """Open a pseudo-terminal and return its far and near ends. Skip the test on a system that has none."""
    try:
        return os.openpty()
    except OSError as error:
        pytest.skip(f"this system has no pseudo-terminals; mount /dev/pts to run this test ({error})")


class Terminal:
    """Runs a program in a terminal of its own, whose foreground it has; a context manager.

    Args:
        command: the program and its arguments.
        cwd: where.
        size: rows and columns.
        environment: added to ours.

    Attributes:
        process: the program.
        seen: all that it wrote.
    """

    def __init__(
        self, *command: object, cwd: Path, size: tuple[int, int] = (24, 120), environment: dict[str, str] | None = None
    ) -> None:
        self.far, near = open_terminal()
        self.resize(*size)
        ours = {**_without_size(), "PYTHONPATH": os.pathsep.join(sys.path), "TERM": "xterm-256color"}
        ours |= environment or {}
        self.process = subprocess.Popen(
            [str(word) for word in command],
            cwd=cwd, env=ours, stdin=near, stdout=near, stderr=near, start_new_session=True, preexec_fn=_own_terminal,
        )  # fmt: skip
        self.near = near
        self.seen = ""

    def press(self, text: str) -> None:
        """Presses keys."""
        os.write(self.far, text.encode())

    def resize(self, rows: int, columns: int) -> None:
        """Makes the window another size."""
        import termios

        termios.tcsetwinsize(self.far, (rows, columns))

    def wait_for(self, pattern: str) -> re.Match[str]:
        """Reads until a pattern is there that has not been found before; the match."""
        end = time.monotonic() + _PATIENCE
        while (found := re.search(pattern, self.seen)) is None:
            if not self._read(end):
                raise AssertionError(f"{pattern!r} never came:\n{self.seen}")
        self.seen = self.seen[found.end() :]
        return found

    def read(self, seconds: float) -> None:
        """Reads for a time: a program whose output nobody reads stops."""
        end = time.monotonic() + seconds
        while self._read(end):
            pass

    def wait(self) -> int:
        """Reads until the program ends; its exit code."""
        end = time.monotonic() + _PATIENCE
        while self.process.poll() is None:
            if time.monotonic() > end:
                raise AssertionError(f"it does not end:\n{self.seen}")
            self._read(min(end, time.monotonic() + 0.05))
        while self._read(0.0):
            pass
        return self.process.returncode

    def shows_keys(self) -> bool:
        """Whether what is typed is shown, as a shell's terminal does."""
        import termios

        modes = termios.tcgetattr(self.near)[3]
        return bool(modes & termios.ECHO) and bool(modes & termios.ICANON)

    def _read(self, until: float) -> bool:
        left = max(0.0, until - time.monotonic())
        if not select.select([self.far], [], [], left)[0]:
            return False
        self.seen += os.read(self.far, 65536).decode(errors="replace")
        return True

    def __enter__(self) -> Terminal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for end in (self.far, self.near):
            with suppress(OSError):
                os.close(end)
        try:  # a shell takes its jobs along when its terminal is closed
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


def _own_terminal() -> None:
    """In the child: makes the terminal at its standard input the one that controls it."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # tests that `nohup` has started inherit that it is ignored
    import fcntl
    import termios

    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


def _without_size() -> dict[str, str]:
    """The environment but for what is there said of another terminal's size."""
    return {name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES")}
