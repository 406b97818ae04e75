"""The command `simkit check`: print every problem of a file."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.terminal.output import print_diagnostics, report_errors, stdout_console
from simkit.cli.terminal.shared_options import (
    Base,
    File,
    Force,
    Json,
    PackagePaths,
    PluginPaths,
    ResourcePaths,
    Strict,
    XacroArgs,
    source_arguments,
)
from simkit.diagnostics import Diagnostic
from simkit.errors import InputError
from simkit.writers.atomic_output import check_file


@report_errors
def check(
    file: File,
    json_: Json = False,
    strict: Strict = False,
    every: Annotated[bool, typer.Option("--all", help="Lists repeats one by one.")] = False,
    fix_inertia: Annotated[
        bool, typer.Option("--fix-inertia", help="Shows new numbers for inertias that no solid has.")
    ] = False,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="With --fix-inertia: the file with them.", metavar="OUT")
    ] = None,
    force: Force = False,
    resource_path: ResourcePaths = [],
    package_path: PackagePaths = [],
    plugin_path: PluginPaths = [],
    xacro_arg: XacroArgs = [],
    base: Base = "auto",
) -> int:
    """Prints every problem of a file, not only the first; runs nothing."""
    from simkit.build import check as check_file

    if fix_inertia:
        return _fix_inertia(file, output, force, resource_path, json_)
    if output is not None:
        raise InputError("SK-CLI-018 check writes a file only with --fix-inertia", "SK-CLI-018")
    found = list(
        check_file(file, plugin_paths=plugin_path, **source_arguments(resource_path, package_path, xacro_arg, base))
    )
    if json_:
        stdout_console().file.write(json.dumps([d.as_dict() for d in found], indent=2) + "\n")
    else:
        print_diagnostics(found, verbose=True, console=stdout_console(), every=every)
        stdout_console().print(_counts(found))
    bad = {"error", "warning"} if strict else {"error"}
    return 2 if any(d.severity in bad for d in found) else 0


def _counts(found: Sequence[Diagnostic]) -> str:
    counts = Counter(d.severity for d in found)
    return ", ".join(f"{counts[s]} {s}{'' if counts[s] == 1 else 's'}" for s in ("error", "warning", "note"))


def _fix_inertia(file: str, output: Path | None, force: bool, resource_paths: list[Path], json_: bool) -> int:
    from simkit.writers.fix_inertia import find_inertia_fixes

    found = find_inertia_fixes(Path(file), resource_paths)
    if output is not None:
        check_file(output, overwrite=force)
    if json_:
        fixes = [
            {"file": str(f.file), "line": f.line, "link": f.link, "mass": f.mass, "old": f.before, "new": f.numbers,
             "moments_old": f.old, "moments_new": f.new, "why": f.why}
            for f in found.fixes
        ]  # fmt: skip
        stdout_console().file.write(json.dumps(fixes, indent=2) + "\n")
    else:
        for fix in found.fixes:
            stdout_console().print(str(fix))
        for problem in found.problems:
            stdout_console().print(problem)
        stdout_console().print(f"{len(found.fixes)} inertias that no solid has")
    if output is not None:
        count = found.write(output)
        rest = f"; {len(found.elsewhere)} stand in other files" if found.elsewhere else ""
        if not json_:
            stdout_console().print(f"{output}: {count} links changed{rest}")
    return 0
