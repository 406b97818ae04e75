"""Programs of ROS 1 in an empty world, for the tests."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest

import simkit

Add = Callable[..., Any]


@pytest.fixture
def sim() -> Iterator[simkit.Simulation]:
    """Empty world with steps of 1 ms."""
    with simkit.load("empty") as loaded:
        yield loaded


@pytest.fixture
def add(sim: simkit.Simulation, tmp_path: Path) -> Add:
    """Function that adds a program with a text; further arguments are those of `add_node`."""

    def add_program(text: str, file_name: str = "program", **options: Any) -> Any:
        file = tmp_path / f"{file_name}.py"
        file.write_text(dedent(text))
        return sim.add_node(file, **options)

    return add_program


@pytest.fixture
def texts() -> Callable[[Any], list[str]]:
    """Function that returns the texts of the lines that a node has logged, without level, time and name."""
    return lambda node: [line.split("]: ", 1)[1] if "]: " in line else line for line in node.log]
