"""Every block of code of `docs/movers.md` works as it stands there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parents[2] / "docs" / "movers.md"
BLOCK = re.compile(
    r"(?:^`(?P<file>[\w.]+)`\n\n)?^```(?P<language>\w+)\n(?P<text>.*?)^```$", flags=re.DOTALL | re.MULTILINE
)
BLOCKS = [(m["file"] or "", m["language"], m["text"]) for m in BLOCK.finditer(PAGE.read_text(encoding="utf-8"))]


def test_every_block_is_a_file_or_python() -> None:
    assert {language for name, language, _ in BLOCKS if not name} == {"python"}
    assert {language for name, language, _ in BLOCKS if name} == {"xml"}
    assert len(BLOCKS) == 7


def test_its_python_runs_from_top_to_bottom(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": "page"}
    for name, _, text in BLOCKS:
        if name:
            (tmp_path / name).write_text(text, encoding="utf-8")
        else:
            exec(compile(text, str(PAGE), "exec"), names)
