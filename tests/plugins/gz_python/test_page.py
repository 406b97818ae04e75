"""The page on Gazebo's Python: its files and its script run, and what it names is there."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import simkit
from simkit.plugins import gz_python

PAGE = Path(__file__).resolve().parents[3] / "docs" / "gazebo_python.md"
TEXT = PAGE.read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "pusher.py").write_text(blocks("python")[0], encoding="utf-8")
    (tmp_path / "lift.sdf").write_text(blocks("xml")[0], encoding="utf-8")
    return tmp_path


def test_the_system_lifts_the_crate(folder: Path) -> None:
    with simkit.load(folder / "lift.sdf", plugin_paths=[folder]) as sim:
        assert [d for d in sim.diagnostics if d.severity != "note"] == []
        sim.run(1.0)
        assert sim.link("crate::box").linear_velocity[2] == pytest.approx(20 / 2 - 9.8, rel=1e-6)


def test_the_script_prints_time_and_gravity(folder: Path) -> None:
    (folder / "script.py").write_text(blocks("python")[1], encoding="utf-8")
    done = subprocess.run([sys.executable, "script.py"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.stdout.splitlines() == [f"0:00:00.00{n}000 0 0 -9.8" for n in (1, 2, 3)]


def test_every_name_of_the_table_can_be_imported() -> None:
    rows = re.findall(r"^\| `(gz\.\w+|sdformat)` \| (.*) \|$", TEXT, re.MULTILINE)
    assert len(rows) == 6
    with gz_python.importable():
        for module, names in rows:
            found = __import__(module, fromlist=["_"])
            for name in re.findall(r"`(\w+)`", names):
                held = found if hasattr(found, name) else getattr(found, "Node")  # noqa: B009
                assert getattr(held, name) is not None, f"{module}.{name}"
