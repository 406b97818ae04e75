"""Run parts: a pack outside the repository brings an option of `simkit run`."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from simkit.cli.run_part import RunPart, fill_in_value, part_classes, run_parts

BALL = '<sdf version="1.9"><world name="w"><model name="ball"><link name="l"/></model></world></sdf>'
PART = '''
"""Run part `--count`: count the steps of a run."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Annotated

import typer

from simkit.cli.run_part import OpenRun, RunPart, fill_in_value
from simkit.cli.run_verdict import RunVerdict
from simkit.cli.terminal.options import option
from simkit.run_spec import RunSpec


@dataclass
class StepCount(RunPart):
    count: Annotated[int | None, option("Count at most N steps; default: 1000.", "[N]")] = None
    loud: Annotated[bool, option("Print the count in capitals.", None, "--loud")] = False

    def __post_init__(self) -> None:
        if self.count == 0:
            raise typer.BadParameter("0 is not greater than 0", param_hint="--count")

    @classmethod
    def complete_words(cls, words: list[str]) -> list[str]:
        return fill_in_value(words, "--count", "1000", str.isdigit)

    @property
    def is_watched(self) -> bool:
        return self.count is not None

    @contextmanager
    def around_run(self, spec: RunSpec, verdict: RunVerdict) -> Iterator[None]:
        verdict.reports.append(lambda error: self.count and print("error" if error else "no error"))
        yield

    @contextmanager
    def around_loop(self, run: OpenRun) -> Iterator[None]:
        yield
        if self.count is not None:
            text = f"pace {run.spec.pace:g}, {min(self.count, run.sim.engine.steps)} steps"
            print(text.upper() if self.loud else text)
'''


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a pack `count`, with the metadata that pip would write beside it."""
    folder = tmp_path_factory.mktemp("pack")
    parts = folder / "simkit_count" / "cli" / "run_parts"
    parts.mkdir(parents=True)
    for package in (folder / "simkit_count", folder / "simkit_count" / "cli", parts):
        (package / "__init__.py").touch()
    (parts / "count.py").write_text(PART)
    info = folder / "simkit_count-0.1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: simkit_count\nVersion: 0.1.0\n")
    (info / "entry_points.txt").write_text("[simkit.packs]\ncount = simkit_count\n")
    (folder / "w.sdf").write_text(BALL)
    return folder


def simkit(folder: Path, *words: str) -> tuple[int, str]:
    environment = {**os.environ, "PYTHONPATH": str(folder), "COLUMNS": "200"}
    command = [sys.executable, "-m", "simkit", *words]
    done = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def test_the_help_lists_the_option(folder: Path) -> None:
    code, text = simkit(folder, "run", "--help")
    assert "--loud" in text and "--no-loud" not in text
    assert code == 0 and "--count [N]" in text and "Count at most N steps; default: 1000." in text


@pytest.mark.parametrize(("words", "count"), [(["--count", "w.sdf"], 20), (["w.sdf", "--count", "7"], 7)])
def test_a_run_has_the_option_with_and_without_a_value(folder: Path, words: list[str], count: int) -> None:
    code, text = simkit(folder, "run", *words, "--duration", "0.02")
    assert code == 0 and f"pace 1, {count} steps" in text and "no error" in text, text


def test_a_part_has_a_flag(folder: Path) -> None:
    code, text = simkit(folder, "run", "w.sdf", "--count", "--loud", "--duration", "0.02")
    assert code == 0 and "PACE 1, 20 STEPS" in text, text


def test_a_part_checks_its_value(folder: Path) -> None:
    code, text = simkit(folder, "run", "w.sdf", "--count", "0")
    assert code == 2 and "0 is not greater than 0" in text


def test_a_run_without_the_option_imports_the_part_and_does_nothing_more(folder: Path) -> None:
    code, text = simkit(folder, "run", "w.sdf", "--duration", "0.02")
    assert code == 0 and "steps" not in text.replace("step_size", "")


def test_other_commands_do_not_import_a_part(folder: Path) -> None:
    program = (
        "import sys; from simkit.cli import app; app(['--help'], standalone_mode=False); print(sys.modules.keys())"
    )
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True)
    assert "run_part" not in done.stdout and "Robot simulator" in done.stdout


OTHER = PART.replace("count: Ann", "other: Ann").replace("loud", "silent")
FILE = r"package simkit_count: \S*/other\.py:%d: "


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "import missing_module\n",
            "package simkit_count: a run part cannot be imported: .*other.py:1: ModuleNotFoundError: No module named",
        ),
        (
            PART.replace("count: Ann", "seed: Ann").replace("self.count", "self.seed"),
            FILE % 20 + "run part StepCount: there is another option --seed, of the command",
        ),
        (
            PART.replace("loud", "silent"),
            FILE % 20 + "run part StepCount: there is another option --count, of simkit_count.cli.run_parts.count",
        ),
        (
            OTHER.replace("int | None", "integer | None").replace("count: Ann", "other: Ann"),
            FILE % 21 + "option 'other' of .*'integer' is not",
        ),
        (
            OTHER.replace('"[N]")] = None', '"[N]")]').replace("count: Ann", "other: Ann"),
            FILE % 21 + ".* needs a default",
        ),
        (OTHER.replace("int | None", "complex"), FILE % 21 + ".*Type not yet supp"),
        (OTHER.replace("@dataclass\n", ""), FILE % 19 + ".* write @dataclass above"),
        (OTHER, FILE % 25 + "AttributeError: 'StepCount' object has no .* 'count'"),
    ],
)
def test_a_part_of_others_that_cannot_be_used_ends_no_run(folder: Path, text: str, message: str) -> None:
    file = folder / "simkit_count" / "cli" / "run_parts" / "other.py"
    file.write_text(text)
    try:
        code, output = simkit(folder, "run", "w.sdf", "--duration", "0.02", "--seed", "4")
    finally:
        file.unlink()
    assert code == 0 and len(re.findall(message, output)) == 1 and "Traceback" not in output, output


def test_every_part_does_nothing_with_its_defaults() -> None:
    assert len(part_classes()) >= 3
    assert not any(part.is_watched for part in run_parts())
    assert all(issubclass(cls, RunPart) and cls.__doc__ for cls in part_classes())


def test_a_word_after_the_end_of_options_is_no_option() -> None:
    assert fill_in_value(["--x", "--", "--x"], "--x", "1", str.isdigit) == ["--x=1", "--", "--x"]
    assert fill_in_value(["--x", "5", "--x"], "--x", "1", str.isdigit) == ["--x", "5", "--x=1"]
