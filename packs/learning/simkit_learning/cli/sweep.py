"""Run a world with many parameters and seeds, and report the results."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Option
from typer.core import TyperGroup

from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_to_report, report_errors_and_json
from simkit.cli.terminal.output import print_status, stdout_console
from simkit.errors import InputError
from simkit.extend import argument, counted, option

if TYPE_CHECKING:
    from simkit_learning.sweeps.sweep import SweepOutcome
    from simkit_learning.sweeps.sweep_spec import Keep, SweepSpec


class _RunByDefault(TyperGroup):
    """Group whose first argument may be a file instead of a command."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Insert the command `run`, unless another command or `--help` is first."""
        if args and args[0] not in (*self.commands, "--help", "-h"):
            args = ["run", *args]
        return super().parse_args(ctx, args)


sweep = typer.Typer(
    cls=_RunByDefault,
    help="Run a world with many parameters and seeds, and report the results.\n\n"
    "simkit sweep SWEEP.yaml runs a sweep; simkit sweep report DIR writes a page of its results.",
    no_args_is_help=True,
)

SweepFile = Annotated[Path, argument("Sweep file: a scenario file with parameters, seeds and metrics.", "SWEEP.yaml")]
Results = Annotated[Path, argument("Folder with the results of a sweep.", "DIR")]


@sweep.command()
@report_errors_and_json
def run(
    file: SweepFile,
    output: Annotated[
        Path | None,
        option(
            "Folder for the results; default: NAME_sweep. The same command continues there.", "DIR", "--output", "-o"
        ),
    ] = None,
    jobs: Annotated[
        int | None, option("Number of parallel processes; default: one per processor core.", "N", "--jobs", "-n", min=1)
    ] = None,
    keep: Annotated[
        str | None, option("Runs whose bundles (and bags) are kept; default: 10 failed ones.", "failed|all|N")
    ] = None,
    shard: Annotated[
        str | None,
        option("Make only part I of N, numbered from 0; other calls make the others in the same folder.", "I/N"),
    ] = None,
    cluster: Annotated[str | None, option("Ray cluster; auto for a running one.", "ray://HOST:PORT|auto")] = None,
    cold: Annotated[bool, Option("--cold", help="Load the world again for every run.")] = False,
    optimise: Annotated[
        str | None, option("Search the parameters for the smallest (or largest) value of this metric.", "METRIC")
    ] = None,
    trials: Annotated[int | None, option("Number of trials of a search; default: 100.", "N", min=1)] = None,
    maximise: Annotated[bool, Option("--maximise", help="Search for the largest value.")] = False,
    plugin_path: options.CodePaths = [],
    allow_code: options.AllowCode = False,
    resource_path: options.ReadableFolders = [],
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
    quiet: Annotated[bool, Option("--quiet", "-q", help="Print nothing but errors.")] = False,
) -> int:
    """Make all runs of a sweep that are not finished, and write one table of their results.

    A failed run is a row of the table. After an interruption, the same command makes only the missing runs.
    """
    from simkit_learning.sweeps.sweep import run_sweep
    from simkit_learning.sweeps.sweep_file import read_sweep

    _check_combination(optimise=optimise, trials=trials, maximise=maximise, shard=shard, cluster=cluster, jobs=jobs)
    part = _shard(shard or "0/1")
    spec = read_sweep(file, resource_path, allow_code=allow_code, plugin_paths=plugin_path)
    spec = replace(spec, is_warm=not cold, keep=spec.keep if keep is None else _keep(keep))
    folder = output or Path(f"{file.stem}_sweep")
    os.fspath(folder.absolute()).encode()  # PyArrow writes only to paths that are valid UTF-8
    if optimise is not None:
        return _search(spec, folder, optimise, trials or 100, jobs, cluster, maximise=maximise, quiet=quiet)
    try:
        outcome = run_sweep(spec, folder, jobs=jobs, cluster=cluster, always_processes=True, shard=part)
    except KeyboardInterrupt:
        print_status(f"the finished runs are stored; the same command continues in {folder}")
        raise
    _print_outcome(outcome, folder, quiet=quiet)
    return 0


def _check_combination(
    *,
    optimise: str | None,
    trials: int | None,
    maximise: bool,
    shard: str | None,
    cluster: str | None,
    jobs: int | None,
) -> None:
    """Raise an error that lists the options which would have no effect.

    Raises:
        InputError: SK-CLI-018 an option needs or excludes another one.
    """
    problems = []
    if optimise is None:
        searching = {"--trials": trials is not None, "--maximise": maximise}
        problems += [f"{name} needs --optimise METRIC" for name, is_given in searching.items() if is_given]
    elif shard is not None:
        problems.append("--optimise excludes --shard: a trial depends on earlier ones; use --jobs or --cluster")
    if cluster is not None and jobs is not None:
        problems.append("--cluster excludes --jobs: the cluster uses all of its processor cores")
    if problems:
        raise InputError("SK-CLI-018", "\nSK-CLI-018 ".join(problems))


