"""Every block of code of `docs/air_and_water.md` works as it stands there."""

from __future__ import annotations

import re
from pathlib import Path

import simkit

PAGE = Path(__file__).resolve().parents[2] / "docs" / "air_and_water.md"
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)


def test_its_python_runs_from_top_to_bottom() -> None:
    names: dict[str, object] = {"__name__": "page"}
    texts = [text for language, text in BLOCKS if language == "python"]
    assert len(texts) == 3
    for text in texts:
        exec(compile(text, str(PAGE), "exec"), names)


def test_its_xml_loads_without_a_word() -> None:
    texts = [text for language, text in BLOCKS if language == "xml"]
    assert {language for language, _ in BLOCKS} == {"python", "xml"}
    for text in texts:
        sim = simkit.load(f'<sdf version="1.9"><world name="w">{text}</world></sdf>')
        assert not list(sim.diagnostics)
        sim.step(10)
