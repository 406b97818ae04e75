"""Scenario files and exercises."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import BALL, command, python

_READ = """
from simkit.scenario.read import read_scenario

read_scenario("drop.yaml")
"""
_FALL = 'world: ball.sdf\ngoals: ["time > 0.1"]\nexercise: {title: Fall}\n'
_PYTHON = _READ.replace("yaml", "py")


def _scenario(text: str) -> dict[str, str | bytes]:
    return {"ball.sdf": BALL, "drop.yaml": text}


CODES: tuple[Code, ...] = (
    Code(
        "SK-SCEN-001",
        "error",
        "a scenario file cannot be read, or is no YAML",
        "the line that is given; texts with `:`, `#` or quotes in them need quotes",
        python(_READ, _scenario("world: [ball.sdf\nduration: 2\n")),
    ),
    Code(
        "SK-SCEN-002",
        "error",
        "a scenario says something that no scenario has",
        "the closest name is given; `docs/scenarios.md` lists them",
        python(_READ, _scenario("world: ball.sdf\nduraton: 2\n")),
    ),
    Code(
        "SK-SCEN-003",
        "error",
        "a value of a scenario is not of those that are allowed, or is given twice",
        "what is allowed is given",
        python(_READ, _scenario("world: ball.sdf\nduration: long\n")),
    ),
    Code(
        "SK-SCEN-004",
        "error",
        "a scenario, or an entry of it, lacks what it cannot do without",
        "what is needed is given",
        python(_READ, _scenario("duration: 2\n")),
    ),
    Code(
        "SK-SCEN-005",
        "error",
        "a Python file that is to be a scenario fails, or has no `scenario`",
        "`scenario = Scenario(world=..., duration=...)`, with `from simkit.scenario import Scenario`",
        python(_PYTHON, {"drop.py": "scenario = 3\n"}),
    ),
    Code(
        "SK-SCEN-006",
        "error",
        "an exercise asks for nothing",
        "`goals`, `limits`, `no_contact`, `rates` or `until`",
        command("simkit grade drop.yaml", _scenario("world: ball.sdf\nexercise: {title: Fall}\n")),
    ),
    Code(
        "SK-SCEN-007",
        "error",
        "a plugin that is to be graded is not there",
        "`simkit grade EXERCISE.yaml PLUGIN.py`",
        command("simkit grade drop.yaml mine.py", _scenario(_FALL)),
    ),
)
