"""The XML samples of `docs/air.md` and `docs/water.md` load without a diagnostic."""

from __future__ import annotations

import re
from pathlib import Path

import simkit

FOLDER = Path(__file__).resolve().parents[1] / "docs"
TEXT = "\n".join((FOLDER / name).read_text(encoding="utf-8") for name in ("air.md", "water.md"))
SAMPLES = re.findall(r"^```xml\n(.*?)^```$", TEXT, flags=re.DOTALL | re.MULTILINE)


def test_its_xml_loads_without_a_diagnostic() -> None:
    assert SAMPLES
    for text in SAMPLES:
        sim = simkit.load(f'<sdf version="1.9"><world name="w">{text}</world></sdf>')
        assert not list(sim.diagnostics)
        sim.step(10)
