"""Command `simkit golden`: record golden runs and check them."""

from __future__ import annotations

import math
import shlex
from collections.abc import Sequence
from contextlib import chdir
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.run_options import NONE_GIVEN, GivenOptions, scenario_spec, with_run_options
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_diagnostics, add_to_report, error_diagnostics, report_errors_and_json
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import (
    JsonObject,
    JsonValue,
    print_diagnostics,
    print_error,
    print_message,
    print_status,
    stdout_console,
)
from simkit.errors import InputError, RegressionError
from simkit.number_text import counted
from simkit.run_spec import run_fields
from simkit.testing.golden.parallel_check import CheckResult
from simkit.testing.scenarios.code_permission import without_permissions
from simkit.testing.scenarios.readable_files import HELP
from simkit.writers.atomic_output import check_writable

if TYPE_CHECKING:
    from simkit.run_spec import RunSpec
    from simkit.testing.conditions import CheckResult as ConditionResult
    from simkit.testing.golden.compare.difference import Verdict
    from simkit.testing.run_record.record import RunRecord


def record_golden(spec: RunSpec, folder: Path, *, force: bool = False) -> RunRecord:
    """Run a specification and store the result as a golden run.

    Returns:
        Record of the run; its simulation is still open.

    Raises:
        SimkitError: the run failed; nothing is written.
    """
    from simkit.testing.golden.store import MAIN_FILE, write_golden
    from simkit.testing.run_record.run_recorder import record_run
    from simkit.testing.scenarios.scenario_run import open_scenario, resolve_commands

    if (folder / MAIN_FILE).exists() and not force:
        raise InputError(
            "SK-GOLDEN-005",
            f"{folder} already contains a golden run",
            help="update it with `simkit golden check --bless 'REASON'`, or replace it with --force",
        )
    with chdir("."):  # a plugin may change the working directory while it is loaded
        sim = open_scenario(spec)
    try:
        record = record_run(resolve_commands(spec, sim.communication.bus), sim=sim)
        if record.error is not None:
            raise record.error
        write_golden(folder, record)
    except BaseException:
        sim.close()
        raise
    return record


def report_results(
    results: Sequence[CheckResult],
    *,
    blessed: bool = False,
    html: Path | None = None,
    junit: Path | None = None,
    quiet: bool = False,
) -> int:
    """Print results, the worst first, and write the requested reports.

    Args:
        results: results of the checks.
        blessed: True if the differences were accepted as the new golden runs.
        html: HTML report to write.
        junit: JUnit XML report to write.
        quiet: print nothing about golden runs that passed.

    Returns:
        Exit code: that of the first check that could not run, else 5 if any golden run differs, else 0.
    """
    verdicts = [result.verdict for result in results if result.verdict is not None]
    if html is not None:
        from simkit.testing.golden.report import write_html

        write_html(html, verdicts)
    if junit is not None:
        _write_junit(junit, results, verdicts)
    _print_results(results, blessed=blessed, quiet=quiet)
    rows = [result_dict(result) for result in results]
    add_to_report(passed=all(row["passed"] for row in rows), results=rows)
    add_diagnostics(d for result in results if result.error is not None for d in error_diagnostics(result.error))
    for result in results:
        if result.error is not None:
            return int(result.error.exit_code)
    failed = [v for v in verdicts if not (_was_blessed(v, blessed) or v.passed)]
    return RegressionError.exit_code if failed else 0


def _print_results(results: Sequence[CheckResult], *, blessed: bool, quiet: bool) -> None:
    from simkit.testing.golden.report import text_report

    width = max(60, min(stdout_console().width, 160)) if stdout_console().is_terminal else 120
    for result in results:
        verdict = result.verdict
        if result.error is not None:
            print_error(result.error)
        elif verdict is not None and _was_blessed(verdict, blessed):
            count = len(verdict.comparison.differences)
            what = f"with {counted(count, 'difference')}:" if count else "with the bits of this machine"
            stdout_console().print(f"{verdict.name}: updated, {what}")
            for difference in verdict.comparison.differences[:5]:
                stdout_console().print(f"  {difference.words}")
        elif verdict is not None and not (verdict.passed and quiet):
            for line in text_report(verdict, width):
                stdout_console().print(line)
    if len(results) > 1:
        passed = sum(r.verdict is not None and r.verdict.passed for r in results)
        stdout_console().print(f"{passed} of {len(results)} golden runs passed")


def _was_blessed(verdict: Verdict, blessed: bool) -> bool:
    return blessed and verdict.comparison.can_be_blessed and all(check.passed for check in verdict.checks)


def _write_junit(path: Path, results: Sequence[CheckResult], verdicts: list[Verdict]) -> None:
    from simkit.testing.golden.report import junit_cases
    from simkit.testing.junit import JunitCase, write_junit

    cases = [
        JunitCase(
            "run", f"golden.{result.folder.name}", error=(str(result.error).partition("\n")[0], str(result.error))
        )
        for result in results
        if result.error is not None
    ]
    write_junit(path, "simkit golden", [*cases, *junit_cases(verdicts)])


