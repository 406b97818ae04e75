"""The samples of `docs/autopilots.md` load without a diagnostic."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pilot_peers import vehicle

import simkit

PAGE = Path(__file__).resolve().parents[1] / "docs" / "autopilots.md"
SAMPLES = re.findall(r"^```xml\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("text", SAMPLES, ids=("ArduPilot", "PX4"))
def test_its_xml_loads_without_a_diagnostic(text: str) -> None:
    with simkit.load(vehicle(text)) as sim:
        assert not list(sim.diagnostics)
