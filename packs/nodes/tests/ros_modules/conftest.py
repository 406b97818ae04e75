"""Programs of ROS 2 whose text is written to a file and run in lock-step, for tests of libraries."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest

import simkit


@pytest.fixture
def sim() -> Iterator[simkit.Simulation]:
    """Empty world with steps of 1 ms."""
    with simkit.load("empty") as loaded:
        yield loaded


@pytest.fixture
def run_program(sim: simkit.Simulation, tmp_path: Path) -> Callable[..., list[str]]:
    """Function that runs a program for a duration [s], and returns the texts that its nodes have logged."""

    def run(text: str, duration: float = 1.0, **options: Any) -> list[str]:
        file = tmp_path / "program.py"
        file.write_text(dedent(text))
        node = sim.add_node(file, **options)
        sim.run(duration)
        assert node.error is None, "\n".join(node.log)
        return [line.split("]: ", 1)[1] for line in node.log if "]: " in line]

    return run
