"""Executors of sweeps: they take rows and yield their results as soon as these end, in any order.

An executor is one function with state: `stream(tasks)` takes an iterator of tasks and pulls from it only as fast as its
workers run them, so the number of tasks in memory is bounded. This module has the executor of the present process and
the interface; `process_executor` runs tasks in processes of this machine, `ray_executor` on a cluster.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from simkit.experiments.sweeps.design import SweepRow
from simkit.experiments.sweeps.row_runner import RowResult, RowRunner


@dataclass(frozen=True)
class SweepTask:
    """Task of a worker.

    Attributes:
        row: run to make.
        keep: bundle to write; None to run without them.
    """

    row: SweepRow
    keep: Path | None = None


class Executor(Protocol):
    """Executor of tasks; a context manager, at whose end all workers have ended."""

    def stream(self, tasks: Iterable[SweepTask]) -> Iterator[RowResult]:
        """Run tasks and yield their results in the order in which they end."""

    def __enter__(self) -> Any: ...

    def __exit__(self, *_: object) -> None: ...


def run_task(runner: RowRunner, task: SweepTask) -> RowResult:
    """Run one task."""
    return runner.run(task.row) if task.keep is None else runner.keep(task.row, task.keep)


class SerialExecutor:
    """Executor in the present process; functions need not be importable, and a debugger works.

    Args:
        runner: runner of the sweep, perhaps with a loaded world.
    """

    def __init__(self, runner: RowRunner) -> None:
        self._runner = runner

    def stream(self, tasks: Iterable[SweepTask]) -> Iterator[RowResult]:
        """Run tasks one after another."""
        return (run_task(self._runner, task) for task in tasks)

    def __enter__(self) -> SerialExecutor:
        return self

    def __exit__(self, *_: object) -> None:
        self._runner.close()
