"""Run an exercise with submitted plugins and print the results."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument

from simkit.cli.terminal import options
from simkit.cli.terminal.output import print_json, stdout_console
from simkit.errors import InputError
from simkit.extend import argument, option, report_errors
from simkit.run_spec import FilePath
from simkit.writers.atomic_output import check_writable

if TYPE_CHECKING:
    from simkit_verification.testing.grading.exercise_grading import LabHandIn
    from simkit_verification.testing.grading.report_words import ReportWords

_FAILED = 5
DEFAULT_LIMIT = 5.0  # [s]

CallbackLimit = Annotated[
    float, option("Longest time of a callback without progress [s]; 0 for no limit.", "S", min=0.0, max=86400.0)
]

Language = Annotated[
    str, option("Language of the texts: en or fr; the default is that of the environment (LC_ALL, LANG).", "LANGUAGE")
]


@report_errors
def grade(
    exercise: Annotated[Path, argument("YAML file of the exercise.", "EXERCISE.yaml")],
    submissions: Annotated[
        list[Path] | None,
        Argument(help="Submitted plugins; default: the plugin that the exercise names.", metavar="PLUGIN.py"),
    ] = None,
    junit: Annotated[Path | None, option("JUnit XML report to write.", "OUT.xml")] = None,
    pictures: Annotated[Path | None, option("Folder for a picture of the path of each run.", "DIR")] = None,
    jobs: Annotated[int, option("Number of parallel processes.", "N", min=1, max=256)] = 1,
    limit: CallbackLimit = DEFAULT_LIMIT,
    plugin_path: options.CodePaths = [],
    allow_code: options.AllowCode = False,
    resource_path: options.ReadableFolders = [],
    lang: Language = "",
    json_: options.Json = False,
) -> int:
    """Run an exercise with submitted plugins and print the results."""
    words = report_words(exercise.parent, lang)
    with words.translated_errors():
        return grade_files(
            [exercise], submissions, junit, pictures, jobs, limit=limit, json_=json_,
            allow_code=allow_code, plugin_paths=plugin_path, folders=resource_path, words=words,
        )  # fmt: skip


def report_words(folder: Path | None, language: str) -> ReportWords:
    """Return the sentences of reports in a language; an empty name is the language of the environment.

    Args:
        folder: Folder of the exercise, which may have translations of its titles and hints; None for none.
        language: Language of the option `--lang`.

    Raises:
        InputError: SK-CLI-018 there is no such language.
    """
    from simkit_verification.testing.grading.report_words import LANGUAGES, default_language, read_words

    return read_words(folder, options.validate_word("--lang", language, LANGUAGES) if language else default_language())


def grade_files(
    exercises: list[Path],
    submissions: list[Path] | None = None,
    junit: Path | None = None,
    pictures: Path | None = None,
    jobs: int = 1,
    *,
    limit: float = DEFAULT_LIMIT,
    lab: LabHandIn | None = None,
    json_: bool = False,
    allow_code: bool = False,
    plugin_paths: Sequence[Path] = (),
    folders: Sequence[FilePath] = (),
    words: ReportWords | None = None,
) -> int:
    """Grade plugins, print the results, and return the exit code; the arguments are those of the command.

    For the hand-in of a lab, `lab` has its files, and `exercises` are those of the lab. `words` has the language of the
    report; None for English.

    Raises:
        LoadError: an exercise has problems, or SK-SCEN-008 it names code that is not allowed.
        InputError: a plugin does not exist, or a file cannot be written.
    """
    from simkit.testing.scenarios.code_permission import check_requests
    from simkit_verification.testing.grading.exercise import read_exercise
    from simkit_verification.testing.grading.exercise_grading import (
        grade_all,
        grade_json,
        grade_text,
        junit_cases,
        points_text,
        verdict_text,
    )
    from simkit_verification.testing.grading.report_words import ENGLISH

    words = words or ENGLISH
    check_writable(junit)
    tasks = [
        read_exercise(exercise, folders, allow_code=allow_code, plugin_paths=plugin_paths) for exercise in exercises
    ]
    places = [task.file.parent if lab is None else lab.folder for task in tasks]
    own_files = [place / task.hand_in if task.hand_in else None for task, place in zip(tasks, places, strict=True)]
    files = [_files(submissions, file) for file in own_files]
    for task in tasks:
        named = task.own_code if not submissions and lab is None else None  # grading a folder means running its file
        check_requests((*task.code_requests, *([named] if named else [])), allow_code, plugin_paths)
    grades = []
    stopped: set[Path] = set()
    for task, of_task in zip(tasks, files, strict=True):
        folder = pictures if pictures is None or len(tasks) == 1 else pictures / task.file.stem
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
        for result in grade_all(task, of_task, folder, jobs, limit=limit, lab=lab, stopped=stopped, words=words):
            grades.append(result)
            if not json_:
                for line in grade_text(result, words):
                    stdout_console().print(line)
    if json_:
        print_json([grade_json(result) for result in grades])
    if junit is not None:
        from simkit.testing.junit import write_junit

        write_junit(junit, tasks[0].title, [case for result in grades for case in junit_cases(result)])
    if len(grades) > 1 and not json_:
        stdout_console().print("")
        for result in grades:
            name = result.hand_in if len(tasks) == 1 else words.translated(result.exercise.title)
            line = f"    {points_text(result, words):<10}  {verdict_text(result, words):<11}{name}"
            stdout_console().print(line)
    return 0 if all(result.passed for result in grades) else _FAILED


def _files(submissions: list[Path] | None, own: Path | None) -> list[Path | None]:
    """Return the plugins to grade.

    Raises:
        InputError: SK-SCEN-007 a file does not exist.
    """
    files: list[Path | None] = list(submissions) if submissions else [own]
    missing = [str(file) for file in files if file is not None and not file.is_file()]
    if missing:
        hint = "simkit grade EXERCISE.yaml PLUGIN.py"
        raise InputError("SK-SCEN-007", f"no file {', '.join(missing)}", help=hint)
    return files
