"""Programs of tests: their text is written to a file and run in lock-step with an empty world."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest

import simkit
from simkit import Simulation
from simkit_nodes.programs import NodeProgram

WORLD = """<sdf version="1.9"><world name="w"><physics type="ode"><max_step_size>0.001</max_step_size></physics>
<model name="box"><static>true</static><link name="l"/></model></world></sdf>"""


@pytest.fixture
def sim() -> Iterator[Simulation]:
    """Simulation of an empty world with steps of 1 ms."""
    simulation = simkit.load(WORLD, seed=1)
    yield simulation
    simulation.close()


@pytest.fixture
def add_program(sim: Simulation, tmp_path: Path) -> Callable[..., NodeProgram]:
    """Function that adds a program from its text, with further files beside it."""

    def add(
        source: str, file: str = "program.py", files: Mapping[str, str] | None = None, **options: Any
    ) -> NodeProgram:
        for name, text in {**(files or {}), file: source}.items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(dedent(text))
        return sim.add_node(tmp_path / file, **options)

    return add


@pytest.fixture
def run_program(sim: Simulation, add_program: Callable[..., NodeProgram]) -> Callable[..., list[str]]:
    """Function that runs a program for a duration [s], and returns its log without an exception."""

    def run(source: str, duration: float = 1.0, **options: Any) -> list[str]:
        node = add_program(source, **options)
        sim.run(duration)
        assert node.error is None, "\n".join(node.log)
        return node.log

    return run


@pytest.fixture
def reports(sim: Simulation) -> Callable[[str], list[str]]:
    """Function that returns the diagnostics of a code as texts."""
    return lambda code: [str(each) for each in sim.diagnostics if each.code == code]
