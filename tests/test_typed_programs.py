"""Types that mypy finds in users' programs: topics by message class, and sensors by their class."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = """
import simkit
from simkit import msgs
from simkit.sensors import Camera, Imu, Lidar


def switch(request: msgs.SetBool_Request) -> msgs.Message:
    reveal_type(request.data)
    return {"success": request.data}


class Echo(simkit.WorldPlugin):
    def load(self, parent: simkit.Simulation, params: simkit.Params) -> None:
        reveal_type(self.subscribe("/scan", type=msgs.LaserScan))
        reveal_type(self.advertise("/echo", msgs.String))
        self.listen("/cmd_vel", msgs.Twist, lambda message: message.linear.x)


with simkit.load("world") as sim:
    reveal_type(sim.subscribe("/scan"))
    scans = sim.subscribe("/scan", type=msgs.LaserScan, callback=lambda scan: print(scan.ranges))
    reveal_type(scans.latest)
    reveal_type(scans.messages)
    reveal_type(sim.advertise("/chatter", msgs.String))
    reveal_type(sim.sensor("lds"))
    reveal_type(sim.sensor("lds", type=Lidar).latest)
    reveal_type(sim.sensor("imu", type=Imu).truth)
    reveal_type(sim.sensor("camera", type=Camera).latest)
    sim.offer("/lamp", msgs.SetBool_Request, switch)
    sim.act("/count", msgs.Fibonacci_Goal, lambda goal: print(goal.request.order))
    print(scans.latest.ranges.min(), sim.run_until("pose('bot').x > 0.5", timeout=5.0))
"""
REVEALED = [
    "bool",
    "Subscription[LaserScan]",
    "Publisher[String]",
    "Subscription[Any]",
    "LaserScan | Any",
    "list[LaserScan]",
    "Publisher[String]",
    "Any",
    "LaserScan | Any",
    "Imu | Any",
    "Image | Any",
]
MISTAKES = {
    "scans.latest.rangs": 'has no attribute "rangs"',
    "sim.advertise('/chatter', msgs.String).publish(msgs.Bool(True))": "incompatible type",
    "sim.subscribe('/scan', lambda scan: scan.rangs, type=msgs.LaserScan)": 'has no attribute "rangs"',
    "sim.act('/count', msgs.Fibonacci_Goal, lambda goal: print(goal.request.ordr))": 'has no attribute "ordr"',
    "sim.offer('/lamp', msgs.Trigger_Request, switch)": "incompatible type|No overload",
}


def type_check(folder: Path, text: str) -> list[str]:
    """Return the lines that mypy prints for a user's program."""
    (folder / "program.py").write_text(text, encoding="utf-8")
    options = ["--strict", "--follow-imports=silent", "--no-pretty", "--cache-dir", "cache"]
    command = [sys.executable, "-m", "mypy", *options, "program.py"]
    environment = {**os.environ, "MYPYPATH": str(ROOT)}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    return done.stdout.splitlines()


def short(line: str) -> str:
    """Return a revealed type without the modules of its names."""
    text = line.split("Revealed type is ")[1].strip('"').replace("builtins.", "")
    if text.startswith("Union["):
        text = " | ".join(text.removeprefix("Union[").removesuffix("]").split(", "))
    words = text.replace("[", "[ ").replace("]", " ]").split(" ")
    return "".join(word if word == "|" else word.rpartition(".")[2] for word in words).replace("|", " | ").rstrip("?")


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="needs mypy")
def test_mypy_knows_the_messages_of_topics_and_sensors_that_are_named_by_class(tmp_path: Path) -> None:
    lines = type_check(tmp_path, PROGRAM)
    assert lines[-1].startswith("Success"), "\n".join(lines)
    assert [short(line) for line in lines if "Revealed" in line] == REVEALED


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="needs mypy")
def test_mypy_finds_a_misspelled_field_and_a_message_of_another_class(tmp_path: Path) -> None:
    lines = type_check(tmp_path, PROGRAM + "".join(f"    {mistake}\n" for mistake in MISTAKES))
    errors = [line for line in lines if "error:" in line]
    assert len(errors) == len(MISTAKES), "\n".join(lines)
    for line, texts in zip(errors, MISTAKES.values(), strict=True):
        assert any(text in line for text in texts.split("|")), line
