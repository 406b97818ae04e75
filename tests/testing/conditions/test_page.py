"""`docs/conditions.md` names every function, and its examples work."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit.cli import app
from simkit.testing.conditions.binder import FUNCTIONS

PAGE = (Path(__file__).resolve().parents[3] / "docs" / "conditions.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    """Return the first code block of a language."""
    found = re.search(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)
    assert found is not None
    return found.group(1)


def test_every_function_is_documented() -> None:
    assert [name for name in FUNCTIONS if not re.search(rf"\b{name}\b", PAGE)] == []


def test_the_command_prints_what_the_page_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    words = shlex.split(block("sh").replace("\\\n", " "))
    result = CliRunner().invoke(app, words[1:])
    assert result.exit_code == 0 and (tmp_path / "out.xml").exists()
    number = re.compile(r"-?\d+\.\d+")
    for line in block("text").splitlines():
        said = next(said for said in result.stdout.splitlines() if said.startswith(line[:40]))
        assert number.sub("#", said) == number.sub("#", line)
        found, told = (list(map(float, number.findall(text))) for text in (said, line))
        assert found == pytest.approx(told, abs=0.05)


def test_the_command_prints_the_results_of_the_checks(capsys: pytest.CaptureFixture[str]) -> None:
    exec(compile(block("python"), "docs/conditions.md", "exec"), {})
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == ["True"] * 3
