"""Programs whose output on ROS 2 Jazzy is recorded: the same output in lock-step, and on a real rclpy.

Each program in `recorded_behaviours` prints a JSON object. The file beside it has the output of Jazzy's rclpy with
ROS_PYTHON_CHECK_FIELDS=1.
"""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import pytest

import simkit

PROGRAMS = sorted((Path(__file__).parent / "recorded_behaviours").glob("*.py"))
EMPTY = '<sdf version="1.9"><world name="w"/></sdf>'
DOMAIN = 101 + os.getpid() % 100


def recorded(program: Path) -> Any:
    """Return the output of the program on ROS 2."""
    return json.loads(program.with_suffix(".json").read_text())


def printed(text: str) -> Any:
    """Return the JSON object in an output."""
    return json.loads(text[text.index("{") : text.rindex("}") + 1])


@pytest.mark.slow
@pytest.mark.parametrize("program", PROGRAMS, ids=lambda path: path.stem)
def test_a_program_prints_the_same_as_on_ros(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with simkit.load(EMPTY) as sim:
        node = sim.add_node(program)
        assert sim.run_until(lambda _: node.done, 60.0)
        assert node.error is None
    assert printed(capsys.readouterr().out) == recorded(program)


@pytest.mark.ros
@pytest.mark.parametrize("program", PROGRAMS, ids=lambda path: path.stem)
def test_the_recorded_output_is_that_of_rclpy(program: Path, jazzy_python: Path) -> None:
    environment = os.environ | {"ROS_PYTHON_CHECK_FIELDS": "1", "ROS_DOMAIN_ID": str(DOMAIN)}
    command = [str(jazzy_python), str(program)]
    result = subprocess.run(command, env=environment, check=True, capture_output=True, text=True, timeout=120)
    assert printed(result.stdout) == recorded(program)
