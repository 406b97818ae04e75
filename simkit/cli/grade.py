"""The command `simkit grade`: run an exercise with plugins that were handed in, and report their results."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from typer import Argument

from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import print_json, report_errors, stdout_console
from simkit.errors import InputError
from simkit.writers.atomic_output import check_writable

_FAILED = 5


@report_errors
def grade(
    exercise: Annotated[Path, argument("The exercise's YAML file.", "EXERCISE.yaml")],
    hand_ins: Annotated[
        list[Path] | None,
        Argument(help="Plugins that were handed in; that of the exercise where not given.", metavar="PLUGIN.py"),
    ] = None,
    junit: Annotated[Path | None, option("Writes the results for CI.", "OUT.xml")] = None,
    pictures: Annotated[Path | None, option("Draws the path of each run into a folder.", "DIR")] = None,
    jobs: Annotated[int, option("Processes at a time.", "N", min=1, max=256)] = 1,
    json_: options.Json = False,
) -> int:
    """Runs an exercise with plugins that were handed in, and says what each got and why."""
    from simkit.testing.scenarios.exercise import read_exercise
    from simkit.testing.scenarios.grading import grade_all, grade_json, grade_text, junit_cases

    check_writable(junit)
    asked = read_exercise(exercise)
    files = _files(hand_ins, exercise.parent / asked.hand_in if asked.hand_in else None)
    if pictures is not None:
        pictures.mkdir(parents=True, exist_ok=True)
    graded = []
    for one in grade_all(asked, files, pictures, jobs):
        graded.append(one)
        if not json_:
            for line in grade_text(one):
                stdout_console().print(line)
    if json_:
        print_json([grade_json(one) for one in graded])
    if junit is not None:
        from simkit.testing.junit import write_junit

        write_junit(junit, asked.title, [case for one in graded for case in junit_cases(one)])
    if len(graded) > 1 and not json_:
        stdout_console().print("")
        for one in graded:
            stdout_console().print(
                f"{one.points:>6g} of {one.worth:g}  {'passed' if one.passed else 'not passed':<11}{one.hand_in}"
            )
    return 0 if all(one.passed for one in graded) else _FAILED


def _files(given: list[Path] | None, own: Path | None) -> list[Path | None]:
    """The plugins to be tried.

    Raises:
        InputError: SK-SCEN-007 one is not there.
    """
    files: list[Path | None] = list(given) if given else [own]
    missing = [str(file) for file in files if file is not None and not file.is_file()]
    if missing:
        hint = "simkit grade EXERCISE.yaml PLUGIN.py"
        raise InputError(f"SK-SCEN-007 no file {', '.join(missing)}\n    help: {hint}", "SK-SCEN-007")
    return files
