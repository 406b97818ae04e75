"""Executor of a sweep in several processes of this machine."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import IO, Final

from simkit.errors import InputError
from simkit.install_command import install_command
from simkit.process_control import kill_process_tree
from simkit_learning.sweeps.row_runner import CRASHED, RowResult, RowRunner, SweepTask
from simkit_learning.sweeps.sweep_spec import SweepSpec
from simkit_learning.sweeps.worker import WorkerStart, receive_message, send_message

NOT_SENDABLE: Final = "SK-SWEEP-009"
_MOST_WAITING: Final = 64  # tasks that a worker has received and not ended
_BATCH_SECONDS: Final = 0.5  # [s] wall time of the tasks that are sent together
_GRACE: Final = 10.0  # [s] that a run may take beyond its own wall-clock limit before its process is killed
_MOST_OUTPUT: Final = 4 << 20  # [bytes] stored output of a worker, which is read only after a crash
_POLL: Final = 1.0  # [s]


def pickled_spec(spec: object) -> bytes:
    """Return a sweep, or what else workers need, as bytes for other processes.

    Functions of the main script need `cloudpickle`, because another process cannot import them.

    Raises:
        InputError: SK-SWEEP-009 a function or plugin cannot be sent.
    """
    try:
        dumps: Callable[[object], bytes] = import_module("cloudpickle").dumps
    except ImportError:
        dumps = pickle.dumps
    try:
        content = dumps(spec)
        if dumps is pickle.dumps and b"__main__" in content:
            raise pickle.PicklingError("a function or class of the main script")
    except Exception as error:  # noqa: BLE001 - objects of the caller may raise anything
        hint = f"{install_command('experiments')}; or move functions of the script to a module; or use jobs=1"
        text = f"the sweep cannot be sent to other processes: {error}"
        raise InputError(NOT_SENDABLE, text, help=hint) from None
    return content


class _Worker:
    """Process that runs tasks in the order in which it receives them.

    Args:
        first: first message of the process.
        inbox: queue for its results, as pairs of the worker and the result; None instead of a result at its end.
    """

    def __init__(self, first: bytes, inbox: SimpleQueue[tuple[_Worker, bytes | None]]) -> None:
        self.waiting: deque[SweepTask] = deque()
        self.is_ready = self.is_late = False
        self.since = time.monotonic()
        self._output: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - `close` closes it
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", "simkit_learning.sweeps.worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._output,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            start_new_session=True,
        )
        assert self._process.stdin is not None and self._process.stdout is not None
        self._tasks, self._results = self._process.stdin, self._process.stdout
        self._thread = threading.Thread(target=self._receive, args=(inbox,), daemon=True)
        self._thread.start()
        self._send(first)

    def give(self, tasks: list[SweepTask]) -> None:
        """Send tasks."""
        if os.fstat(self._output.fileno()).st_size > _MOST_OUTPUT:
            os.ftruncate(self._output.fileno(), 0)
            os.lseek(self._output.fileno(), 0, os.SEEK_SET)  # the process writes at the same position
        if not self.waiting:
            self.since = time.monotonic()
        self.waiting.extend(tasks)
        self._send(pickle.dumps(tasks))

    def _send(self, content: bytes) -> None:
        with suppress(OSError):  # the process has ended; its end is in the inbox
            send_message(self._tasks, content)

    def _receive(self, inbox: SimpleQueue[tuple[_Worker, bytes | None]]) -> None:
        with self._results as results:
            while (content := receive_message(results)) is not None:
                inbox.put((self, content))
        inbox.put((self, None))

    def end_reason(self) -> str:
        """Return the reason of the end of the process: its exit code or signal, and its last lines of output."""
        code = self._process.wait()
        with suppress(ValueError):
            name = signal.Signals(-code).name if code < 0 else f"exit code {code}"
            self._output.seek(max(0, self._output.seek(0, os.SEEK_END) - 4000))
            lines = self._output.read().decode("utf-8", "replace").strip().splitlines()
            return f"the process of the run ended with {name}" + (f": {lines[-1][:200]}" if lines else "")
        return f"the process of the run ended with {code}"

    def kill(self) -> None:
        """Kill the process and its own child processes."""
        kill_process_tree(self._process)

    def close(self) -> None:
        """Kill the process and wait for its end."""
        self.kill()
        self._process.wait()
        self._thread.join()
        for pipe in (self._tasks, self._output):
            with suppress(OSError):
                pipe.close()


class ProcessExecutor:
    """Executor in processes of this machine. A process that crashes costs the run that it was making.

    Args:
        spec: sweep.
        jobs: number of processes.
        runner: class of the runners in the processes.

    Raises:
        InputError: SK-SWEEP-009 the sweep cannot be sent to other processes.
    """

    def __init__(self, spec: SweepSpec, jobs: int, runner: type[RowRunner] = RowRunner) -> None:
        start: WorkerStart = (sys.path, str(Path.cwd()), pickled_spec((runner, spec)))
        self._first = pickle.dumps(start)
        self._jobs = jobs
        limit = spec.run.wall_timeout
        self._limit = None if limit is None else limit + _GRACE
        self._inbox: SimpleQueue[tuple[_Worker, bytes | None]] = SimpleQueue()
        self._workers: list[_Worker] = []
        self._mean = _BATCH_SECONDS  # [s] running mean of the wall time of a run

    def __enter__(self) -> ProcessExecutor:
        return self

    def __exit__(self, *_: object) -> None:
        for worker in self._workers:
            worker.kill()
        for worker in self._workers:
            worker.close()
        self._workers.clear()

    def stream(self, tasks: Iterable[SweepTask]) -> Iterator[RowResult]:
        """Run tasks and yield their results in the order in which they end."""
        source = iter(tasks)
        again: deque[SweepTask] = deque()  # tasks of a worker that crashed
        is_over = False
        while True:
            while len(self._workers) < self._jobs and not is_over:
                self._workers.append(_Worker(self._first, self._inbox))
            for worker in self._workers:
                is_over = self._refill(worker, source, again) or is_over
            if is_over and not again and not any(worker.waiting for worker in self._workers):
                return
            self._kill_late()
            try:
                worker, content = self._inbox.get(timeout=_POLL)
            except Empty:
                continue
            if worker not in self._workers:
                continue
            if content is None:
                yield from self._crashed(worker, again)
                is_over = is_over and not again
                continue
            if not content:
                worker.is_ready = True
                worker.since = time.monotonic()
                continue
            result: RowResult = pickle.loads(content)
            worker.waiting.popleft()
            worker.since = time.monotonic()
            self._mean += 0.1 * (result.wall_time - self._mean)
            yield result

    def _refill(self, worker: _Worker, source: Iterator[SweepTask], again: deque[SweepTask]) -> bool:
        """Send tasks to a worker that has few; return True if there are no further ones."""
        batch = max(1, min(_MOST_WAITING // 2, int(_BATCH_SECONDS / max(self._mean, 1e-4))))
        if len(worker.waiting) > batch // 2 + 1:
            return False
        tasks: list[SweepTask] = []
        while len(tasks) < batch:
            task = again.popleft() if again else next(source, None)
            if task is None:
                break
            tasks.append(task)
        if tasks:
            worker.give(tasks)
        return len(tasks) < batch

    def _crashed(self, worker: _Worker, again: deque[SweepTask]) -> Iterator[RowResult]:
        """Yield the result of the run that a process was making when it ended; its other tasks are given again."""
        self._workers.remove(worker)
        worker.kill()
        reason = worker.end_reason()
        if not worker.is_ready:
            worker.close()
            raise InputError(NOT_SENDABLE, f"a worker process could not read the sweep: {reason}")
        if worker.waiting:
            result = RowResult(worker.waiting.popleft().row, exit_code=1, code=CRASHED, message=reason)
            if worker.is_late:
                result.exit_code, result.end = 5, "wall_timeout"
                result.message = "the run did not stop at its wall-clock limit, so its process was killed"
            again.extend(worker.waiting)
            yield result
        worker.close()

    def _kill_late(self) -> None:
        for worker in self._workers:
            if self._limit is not None and worker.waiting and time.monotonic() - worker.since > self._limit:
                worker.is_late = True
                worker.kill()
