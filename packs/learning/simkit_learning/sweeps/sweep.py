"""Sweeps: many runs of a world with different parameters and seeds, and one table of their results."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Final, cast

from simkit import RunSpec, progress
from simkit.argument_checks import shown
from simkit.errors import InputError
from simkit.install_command import install_command
from simkit.msgs.data_frames import DataFrame
from simkit.run_spec import FilePath
from simkit.testing import log_left_out
from simkit.testing.scenarios.code_permission import permit_code
from simkit.testing.scenarios.scenario_run import CommandsArgument, with_commands
from simkit_learning.sweeps.design import Design, Sampling, SweepRow
from simkit_learning.sweeps.executor import Executor, make_executor
from simkit_learning.sweeps.parameter_space import (
    InvalidSpace,
    ParameterSpace,
    ParameterValue,
    Spaces,
    Values,
    parameter_space,
    plain_value,
)
from simkit_learning.sweeps.result_store import ResultStore, SweepDescription, locked_blocks, make_folder
from simkit_learning.sweeps.result_table import read_parameters, read_table, write_tables
from simkit_learning.sweeps.row_runner import RowRunner, SweepTask, check_runs, parameter_problems
from simkit_learning.sweeps.sweep_spec import (
    BAG_TOPICS,
    DESIGN_SEED,
    INVALID,
    KEEP,
    SAMPLES,
    SAMPLING,
    UNKNOWN_PARAMETER,
    Keep,
    Metric,
    SweepSpec,
    metric_problems,
    name_problems,
    raise_problems,
    sequence_of_seeds,
    spec_of_world,
)

Parameters = Spaces | Sequence[Mapping[str, object]] | FilePath
"""Spaces by parameter, a list of values by parameter for each run, or a CSV file with such a list."""

_CHECKED_ROWS: Final = 16  # rows that are tried before a parameter counts as wrong


def sweep(
    world: FilePath | RunSpec,
    parameters: Parameters = {},  # noqa: B006 (never changed)
    *,
    seeds: int | Sequence[int] | None = None,
    metrics: Mapping[str, Metric] | None = None,
    duration: float | None = None,
    until: str = "",
    commands: CommandsArgument | None = None,
    samples: int | None = SAMPLES.default,
    sampling: Sampling = SAMPLING.default,
    design_seed: int = DESIGN_SEED.default,
    jobs: int | None = None,
    folder: FilePath | None = None,
    keep: Keep = KEEP.default,
    bag_topics: str | Sequence[str] = BAG_TOPICS.default,
    warm: bool = True,
    cluster: str | None = None,
    allow_code: bool = False,
) -> DataFrame:
    """Run a world with every combination of parameters and seeds, and return a table with a row for each run.

    A run that fails or diverges is a row too. The same call gives the same table with any number of processes.

    Args:
        world: world as for `simkit.load`, or a run specification with commands, conditions and options.
        parameters: values by parameter: a list for a grid, or a distribution such as `{"uniform": [0.1, 0.2]}`. A
            parameter is a path of `--set`, or a variable `{name}` in the texts of the run specification. A list of
            mappings, or a CSV file, gives the values of each run.
        seeds: seeds of the noise, or their number; None for the seed of the specification.
        metrics: measurements at the end of each run: expressions, or functions of the simulation.
        duration: simulated time of each run [s]; None for that of the specification.
        until: condition that ends a run early.
        commands: commands of each run, in place of those of the specification: a list of mappings as in a script,
            `{"at": 1.0, "topic": "/cmd_vel", "message": {"linear": {"x": "{speed}"}}}`; a constant velocity `"V,W"` as
            for `--cmd-vel`; a script `FILE.yaml`; or a bag, whose commands are played. Variables `{name}` are replaced
            in all but bags.
        samples: number of samples of the distributions; None for one sample a seed.
        sampling: "random", "sobol", "latin_hypercube" or "saltelli".
        design_seed: seed of the samples.
        jobs: number of processes; None for one per processor core, 1 for the present process.
        folder: folder for the results. A sweep that was interrupted continues there. None for a temporary one.
        keep: runs whose bundles are kept in the folder: "failed", "all", or the largest number of failed runs.
        bag_topics: patterns of the topics in the bags of kept runs; empty for no bags.
        warm: keep the world loaded between runs with equal load arguments; the results are the same.
        cluster: address of a Ray cluster, "auto" for a running one; None for processes of this machine.
        allow_code: allow the plugin folders that the file of a specification names.

    Returns:
        Table with the columns run, seed, the parameters, the metrics, exit_code, status, end, code, message, time [s],
        steps and state_hash.

    Raises:
        InputError: SK-SWEEP-001 an argument is invalid; SK-SWEEP-002 a parameter is unknown; SK-SWEEP-003 the folder
            has another sweep; SK-CLI-010 to 012 a command is invalid; SK-INPUT-004 pandas is not installed.
        LoadError: the world has errors.
    """
    if find_spec("pandas") is None:
        hint = install_command("experiments")
        raise InputError("SK-INPUT-004", "simkit.sweep needs pandas, which is missing", help=hint)
    run = permit_code(with_commands(spec_of_world(world, duration, until), commands), allow_code)
    design = make_design(
        parameters, sequence_of_seeds(seeds, run.seed), samples=samples, sampling=sampling, design_seed=design_seed
    )
    metrics = {} if metrics is None else metrics
    raise_problems([*metric_problems(metrics), *BAG_TOPICS.problems(bag_topics)])
    topics = (bag_topics,) if isinstance(bag_topics, str) else tuple(bag_topics)
    spec = SweepSpec(run, design, dict(metrics), keep, topics, warm)
    temporary = tempfile.TemporaryDirectory() if folder is None else nullcontext(os.fspath(folder))
    with cast(AbstractContextManager[str], temporary) as name:
        run_sweep(spec, Path(name), jobs=jobs, cluster=cluster, writes_tables=folder is not None)
        return read_table(name)


def make_design(
    parameters: Parameters,
    seeds: tuple[int, ...] | range,
    *,
    samples: int | None = SAMPLES.default,
    sampling: Sampling = SAMPLING.default,
    design_seed: int = DESIGN_SEED.default,
) -> Design:
    """Return the design of a sweep.

    Raises:
        InputError: SK-SWEEP-001 with all problems of the arguments.
    """
    problems: list[str] = []
    spaces: list[ParameterSpace] = []
    listed: tuple[Values, ...] | None = None
    if hasattr(parameters, "to_dict") and hasattr(parameters, "columns"):  # a DataFrame
        parameters = cast(Sequence[Mapping[str, object]], parameters.to_dict("records"))
    if isinstance(parameters, (str, os.PathLike)):
        listed = read_parameters(Path(parameters))
    elif isinstance(parameters, Mapping):
        for names, description in parameters.items():
            try:
                spaces.append(parameter_space(names, description))
            except InvalidSpace as error:
                problems.append(f"{INVALID} parameter {names!r}: {error}")
    else:
        listed = _listed_rows(parameters, problems)
    problems += [*SAMPLING.problems(sampling), *SAMPLES.problems(samples), *DESIGN_SEED.problems(design_seed)]
    distributions = [space for space in spaces if space.levels is None]
    if distributions and samples is None and len(seeds) == 1 and not problems:
        problems.append(
            f"{INVALID} samples: missing; the parameters have distributions, so say how many samples to draw"
        )
    if samples is not None and not distributions and not problems:
        problems.append(f"{INVALID} samples: found {samples}, but no parameter has a distribution to draw from")
    if sampling == "saltelli" and not problems and (not distributions or samples is None):
        problems.append(f"{INVALID} sampling: 'saltelli' needs parameters with distributions, and samples")
    raise_problems(problems)
    return Design(tuple(spaces), seeds, samples, sampling, design_seed, listed)


def _listed_rows(parameters: object, problems: list[str]) -> tuple[Values, ...]:
    rows: list[dict[str, ParameterValue]] = []
    if not isinstance(parameters, Iterable):
        problems.append(f"{INVALID} parameters: found {shown(parameters)}; expected a mapping or a list of mappings")
        return ()
    for number, row in enumerate(parameters):
        if not isinstance(row, Mapping):
            problems.append(
                f"{INVALID} parameters: item {number} is {shown(row)}; expected a mapping of names to values"
            )
            continue
        try:
            rows.append({str(name): plain_value(value) for name, value in row.items()})
        except InvalidSpace as error:
            problems.append(f"{INVALID} parameters: item {number}: {error}")
    if not rows and not problems:
        problems.append(f"{INVALID} parameters: the list is empty")
    return tuple(rows)


# ---------------------------------------------------------------------- run


@dataclass(frozen=True)
class SweepOutcome:
    """Numbers of a sweep after its run.

    Attributes:
        count: number of runs.
        failed: number of runs that did not end with exit code 0.
        skipped: number of runs that were finished before.
        wall_time: wall time of this call [s].
        simulated: simulated time of the runs of this call [s].
        tables: written tables.
    """

    count: int
    failed: int
    skipped: int
    wall_time: float
    simulated: float
    tables: tuple[Path, ...] = ()


def run_sweep(
    spec: SweepSpec,
    folder: Path,
    *,
    jobs: int | None = None,
    cluster: str | None = None,
    writes_tables: bool = True,
    always_processes: bool = False,
    shard: tuple[int, int] = (0, 1),
) -> SweepOutcome:
    """Make the runs of a sweep that are not finished in a folder.

    Args:
        spec: sweep.
        folder: folder of the results.
        jobs: number of processes; None for one per processor core.
        cluster: address of a Ray cluster; None for this machine.
        writes_tables: write `results.csv` and `results.parquet` at the end.
        always_processes: use a process also for one job, so that a crash of a plugin costs one run only.
        shard: number and count of the parts of the sweep, each of which is run by another call, from 0.
    """
    names = name_problems(spec)
    if names:
        raise_problems(names + path_problems(spec, checked_rows(spec.design), spec.design.names))
    store = ResultStore(folder)
    begun = time.perf_counter()
    make_folder(folder)
    store.begin(spec.fingerprint(), spec.design.count, description_of(spec))
    blocks = [block for block in store.blocks if block % shard[1] == shard[0]]
    with locked_blocks(folder, blocks):
        total = sum(len(store.runs_of(block)) for block in blocks)
        missing = sum(len(store.missing(block)) for block in blocks)
        simulated = 0.0
        if missing:
            spec, runner = begin_runs(spec, store)
            runs = (run for block in blocks for run in store.missing(block))
            tasks = (SweepTask(spec.design.row(run)) for run in runs)
            with make_executor(spec, jobs, cluster, missing, runner, always_processes=always_processes) as executor:
                try:
                    with progress.task("running the sweep", missing) as task:
                        for result in executor.stream(tasks):
                            store.add(result.plain())
                            simulated += result.time
                            show_progress(task, simulated)
                finally:
                    store.close()
                if cluster is None:
                    keep_runs(spec, store, blocks, executor)
        chosen = runs_to_keep(spec, store, blocks) if not missing or cluster is not None else ()
        if chosen:
            # the nodes of a cluster cannot write here
            with make_executor(spec, jobs, None, len(chosen), always_processes=always_processes) as local:
                keep_runs(spec, store, blocks, local)
        tables = write_tables(store) if writes_tables and store.finished_count() == store.count else ()
        failed = sum(row["exit_code"] != 0 for row in store.rows())
    wall = time.perf_counter() - begun
    return SweepOutcome(store.count, failed, total - missing, wall, simulated, tuple(tables))


def show_progress(task: progress.Task, simulated: float) -> None:
    """Count a finished run, and show the rate of runs and of simulated time."""
    elapsed = time.perf_counter() - task.begun
    task.advance(f"{(task.done + 1) / elapsed:.3g} runs/s, {simulated / elapsed:.3g} × real time")


def description_of(spec: SweepSpec) -> SweepDescription:
    """Return what a report needs to know about a sweep."""
    design = spec.design
    return {
        "title": spec.run.title,
        "parameters": list(design.names),
        "metrics": list(spec.metrics),
        "expressions": {name: metric for name, metric in spec.metrics.items() if isinstance(metric, str)},
        "sampling": design.sampling,
        "points": design.points,
        "combinations": design.combinations,
        "seeds": 1 if design.is_paired else len(design.seeds),
        "sampled": [name for space in design.distributions for name in space.names],
        "file": str(spec.run.file.absolute()) if spec.run.file is not None else "",
    }


def begin_runs(spec: SweepSpec, store: ResultStore) -> tuple[SweepSpec, RowRunner]:
    """Check a sweep on its world; return it with what its worlds run without, and a runner with a loaded world.

    Raises:
        InputError: problems of the sweep, as in `check_sweep`; SK-SWEEP-003 the stored runs had other plugins.
    """
    runner = check_sweep(spec)
    with runner.closed_on_error():
        left_out = runner.left_out or {}
        store.check_left_out(left_out)
        log_left_out(left_out)
    return replace(spec, left_out=left_out), runner


def check_sweep(spec: SweepSpec) -> RowRunner:
    """Check parameters, conditions and metrics on the world, so that a mistake does not fail every run.

    Returns:
        Runner with a loaded world, so that a sweep in this process does not read the world again.

    Raises:
        InputError: all problems; see `check_runs`.
    """
    rows = checked_rows(spec.design)
    with progress.task("checking the sweep"):
        try:
            runner, loaded = check_runs(spec, rows)
        except InputError:
            raise_problems(path_problems(spec, rows, spec.design.names))
            raise
        with runner.closed_on_error():
            raise_problems(path_problems(spec, rows, [name for name in spec.design.names if name not in loaded.values]))
    return runner


def path_problems(spec: SweepSpec, rows: Sequence[SweepRow], names: Sequence[str]) -> list[str]:
    """Return a message for each of several parameters that no row can set."""
    if not names or spec.run.spawn or spec.run.overrides or spec.run.change_world is not None:
        return []  # the world's file alone does not have all entities; the first run shows the problem
    return [
        f"{UNKNOWN_PARAMETER} the parameter {name!r} cannot be set: {str(error).partition(': ')[2]}"
        for name, error in parameter_problems(spec, rows, names).items()
    ]


def checked_rows(design: Design) -> list[SweepRow]:
    """Return some rows of a design, spread over all runs."""
    count = design.count
    runs = dict.fromkeys(round(part * (count - 1) / (_CHECKED_ROWS - 1)) for part in range(_CHECKED_ROWS))
    return list(design.rows(list(runs)))


def runs_to_keep(spec: SweepSpec, store: ResultStore, blocks: Iterable[int]) -> list[int]:
    """Return the numbers of the runs in some blocks whose bundles are kept and not written yet."""
    folder = store.folder.absolute() / "runs"
    rows = (row for block in blocks for row in store.block_rows(block))
    chosen = [row["run"] for row in rows if spec.keep == "all" or row["exit_code"]]
    if isinstance(spec.keep, int):
        chosen = chosen[: spec.keep]
    return [run for run in chosen if not (folder / f"{run:06d}.zip").exists()]


def keep_runs(spec: SweepSpec, store: ResultStore, blocks: Iterable[int], executor: Executor) -> None:
    """Repeat the runs of some blocks whose bundles are kept, and write them with their bags into the folder `runs`."""
    folder, chosen = store.folder.absolute() / "runs", runs_to_keep(spec, store, blocks)
    if not chosen:
        return
    folder.mkdir(exist_ok=True)
    with progress.task("keeping runs", len(chosen)) as task:
        for result in executor.stream(SweepTask(spec.design.row(run), folder / f"{run:06d}.zip") for run in chosen):
            task.advance(f"run {result.row.run}")
