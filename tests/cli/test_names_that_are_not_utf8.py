"""Files and folders whose names are not valid UTF-8: a result, or one line with a code."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="names of Linux are bytes"),
]
WORLD = """<sdf version="1.9"><world name="w"><model name="ground"><static>true</static><link name="l">
<collision name="c"><geometry><plane/></geometry></collision>
<collision name="d"><geometry><box><size>1 1 1</size></box></geometry></collision></link></model>
<model name="b"><pose>0 0 1 0 0 0</pose><link name="l"><sensor name="imu" type="imu"><topic>imu</topic>
<update_rate>50</update_rate></sensor></link></model></world></sdf>"""
NAME = os.fsdecode(b"\xff")
CODE = "SK-CLI-057"
COMMANDS: dict[str, tuple[int, str]] = {
    f"check w{NAME}.sdf": (0, ""),
    f"check none{NAME}.sdf": (2, "SK-LOAD-002"),
    f"inspect w{NAME}.sdf --json": (0, ""),
    f"run w{NAME}.sdf --duration 0.1 --record o{NAME}.mcap --junit o{NAME}.xml": (0, ""),
    f"vendor w{NAME}.sdf o{NAME}": (0, ""),
    f"convert w{NAME}.sdf -o o{NAME}.sdf": (0, ""),
    f"convert w{NAME}.sdf -o o{NAME}.xml": (2, "SK-CLI-016"),
    f"bundle w{NAME}.sdf --duration 0.05 -o o{NAME}.zip": (2, CODE),
    f"golden record w{NAME}.sdf --duration 0.05 -o o{NAME}": (2, CODE),
    f"certify w{NAME}.sdf --duration 0.02 --runs 2 -o o{NAME}.json": (0, ""),
    f"map w{NAME}.sdf -o o{NAME}": (2, CODE),
    f"graph w{NAME}.sdf -o o{NAME}.svg": (0, ""),
    f"interface show a/{NAME}": (2, "SK-CLI-032"),
}


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: str(command).encode("ascii", "replace").decode())
def test_a_command_ends_with_a_result_or_a_code(command: str, tmp_path: Path) -> None:
    (folder := tmp_path / f"d{NAME}").mkdir()
    (folder / f"w{NAME}.sdf").write_text(WORLD)
    (folder / "w.sdf").write_text(WORLD)
    before = {path.name for path in folder.iterdir()}
    arguments = [sys.executable, "-m", "simkit", *command.split(" ")]
    done = subprocess.run(arguments, cwd=folder, capture_output=True, timeout=120, check=False)
    said = (done.stdout + done.stderr).decode()  # the output itself is valid UTF-8
    code, text = COMMANDS[command]
    assert done.returncode == code and text in said and "Traceback" not in said, said[-800:]
    if code:
        assert {path.name for path in folder.iterdir()} == before
