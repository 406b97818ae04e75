"""Command `simkit demo`: run short examples one after the other, with the command of each.

A step is a folder `cli/demo_steps/<name>` of the core or of a shipped pack, with a file `step.toml` and the input files
of its commands. A step runs the command line itself, so the printed commands can be pasted into a terminal.
"""

from __future__ import annotations

import shlex
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Final

import typer

from simkit import progress
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_to_report, report_errors_and_json
from simkit.cli.terminal.options import option, validate_word
from simkit.cli.terminal.output import print_status, stdout_console
from simkit.errors import InputError, SimkitError
from simkit.packs import left_out_names, missing_pack_text, shipped_packs
from simkit.writers.atomic_output import check_folder, current_umask, remove_abandoned, unfinished_folder

_FOLDER: Final = "cli/demo_steps"
_STEP: Final = "step.toml"
_LAST_LINES: Final = 12  # lines of a failed command that the error repeats
_STOP: Final = 5.0  # [s] of wall time for a command to end after a signal


@dataclass(frozen=True)
class Step:
    """One example.

    Attributes:
        name: name of its folder.
        source: folder with the input files.
        place: position among all steps.
        title: sentence about the example.
        commands: command lines, or tables with `run` and `exit_code`, or with `edit`, `text` and `by`.
        pictures: pictures and pages among the written files.
        show: text in the lines of the last command to print; empty for none.
    """

    name: str
    source: Path
    place: int
    title: str
    commands: Sequence[str | Mapping[str, object]]
    pictures: Sequence[str]
    show: str = ""


@dataclass
class StepResult:
    """Result of a step.

    Attributes:
        commands: what was done, as a user would type it.
        lines: lines of the last command.
    """

    commands: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)


def demo_steps() -> dict[str, Step]:
    """Return the steps of the core and of the shipped packs by name, in order."""
    packages = [Path(__file__).parents[1], *(Path(pack.folder) for pack in shipped_packs())]
    files = [file for package in packages for file in package.glob(f"{_FOLDER}/*/{_STEP}")]
    steps = [Step(file.parent.name, file.parent, **tomllib.loads(file.read_text(encoding="utf-8"))) for file in files]
    return {step.name: step for step in sorted(steps, key=lambda step: (step.place, step.name))}


def _complete(incomplete: str) -> list[str]:
    """Return the names of steps for shell completion."""
    return [name for name in demo_steps() if name.startswith(incomplete)]


@report_errors_and_json
def demo(
    names: Annotated[
        list[str],
        typer.Argument(help="Steps to run; default: all.", metavar="[STEP...]", autocompletion=_complete),
    ] = [],
    output: Annotated[Path, option("New folder for the files of each step.", "DIR", "--output", "-o")] = Path(
        "simkit_demo"
    ),
    force: options.Force = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
) -> None:
    """Run short examples one after the other, in about a minute."""
    steps, left_out = demo_steps(), left_out_names("demo_steps")
    for name in names:
        if name in left_out:
            needs, advice = missing_pack_text(left_out[name])
            raise InputError("SK-INPUT-004", f"the step {name} {needs}", help=advice)
    chosen = [steps[validate_word("STEP", name, list(steps))] for name in dict.fromkeys(names)] or list(steps.values())
    check_folder(output)
    existing = [output / step.name for step in chosen if (output / step.name).exists()]
    if existing and not force:
        message = f"{existing[0]} already exists"
        raise InputError("SK-CLI-016", message, help="name another folder with --output, or replace it with --force")
    if left_out and not names:
        print_status(f"steps of packs that are not installed: {', '.join(left_out)}")
    console, rows = stdout_console(), []
    for number, step in enumerate(progress.report_each("running the examples", chosen, len(chosen)), 1):
        console.print(f"{number}/{len(chosen)} {step.name}: {step.title}", style="bold")
        result = _run(step, output / step.name)
        pictures = [str(output / step.name / picture) for picture in step.pictures]
        for command in result.commands:
            console.print(f"    {command}", style="dim")
        shown = [line.strip() for line in result.lines if step.show and step.show in line]
        for line in (*shown, *pictures):
            console.print(f"    {line}")
        folder = str(output / step.name)
        rows.append(
            {"name": step.name, "title": step.title, "folder": folder, "commands": result.commands, "lines": shown}
            | {"pictures": pictures}
        )
        add_to_report(steps=rows)
    console.print(f"Each command can be repeated in the folder of its step, such as {output / chosen[0].name}.")
    if len(chosen) > 1:
        console.print(f"One example alone: simkit demo {chosen[0].name} -o NEW_FOLDER")


def _run(step: Step, target: Path) -> StepResult:
    """Run the commands of a step in a hidden folder, which becomes the target when all commands have ended.

    Raises:
        SimkitError: SK-CLI-063 a command failed.
    """
    stage: Path | None = None
    is_new = not target.parent.exists()
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        remove_abandoned(target.parent, target.name)
        stage = unfinished_folder(target.parent, target.name)
        stage.chmod(0o777 & ~current_umask())
        shutil.copytree(step.source, stage, dirs_exist_ok=True, ignore=shutil.ignore_patterns(_STEP))
        result = StepResult()
        for command in step.commands:
            entry = {"run": command} if isinstance(command, str) else command
            with progress.task(str(entry.get("run") or f"editing {entry['edit']}")):
                _do(entry, stage, result)
        shutil.rmtree(target, ignore_errors=True)
        stage.rename(target)
    except OSError as error:
        raise InputError("SK-CLI-016", f"cannot write to {target}: {error.strerror or error}") from None
    finally:
        if stage is not None:
            shutil.rmtree(stage, ignore_errors=True)  # after an error or an interrupt
            if is_new and target.parent.is_dir() and not any(target.parent.iterdir()):
                target.parent.rmdir()
    return result


def _do(entry: Mapping[str, object], folder: Path, result: StepResult) -> None:
    """Run one command of a step, or make its edit."""
    if "edit" in entry:
        file, text, by = folder / str(entry["edit"]), str(entry["text"]), str(entry["by"])
        content = file.read_text(encoding="utf-8")
        line = content[: content.index(text)].count("\n") + 1
        file.write_text(content.replace(text, by, 1), encoding="utf-8")
        result.commands.append(f"edit {file.name}:{line}: {text} becomes {by}")
        return
    command = str(entry["run"])
    result.commands.append(command)
    words = [sys.executable, "-P", "-m", *shlex.split(command)]
    ended = _finished(words, folder)
    if ended.returncode != entry.get("exit_code", 0):
        last = "\n".join((ended.stdout + ended.stderr).splitlines()[-_LAST_LINES:])
        raise SimkitError("SK-CLI-063", f"{command!r} ended with exit code {ended.returncode}:\n{last}")
    result.lines[:] = ended.stdout.splitlines()


def _finished(words: Sequence[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a command to its end; after an interrupt, end it and wait until it has removed its files."""
    with subprocess.Popen(
        words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        encoding="utf-8", errors="replace",
    ) as process:  # fmt: skip
        try:
            stdout, stderr = process.communicate()
        except BaseException:
            process.terminate()
            try:
                process.communicate(timeout=_STOP)
            except subprocess.TimeoutExpired:
                process.kill()
            raise
    return subprocess.CompletedProcess(words, process.returncode, stdout, stderr)
