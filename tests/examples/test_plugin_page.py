"""The files and commands of `docs/writing_a_plugin.md` work together as the page shows them."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit.cli import app
from simkit.diagnostics import Diagnostics
from simkit.loaders.resources.xml_reader import parse_text

PAGE = Path(__file__).resolve().parents[2] / "docs" / "writing_a_plugin.md"
BLOCK = re.compile(
    r"(?:^`(?P<file>[\w.]+)`\n\n)?^```(?P<language>\w+)\n(?P<text>.*?)^```$", flags=re.DOTALL | re.MULTILINE
)
BLOCKS = [(m["file"] or "", m["language"], m["text"]) for m in BLOCK.finditer(PAGE.read_text(encoding="utf-8"))]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the files of the page, in which it is worked."""
    for name, _, text in BLOCKS:
        if name:
            (tmp_path / name).write_text(text, encoding="utf-8")
            monkeypatch.delitem(sys.modules, Path(name).stem, raising=False)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    return tmp_path


def test_every_block_is_of_a_language_that_is_tried_here() -> None:
    assert {language for _, language, _ in BLOCKS} == {"python", "xml", "sh", "toml"}
    assert len(BLOCKS) > 6


def test_its_commands_run(folder: Path) -> None:
    for _, language, text in BLOCKS:
        for line in text.splitlines() if language == "sh" else ():
            done = CliRunner().invoke(app, shlex.split(line)[1:])
            assert done.exit_code == 0, done.output
            assert "/blinker" in done.output
    assert (folder / "blinks.mcap").stat().st_size > 0


def test_its_xml_and_toml_can_be_read() -> None:
    for _, language, text in BLOCKS:
        if language == "toml":
            assert tomllib.loads(text)
        if language == "xml":
            found = Diagnostics()
            assert parse_text(f"<page>{text}</page>", found) is not None and not len(found)


def test_the_test_of_the_page_passes(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")  # as if pytest were alone with simkit's own plugin
    monkeypatch.setenv("PYTHONPATH", str(PAGE.parents[1]))
    words = [sys.executable, "-m", "pytest", "-q", "-p", "simkit.pytest_plugin", "-p", "no:cacheprovider"]
    (text,) = [text for _, _, text in BLOCKS if "def test_" in text]
    (folder / "test_brake.py").write_text(text, encoding="utf-8")
    done = subprocess.run([*words, "test_brake.py"], cwd=folder, capture_output=True, text=True, check=False)
    assert "1 passed" in done.stdout, done.stdout
