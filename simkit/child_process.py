"""A program of ours in a process apart: what it says is kept short, it has a limit, and it ends when this one does."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Final

_KEPT_BYTES: Final = 1 << 16  # bytes of its last words
_CHUNK: Final = 1 << 16
_MAX_LINE_LENGTH: Final = 500  # letters of a line that are kept
_OUTPUT_WAIT: Final = 2.0  # [s] that are waited for what it said, where a process that it began holds the pipe


@dataclass(frozen=True)
class ProcessResult:
    """How a process ended.

    Attributes:
        code: its exit code, negative for a signal.
        said: the end of what it wrote to standard output and standard error.
        is_late: whether it was ended because its limit had passed.
    """

    code: int
    said: str
    is_late: bool = False

    def last_lines(self, most: int) -> list[str]:
        """The last lines that it wrote, none of them very long."""
        return [line[:_MAX_LINE_LENGTH] for line in self.said.splitlines()[-most:]]


class ChildProcesses:
    """Runs modules of ours in processes of their own; several threads may do so at a time."""

    def __init__(self) -> None:
        self._alive: set[subprocess.Popen[bytes]] = set()
        self._lock = threading.Lock()
        self._is_over = False

    def run(
        self,
        module: str,
        arguments: Sequence[str],
        *,
        environment: Mapping[str, str] | None = None,
        folder: Path | None = None,
        limit: float | None = None,
    ) -> ProcessResult:
        """Runs `python -m module arguments` to its end, or until its limit.

        The module calls `exit_with_parent` first.

        Args:
            module: full name.
            arguments: of its command line.
            environment: all its variables; ours where not given.
            folder: it stands in; ours where not given.
            limit: wall time [s]; none where not given.
        """
        with self._lock:
            if self._is_over:
                return ProcessResult(-signal.SIGTERM, "")
            process = subprocess.Popen(
                [sys.executable, "-P", "-m", module, *arguments],  # -P: no file beside us stands for a module of ours
                stdin=subprocess.PIPE,  # nothing is ever written: its end tells that we are gone
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                env=environment,
                cwd=folder,
                start_new_session=True,
            )
            self._alive.add(process)
        tail = _OutputTail(process.stdout)
        try:
            process.wait(limit)
            is_late = False
        except subprocess.TimeoutExpired:
            is_late = True
        finally:
            self._end(process)
        return ProcessResult(process.wait(), tail.text(), is_late)

    def end(self) -> None:
        """Ends whatever runs, and begins nothing more."""
        with self._lock:
            self._is_over = True
            alive = tuple(self._alive)
        for process in alive:
            _kill(process)

    def _end(self, process: subprocess.Popen[bytes]) -> None:
        _kill(process)
        process.wait()
        if process.stdin is not None:
            process.stdin.close()
        with self._lock:
            self._alive.discard(process)


class _OutputTail:
    """Reads all that a process says, so that it never waits for us, and keeps the end of it."""

    def __init__(self, pipe: IO[bytes] | None) -> None:
        self._pipe, self._kept = pipe, bytearray()
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def text(self) -> str:
        self._thread.join(_OUTPUT_WAIT)
        return bytes(self._kept).decode("utf-8", "replace")

    def _read(self) -> None:
        if self._pipe is None:
            return
        with self._pipe as pipe:
            while content := os.read(pipe.fileno(), _CHUNK):
                self._kept += content
                del self._kept[:-_KEPT_BYTES]


def _kill(process: subprocess.Popen[bytes]) -> None:
    """Ends a process, and what it has begun, which may be there still where it has ended itself."""
    if hasattr(os, "killpg"):
        try:
            os.killpg(process.pid, signal.SIGKILL)  # a session of its own: its number is the group's
            return
        except (ProcessLookupError, PermissionError):
            pass
    if process.poll() is None:
        process.kill()


def exit_with_parent() -> None:
    """In the process apart: ends it, and what it has begun, once whoever began it is gone, however that went."""
    try:
        pipe = os.dup(0)
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        os.close(nothing)
    except OSError:
        return

    def watch() -> None:
        with suppress(OSError):
            while os.read(pipe, 1):
                pass
        exit_immediately(1)

    threading.Thread(target=watch, name="simkit ends with its parent", daemon=True).start()


def exit_immediately(code: int) -> None:
    """In the process apart: ends what it has begun, and itself, whatever threads there are."""
    if hasattr(os, "killpg") and os.getpgrp() == os.getpid():
        with suppress(OSError, ValueError):  # only the main thread may say what a signal does: then it takes us along
            signal.signal(signal.SIGTERM, signal.SIG_IGN)
        with suppress(OSError):
            os.killpg(0, signal.SIGTERM)
    os._exit(code)
