"""Protocol of a bridge process: one JSON object per line on standard output.

`ready` describes what is open, `note` is for the user, `ended` is the reason for the end of the simulation, and `error`
that of an end with an error.
"""

from __future__ import annotations

import ctypes
import json
import signal
from collections.abc import Callable
from contextlib import suppress
from typing import Final

from simkit.bridges.live.protocol import LiveClosed, LiveError
from simkit.child_process import exit_with_parent

_MEMORY_OPTIONS: Final = ((-1, 128 << 20), (-3, 32 << 20))  # M_TRIM_THRESHOLD and M_MMAP_THRESHOLD of glibc [bytes]


def tell(**words: object) -> None:
    """Write a line to the process that started the bridge."""
    print(json.dumps(words), flush=True)  # noqa: T201 - this is the protocol of the process


def begin() -> None:
    """End this process with its parent, and ignore Ctrl-C, which ends the simulation and so the bridge."""
    exit_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _keep_freed_memory()


def _keep_freed_memory() -> None:
    """Let the C library keep freed memory: new pages for each image take half of a bridge's processor time."""
    with suppress(AttributeError, OSError, TypeError):  # another C library, or Windows
        for option, size in _MEMORY_OPTIONS:
            ctypes.CDLL(None).mallopt(option, size)


def run_until_end(run: Callable[[], None]) -> int:
    """Call a function that runs until the simulation ends; report the reason and return the exit code."""
    try:
        run()
    except LiveClosed as end:
        tell(ended=str(end))
    except LiveError as error:
        tell(error=str(error))
        return 1
    return 0
