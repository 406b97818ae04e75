"""Executors of sweeps: they take rows and yield their results as soon as these end, in any order.

An executor is one function with state: `stream(tasks)` takes an iterator of tasks and pulls from it only as fast as its
workers run them, so the number of tasks in memory is bounded. This module has the executor of the present process and
the choice of an executor; `process_executor` runs tasks in processes of this machine, `ray_executor` on a cluster.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Protocol

from simkit.argument_checks import shown
from simkit.errors import InputError
from simkit.sensors.cameras.rendering.render_thread import usable_cores
from simkit_learning.sweeps.process_executor import ProcessExecutor
from simkit_learning.sweeps.ray_executor import RayExecutor
from simkit_learning.sweeps.row_runner import RowResult, RowRunner, SweepTask
from simkit_learning.sweeps.sweep_spec import INVALID, SweepSpec


class Executor(Protocol):
    """Executor of tasks; a context manager, at whose end all workers have ended."""

    def stream(self, tasks: Iterable[SweepTask]) -> Iterator[RowResult]:
        """Run tasks and yield their results in the order in which they end."""

    def __enter__(self) -> Executor: ...

    def __exit__(self, *_: object) -> None: ...


class SerialExecutor:
    """Executor in the present process; functions need not be importable, and a debugger works.

    Args:
        runner: runner of the sweep, perhaps with a loaded world.
    """

    def __init__(self, runner: RowRunner) -> None:
        self._runner = runner

    def stream(self, tasks: Iterable[SweepTask]) -> Iterator[RowResult]:
        """Run tasks one after another."""
        return map(self._runner.run_task, tasks)

    def __enter__(self) -> SerialExecutor:
        return self

    def __exit__(self, *_: object) -> None:
        self._runner.close()


def make_executor(
    spec: SweepSpec,
    jobs: int | None,
    cluster: str | None,
    min_tasks: int,
    runner: RowRunner | None = None,
    *,
    always_processes: bool,
) -> Executor:
    """Return the executor for a number of processes or a cluster; only that of the present process uses a runner."""
    runner = runner or RowRunner(spec)
    with runner.closed_on_error():
        if jobs is not None and (not isinstance(jobs, int) or isinstance(jobs, bool) or jobs < 1):
            raise InputError(INVALID, f"jobs: found {shown(jobs)}; expected a whole number of at least 1")
    jobs = min(usable_cores() if jobs is None else jobs, min_tasks)
    if cluster is None and jobs == 1 and not always_processes:
        return SerialExecutor(runner)
    runner.close()
    return ProcessExecutor(spec, jobs, type(runner)) if cluster is None else RayExecutor(spec, cluster)
