"""Command `simkit check`: print every problem of a file."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from typer import Option

from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.second_reader import Against, compare_readers
from simkit.cli.terminal import options
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import print_diagnostics, report_errors, stdout_console
from simkit.diagnostics import Diagnostic
from simkit.errors import InputError
from simkit.run_files import FilePath
from simkit.writers.atomic_output import check_file


@report_errors
@with_run_options(
    *("file", "world"),
    usual={"model_world": "empty space"},
    without={
        "seed": "a check makes no step",
        "strict": "--strict of a check changes the exit code alone",
        "on_error": "a check reports a plugin that raises",
        "run": "a check makes no step",
        "session": "a check makes no step",
    },
)
def check(
    file: options.File,
    json_: options.Json = False,
    strict: options.Strict = False,
    every: Annotated[bool, Option("--all", help="List repeated problems one by one.")] = False,
    fix_inertia: Annotated[
        bool, Option("--fix-inertia", help="Show corrected values for impossible inertias.")
    ] = False,
    output: Annotated[
        Path | None, option("With --fix-inertia: corrected file to write.", "OUT", "--output", "-o")
    ] = None,
    force: options.Force = False,
    against: Against = None,
    given: GivenOptions = NONE_GIVEN,
) -> int:
    """Print all problems of a file without running it."""
    from simkit.build import check as check_file

    if fix_inertia:
        return _fix_inertia(file, output, force, given.source_options().get("resource_paths", ()), json_)
    if output is not None:
        raise InputError("SK-CLI-018", "--output needs --fix-inertia")
    diagnostics, comparison = list(check_file(file, **given.load_arguments())), ""
    if against is not None:
        differences, comparison = compare_readers(file, against, given.source_options(), diagnostics)
        diagnostics += differences
    if json_:
        stdout_console().file.write(json.dumps([d.as_dict() for d in diagnostics], indent=2) + "\n")
    else:
        print_diagnostics(diagnostics, verbose=True, console=stdout_console(), every=every)
        if comparison:
            stdout_console().print(comparison)
        stdout_console().print(_counts(diagnostics))
    bad = {"error", "warning"} if strict else {"error"}
    return 2 if any(d.severity in bad for d in diagnostics) else 0


def _counts(diagnostics: Sequence[Diagnostic]) -> str:
    counts = Counter(d.severity for d in diagnostics)
    return ", ".join(f"{counts[s]} {s}{'' if counts[s] == 1 else 's'}" for s in ("error", "warning", "note"))


def _fix_inertia(file: str, output: Path | None, force: bool, resource_paths: Sequence[FilePath], json_: bool) -> int:
    from simkit.writers.fix_inertia import find_inertia_fixes

    result = find_inertia_fixes(Path(file), resource_paths)
    if output is not None:
        check_file(output, overwrite=force)
    if json_:
        fixes = [
            {"file": str(f.file), "line": f.line, "link": f.link, "mass": f.mass, "old": f.before, "new": f.numbers,
             "moments_old": f.old, "moments_new": f.new, "why": f.why}
            for f in result.fixes
        ]  # fmt: skip
        stdout_console().file.write(json.dumps(fixes, indent=2) + "\n")
    else:
        for fix in result.fixes:
            stdout_console().print(str(fix))
        for problem in result.problems:
            stdout_console().print(problem)
        stdout_console().print(f"{len(result.fixes)} impossible inertias")
    if output is not None:
        count = result.write(output)
        rest = f"; {len(result.elsewhere)} are in other files" if result.elsewhere else ""
        if not json_:
            stdout_console().print(f"{output}: {count} links changed{rest}")
    return 0
