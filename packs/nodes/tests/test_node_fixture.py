"""The fixture `simkit_nodes`: a test fails with the line at which a program raised, and reports the program's log."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
import sys
import time

print("words", *sys.argv[1:])
time.sleep(0.25)
print("awake at", round(time.time(), 6))
if "fail" in sys.argv:
    raise ValueError("as told")
"""
TESTS = """
WORLD = '<sdf version="1.9"><world name="w"/></sdf>'


def test_a_program(simkit_world, simkit_nodes):
    sim = simkit_world(WORLD)
    node = simkit_nodes(sim, "program.py", args=["one"])
    sim.run(1.0)
    assert node.done and node.error is None
    assert node.log[:1] == ["words one"] or node.log == []


def test_a_function(simkit_world, simkit_nodes):
    def wait():
        import time

        time.sleep(0.5)

    sim = simkit_world(WORLD)
    node = simkit_nodes(sim, wait)
    sim.run(0.25)
    assert not node.done
    sim.run(0.5)
    assert node.done


def test_that_fails_with_its_program(simkit_world, simkit_nodes):
    sim = simkit_world(WORLD)
    simkit_nodes(sim, "program.py", args=["fail"])
    sim.run(1.0)


def test_that_expects_the_failure(simkit_world, simkit_nodes):
    sim = simkit_world(WORLD)
    node = simkit_nodes(sim, "program.py", args=["fail"], strict=False)
    sim.run(1.0)
    assert isinstance(node.error, ValueError)


def test_that_fails_by_itself(simkit_world, simkit_nodes):
    sim = simkit_world(WORLD)
    simkit_nodes(sim, "program.py", args=["fail"])
    sim.run(1.0)
    assert sim.time == 2.0
"""


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Output of pytest for the tests above, in a process of its own."""
    folder = tmp_path_factory.mktemp("tests")
    (folder / "program.py").write_text(PROGRAM)
    (folder / "test_nodes.py").write_text(TESTS)
    alone = ["-p", "simkit.pytest_plugin", "-p", "simkit_nodes.pytest_plugin", "-p", "no:cacheprovider"]
    environment = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", "COLUMNS": "100"}
    command = [sys.executable, "-m", "pytest", *alone, "-rA", "--rootdir", str(folder), "-c", os.devnull, str(folder)]
    done = subprocess.run(command, cwd=Path(__file__).parent, env=environment, capture_output=True, text=True)
    assert not done.stderr, done.stderr
    return done.stdout


def outcome(report: str, test: str) -> list[str]:
    return re.findall(rf"^([A-Z]+) \S*::{test}\b", report, re.MULTILINE)


def failure(report: str, test: str) -> str:
    """Text of pytest about a test that failed."""
    text = re.search(rf"^_+ {test} _+$(.*?)(?=^_{{10}}|^={{10}})", report, re.MULTILINE | re.DOTALL)
    assert text is not None, report
    return text[1]


@pytest.mark.parametrize("test", ["test_a_program", "test_a_function", "test_that_expects_the_failure"])
def test_programs_beside_the_test_and_functions_run_in_simulated_time(report: str, test: str) -> None:
    assert outcome(report, test) == ["PASSED"], report


def test_a_test_fails_with_the_line_at_which_its_program_raised(report: str) -> None:
    assert outcome(report, "test_that_fails_with_its_program") == ["FAILED"]
    text = failure(report, "test_that_fails_with_its_program")
    assert re.search(r"node 'program' raised ValueError at \S*program\.py:9: as told", text)
    assert re.search(r"^-+ simkit node program -+$.*ValueError: as told", text, re.MULTILINE | re.DOTALL)


def test_the_report_of_any_failure_has_the_log_of_the_program(report: str) -> None:
    assert outcome(report, "test_that_fails_by_itself") == ["FAILED"]
    assert "simkit node program" in failure(report, "test_that_fails_by_itself")
