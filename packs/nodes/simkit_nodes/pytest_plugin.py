"""Pytest fixture `simkit_nodes`.

A test runs a program for ROS in lock-step with a world, and fails if the program raises an exception:

    def test_it_stops_at_the_wall(simkit_world, simkit_nodes):
        sim = simkit_world("turtlebot3_world")
        simkit_nodes(sim, "wall_follower.py", remap={"scan": "/scan"})
        sim.run(10.0)
        assert sim.model("turtlebot3").pose.position[0] > -1.5

pytest imports this module at every start, even if no test runs a program. Therefore the module imports nothing heavy.
"""

from __future__ import annotations

import os
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator

    from simkit import Simulation
    from simkit_nodes.programs import NodeProgram

_NODES: Final = pytest.StashKey["list[tuple[NodeProgram, bool]]"]()
_LOG_LINES: Final = 60  # last lines of a node's log in a report


class NodeStarter:
    """Function object of the fixture `simkit_nodes`; adds programs to the worlds of one test.

    Args:
        folder: folder of the test file; programs are searched there first.
        nodes: list that receives every program, with True if the test fails when the program raises.
        stack: closes the worlds at the end of the test, which ends the programs.
    """

    def __init__(self, folder: Path, nodes: list[tuple[NodeProgram, bool]], stack: ExitStack) -> None:
        self._folder, self._nodes, self._stack = folder, nodes, stack

    def __call__(
        self,
        sim: Simulation,
        program: str | os.PathLike[str] | Callable[[], object],
        *,
        strict: bool = True,
        **options: Any,
    ) -> NodeProgram:
        """Add a program that runs in lock-step with a world; it starts with the next step.

        Args:
            sim: world.
            program: Python file (relative to the test's folder or to the working directory), `PACKAGE/EXECUTABLE` of a
                ROS workspace, or function.
            strict: fail the test if the program raises an exception.
            options: options of `Simulation.add_node`: `name`, `namespace`, `remap`, `params`, `args`, `latency`, …

        Raises:
            InputError: the program does not exist.
        """
        if not callable(program) and (self._folder / program).is_file():
            program = self._folder / program
        self._stack.callback(sim.close)
        node = sim.add_node(program, **options)
        self._nodes.append((node, strict))
        return node


@pytest.fixture
def simkit_nodes(request: pytest.FixtureRequest) -> Iterator[NodeStarter]:
    """Run programs for ROS in lock-step with a world, `simkit_nodes(sim, "talker.py", remap={"chatter": "/chat"})`.

    The fixture returns the node, with `log`, `error` and `done`. A test fails if a program raised an exception, unless
    `strict=False`. The report of a failed test has the logs of all programs.
    """
    nodes: list[tuple[NodeProgram, bool]] = request.node.stash.setdefault(_NODES, [])
    with ExitStack() as stack:
        yield NodeStarter(request.path.parent, nodes, stack)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, None, None]:
    """Fail a test after its end if one of its programs raised an exception."""
    yield
    failures = [node.failure for node, is_strict in item.stash.get(_NODES, ()) if is_strict and node.error is not None]
    if failures:
        pytest.fail("\n".join(f"node {failure}" for failure in failures), pytrace=False)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Add the logs of the programs to the report of a failure."""
    report = yield
    if report.failed and report.when == "call":
        for node, _ in item.stash.get(_NODES, ()):
            if node.log:
                report.sections.append((f"simkit node {node.name}", "\n".join(node.log[-_LOG_LINES:])))
    return report
