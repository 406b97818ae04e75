"""Command `simkit check`: print every problem of a file, its score, or the scores of all files of a folder."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated

from typer import Option

from simkit.cli.run_options import NONE_GIVEN, GivenOptions, parse_seconds, with_run_options
from simkit.cli.second_reader.against_option import Against, compare_readers
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import report_errors
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import print_diagnostics, print_json, stdout_console
from simkit.diagnostics import Diagnostic, Diagnostics, Where
from simkit.errors import InputError
from simkit.number_text import counted
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
    every: Annotated[
        bool,
        Option("--all", help="List repeated problems one by one; of a folder, also files that are parts of others."),
    ] = False,
    fix_inertia: Annotated[
        bool, Option("--fix-inertia", help="Show corrected values for impossible inertias.")
    ] = False,
    output: Annotated[
        Path | None, option("With --fix-inertia: corrected file to write.", "OUT", "--output", "-o")
    ] = None,
    score: Annotated[
        bool, Option("--score", help="Show how much of the file works as in Gazebo: 0 to 100, with the reasons.")
    ] = False,
    html: Annotated[Path | None, option("Write the scores as one HTML page.", "OUT", "--html")] = None,
    jobs: Annotated[
        int | None, option("For a folder: number of parallel processes; default: one per core.", "N", "--jobs", min=1)
    ] = None,
    limit: Annotated[
        float | None,
        option("For a folder: longest wall time for one file; default: 60 s.", "S", "--limit", parser=parse_seconds),
    ] = None,
    force: options.Force = False,
    against: Against = None,
    given: GivenOptions = NONE_GIVEN,
) -> int:
    """Print all problems of a file without running it, or the scores of all files of a folder."""
    from simkit.build import check as find_problems
    from simkit.cli.diagnostic_catalogue import effect_of

    if fix_inertia and (score or html is not None):
        raise InputError("SK-CLI-018", "--fix-inertia cannot be used with --score and --html")
    if output is not None and not fix_inertia:
        raise InputError("SK-CLI-018", "--output needs --fix-inertia")
    if against is not None and (score or html is not None or fix_inertia):
        raise InputError("SK-CLI-018", "--against cannot be used with --score, --html and --fix-inertia")
    if html is not None:
        check_file(html, overwrite=force)
    if not fix_inertia and _is_searched(file):
        from simkit.cli.scores.score_command import check_folder

        if against is not None:
            raise InputError("SK-CLI-018", "--against needs one file, not a folder")
        return check_folder(
            file, given.load_arguments(), effect_of, run_options=list(_run_options(given)), jobs=jobs, limit=limit,
            html=html, json_=json_, strict=strict, every=every,
        )  # fmt: skip
    if jobs is not None or limit is not None:
        raise InputError("SK-CLI-018", "--jobs and --limit are for a folder of files")
    if fix_inertia:
        return _fix_inertia(file, output, force, given.source_options().get("resource_paths", ()), json_)
    if score or html is not None:
        if every:
            raise InputError("SK-CLI-018", "--all cannot be used with the score of one file; --json lists everything")
        from simkit.cli.scores.score_command import show_score

        return show_score(file, given.load_arguments(), effect_of, html=html, json_=json_, strict=strict)
    diagnostics, comparison = list(find_problems(file, **given.load_arguments())), ""
    if against is not None:
        differences, comparison = compare_readers(file, against, given.source_options(), diagnostics)
        diagnostics += differences
    if json_:
        print_json([d.as_dict() for d in diagnostics], indent=2)
    else:
        print_diagnostics(diagnostics, verbose=True, console=stdout_console(), every=every)
        if comparison:
            stdout_console().print(comparison)
        stdout_console().print(_counts(diagnostics))
    bad = {"error", "warning"} if strict else {"error"}
    return 2 if any(d.severity in bad for d in diagnostics) else 0


def _is_searched(file: str) -> bool:
    """Check for a folder whose files are all checked: one that is not itself a model, and no bundled name."""
    try:
        if "<" in file or "://" in file or not os.path.isdir(file):  # noqa: PTH112 (a long name is no error)
            return False
    except ValueError:  # a zero byte
        return False
    from simkit.loaders.resources.bundled_models import find_bundled_model, find_bundled_world
    from simkit.loaders.resources.model_folder import model_file

    folder, where = Path(file), Where(file)
    if (folder / "model.config").exists() or (folder / "manifest.xml").exists():
        return False
    model = model_file(folder, where, Diagnostics(), lambda _: True)
    if model is not None:
        return model.suffix == ".xml" and not _is_mjcf_folder(folder)
    return not (find_bundled_world(file) or find_bundled_model(file))


def _is_mjcf_folder(folder: Path) -> bool:
    """Check whether a folder has files in MJCF and no other worlds, models or robots, also not in folders below it."""
    from simkit.cli.scores.folder_search import find_files, root_element

    files = find_files(folder).files
    return bool(files) and all("/" not in name and root_element(folder / name) == "mujoco" for name in files)


def _run_options(given: GivenOptions) -> Iterator[str]:
    """Yield the options of the command that a run of a file needs too."""
    for folder in given.values.get("resource_paths", ()):
        yield from ("--resource-path", str(folder))
    packages = given.values.get("package_paths") or ()
    for item in packages.items() if isinstance(packages, Mapping) else packages:
        yield from ("--package-path", f"{item[0]}={item[1]}" if isinstance(item, tuple) else str(item))
    for name, value in dict(given.values.get("xacro_args") or {}).items():
        yield from ("--xacro-arg", f"{name}={value}")


def _counts(diagnostics: Sequence[Diagnostic]) -> str:
    counts = Counter(d.severity for d in diagnostics)
    return ", ".join(counted(counts[s], s) for s in ("error", "warning", "note"))


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
        print_json(fixes, indent=2)
    else:
        for fix in result.fixes:
            stdout_console().print(str(fix))
        for problem in result.problems:
            stdout_console().print(problem)
        stdout_console().print(counted(len(result.fixes), "impossible inertia"))
    if output is not None:
        count = result.write(output)
        rest = f"; {len(result.elsewhere)} are in other files" if result.elsewhere else ""
        if not json_:
            stdout_console().print(f"{output}: {counted(count, 'link')} changed{rest}")
    return 0
