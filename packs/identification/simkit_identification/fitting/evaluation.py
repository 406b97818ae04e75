"""Evaluation of a fit: simulated readings for scaled coordinates of the parameters, in parallel and each run once."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from types import TracebackType
from typing import Any

import numpy as np
import numpy.typing as npt

from simkit import progress
from simkit_identification.fitting.parameters import Parameter
from simkit_identification.fitting.problem import FitProblem, ReplayRunner, ReplayTask
from simkit_learning.sweeps.design import SweepRow
from simkit_learning.sweeps.executor import Executor, make_executor

Floats = npt.NDArray[np.float64]
Point = Sequence[float] | Floats
_MOST_STORED = 64  # results that are kept for later requests
_WHOLE = 1e-6  # [steps] tolerance between a time and its step


class Evaluator:
    """Function from scaled coordinates to simulated readings; a context manager.

    A time that acts in whole steps is interpolated: between two steps the readings are a weighted mean of two runs, so
    that they depend on it continuously.

    Args:
        problem: runs and recordings.
        parameters: parameters; a point has one coordinate for each.
        jobs: number of processes; None for one per core.
        task: task of the progress display.

    Attributes:
        runs: number of runs up to now.
        failed: number of failed runs.
        failures: messages of failed runs, each once.
    """

    def __init__(
        self, problem: FitProblem, parameters: Sequence[Parameter], jobs: int | None, task: progress.Task
    ) -> None:
        self._problem, self._parameters, self._task = problem, list(parameters), task
        most = len(problem.recordings) * max(2, len(parameters) + 1)
        runner = ReplayRunner(problem)
        self._executor: Executor = make_executor(problem, jobs, None, most, runner, always_processes=False)
        self._stored: dict[tuple[float, ...], Floats | None] = {}
        self.runs = self.failed = 0
        self.failures: list[str] = []
        self._number = 0

    def __enter__(self) -> Evaluator:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._executor.__exit__(kind, error, trace)

    @property
    def parameters(self) -> list[Parameter]:
        """Parameters."""
        return self._parameters

    def values_of(self, point: Point) -> list[float]:
        """Return the values of a point."""
        return [parameter.value(float(u)) for parameter, u in zip(self._parameters, point, strict=True)]

    def __call__(self, points: Sequence[Point]) -> list[Floats | None]:
        """Return the readings at each point, shape (size,); None if a run failed."""
        mixtures = [self._mixture(self.values_of(point)) for point in points]
        readings = self.at_values([values for mixture in mixtures for values, _ in mixture])
        results: list[Floats | None] = []
        at = 0
        for mixture in mixtures:
            parts = readings[at : at + len(mixture)]
            at += len(mixture)
            if any(part is None for part in parts):
                results.append(None)
                continue
            total = np.zeros(0)
            for part, (_, weight) in zip(parts, mixture, strict=True):
                assert part is not None
                total = part if weight == 1.0 else (weight * part if not total.size else total + weight * part)
            results.append(total)
        return results

    def at_values(
        self, values: Sequence[Sequence[float]], more: Mapping[str, float] | None = None
    ) -> list[Floats | None]:
        """Return the readings for values of the parameters.

        Args:
            values: values of each run.
            more: further values by path.
        """
        keys = [(*each, *(more or {}).values()) for each in values]
        missing = [key for key in dict.fromkeys(keys) if key not in self._stored]
        if len(self._stored) + len(missing) > _MOST_STORED:
            self._stored = {key: self._stored[key] for key in dict.fromkeys(keys) if key in self._stored}
        paths = [*(parameter.path for parameter in self._parameters), *(more or {})]
        self._run([dict(zip(paths, key, strict=True)) for key in missing], missing)
        return [self._stored[key] for key in keys]

    def _mixture(self, values: list[float]) -> list[tuple[list[float], float]]:
        """Return the runs whose weighted mean stands for values, with their weights."""
        choices: list[list[tuple[float, float]]] = []
        for parameter, value in zip(self._parameters, values, strict=True):
            if not parameter.step:
                choices.append([(value, 1.0)])
                continue
            steps = value / parameter.step
            whole = int(np.floor(steps + _WHOLE))
            share = steps - whole
            below = _time_of(whole, parameter.step)
            if share <= _WHOLE:
                choices.append([(below, 1.0)])
            else:
                choices.append([(below, 1.0 - share), (_time_of(whole + 1, parameter.step), share)])
        mixture = []
        for combination in itertools.product(*choices):
            weight = 1.0
            for _, share in combination:
                weight *= share
            mixture.append(([value for value, _ in combination], weight))
        return mixture

    def _run(self, rows: Sequence[Mapping[str, float]], keys: Sequence[tuple[float, ...]]) -> None:
        count = len(self._problem.recordings)
        tasks: list[ReplayTask] = []
        for values in rows:
            for recording in range(count):
                row = SweepRow(self._number, self._problem.run.seed, dict(values))
                tasks.append(ReplayTask(row, recording=recording))
                self._number += 1
        first = self._number - len(tasks)
        parts: list[Any] = [None] * len(tasks)
        for result in self._executor.stream(iter(tasks)):
            parts[result.row.run - first] = result
            self._task.advance()
        self.runs += len(tasks)
        for number, key in enumerate(keys):
            self._stored[key] = self._joined(parts[number * count : (number + 1) * count])

    def _joined(self, results: Iterable[Any]) -> Floats | None:
        """Return the readings of all recordings; None if a run failed."""
        arrays: list[Floats] = []
        is_whole = True
        for result in results:
            values = getattr(result, "values", None)
            if values is None:
                self.failed += 1
                is_whole = False
                text = f"{result.code}: {result.message}" if result.code not in result.message else result.message
                if text not in self.failures:
                    self.failures.append(text)
            else:
                arrays.append(values)
        return np.concatenate(arrays) if is_whole else None


def _time_of(steps: int, step: float) -> float:
    """Return a number of steps as a time whose decimal text is exact."""
    return round(steps * step, 12)
