"""The course's page about launch files is executed; its four launch files start the same run."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

import simkit
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing import open_scenario, run_scenario
from tests.cli.course_page import Desk, blocks

PAGE = Path(__file__).resolve().parents[1] / "docs" / "course_launch.md"
TEXT = PAGE.read_text(encoding="utf-8")
LAUNCH_FILES = [block for block in blocks(TEXT) if "LaunchDescription" in block.text or "launch" in block.text[:10]]


@pytest.fixture
def sockets() -> Iterator[Path]:
    """A short folder for sockets that nobody else uses."""
    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp") as folder:
        yield Path(folder)


@pytest.mark.slow
def test_the_terminals_of_the_page_show_what_it_says(sockets: Path, tmp_path: Path) -> None:
    with ExitStack() as stack:
        desk = Desk(tmp_path, stack, {"TMPDIR": str(sockets)})
        desk.play(TEXT)
        desk.finish()


@pytest.mark.slow
def test_the_four_launch_files_start_the_same_run(tmp_path: Path) -> None:
    assert [Path(block.title).suffix for block in LAUNCH_FILES] == [".py", ".xml", ".yaml", ".launch"]
    states = set()
    for block in LAUNCH_FILES:
        file = tmp_path / block.title
        file.write_text(block.text, encoding="utf-8")
        spec = simkit.launch(file).with_values({"duration": 0.5})
        with open_scenario(spec) as sim:
            sim.run(0.1)
            sim.publish("/turtlesim1/turtle1/cmd_vel", {"linear": {"x": 2.0}})
            run_scenario(spec, sim)
            states.add(state_hash(sim))
    assert len(states) == 1
