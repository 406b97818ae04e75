"""The page on Gazebo's Python: its system lifts the crate, and the names of its table can be imported."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import simkit_gz_python as gz_python

PAGE = Path(__file__).resolve().parents[1] / "docs" / "gazebo_python.md"
TEXT = PAGE.read_text(encoding="utf-8")
PROGRAMS = re.findall(r"^```python\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)


def printed(program: str, folder: Path) -> list[str]:
    """Return the lines that a program of the page prints in an empty folder."""
    (folder / "script.py").write_text(program, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(PAGE.parents[1])}
    command = [sys.executable, "script.py"]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_the_system_lifts_the_crate(tmp_path: Path) -> None:
    assert printed(PROGRAMS[0], tmp_path) == ["0.20 m/s"]  # 20 N / 2 kg - 9.8 m/s² for one second


def test_the_script_prints_time_and_gravity(tmp_path: Path) -> None:
    assert printed(PROGRAMS[1], tmp_path) == [f"0:00:00.00{n}000 0 0 -9.8" for n in (1, 2, 3)]


def test_every_name_of_the_table_can_be_imported() -> None:
    rows = re.findall(r"^\| `(gz\.\w+|sdformat)` \| (.*) \|$", TEXT, re.MULTILINE)
    assert len(rows) == 6
    with gz_python.importable():
        for module, names in rows:
            found = __import__(module, fromlist=["_"])
            for name in re.findall(r"`(\w+)`", names):
                held = found if hasattr(found, name) else getattr(found, "Node")  # noqa: B009
                assert getattr(held, name) is not None, f"{module}.{name}"
