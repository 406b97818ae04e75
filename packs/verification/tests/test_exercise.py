"""The exercise among the examples: its solution gets every point, who does not look ahead is told what went wrong."""

from __future__ import annotations

import re
import shlex
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from simkit.cli import app

pytestmark = pytest.mark.slow  # processes and whole runs

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "examples" / "exercise"
PAGE = (FOLDER / "README.md").read_text(encoding="utf-8")
COMMAND = (Path(__file__).parents[1] / "docs" / "commands" / "grade.md").read_text(encoding="utf-8")


def blocks(page: str, language: str) -> list[str]:
    return re.findall(rf"^```{language}(?: file=\S+)?\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)


def shown(page: str) -> Iterator[str]:
    """The lines of output that a page shows, as far as the dots that stand for numbers."""
    return (line.partition("…")[0] for block in blocks(page, "text") for line in block.splitlines())


@pytest.fixture
def grade(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Result]:
    """Runs a line of a page in a copy of the folder."""
    shutil.copytree(FOLDER, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    return lambda line: CliRunner().invoke(app, shlex.split(line, comments=True)[1:])


def test_the_solution_passes_and_who_drives_straight_on_is_told_why(grade, tmp_path):
    _, both = blocks(PAGE, "sh")[0].splitlines()
    done = grade(both)
    assert done.exit_code == 5, done.output
    said = done.stdout.splitlines()
    for line in (*shown(PAGE), *shown(COMMAND)):
        assert any(one.startswith(line) for one in said), line
    assert (tmp_path / "results.xml").read_text().count("<failure") == 6


def test_the_exercise_that_a_teacher_sets_is_solved_by_its_solution(grade, tmp_path):
    for name, text in re.findall(r"^```\w+ file=(\S+)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL):
        (tmp_path / name).write_text(text)
    done = grade(blocks(PAGE, "sh")[1])
    assert done.exit_code == 0 and "8 of 8 points" in done.stdout, done.output
