"""The pages of the course: every command runs, every lab is listed, and both languages say the same."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit.cli import app

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "docs" / name for name in ("course.md", "cours.md")]
LABS = sorted(path.parent.name for path in (ROOT / "labs").glob("*/exercise.yaml"))


def commands(page: Path) -> list[str]:
    blocks = re.findall(r"```sh\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
    return [line for block in blocks for line in block.splitlines() if line.startswith("simkit ")]


@pytest.mark.labs
def test_each_command_of_the_page_runs_as_it_stands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for line in commands(PAGES[0]):
        found = CliRunner().invoke(app, shlex.split(line)[1:])
        assert found.exit_code == 0, f"{line}: {found.output}"
    assert (tmp_path / "drive.png").stat().st_size > 10_000
    assert {path.name for path in tmp_path.iterdir()} >= {"house.pgm", "house.yaml", "bench.mcap"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_page_lists_every_lab(page: Path) -> None:
    text = page.read_text("utf-8")
    assert sorted(set(re.findall(r"`(\d\d_\w+)`", text))) == LABS
    assert {line.split()[3] for line in commands(page) if line.startswith("simkit lab start")} < set(LABS)


def test_both_pages_have_the_same_commands_pages_and_words() -> None:
    texts = [page.read_text("utf-8") for page in PAGES]
    assert commands(PAGES[0]) == commands(PAGES[1])
    links = [sorted(set(re.findall(r"\]\(([\w/]+\.md)\)", text)) - {"course.md", "cours.md"}) for text in texts]
    assert links[0] == links[1]
    tables = [text.split("\n## ")[-1].splitlines() for text in texts]
    english, french = ([tuple(row.split(" | ")[:2]) for row in rows if row.startswith("| ")][1:] for rows in tables)
    assert {(a.removeprefix("| "), b) for a, b in english} == {(b, a.removeprefix("| ")) for a, b in french}


def test_both_pages_have_the_same_sections_with_the_same_rows() -> None:
    sections = [
        [
            [row.split(" | ")[0] for row in part.splitlines() if row.startswith("| ")]
            for part in text.split("\n## ")[1:-1]
        ]
        for text in (page.read_text("utf-8") for page in PAGES)
    ]
    english, french = ([rows[1:] for rows in page] for page in sections)  # without the headers
    assert english == french
