"""The fixture `simkit_world`: one line opens a world, its end closes it, a failure says what loading it found."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SLIDE = """<sdf version="1.9"><world name="slide">
  <model name="puck"><pose>0 0 5 0 0 0</pose><link name="body">
    <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
  </link></model>
  <plugin name="p" filename="libnobody_has_this.so"/>
</world></sdf>
"""
FIRST = """
import pytest
import simkit
from simkit import WorldPlugin


class Push(WorldPlugin):
    def load(self, sim, params):
        self.force = params.number("force", 1.0)
        self.link = sim.link("puck::body")

    def before_step(self):
        self.link.apply_wrench((self.force, 0.0, 0.0))


def test_a_file_beside_it(simkit_world):
    sim = simkit_world("slide.sdf", plugins=[Push(force=2)])
    sim.run(0.5)
    # 1 kg is what SDF gives a link without an inertial: x = F t² / 2 m
    assert abs(sim.link("puck::body").pose.position[0] - 0.25) < 1e-3


def test_a_bare_name(simkit_world):
    assert simkit_world("empty").time == 0.0


def test_a_text_and_two_at_once(simkit_world):
    first = simkit_world('<sdf version="1.9"><world name="w"/></sdf>', seed=3)
    second = simkit_world('<sdf version="1.9"><world name="v"/></sdf>')
    first.step()
    assert (first.tick, second.tick, first.seed) == (1, 0, 3)


opened = []


def test_that_fails(simkit_world):
    opened.append(simkit_world("slide.sdf"))
    opened[0].run(0.25)
    assert False


def test_that_the_one_before_is_closed():
    with pytest.raises(simkit.InputError, match="closed"):
        opened[0].step()
"""
SECOND = """
import simkit


def test_that_is_refused(simkit_world):
    simkit_world('<sdf version="1.9"><world name="w"><include><name>n</name></include></world></sdf>')


def test_that_fails_without_a_world():
    assert False


class Faulty(simkit.WorldPlugin):
    def load(self, sim, params):
        pass

    def close(self):
        raise ValueError("cannot let go")


def test_whose_plugin_cannot_be_closed(simkit_world):
    simkit_world("empty", plugins=[Faulty()])
    simkit_world("slide.sdf").step()
"""


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> str:
    """What pytest says of two files of tests, each run in a process of its own."""
    folder = tmp_path_factory.mktemp("tests")
    (folder / "slide.sdf").write_text(SLIDE)
    (folder / "test_first.py").write_text(FIRST)
    (folder / "test_second.py").write_text(SECOND)
    # the plugin is named here, so that the same holds whether or not the package's entry point is installed
    alone = ["-p", "simkit.pytest_plugin", "-p", "xdist", "-p", "no:cacheprovider", "-n", "2", "--dist", "loadfile"]
    environment = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", "PYTHONPATH": str(ROOT), "COLUMNS": "80"}
    command = [sys.executable, "-m", "pytest", *alone, "-rA", "--rootdir", str(folder), "-c", os.devnull, str(folder)]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert not done.stderr, done.stderr
    return done.stdout


MANY = """
import pytest
import simkit

CART = '''<sdf version="1.9"><world name="w"><model name="cart"><link name="l"/>
<joint name="rail" type="prismatic"><parent>world</parent><child>l</child><axis><xyz>1 0 0</xyz></axis></joint>
</model></world></sdf>'''


class Push(simkit.ModelPlugin):
    def load(self, parent, params):
        self.force, self.steps = params.number("force", required=True), 0

    def before_step(self):
        self.steps += 1
        self.sim.joint("cart::rail").set_effort(self.force)


@pytest.mark.parametrize("force", range(200))
def test_push(simkit_world, force):
    push = Push(force=force)
    sim = simkit_world(CART, plugins=[push])
    sim.run(0.1)
    assert push.steps == 100
    # 1 kg is what SDF gives a link without an inertial
    assert abs(sim.joint("cart::rail").velocity - 0.1 * force) < 1e-9
"""


@pytest.mark.slow
def test_two_hundred_worlds_in_parallel_processes_share_no_state(tmp_path: Path) -> None:
    (tmp_path / "test_many.py").write_text(MANY)
    words = ["-p", "simkit.pytest_plugin", "-p", "xdist", "-p", "no:cacheprovider", "-n", "2", "-q", str(tmp_path)]
    environment = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "pytest", "-c", os.devnull, "--rootdir", str(tmp_path), *words]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert "200 passed" in done.stdout, done.stdout[-3000:]


def outcome(report: str, test: str) -> list[str]:
    """What the summary says of a test: one word, or two where its end failed too."""
    return re.findall(rf"^([A-Z]+) \S*::{test}\b", report, re.MULTILINE)


def about(report: str, test: str) -> str:
    """What the report says at length of a test that failed."""
    found = re.search(rf"^_+ (ERROR at teardown of )?{test} _+$(.*?)(?=^_{{10}}|^={{10}})", report, re.MULTILINE | re.S)
    assert found is not None, report
    return found[2]


@pytest.mark.parametrize("test", ["test_a_file_beside_it", "test_a_bare_name", "test_a_text_and_two_at_once"])
def test_a_world_is_a_file_beside_the_test_a_bare_name_or_a_text(report: str, test: str) -> None:
    assert outcome(report, test) == ["PASSED"]


def test_worlds_are_closed_when_their_test_ends_also_where_it_fails(report: str) -> None:
    assert outcome(report, "test_that_fails") == ["FAILED"]
    assert outcome(report, "test_that_the_one_before_is_closed") == ["PASSED"]


def test_the_report_of_a_failure_says_what_loading_found_and_where_the_run_stood(report: str) -> None:
    text = about(report, "test_that_fails")
    assert re.search(r"^-+ simkit slide\.sdf -+$", text, re.MULTILINE)
    assert "stopped at 0.25 s, after 250 steps of 0.001 s" in text
    assert "slide.sdf:5: warning SK-PLUGIN-001: unknown plugin 'libnobody_has_this.so'" in text


def test_a_world_that_cannot_be_opened_is_told_with_everything_that_is_wrong(report: str) -> None:
    assert outcome(report, "test_that_is_refused") == ["FAILED"]
    text = about(report, "test_that_is_refused")
    assert "LoadError" in text and "- simkit <sdf version=" in text and "error SK-PARAM-001:" in text


def test_a_plugin_that_cannot_be_closed_is_an_error_of_its_test_and_the_other_worlds_are_closed(report: str) -> None:
    assert outcome(report, "test_whose_plugin_cannot_be_closed") == ["PASSED", "ERROR"]
    assert "cannot let go" in report


def test_a_test_that_passes_and_one_without_a_world_say_nothing(report: str) -> None:
    assert outcome(report, "test_that_fails_without_a_world") == ["FAILED"]
    text = about(report, "test_that_fails_without_a_world")
    # the first line names the interpreter, whose folder may be called simkit
    assert "simkit" not in re.sub(r"^\[gw\d+\] .*$", "", text, flags=re.MULTILINE)
    worlds = re.findall(r"^-+ simkit (\S+)", report, re.MULTILINE)
    # of the tests that passed nothing; where only the end of a test failed, the worlds it had
    assert sorted(worlds) == ["<sdf", "empty", "slide.sdf", "slide.sdf"]


def test_a_run_of_tests_that_wants_no_world_imports_nothing_heavy() -> None:
    code = "import sys, simkit.pytest_plugin; print(*sorted({'numpy', 'mujoco', 'lxml', 'rosbags'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
