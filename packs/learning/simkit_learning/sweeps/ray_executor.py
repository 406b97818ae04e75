"""Executor of a sweep on a Ray cluster.

The sweep is put into the object store of the cluster once. The files of the world are copied to each node once, as an
archive that Ray names by its content. Ray starts processes where processors are free, also on nodes that join later. A
process keeps its world loaded between tasks. If a node dies, Ray repeats the tasks that ran there on another node.
"""

from __future__ import annotations

import hashlib
import pickle
import socket
import tempfile
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from importlib import import_module
from itertools import islice
from pathlib import Path
from typing import Any, Final, cast

from simkit import describe
from simkit.errors import InputError
from simkit.install_command import install_command
from simkit.run_spec import LoadOptions, SourceOptions
from simkit.writers.vendored_folder import vendor
from simkit_learning.sweeps.metrics import FileMetric
from simkit_learning.sweeps.process_executor import pickled_spec
from simkit_learning.sweeps.row_runner import CRASHED, RowResult, RowRunner, SweepTask
from simkit_learning.sweeps.sweep_spec import SweepSpec

NO_CLUSTER: Final = "SK-SWEEP-011"
_BATCH_SECONDS: Final = 1.0  # [s] wall time of the runs that are sent together
_MOST_TOGETHER: Final = 200
_WAITING_PER_CORE: Final = 3  # batches for each core of the cluster, which hides the time of the network
_RETRIES: Final = 3  # repetitions of a batch whose process or node has died
_POLL: Final = 2.0  # [s]
_CONNECT_SECONDS: Final = 5.0

_runners: dict[str, RowRunner] = {}
"""Runner of the last sweep of a process of the cluster."""


def run_batch(content: bytes, tasks: Sequence[SweepTask]) -> list[RowResult]:
    """Run tasks in a process of the cluster.

    Args:
        content: pickled sweep.
        tasks: tasks.
    """
    key = hashlib.sha256(content).hexdigest()
    if key not in _runners:
        for runner in _runners.values():
            runner.close()
        _runners.clear()
        _runners[key] = RowRunner(pickle.loads(content))
    return [_runners[key].run_task(task) for task in tasks]


class RayExecutor:
    """Executor on a cluster.

    Args:
        spec: sweep.
        address: `ray://HOST:PORT`, `HOST:PORT`, or `auto` for the cluster that runs on this machine.

    Raises:
        InputError: SK-SWEEP-011 Ray is not installed, or there is no cluster at the address.
    """

    def __init__(self, spec: SweepSpec, address: str) -> None:
        try:
            self._ray: Any = import_module("ray")
        except ImportError:
            hint = install_command("cluster")
            raise InputError(NO_CLUSTER, "a cluster needs Ray, which is missing", help=hint) from None
        with ExitStack() as stack:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
            self._spec = pickled_spec(_self_contained(spec, folder))
            self._connect(address, folder)
            self._stack = stack.pop_all()
        self._mean = _BATCH_SECONDS  # [s] running mean of the wall time of a run

    def _connect(self, address: str, folder: Path) -> None:
        ray = self._ray
        self._was_connected = ray.is_initialized()
        environment = {"working_dir": str(folder)} if any(folder.iterdir()) else {}
        try:
            _check_reachable(address)
            if not self._was_connected:
                ray.init(address, logging_level="ERROR", log_to_driver=False, runtime_env=environment or None)
        except Exception as error:  # noqa: BLE001 - Ray raises errors of several kinds
            reason = str(error).strip().partition("\n")[0]
            text = f"there is no Ray cluster at {address!r}: {reason}"
            raise InputError(NO_CLUSTER, text, help="start one with `ray start --head`") from None
        remote = ray.remote(num_cpus=1, max_retries=_RETRIES)(run_batch)
        self._run = remote.options(runtime_env=environment) if self._was_connected and environment else remote
        self._content = ray.put(self._spec)

    def __enter__(self) -> RayExecutor:
        return self

    def __exit__(self, *_: object) -> None:
        if not self._was_connected:
            self._ray.shutdown()
        self._stack.close()

    def stream(self, tasks: Iterable[SweepTask]) -> Iterator[RowResult]:
        """Run tasks and yield their results in the order in which their batches end."""
        source = iter(tasks)
        alone: deque[SweepTask] = deque()  # tasks of a batch that ended its process several times
        waiting: dict[object, list[SweepTask]] = {}
        while True:
            for _ in range(_WAITING_PER_CORE * self._cores() - len(waiting)):
                batch = self._next_batch(source, alone)
                if not batch:
                    break
                waiting[self._run.remote(self._content, batch)] = batch
            if not waiting:
                return
            done, _ = self._ray.wait(list(waiting), num_returns=1, timeout=_POLL)
            for reference in done:
                yield from self._results(reference, waiting.pop(reference), alone)

    def _cores(self) -> int:
        """Return the number of processor cores of the cluster, which may change; at least 1."""
        return max(1, int(self._ray.cluster_resources().get("CPU", 1)))

    def _next_batch(self, source: Iterator[SweepTask], alone: deque[SweepTask]) -> list[SweepTask]:
        if alone:
            return [alone.popleft()]
        count = max(1, min(_MOST_TOGETHER, int(_BATCH_SECONDS / max(self._mean, 1e-4))))
        return list(islice(source, count))

    def _results(self, reference: object, batch: list[SweepTask], alone: deque[SweepTask]) -> Iterator[RowResult]:
        try:
            results: list[RowResult] = self._ray.get(reference)
        except self._ray.exceptions.RayError as error:
            if len(batch) > 1:  # one of the tasks ends each process that runs it; the others are innocent
                alone.extend(batch)
                return
            reason = str(error).strip().partition("\n")[0][:300]
            yield RowResult(batch[0].row, exit_code=1, code=CRASHED, message=f"the process of the run ended: {reason}")
            return
        for result in results:
            self._mean += 0.1 * (result.wall_time - self._mean)
            yield result


def _check_reachable(address: str) -> None:
    """Check that a server listens at an address; Ray itself would wait for minutes.

    Raises:
        OSError: no server answers.
    """
    host, colon, port = address.removeprefix("ray://").rpartition(":")
    if colon and port.isdecimal():
        socket.create_connection((host.strip("[]"), int(port)), timeout=_CONNECT_SECONDS).close()


def _self_contained(spec: SweepSpec, folder: Path) -> SweepSpec:
    """Return a sweep that a machine without the user's files can run; the world's files are copied to a folder.

    The folder becomes the working folder of the processes of the cluster. A bundled world needs no files.
    """
    run = spec.run
    metrics = {
        name: metric.function if isinstance(metric, FileMetric) else metric for name, metric in spec.metrics.items()
    }
    if run.beside is not None:
        file, _ = vendor(run.source, folder / "world", describe, **run.source_options())
        options = {name: value for name, value in run.options.items() if name not in SourceOptions.__optional_keys__}
        run = replace(run, world=f"world/{file}", folder=Path(), file=None, options=cast(LoadOptions, options))
    return replace(spec, run=run, metrics=metrics)
