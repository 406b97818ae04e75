"""List, start and grade the labs of the course."""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import not_found_error, print_json, print_line, print_status, without_interrupt_message
from simkit.errors import InputError
from simkit.extend import add_to_report, argument, option, report_errors
from simkit.input_file import TEXT_LIMIT, read_input
from simkit.install_command import install_command
from simkit.loaders.resources.bundled_models import bundled_folders
from simkit.writers.atomic_output import copy_failure, remove_abandoned, unfinished_folder
from simkit_verification.cli.grade import DEFAULT_LIMIT, CallbackLimit, Language, grade_files, report_words

if TYPE_CHECKING:
    from simkit_verification.testing.grading.report_words import ReportWords

lab = typer.Typer(help="List, start and grade the labs of the course.", no_args_is_help=True)

_EXERCISE = "exercise.yaml"
_MARKER = ".simkit-lab"  # file with the name of the lab in a folder that `start` made
_NAME_LIMIT = 1000  # bytes of this file
_SOLUTION = "solution"
_TRANSLATED_README = "README.{}.md"
_REQUIREMENTS = "requirements.txt"  # packages that a lab needs beside simkit, one in a line


def _labs() -> dict[str, Path]:
    """Return the folder of each lab, sorted by name."""
    folders = {
        file.parent.name: file.parent for folder in bundled_folders("labs") for file in folder.glob(f"*/{_EXERCISE}")
    }
    return dict(sorted(folders.items()))


def _named_lab(name: str) -> Path:
    """Return the folder of a lab by its name or number.

    Raises:
        InputError: SK-CLI-055 there is no such lab.
    """
    labs = _labs()
    matching = [label for label in labs if label == name or label.split("_")[0] == name.zfill(2)]
    if len(matching) != 1:
        raise not_found_error("lab", name, labs, "SK-CLI-055", "simkit")
    return labs[matching[0]]


def _complete(incomplete: str) -> list[str]:
    """Return the names of labs for shell completion."""
    return [name for name in _labs() if name.startswith(incomplete)]


@lab.command("list")
@report_errors
@without_interrupt_message
def list_(json_: options.Json = False) -> None:
    """List the labs, a name a line."""
    names = list(_labs())
    if json_:
        print_json(names)
        return
    for name in names:
        print_line(name)


