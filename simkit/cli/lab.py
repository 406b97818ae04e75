"""Command `simkit lab`: list the labs of the course, start one in a folder, and grade the folder."""

from __future__ import annotations

import shutil
import sys
from importlib import metadata
from pathlib import Path
from typing import Annotated

import typer
from typer import Option

from simkit.cli.grade import grade_files
from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import not_found_error, print_json, print_line, report_errors, report_errors_quietly
from simkit.errors import InputError
from simkit.input_file import TEXT_LIMIT, read_input
from simkit.install_command import install_command
from simkit.loaders.resources.bundled_models import bundled_folders
from simkit.writers.atomic_output import copy_failure, remove_abandoned, unfinished_folder

lab = typer.Typer(help="List, start and grade the labs of the course.", no_args_is_help=True)

_EXERCISE = "exercise.yaml"
_SOLUTION = "solution"
_REQUIREMENTS = "requirements.txt"  # packages that a lab needs beside simkit, one in a line


def _labs() -> dict[str, Path]:
    """Return the folder of each lab, sorted by name."""
    found = {
        file.parent.name: file.parent for folder in bundled_folders("labs") for file in folder.glob(f"*/{_EXERCISE}")
    }
    return dict(sorted(found.items()))


def _complete(incomplete: str) -> list[str]:
    """Return the names of labs for shell completion."""
    return [name for name in _labs() if name.startswith(incomplete)]


@lab.command("list")
@report_errors_quietly
def list_(json_: options.Json = False) -> None:
    """List the labs, a name a line."""
    names = list(_labs())
    if json_:
        print_json(names)
        return
    for name in names:
        print_line(name)


@lab.command()
@report_errors_quietly
def start(
    name: Annotated[str, argument("Name of the lab; its number is enough.", "NAME", _complete)],
    folder: Annotated[Path, argument("New folder of the lab.", "DIR")],
    solution: Annotated[bool, Option("--solution", help="Write a solution instead of the student's file.")] = False,
) -> None:
    """Copy a lab into a new folder."""
    labs = _labs()
    matching = [one for one in labs if one == name or one.split("_")[0] == name.zfill(2)]
    if len(matching) != 1:
        raise not_found_error("lab", name, labs, "SK-CLI-055", "simkit")
    source = labs[matching[0]]
    target = folder.absolute()
    if target.exists() and (not target.is_dir() or any(target.iterdir())):
        raise _not_writable(folder, "it exists and is not an empty folder")
    stage: Path | None = None
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        remove_abandoned(target.parent, target.name)
        stage = unfinished_folder(target.parent, target.name)
        shutil.copytree(source, stage, dirs_exist_ok=True, ignore=shutil.ignore_patterns(_SOLUTION, "__pycache__"))
        if solution:
            ignored = shutil.ignore_patterns("__pycache__")
            shutil.copytree(source / _SOLUTION, stage, dirs_exist_ok=True, ignore=ignored)
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
    print_line(f"{folder}: {', '.join(sorted(path.name for path in target.iterdir()))}")
    missing = _missing_packages(target)
    if missing:
        print_line(f"this lab needs {' and '.join(missing)}: {_remedy(missing)}")
    print_line(f"read {folder / 'README.md'}, then run: simkit lab grade {folder}")


def _missing_packages(folder: Path) -> list[str]:
    """Return the packages that a lab needs and that are not installed."""
    file = folder / _REQUIREMENTS
    needed = read_input(file, TEXT_LIMIT).decode("utf-8", "replace").split() if file.is_file() else []
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
    message = f"SK-CLI-016 cannot write {folder}: {reason}\n    help: choose a new folder"
    return InputError(message, "SK-CLI-016")


@lab.command()
@report_errors
def grade(
    folder: Annotated[Path, argument("Folder of the lab.", "DIR")] = Path(),
    pictures: Annotated[Path | None, option("Folder for a picture of the path of each run.", "DIR")] = None,
    jobs: Annotated[int, option("Number of parallel processes.", "N", min=1, max=256)] = 1,
    json_: options.Json = False,
) -> int:
    """Grade the exercises of the lab in a folder: exit code 0 for full points, 5 otherwise."""
    exercise = folder / _EXERCISE
    exercises = sorted(folder.glob("exercise*.yaml"))
    if exercise not in exercises:
        hint = f"simkit lab start NAME {folder}; the labs are: {', '.join(_labs())}"
        raise InputError(f"SK-SCEN-007 no file {exercise}\n    help: {hint}", "SK-SCEN-007")
    missing = _missing_packages(folder)
    if missing:
        message = f"SK-CLI-056 {folder}: the lab needs {' and '.join(missing)}\n    help: {_remedy(missing)}"
        raise InputError(message, "SK-CLI-056")
    return grade_files(exercises, pictures=pictures, jobs=jobs, json_=json_)
