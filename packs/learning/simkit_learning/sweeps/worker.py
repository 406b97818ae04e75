"""Worker process of a sweep: receives rows on standard input and returns their results on standard output.

Each message is a pickled object after its length in 8 bytes. The first message is a `WorkerStart`. What plugins print
goes to standard error, which the parent process reads.
"""

from __future__ import annotations

import faulthandler
import gc
import os
import pickle
import signal
import struct
import sys
import threading
from collections.abc import Callable
from queue import SimpleQueue
from typing import IO, Final, TypeAlias

from simkit.child_process import exit_immediately
from simkit_learning.sweeps.row_runner import RowResult, RowRunner, SweepTask

_LENGTH: Final = struct.Struct("<Q")


WorkerStart: TypeAlias = tuple[list[str], str, bytes]
"""First message to a worker: import path and folder of the parent process, pickled class of runners and sweep."""


def send_message(pipe: IO[bytes], content: bytes) -> None:
    """Write a message and its length."""
    pipe.write(_LENGTH.pack(len(content)) + content)
    pipe.flush()


def receive_message(pipe: IO[bytes]) -> bytes | None:
    """Read a message; None at the end of the pipe."""
    head = pipe.read(_LENGTH.size)
    if len(head) < _LENGTH.size:
        return None
    (length,) = _LENGTH.unpack(head)
    content = pipe.read(length)
    return content if len(content) == length else None


def _receive_all(pipe: IO[bytes], tasks: SimpleQueue[bytes]) -> None:
    """Receive tasks, and end this process when the parent process has ended."""
    while (content := receive_message(pipe)) is not None:
        tasks.put(content)
    exit_immediately(1)


def main() -> None:
    """Run the tasks of the parent process until its pipe closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent process handles Ctrl-C and ends this process
    faulthandler.enable()
    results = os.fdopen(os.dup(1), "wb")
    tasks_pipe = os.fdopen(os.dup(0), "rb")
    null = os.open(os.devnull, os.O_RDONLY)
    os.dup2(null, 0)
    os.dup2(2, 1)
    tasks: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_receive_all, args=(tasks_pipe, tasks), daemon=True).start()
    start: WorkerStart = pickle.loads(tasks.get())
    sys.path[:], folder, spec = start
    os.chdir(folder)
    run = _runner(spec)
    send_message(results, b"")  # tells the parent process that the sweep could be read here
    while True:
        batch: list[SweepTask] = pickle.loads(tasks.get())
        for task in batch:
            send_message(results, pickle.dumps(run(task)))


def _runner(spec: bytes) -> Callable[[SweepTask], RowResult]:
    """Return the function that runs a task; the import path of the parent process is set."""
    runner_class, sweep = pickle.loads(spec)
    runner: RowRunner = runner_class(sweep)
    is_frozen = False  # `gc.get_freeze_count` would count all frozen objects, which takes 5 ms

    def run(task: SweepTask) -> RowResult:
        nonlocal is_frozen
        result = runner.run_task(task)
        if not is_frozen:
            # modules and the loaded world live on; searching them for garbage takes 3 % of all later runs
            gc.collect()
            gc.freeze()
            is_frozen = True
        return result

    return run


if __name__ == "__main__":
    main()
