"""Scores of many files in child processes with limits of time and memory, so that one file cannot end the others.

A child process scores one file after the other, and sends each score as JSON. A process that crashes, hangs or needs
too much memory is replaced.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit import progress
from simkit.cli.scores.file_score import FileScore
from simkit.cli.scores.score_calculation import ScoreOptions, refused_score, score_file
from simkit.diagnostics import Diagnostic
from simkit.errors import SimkitError
from simkit.memory_error import OutOfMemory
from simkit.process_control import end_with_parent, safe_path, without_interrupts
from simkit.run_fields import LoadArguments

if TYPE_CHECKING:
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess

STOPPED: Final = "SK-CLI-061"
MEMORY: Final = 6 << 30
"""Limit of the address space of a child process [bytes]."""
_KEPT_MEMORY: Final = 3 << 29  # resident memory [bytes] above which a process is replaced after a file
_START: Final = 30.0  # [s] additional time for the first file of a process, which imports the simulator
_LARGEST_REPLY: Final = 1 << 26  # bytes


@dataclass(frozen=True)
class ScoreLimits:
    """Limits of the scores of many files.

    Attributes:
        jobs: number of parallel processes.
        seconds: wall time for one file [s].
    """

    jobs: int
    seconds: float


class _Worker:
    """Child process that scores files.

    Attributes:
        number: number of the file that it scores now; -1 for none.
        deadline: end of its time for this file.
        is_large: True if it has needed much memory, so that another process scores the next file.
    """

    def __init__(self, arguments: LoadArguments, options: ScoreOptions) -> None:
        import multiprocessing

        context = multiprocessing.get_context("spawn")  # graphics libraries do not work in a forked process
        self.connection, theirs = context.Pipe()
        self.process: BaseProcess = context.Process(target=_score_files, args=(theirs, arguments, options), daemon=True)
        with without_interrupts(), safe_path():
            self.process.start()
        theirs.close()
        self.number, self.deadline, self._is_new, self.is_large = -1, 0.0, True, False

    def begin(self, number: int, file: str, seconds: float) -> None:
        """Send a file to the process."""
        self.number = number
        self.deadline = time.monotonic() + seconds + (_START if self._is_new else 0.0)
        self._is_new = False
        with suppress(OSError):  # the process has ended: this is seen when its answer is read
            self.connection.send_bytes(json.dumps(file).encode())

    def answer(self) -> FileScore | None:
        """Return the score that the process sends; None if the process has ended without one."""
        try:
            score, memory = json.loads(self.connection.recv_bytes(_LARGEST_REPLY))
            self.is_large = memory > _KEPT_MEMORY
            return FileScore.from_dict(score)
        except (OSError, EOFError, ValueError, TypeError, KeyError):
            return None

    def end(self) -> int | None:
        """Kill the process; return its exit code if it had ended before."""
        self.process.join(0.2)
        code = self.process.exitcode
        self.process.kill()
        self.process.join()
        self.connection.close()
        return code


def score_files(
    files: Sequence[str], arguments: LoadArguments, options: ScoreOptions, limits: ScoreLimits
) -> Iterator[FileScore]:
    """Yield the score of each file, in the order of the files.

    Args:
        files: paths.
        arguments: further arguments of `simkit.load`, for every file.
        options: what a score contains.
        limits: limits of the processes.
    """
    from multiprocessing.connection import wait

    scores: dict[int, FileScore] = {}
    workers: list[_Worker] = []
    sent = shown = 0
    with progress.task("checking files", len(files)) as task:
        try:
            while shown < len(files):
                while (
                    sent < len(files) and (idle := _idle_worker(workers, arguments, options, limits.jobs)) is not None
                ):
                    idle.begin(sent, files[sent], limits.seconds)
                    task.item = os.path.basename(files[sent])  # noqa: PTH119
                    sent += 1
                busy = [worker for worker in workers if worker.number >= 0]
                left = min(worker.deadline for worker in busy) - time.monotonic()
                ready = wait([worker.connection for worker in busy], max(0.0, left))
                for worker in busy:
                    is_late = worker.deadline <= time.monotonic()
                    if worker.connection not in ready and not is_late:
                        continue
                    score = worker.answer() if worker.connection in ready else None
                    if score is None:
                        score = _stopped_score(files[worker.number], worker.end(), options, limits, is_late=is_late)
                        workers.remove(worker)
                    elif worker.is_large:
                        worker.end()
                        workers.remove(worker)
                    scores[worker.number] = replace(score, file=files[worker.number])
                    worker.number = -1
                    task.advance()
                while shown in scores:
                    yield scores.pop(shown)
                    shown += 1
        finally:
            for worker in workers:
                worker.end()


def _idle_worker(workers: list[_Worker], arguments: LoadArguments, options: ScoreOptions, jobs: int) -> _Worker | None:
    """Return a process without a file, a new one if there may be more; None if all are busy."""
    idle = next((worker for worker in workers if worker.number < 0), None)
    if idle is not None:
        return idle
    if len(workers) >= jobs:
        return None
    workers.append(_Worker(arguments, options))
    return workers[-1]


def _stopped_score(
    file: str, code: int | None, options: ScoreOptions, limits: ScoreLimits, *, is_late: bool
) -> FileScore:
    """Return the score of a file whose process was stopped or has ended by itself."""
    if is_late:
        message = f"the check was stopped after {limits.seconds:g} s"
        hint = f"check this file alone: simkit check {file}; or set another limit with --limit"
    else:
        ending = f"signal {-code}" if code is not None and code < 0 else f"exit code {code}"
        message = f"the process of the check ended with {ending}"
        hint = f"check this file alone: simkit check {file}"
    return refused_score(file, [Diagnostic(STOPPED, "error", message, file, None, hint)], options)


def _score_files(connection: Connection, arguments: LoadArguments, options: ScoreOptions) -> None:
    """Score files in a child process until the parent process closes the connection."""
    end_with_parent()
    _limit_process()
    while True:
        try:
            file = json.loads(connection.recv_bytes())
        except (OSError, EOFError):
            return
        reply = _score(file, arguments, options).as_dict(), _resident_memory()
        connection.send_bytes(json.dumps(reply).encode())


def _score(file: str, arguments: LoadArguments, options: ScoreOptions) -> FileScore:
    """Score a file; an exception of simkit itself becomes an error of this file."""
    try:
        return score_file(Path(file) if "<" in file else file, arguments, options)  # a text with < would be XML
    except (OutOfMemory, MemoryError):
        error = Diagnostic(STOPPED, "error", f"the check needs more than {MEMORY >> 30} GiB of memory", file)
    except SimkitError as raised:
        error = Diagnostic(raised.code, "error", raised.message, file, None, raised.help or "")
    except Exception as raised:  # noqa: BLE001 - one file must not end the check of the others
        text = f"the check failed with {type(raised).__name__}: {raised}"
        error = Diagnostic(STOPPED, "error", text, file, None, f"report it with the output of: simkit check {file}")
    return refused_score(file, [error], options)


def _limit_process() -> None:
    """Limit the memory of this process, and discard what libraries print."""
    sink = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(sink, stream)
    os.close(sink)
    try:
        import resource
    except ImportError:  # Windows
        return
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    limit = MEMORY if hard == resource.RLIM_INFINITY else min(MEMORY, hard)
    with suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_AS, (limit, hard))


def _resident_memory() -> int:
    """Return the largest resident memory of this process so far [bytes]; 0 if the system does not say."""
    try:
        import resource
    except ImportError:
        return 0
    largest = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return largest if sys.platform == "darwin" else largest * 1024