def result_dict(result: CheckResult) -> JsonObject:
    """Return a result as a JSON object."""
    if result.verdict is None:
        code = getattr(result.error, "code", "")
        return {"folder": str(result.folder), "passed": False, "error": {"code": code, "message": str(result.error)}}
    verdict = result.verdict
    comparison, explanation = verdict.comparison, verdict.explanation
    content: JsonObject = {
        "folder": str(result.folder),
        "name": verdict.name,
        "passed": verdict.passed,
        "tier": comparison.tier,
        "elapsed": round(verdict.elapsed, 3),
        "end": verdict.run.end,
        "differences": [_json_number(vars(d) if hasattr(d, "__dict__") else d) for d in comparison.differences],
        "notes": list(comparison.notes),
        "machine": {name: {"golden": a, "run": b} for name, (a, b) in comparison.machine.items()},
        "checks": _check_dicts(verdict.checks),
    }
    if explanation is not None:
        content["explanation"] = {
            "lines": list(explanation.lines),
            "tick": _json_number(explanation.tick),
            "time": _json_number(explanation.time),
            "quantity": explanation.quantity,
            "causes": [_json_number(vars(cause)) for cause in explanation.causes],
        }
    return content


def _check_dicts(checks: Sequence[ConditionResult]) -> list[JsonObject]:
    """Return the results of a scenario's own checks as JSON objects."""
    return [
        {"title": c.check.title, "passed": c.passed, "message": c.message, "time": _json_number(c.time)} for c in checks
    ]


def _json_number(value: JsonValue) -> object:
    """Convert a value to JSON; NaN and infinity become null."""
    if isinstance(value, dict):
        return {str(key): _json_number(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)) or hasattr(value, "tolist"):
        return _json_number(value.tolist()) if hasattr(value, "tolist") else [_json_number(item) for item in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if isinstance(value, (bool, int, str)) or value is None else str(value)


golden = typer.Typer(help="Record and compare golden runs (reference sensor outputs).", no_args_is_help=True)


@golden.command()
@report_errors_and_json
@with_run_options(
    *("file", "world", "run"),
    usual={"duration": "the scenario's, else 10"},
    without={"session": "nobody follows the run of a golden run"},
)
def record(
    world: options.Scenario,
    out_: Annotated[Path, option("Folder to write.", "DIR", "--out", "-o")],
    given: GivenOptions = NONE_GIVEN,
    allow_code: options.AllowCode = False,
    force: options.Force = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
) -> None:
    """Run a scenario and store the result as a golden run."""
    from simkit.testing.scenarios.scenario_file import read_run

    loading = given.load_options()
    source = read_run(world, folders=loading.get("resource_paths", ()))
    spec = scenario_spec(source, given, allow_code=allow_code)
    if without_permissions(source, loading) or any(not run_fields()[name].is_load_option for name in given.values):
        spec = replace(spec, file=None)  # the golden run itself keeps the changes to the scenario file
    recorded = record_golden(spec, out_, force=force)
    if recorded.simulation is not None:
        print_diagnostics(recorded.simulation.diagnostics, verbose=False)
        add_diagnostics(recorded.simulation.diagnostics)
        recorded.simulation.close()
    _print_needed_folders(out_)
    messages = sum(len(stream.times_ns) for stream in recorded.streams.values())
    size = sum(path.stat().st_size for path in out_.iterdir())
    stdout_console().print(
        f"{out_}: {counted(len(recorded.streams), 'topic')}, {counted(messages, 'message')}, {size / 1000:.1f} kB"
    )
    add_to_report(
        folder=str(out_),
        topics=len(recorded.streams),
        messages=messages,
        bytes=size,
        checks=_check_dicts(recorded.checks),
    )
    for result in recorded.checks:
        if not result.passed:
            print_message(f"warning: the scenario's own check failed: {result.check.title}: {result.message}")


def _print_needed_folders(folder: Path) -> None:
    """Print the options that a check of a golden run needs, because the run names files of other folders."""
    from simkit.testing.golden.check import refused_files
    from simkit.testing.golden.record_encoding import decode_scenario
    from simkit.testing.golden.store import read_main

    problems = refused_files(folder, decode_scenario(read_main(folder)["scenario"], folder))
    needed = dict.fromkeys(problem.hint.removeprefix(HELP) for problem in problems)
    if needed:
        print_status(f"note: simkit golden check {shlex.quote(str(folder))} needs {' '.join(needed)}")


@golden.command()
@report_errors_and_json
def check(
    folders: Annotated[list[Path], argument("Golden runs, or folders that contain golden runs.", "DIR...")],
    bless: Annotated[str | None, option("Accept the differences as golden, with the reason.", "REASON")] = None,
    bless_other_renderer: Annotated[
        bool, Option("--bless-other-renderer", help="Accept images of another renderer, too.")
    ] = False,
    html: Annotated[Path | None, option("HTML report to write, with plots and images.", "OUT.html")] = None,
    junit: Annotated[Path | None, option("JUnit XML report to write.", "OUT.xml")] = None,
    jobs: Annotated[int, option("Number of parallel processes.", "N", "--jobs", "-n", min=1)] = 1,
    causes: Annotated[bool, Option("--causes/--no-causes", help="Search for the causes of differences.")] = True,
    budget: Annotated[float, option("Wall time limit of the search for each golden run.", "S", min=0)] = 60.0,
    plugin_path: options.CodePaths = [],
    allow_code: options.AllowCode = False,
    resource_path: options.ReadableFolders = [],
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
    quiet: Annotated[bool, Option("--quiet", "-q", help="Print only failures.")] = False,
) -> int:
    """Repeat golden runs and report the first difference and its cause. Exit code 5 if any golden run differs."""
    from simkit.testing.golden.parallel_check import CheckOptions, check_goldens

    check_writable(html)
    check_writable(junit)
    check_options = CheckOptions(
        bless,
        bless_other_renderer,
        causes,
        budget,
        html is not None,
        allow_code=allow_code,
        plugin_paths=tuple(plugin_path),
        folders=tuple(resource_path),
    )
    results = check_goldens(folders, check_options, jobs)
    return report_results(results, blessed=bless is not None, html=html, junit=junit, quiet=quiet)