@lab.command()
@report_errors
@without_interrupt_message
def start(
    name: Annotated[str, argument("Name of the lab; its number is enough.", "NAME", _complete)],
    folder: Annotated[Path, argument("New folder of the lab.", "DIR")],
    solution: Annotated[bool, Option("--solution", help="Write a solution instead of the student's file.")] = False,
    lang: Language = "",
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> None:
    """Copy a lab into a new folder."""
    words = report_words(None, lang)
    with words.translated_errors():
        source = _named_lab(name)
        target = folder.absolute()
        if target.exists() and (not target.is_dir() or any(target.iterdir())):
            raise _not_writable(folder, "it exists and is not an empty folder")
        _copy(source, folder, solution=solution)
    files = sorted(path.name for path in target.iterdir() if path.name != _MARKER)
    add_to_report(folder=str(folder), files=files)
    print_line(f"{folder}: {', '.join(files)}")
    missing = _missing_packages(target)
    if missing:
        packages, remedy = _joined(missing, words), words.message(_remedy(missing))
        print_line(words.say("this lab needs {packages}: {remedy}", packages=packages, remedy=remedy))
    translated = _TRANSLATED_README.format(words.language)
    readme = translated if (target / translated).is_file() else "README.md"
    again = f"simkit lab grade {folder}" + (f" --lang {lang}" if lang else "")
    print_line(words.say("read {file}, then run: {command}", file=folder / readme, command=again))


def _copy(source: Path, folder: Path, *, solution: bool) -> None:
    """Copy a lab to a folder that is empty or does not exist, all files or none.

    Raises:
        InputError: SK-CLI-016 the folder cannot be written.
    """
    target = folder.absolute()
    stage: Path | None = None
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        remove_abandoned(target.parent, target.name)
        stage = unfinished_folder(target.parent, target.name)
        shutil.copytree(source, stage, dirs_exist_ok=True, ignore=shutil.ignore_patterns(_SOLUTION, "__pycache__"))
        if solution:
            ignored = shutil.ignore_patterns("__pycache__")
            shutil.copytree(source / _SOLUTION, stage, dirs_exist_ok=True, ignore=ignored)
        (stage / _MARKER).write_text(f"{source.name}\n", encoding="utf-8")
        stage.chmod(0o755)
        if target.exists():  # it may be the folder of the user's shell, so it stays
            for item in sorted(stage.iterdir()):
                item.rename(target / item.name)
            stage.rmdir()
        else:
            stage.rename(target)
    except OSError as error:
        raise _not_writable(folder, copy_failure(error)) from None
    finally:
        if stage is not None:
            shutil.rmtree(stage, ignore_errors=True)  # after an error or an interrupt


def _joined(names: list[str], words: ReportWords) -> str:
    return f" {words.say('and')} ".join(names)


def _missing_packages(folder: Path) -> list[str]:
    """Return the packages that a lab needs and that are not installed."""
    file = folder / _REQUIREMENTS
    needed = read_input(file, TEXT_LIMIT, inside=folder).decode("utf-8", "replace").split() if file.is_file() else []
    return [name for name in needed if not _is_installed(name)]


def _is_installed(package: str) -> bool:
    try:
        metadata.version(package)
    except (metadata.PackageNotFoundError, ValueError):
        return False
    return True


def _remedy(missing: list[str]) -> str:
    if sys.platform == "win32" and {"pin", "coal"} & set(missing):
        return "there are no such packages for Windows; use Linux, macOS or the Windows Subsystem for Linux"
    return install_command("labs")


def _not_writable(folder: Path, reason: str) -> InputError:
    message = f"cannot write {folder}: {reason}"
    return InputError("SK-CLI-016", message, help="choose a new folder")


@lab.command()
@report_errors
def grade(
    folder: Annotated[Path, argument("Folder of the lab.", "DIR")] = Path(),
    name: Annotated[str, option("Name of the lab, if the folder does not tell it.", "NAME", "--lab")] = "",
    exercise: Annotated[
        Path | None, option("Exercise, or folder of a lab, to use instead of the installed lab.", "FILE|DIR")
    ] = None,
    pictures: Annotated[Path | None, option("Folder for a picture of the path of each run.", "DIR")] = None,
    jobs: Annotated[int, option("Number of parallel processes.", "N", min=1, max=256)] = 1,
    limit: CallbackLimit = DEFAULT_LIMIT,
    allow_code: options.AllowCode = False,
    lang: Language = "",
    json_: options.Json = False,
) -> int:
    """Grade the exercises of the lab in a folder: exit code 0 for full points, 5 otherwise."""
    from simkit_verification.testing.grading.exercise_grading import LabHandIn

    words = report_words(None, lang)
    with words.translated_errors():
        source, exercises = _graded_lab(folder, name, exercise)
        words = report_words(source, lang)
        missing = _missing_packages(source)
        if missing:
            message = words.say("{lab}: the lab needs {packages}", lab=source.name, packages=_joined(missing, words))
            raise InputError("SK-CLI-056", message, help=_remedy(missing))
        files = _files_to_grade(source, exercises, folder, words, print_status if json_ else print_line)
        return grade_files(
            exercises, pictures=pictures, jobs=jobs, limit=limit, lab=LabHandIn(folder, tuple(files)), json_=json_,
            words=words,
            allow_code=allow_code or exercise is None,  # the code of the installed lab is simkit's own
        )  # fmt: skip


def _files_to_grade(
    source: Path, exercises: list[Path], folder: Path, words: ReportWords, tell: Callable[[str], None]
) -> list[str]:
    """Return the files of a folder that are graded; tell which they are, and which changed files are not used."""
    from simkit_verification.testing.grading.exercise import read_exercise
    from simkit_verification.testing.grading.lab_files import changed_files, hand_in_files

    files = hand_in_files(source, [read_exercise(file).hand_in for file in exercises])
    tell(words.say("lab {lab}: {files} of {folder}", lab=source.name, files=", ".join(files), folder=folder))
    changed = changed_files(source, folder, files)
    if changed:
        tell(words.say("note: not used, because the lab has its own: {files}", files=", ".join(changed)))
    return files


def _graded_lab(folder: Path, name: str, exercise: Path | None) -> tuple[Path, list[Path]]:
    """Return the folder with the true files of a lab, and its exercises.

    Raises:
        InputError: SK-SCEN-007 the folder tells no lab, or there is no exercise; SK-CLI-055 the lab is unknown.
    """
    if exercise is not None and exercise.is_file():
        return exercise.absolute().parent, [exercise.absolute()]
    if exercise is not None:
        source = exercise.absolute()
    elif name:
        source = _named_lab(name)
    else:
        source = _lab_of(folder)
    exercises = sorted(source.glob("exercise*.yaml"))
    if not exercises:
        hint = "simkit lab grade DIR --exercise FILE"
        raise InputError("SK-SCEN-007", f"no file {source / _EXERCISE}", help=hint)
    return source, exercises


def _lab_of(folder: Path) -> Path:
    """Return the folder of the installed lab from which a student's folder was started.

    Raises:
        InputError: SK-SCEN-007 the folder does not tell the lab.
    """
    labs = _labs()
    marker, exercise = folder / _MARKER, folder / _EXERCISE
    if marker.is_file():
        name = read_input(marker, _NAME_LIMIT).decode("utf-8", "replace").strip()
        if name in labs:
            return labs[name]
    elif exercise.is_file():  # a folder from before simkit wrote the marker
        title = _title(exercise)
        same = [lab for lab in labs.values() if title and _title(lab / _EXERCISE) == title]
        if len(same) == 1:
            return same[0]
    start = f"simkit lab start NAME {folder}"
    hint = f"{start}, or simkit lab grade {folder} --lab NAME; the labs are: {', '.join(labs)}"
    raise InputError("SK-SCEN-007", f"{folder} does not tell its lab", help=hint)


def _title(exercise: Path) -> str:
    """Return the title of an exercise; the file need not be valid."""
    text = read_input(exercise, TEXT_LIMIT).decode("utf-8", "replace")
    match = re.search(r"^  title:(.*)$", text, re.MULTILINE)
    return match[1].strip() if match else ""
