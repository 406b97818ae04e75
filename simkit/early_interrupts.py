"""Ctrl-C and SIGTERM in the first milliseconds of a command, before its own handler of signals is imported.

Without this module, Ctrl-C would print a traceback of simkit's first files. While Python itself starts, a signal still
ends the process in Python's way: without a message, or with a traceback of Python's own files.
"""

from __future__ import annotations

# not `signal`: `python -m simkit` would import a file of that name in the working directory
import _signal as signal  # type: ignore[import-not-found]
import os
import sys

TYPE_CHECKING = False  # `typing` takes 3 ms
if TYPE_CHECKING:
    from typing import NoReturn


def install_in_command() -> None:
    """Handle both signals if this process is the command `simkit`, not another program that imports simkit."""
    if not _is_command():
        return
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, _end)


def _is_command() -> bool:
    """Check for `python -m simkit …` and `simkit …`; a process that `multiprocessing` starts has other arguments."""
    arguments = sys.orig_argv[1:3]
    return arguments == ["-m", "simkit"] or os.path.basename("".join(arguments[:1])) in ("simkit", "simkit.exe")  # noqa: PTH119


def _end(number: int, _frame: object) -> NoReturn:
    os.write(2, b"interrupted\n")
    os._exit(128 + number)
