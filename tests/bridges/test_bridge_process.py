"""Process of a bridge: the module that it runs, and its notes, with which a client cannot fill the terminal."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from simkit.bridges.bridge_process import BridgeCodes, BridgeProcess


def test_a_flood_of_notes_is_cut_and_counted() -> None:
    lines: list[str] = []
    bridge = BridgeProcess("bridge", BridgeCodes("SK-ROS-002", "SK-ROS-004", "SK-ROS-005"), "none", {}, lines.append)
    for number in range(1000):
        bridge._take_line(json.dumps({"note": f"/add failed: {number}"}))
    bridge._report_last_notes()
    assert lines[0] == "note SK-ROS-005: /add failed: 0"
    assert lines[-1] == "note SK-ROS-005: 980 more notes not shown"
    assert len(lines) == 21


PROGRAM = """
import sys
from simkit.bridges.bridge_program import tell
from simkit_fleet.words import GREETING

def main(options):
    tell(ready=GREETING + options["name"])
    sys.stdin.read()  # until the test has read the line
    return 0
"""


class Greeting(BridgeProcess):
    def _ready_text(self, found: Any) -> str:
        return str(found)


def test_a_program_of_a_pack_runs_in_a_python_that_has_no_such_pack(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "simkit_fleet"
    folder.mkdir()
    for name, text in {"__init__": "", "words": "GREETING = 'hello '", "program": PROGRAM}.items():
        (folder / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(str(tmp_path))
    lines: list[str] = []
    codes = BridgeCodes("SK-ROS-002", "SK-ROS-004", "SK-ROS-005")
    with Greeting("bridge", codes, "simkit_fleet.program", {"name": "lab"}, lines.append) as bridge:
        bridge.start(tmp_path / "socket")
        bridge.wait(lambda: True)
    assert lines == ["hello lab"]
