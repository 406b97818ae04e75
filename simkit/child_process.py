"""Child processes with a time limit: the end of their output is stored, and they stop when their parent ends."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Final

from simkit.hidden_text import hide_everywhere
from simkit.process_control import kill_process_tree

_KEPT_BYTES: Final = 1 << 16  # largest number of stored bytes of output
_CHUNK: Final = 1 << 16
_MAX_LINE_LENGTH: Final = 500  # largest number of characters of a returned line
_OUTPUT_WAIT: Final = 2.0  # [s] longest wait for output; a grandchild process may still hold the pipe


@dataclass(frozen=True)
class ProcessResult:
    """Result of a child process.

    Attributes:
        code: exit code, negative for a signal.
        output: end of the text on standard output and standard error.
        is_late: True if the process was killed because its time limit had passed.
    """

    code: int
    output: str
    is_late: bool = False

    def last_lines(self, most: int) -> list[str]:
        """Return the last lines of the output, each cut to 500 characters."""
        return last_lines(self.output, most)


def last_lines(output: str, most: int) -> list[str]:
    """Return the last lines of an output, each cut to 500 characters."""
    return [line[:_MAX_LINE_LENGTH] for line in output.splitlines()[-most:]]


class ChildProcesses:
    """Runs simkit's modules in child processes. Several threads may use the same object at a time."""

    def __init__(self) -> None:
        self._alive: set[subprocess.Popen[bytes]] = set()
        self._lock = threading.Lock()
        self._is_over = False

    def run(
        self,
        module: str | Path,
        arguments: Sequence[str],
        *,
        environment: Mapping[str, str] | None = None,
        folder: Path | None = None,
        limit: float | None = None,
        on_line: Callable[[str], None] | None = None,
    ) -> ProcessResult:
        """Run `python -m module arguments` until it ends or its time limit passes.

        The module must call `exit_with_parent` first.

        Args:
            module: full name of the module, or the path of a script.
            arguments: command-line arguments of the module.
            environment: all environment variables of the child; None for the environment of this process.
            folder: working directory of the child; None for the working directory of this process.
            limit: wall-time limit [s]; None for no limit.
            on_line: function that receives each line of output, on another thread; lines may come in pieces.
        """
        with self._lock:
            if self._is_over:
                return ProcessResult(-signal.SIGTERM, "")
            process = subprocess.Popen(
                # -P: no file of the working directory shadows a module
                [sys.executable, "-P", *([str(module)] if isinstance(module, Path) else ["-m", module]), *arguments],
                stdin=subprocess.PIPE,  # nothing is written; the pipe closes when this process ends
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                env=environment,
                cwd=folder,
                start_new_session=True,
            )
            self._alive.add(process)
        tail = OutputTail(process.stdout, on_line)
        try:
            process.wait(limit)
            is_late = False
        except subprocess.TimeoutExpired:
            is_late = True
        finally:
            self._end(process)
        return ProcessResult(process.wait(), tail.text(), is_late)

    def end(self) -> None:
        """Kill all running child processes and start no more."""
        with self._lock:
            self._is_over = True
            alive = tuple(self._alive)
        for process in alive:
            kill_process_tree(process)

    def _end(self, process: subprocess.Popen[bytes]) -> None:
        kill_process_tree(process)
        process.wait()
        if process.stdin is not None:
            process.stdin.close()
        with self._lock:
            self._alive.discard(process)


class OutputTail:
    """Thread that stores the end of a process's output; it reads all output, so that the process never blocks."""

    def __init__(self, pipe: IO[bytes] | None, on_line: Callable[[str], None] | None = None) -> None:
        self._pipe, self._kept, self._on_line = pipe, bytearray(), on_line
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def text(self) -> str:
        """Return the end of the output when the process has ended."""
        self._thread.join(_OUTPUT_WAIT)
        return bytes(self._kept).decode("utf-8", "replace")

    def _read(self) -> None:
        if self._pipe is None:
            return
        with self._pipe as pipe:
            while content := os.read(pipe.fileno(), _CHUNK):
                if self._on_line is not None:
                    for line in content.decode("utf-8", "replace").splitlines():
                        self._on_line(line)
                self._kept += content
                del self._kept[:-_KEPT_BYTES]


def exit_with_parent() -> None:
    """Exit this child process, with its own child processes, as soon as its parent has ended for any reason."""
    hide_everywhere()
    try:
        pipe = os.dup(0)
        null_device = os.open(os.devnull, os.O_RDONLY)
        os.dup2(null_device, 0)
        os.close(null_device)
    except OSError:
        return

    def watch() -> None:
        with suppress(OSError):
            while os.read(pipe, 1):
                pass
        exit_immediately(1)

    threading.Thread(target=watch, name="simkit ends with its parent", daemon=True).start()


def exit_immediately(code: int) -> None:
    """Exit this child process at once, with its own child processes, whatever threads are running."""
    if hasattr(os, "killpg") and os.getpgrp() == os.getpid():
        with suppress(OSError, ValueError):  # fails outside the main thread: SIGTERM then ends this process
            signal.signal(signal.SIGTERM, signal.SIG_IGN)
        with suppress(OSError):
            os.killpg(0, signal.SIGTERM)
    os._exit(code)
