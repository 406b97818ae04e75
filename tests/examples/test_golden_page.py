"""Every block of code of `docs/golden.md` works as it stands there, one after the other."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit.cli import app

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "golden.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)(?: file=(\S+))?\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


def run(line: str) -> str:
    """What a line of the shell prints; it ends well."""
    words = shlex.split(line)
    given: dict[str, str] = {}
    while "=" in words[0]:
        name, _, value = words.pop(0).partition("=")
        given[name] = value
    result = CliRunner().invoke(app, words[1:], env=given, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In an empty folder, with no robot chosen: checking knows which one was recorded."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("TURTLEBOT3_MODEL", raising=False)


@pytest.mark.slow
def test_the_page_works_as_it_stands(tmp_path: Path) -> None:
    assert [kind for kind, _, _ in BLOCKS] == ["sh", "sh", "sh", "yaml", "sh", "python"]
    shown = re.search(r"^    (ok +circle: .*), bit for bit", PAGE, re.MULTILINE)
    assert shown
    said = ""
    for kind, name, text in BLOCKS:
        if kind == "sh":
            said += "".join(map(run, text.splitlines()))
        elif name:
            (tmp_path / name).write_text(text)
        else:
            exec(compile(text, "golden.md", "exec"), {})
    assert (tmp_path / "golden" / "slow" / "golden.json").is_file()
    assert shown.group(1) in said