def _print_outcome(outcome: SweepOutcome, folder: Path, *, quiet: bool) -> None:
    made = outcome.count - outcome.skipped
    add_to_report(
        folder=str(folder), runs=outcome.count, failed=outcome.failed, skipped=outcome.skipped,
        wall_time=outcome.wall_time, tables=[str(path) for path in outcome.tables],
    )  # fmt: skip
    if quiet:
        return
    console = stdout_console()
    factor = outcome.simulated / outcome.wall_time if outcome.wall_time > 0 else 0.0
    before = f", {outcome.skipped} of them before" if outcome.skipped else ""
    console.print(
        f"{counted(outcome.count, 'run')}{before}: {outcome.count - outcome.failed} ok, {outcome.failed} failed"
    )
    if made:
        console.print(f"{outcome.wall_time:.1f} s, {made / outcome.wall_time:.3g} runs/s, {factor:.3g} × real time")
    for path in outcome.tables:
        console.print(str(path))
    if not outcome.tables:
        print_status("the other parts of the sweep are not finished, so there is no table yet")


def _search(
    spec: SweepSpec,
    folder: Path,
    metric: str,
    trials: int,
    jobs: int | None,
    cluster: str | None,
    *,
    maximise: bool,
    quiet: bool,
) -> int:
    from simkit_learning.sweeps.optimisation import optimise_sweep

    best = optimise_sweep(spec, folder, metric, trials, jobs=jobs, cluster=cluster, maximise=maximise)
    add_to_report(folder=str(folder), best=best)
    if not quiet:
        values = ", ".join(f"{name} = {value}" for name, value in best["values"].items())
        stdout_console().print(
            f"best of {trials} runs: run {best['run']} with {metric} = {best['value']:.6g}: {values}"
        )
    return 0


def _keep(text: str) -> Keep:
    from simkit_learning.sweeps.sweep_spec import INVALID, KEEP

    value = int(text) if text.isdecimal() else text
    if KEEP.allows(value):
        return value
    raise InputError(INVALID, f"--keep: found {text!r}; expected {KEEP.expected}")


def _shard(text: str) -> tuple[int, int]:
    first, slash, second = text.partition("/")
    if slash and first.isdecimal() and second.isdecimal() and int(first) < int(second):
        return int(first), int(second)
    raise InputError("SK-SWEEP-001", f"--shard: found {text!r}; expected I/N, such as 0/4 to 3/4")


@sweep.command()
@report_errors_and_json
def report(
    folder: Results,
    output: Annotated[
        Path | None, option("Page to write; default: DIR/report.html.", "OUT.html", "--output", "-o")
    ] = None,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
) -> None:
    """Write a page with histograms, scatter plots, sensitivities and the worst runs of a sweep."""
    from simkit_learning.sweeps.report import write_report

    path = write_report(folder, output or folder / "report.html")
    add_to_report(report=str(path))
    stdout_console().print(str(path))


@sweep.command()
@report_errors_and_json
def table(
    folder: Results,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
) -> None:
    """Write the tables of the runs that are finished, also of an unfinished sweep."""
    from simkit_learning.sweeps.result_store import ResultStore
    from simkit_learning.sweeps.result_table import write_tables

    store = ResultStore(folder)
    store.open()
    tables = write_tables(store)
    add_to_report(tables=[str(path) for path in tables], runs=store.count, finished=store.finished_count())
    for path in tables:
        stdout_console().print(str(path))


@sweep.command()
@report_errors_and_json
def replay(
    folder: Results,
    number: Annotated[int, argument("Number of the run.", "RUN")],
    file: Annotated[Path | None, option("Sweep file; default: the file that the folder names.", "SWEEP.yaml")] = None,
    bundle: Annotated[Path | None, option("Write a bundle of the run.", "FILE.zip")] = None,
    plugin_path: options.CodePaths = [],
    allow_code: options.AllowCode = False,
    resource_path: options.ReadableFolders = [],
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
) -> int:
    """Repeat one run of a sweep and compare its end with the table. Exit code 5 if it differs."""
    from simkit_learning.sweeps.repetition import repeat_run

    repeated = repeat_run(folder, number, file, bundle, resource_path, allow_code=allow_code, plugin_paths=plugin_path)
    add_to_report(**repeated.as_dict())
    for line in repeated.lines():
        stdout_console().print(line)
    return 0 if repeated.is_same else 5
