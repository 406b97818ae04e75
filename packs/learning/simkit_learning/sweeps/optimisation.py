"""Search for the parameters with the best value of a metric, by Optuna.

The search asks Optuna for a fixed number of points at a time, runs them in parallel, and reports their values in the
order of the runs. A search therefore does not depend on the number of processes. An interrupted search continues: the
stored values are reported again, and Optuna, with the same seed, asks for the same points.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypedDict

from simkit import progress
from simkit.errors import InputError
from simkit.extend import did_you_mean
from simkit.float_sum import float_sum
from simkit.install_command import install_command
from simkit_learning.sweeps.design import Design, SweepRow
from simkit_learning.sweeps.executor import Executor, make_executor
from simkit_learning.sweeps.parameter_space import ParameterSpace, ParameterValue, Values
from simkit_learning.sweeps.result_store import (
    OTHER_SWEEP,
    ResultStore,
    StoredRow,
    SweepDescription,
    locked_blocks,
    make_folder,
)
from simkit_learning.sweeps.result_table import write_tables
from simkit_learning.sweeps.row_runner import SweepTask
from simkit_learning.sweeps.sweep import begin_runs, description_of, keep_runs
from simkit_learning.sweeps.sweep_spec import INVALID, SweepSpec, name_problems, raise_problems

if TYPE_CHECKING:
    from types import ModuleType

    import optuna

_TOGETHER: Final = 8
"""Number of points that are asked for together; more would use fewer results for each point."""


class BestTrial(TypedDict):
    """Best trial of a search: its number, its first run, its value, and the values of its parameters."""

    trial: int
    run: int
    value: float
    values: Values


def optimise_sweep(
    spec: SweepSpec,
    folder: Path,
    metric: str,
    trials: int,
    *,
    jobs: int | None = None,
    cluster: str | None = None,
    maximise: bool = False,
    always_processes: bool = True,
) -> BestTrial:
    """Search the parameters of a sweep for the best value of a metric; a trial with a failed run is not used.

    Each trial runs with each seed, and its value is the mean.

    Args:
        spec: sweep, whose lists of values are choices.
        folder: folder of the results; a search continues there, also with more trials.
        metric: name of the metric.
        trials: number of trials.
        jobs: number of processes; None for one per processor core.
        cluster: address of a Ray cluster; None for this machine.
        maximise: search for the largest value instead of the smallest.
        always_processes: use a process also for one job.

    Returns:
        The best trial.

    Raises:
        InputError: SK-SWEEP-001 no such metric, or no parameter to search; SK-INPUT-004 Optuna is not installed.
    """
    package = _optuna()
    _check_search(spec, metric)
    raise_problems(name_problems(spec))
    seeds = spec.design.seeds
    search = _Search(package, spec, maximise)
    store = ResultStore(folder)
    make_folder(folder)
    fingerprint = f"{spec.fingerprint()} {'max' if maximise else 'min'} {metric}"
    description: SweepDescription = {**description_of(spec), "search": metric}
    store.begin(fingerprint, trials * len(seeds), description)
    with locked_blocks(folder, store.blocks):
        finished = {row["run"]: row for row in store.rows()}
        spec, runner = begin_runs(spec, store)
        most = min(_TOGETHER, trials) * len(seeds)
        with make_executor(spec, jobs, cluster, most, runner, always_processes=always_processes) as executor:
            with progress.task("searching", trials) as task:
                for first in range(0, trials, _TOGETHER):
                    asked = [search.ask() for _ in range(first, min(first + _TOGETHER, trials))]
                    rows = {
                        number * len(seeds) + at: SweepRow(number * len(seeds) + at, seed, values)
                        for number, (_, values) in enumerate(asked, first)
                        for at, seed in enumerate(seeds)
                    }
                    _run_missing(executor, store, rows, finished)
                    for number, (trial, _) in enumerate(asked, first):
                        rows_of_trial = [finished[number * len(seeds) + at] for at in range(len(seeds))]
                        search.tell(trial, _mean(rows_of_trial, metric))
                        task.advance(search.best_text())
            store.close()
            keep_runs(replace(spec, design=_stored_design(spec.design, store)), store, store.blocks, executor)
        write_tables(store)
    return search.best(metric, len(seeds))


def _optuna() -> ModuleType:
    try:
        package = import_module("optuna")
    except ImportError:
        text = "a search needs optuna, which is missing"
        raise InputError("SK-INPUT-004", text, help=install_command("search")) from None
    package.logging.set_verbosity(package.logging.ERROR)
    return package


def _check_search(spec: SweepSpec, metric: str) -> None:
    if metric not in spec.metrics:
        hint = did_you_mean(metric, spec.metrics) or f"metrics of the sweep: {', '.join(spec.metrics) or 'none'}"
        raise InputError(INVALID, f"no metric {metric!r}; {hint}")
    if spec.design.listed is not None or not spec.design.spaces:
        raise InputError(INVALID, "a search needs parameters with distributions or lists of values")


def _run_missing(
    executor: Executor, store: ResultStore, rows: Mapping[int, SweepRow], finished: dict[int, StoredRow]
) -> None:
    for run, proposed in rows.items():
        if run in finished and finished[run]["values"] != json.loads(json.dumps(proposed.values)):
            text = f"{store.folder} has other values of run {run} than this search proposes"
            help_ = "install the version of Optuna that began it, or name another folder with -o"
            raise InputError(OTHER_SWEEP, text, help=help_)
    tasks = (SweepTask(row) for run, row in rows.items() if run not in finished)
    for result in executor.stream(tasks):
        row = result.plain()
        store.add(row)
        finished[row["run"]] = row


def _mean(rows: list[StoredRow], metric: str) -> float:
    """Return the mean value of a metric; NaN if a run failed.

    Raises:
        InputError: SK-SWEEP-001 the value of the metric is no number.
    """
    values = []
    for row in rows:
        value = math.nan if row["exit_code"] else row["metrics"].get(metric, math.nan)
        if isinstance(value, str):
            raise InputError(INVALID, f"metric {metric!r}: found {value!r:.60}; a search needs numbers")
        values.append(value)
    return float_sum(values) / len(values)


class _Search:
    """Optuna study, in the terms of a sweep."""

    def __init__(self, package: ModuleType, spec: SweepSpec, maximise: bool) -> None:
        self._failed, self._spaces = package.trial.TrialState.FAIL, spec.design.spaces
        sampler = package.samplers.TPESampler(seed=spec.design.design_seed, constant_liar=True)
        self._study: optuna.Study = package.create_study(
            direction="maximize" if maximise else "minimize", sampler=sampler
        )
        self._values: dict[int, Values] = {}

    def ask(self) -> tuple[optuna.Trial, Values]:
        """Return the next trial and its values by parameter."""
        trial = self._study.ask()
        values: dict[str, ParameterValue] = {}
        for space in self._spaces:
            values.update(_suggested(trial, space))
        self._values[trial.number] = values
        return trial, values

    def tell(self, trial: optuna.Trial, value: float) -> None:
        """Report the value of a trial; NaN for a failed one."""
        if math.isnan(value):
            self._study.tell(trial, state=self._failed)
        else:
            self._study.tell(trial, value)

    def best_text(self) -> str:
        """Return the best value up to now as text."""
        try:
            return f"best {self._study.best_value:.6g}"
        except ValueError:
            return "no run has a value yet"

    def best(self, metric: str, seeds: int) -> BestTrial:
        """Return the best trial.

        Raises:
            InputError: SK-SWEEP-006 no trial has a value.
        """
        try:
            trial = self._study.best_trial
        except ValueError:
            raise InputError("SK-SWEEP-006", f"no run of the search has a value of {metric!r}") from None
        values = self._values[trial.number]
        return {"trial": trial.number, "run": trial.number * seeds, "value": self._study.best_value, "values": values}


def _suggested(trial: optuna.Trial, space: ParameterSpace) -> dict[str, ParameterValue]:
    """Return the values that Optuna suggests for a space: a choice, or numbers between 0 and 1 for a distribution."""
    if space.levels is not None:
        if len(space.levels) == 1:
            return {space.names[0]: space.levels[0]}
        at = trial.suggest_categorical(space.names[0], list(range(len(space.levels))))
        return {space.names[0]: space.levels[at]}
    return space.values([trial.suggest_float(name, 0.0, 1.0) for name in space.names])


def _stored_design(design: Design, store: ResultStore) -> Design:
    """Return a design with the values of the stored runs, so that kept runs can be repeated."""
    values = {row["run"] // len(design.seeds): row["values"] for row in store.rows()}
    return Design((), design.seeds, listed=tuple(values[number] for number in sorted(values)))
