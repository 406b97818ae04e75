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
from typing import Any, Final

from simkit import progress
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.experiments.sweeps.design import Design, SweepRow
from simkit.experiments.sweeps.executor import Executor, SweepTask
from simkit.experiments.sweeps.folder_lock import locked_blocks, make_folder
from simkit.experiments.sweeps.parameter_space import ParameterSpace
from simkit.experiments.sweeps.result_store import OTHER_SWEEP, ResultStore
from simkit.experiments.sweeps.result_table import write_tables
from simkit.experiments.sweeps.sweep import (
    check_sweep,
    description_of,
    keep_runs,
    make_executor,
)
from simkit.experiments.sweeps.sweep_spec import INVALID, SweepSpec, name_problems, raise_problems
from simkit.float_sum import float_sum
from simkit.install_command import install_command

_TOGETHER: Final = 8
"""Number of points that are asked for together; more would use fewer results for each point."""


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
) -> dict[str, Any]:
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
        The best trial: "trial", "run" (its first run), "value" and "values" of its parameters.

    Raises:
        InputError: SK-SWEEP-001 no such metric, or no parameter to search; SK-INPUT-004 Optuna is not installed.
    """
    optuna = _optuna()
    _check_search(spec, metric)
    raise_problems(name_problems(spec))
    seeds = spec.design.seeds
    search = _Search(optuna, spec, maximise)
    store = ResultStore(folder)
    make_folder(folder)
    fingerprint = f"{spec.fingerprint()} {'max' if maximise else 'min'} {metric}"
    store.begin(fingerprint, trials * len(seeds), {**description_of(spec), "search": metric})
    with locked_blocks(folder, store.blocks):
        finished = {row["run"]: row for row in store.rows()}
        runner = check_sweep(spec)
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
                        own = [finished[number * len(seeds) + at] for at in range(len(seeds))]
                        search.tell(trial, _mean(own, metric))
                        task.advance(search.best_text())
            store.close()
            keep_runs(replace(spec, design=_stored_design(spec.design, store)), store, store.blocks, executor)
        write_tables(store)
    return search.best(metric, len(seeds))


def _optuna() -> Any:
    try:
        optuna = import_module("optuna")
    except ImportError:
        text = "SK-INPUT-004 a search needs optuna, which is missing"
        raise InputError(f"{text}\n    help: {install_command('search')}", "SK-INPUT-004") from None
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    return optuna


def _check_search(spec: SweepSpec, metric: str) -> None:
    if metric not in spec.metrics:
        hint = did_you_mean(metric, spec.metrics) or f"metrics of the sweep: {', '.join(spec.metrics) or 'none'}"
        raise InputError(f"{INVALID} no metric {metric!r}; {hint}", INVALID)
    if spec.design.listed is not None or not spec.design.spaces:
        raise InputError(f"{INVALID} a search needs parameters with distributions or lists of values", INVALID)


def _run_missing(
    executor: Executor, store: ResultStore, rows: Mapping[int, SweepRow], finished: dict[int, dict[str, Any]]
) -> None:
    for run, proposed in rows.items():
        if run in finished and finished[run]["values"] != json.loads(json.dumps(proposed.values)):
            text = f"{OTHER_SWEEP} {store.folder} has other values of run {run} than this search proposes"
            help_ = "install the version of Optuna that began it, or name another folder with -o"
            raise InputError(f"{text}\n    help: {help_}", OTHER_SWEEP)
    tasks = (SweepTask(row) for run, row in rows.items() if run not in finished)
    for result in executor.stream(tasks):
        row = result.plain()
        store.add(row)
        finished[row["run"]] = row


def _mean(rows: list[dict[str, Any]], metric: str) -> float:
    """Return the mean value of a metric; NaN if a run failed.

    Raises:
        InputError: SK-SWEEP-001 the value of the metric is no number.
    """
    values = [math.nan if row["exit_code"] else row["metrics"].get(metric, math.nan) for row in rows]
    texts = [value for value in values if not isinstance(value, (bool, int, float))]
    if texts:
        raise InputError(f"{INVALID} metric {metric!r}: found {texts[0]!r:.60}; a search needs numbers", INVALID)
    return float_sum(values) / len(values)


class _Search:
    """Optuna study, in the terms of a sweep."""

    def __init__(self, optuna: Any, spec: SweepSpec, maximise: bool) -> None:
        self._optuna, self._spaces = optuna, spec.design.spaces
        sampler = optuna.samplers.TPESampler(seed=spec.design.design_seed, constant_liar=True)
        self._study = optuna.create_study(direction="maximize" if maximise else "minimize", sampler=sampler)
        self._values: dict[int, dict[str, Any]] = {}

    def ask(self) -> tuple[Any, dict[str, Any]]:
        """Return the next trial and its values by parameter."""
        trial = self._study.ask()
        values: dict[str, Any] = {}
        for space in self._spaces:
            values.update(_suggested(trial, space))
        self._values[trial.number] = values
        return trial, values

    def tell(self, trial: Any, value: float) -> None:
        """Report the value of a trial; NaN for a failed one."""
        state = self._optuna.trial.TrialState.FAIL if math.isnan(value) else None
        self._study.tell(trial, None if math.isnan(value) else value, state=state)

    def best_text(self) -> str:
        """Return the best value up to now as text."""
        try:
            return f"best {self._study.best_value:.6g}"
        except ValueError:
            return "no run has a value yet"

    def best(self, metric: str, seeds: int) -> dict[str, Any]:
        """Return the best trial.

        Raises:
            InputError: SK-SWEEP-006 no trial has a value.
        """
        try:
            trial = self._study.best_trial
        except ValueError:
            raise InputError(f"SK-SWEEP-006 no run of the search has a value of {metric!r}", "SK-SWEEP-006") from None
        values = self._values[trial.number]
        return {"trial": trial.number, "run": trial.number * seeds, "value": trial.value, "values": values}


def _suggested(trial: Any, space: ParameterSpace) -> dict[str, Any]:
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
