"""The fixture `sensor_regression`: golden runs of tests, also written by several workers."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.errors import InputError
from simkit.run_spec import RunSpec, Tolerance
from simkit.runtime import Simulation
from simkit.testing.golden.pytest_fixture import GoldenLocation, SensorRegression, safe_name
from simkit.testing.golden.store import read_golden

ROOT = Path(__file__).parents[3]
PUCK = """<sdf version="1.9"><world name="slide">
  <model name="puck"><pose>0 0 5 0 0 0</pose><link name="body">
    <inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
    <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
    <sensor name="imu" type="imu"><update_rate>100</update_rate><topic>imu</topic></sensor>
  </link></model>
</world></sdf>
"""
TESTS = """
import pytest
from simkit import WorldPlugin
from simkit import RunSpec


class Push(WorldPlugin):
    def __init__(self, force):
        self.force = force

    def load(self, sim, params):
        self.link = sim.link("puck::body")

    def before_step(self):
        self.link.apply_wrench((self.force, 0.0, 0.0))


def test_a_world(sensor_regression):
    verdict = sensor_regression("puck.sdf", duration=0.1)
    assert verdict.comparison.messages


@pytest.mark.parametrize("force", [0.5 * number for number in range(12)])
def test_a_plugin(sensor_regression, force):
    sensor_regression("puck.sdf", duration=0.05, plugins=[Push(force)], tolerances={"/imu": 0.01})


class TestInAClass:
    def test_a_world(self, sensor_regression):
        sensor_regression(RunSpec("puck.sdf", duration=0.05, seed=3))

    def test_two(self, sensor_regression):
        sensor_regression("puck.sdf", duration=0.05)
        sensor_regression("puck.sdf", duration=0.05, seed=2, name="other seed")


def test_an_open_simulation(sensor_regression, simkit_world):
    sim = simkit_world("puck.sdf", plugins=[Push(2)])
    sim.run(0.05)
    sensor_regression(sim, duration=0.05, topics="imu")


def test_stepping_oneself(sensor_regression, simkit_world):
    sim = simkit_world("puck.sdf")
    with sensor_regression.of(sim):
        sim.run(0.05)
        sim.step(3)


def test_without_a_golden_run_that_fails_by_itself(sensor_regression):
    assert 1 == 2
"""
FOLDERS = [
    "TestInAClass.test_a_world", "TestInAClass.test_two", "TestInAClass.test_two+other-seed-",
    *(f"test_a_plugin-{0.5 * number}" for number in range(12)),
    "test_a_world", "test_an_open_simulation", "test_stepping_oneself",
]  # fmt: skip


def run(folder: Path, *arguments: str) -> str:
    """Run pytest in a folder and return the result."""
    alone = ["-p", "simkit.pytest_plugin", "-p", "no:cacheprovider", "-q", "--rootdir", str(folder), "-c", os.devnull]
    environment = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", "PYTHONPATH": str(ROOT), "COLUMNS": "160"}
    command = [sys.executable, "-m", "pytest", *alone, *arguments]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert not done.stderr, done.stderr
    return done.stdout


WRITE = ("--simkit-update-golden", "--simkit-golden-reason", "a new puck")


def with_tests(folder: Path) -> Path:
    (folder / "puck.sdf").write_text(PUCK)
    (folder / "test_puck.py").write_text(TESTS)
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Create a folder with tests and their golden runs."""
    folder = with_tests(tmp_path_factory.mktemp("tests"))
    said = run(folder, *WRITE)
    assert "1 failed, 17 passed" in said, said
    assert said.count("written: golden/test_puck/") == len(FOLDERS)
    return folder


def golden(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted((folder / "golden").rglob("*")) if p.is_file()}


def test_each_test_has_a_folder_of_its_own(folder: Path) -> None:
    found = sorted(re.sub(r"[0-9a-f]{8}$", "", p.name) for p in (folder / "golden" / "test_puck").iterdir())
    assert found == sorted(FOLDERS)
    said = json.loads((folder / "golden/test_puck/test_a_world/golden.json").read_text())
    assert [entry["reason"] for entry in said["history"]] == ["a new puck"]
    assert said["scenario"]["world"] == "../../../puck.sdf"


def test_a_run_that_only_a_test_can_repeat_names_the_test(folder: Path) -> None:
    goldens = folder / "golden" / "test_puck"
    assert read_golden(goldens / "test_stepping_oneself").scenario.test == "test_puck.py::test_stepping_oneself"
    assert read_golden(goldens / "test_a_plugin-0.5").scenario.test == "test_puck.py::test_a_plugin[0.5]"
    assert read_golden(goldens / "test_a_world").scenario.test == ""


@pytest.mark.slow
def test_a_repeated_run_passes_and_a_second_update_changes_no_byte(folder: Path) -> None:
    before = golden(folder)
    said = run(folder, "--simkit-update-golden", "-k", "not by_itself")
    assert "17 passed" in said, said
    assert said.count("unchanged: golden/") == len(FOLDERS)
    assert golden(folder) == before
    said = run(folder, "-k", "world or oneself")
    assert "3 passed" in said, said
    assert "golden" not in said


@pytest.mark.slow
def test_eight_workers_write_the_same_golden_runs(folder: Path, tmp_path: Path) -> None:
    said = run(with_tests(tmp_path), "-p", "xdist", "-n", "8", *WRITE)
    assert "1 failed, 17 passed" in said, said
    assert said.count("written: golden/test_puck/") == len(FOLDERS)
    assert golden(tmp_path) == golden(folder)


@pytest.mark.slow
def test_a_failure_shows_what_differs_and_why_and_writes_a_page(folder: Path) -> None:
    before = golden(folder)
    (folder / "puck.sdf").write_text(PUCK.replace("<mass>1<", "<mass>1.25<"))
    try:
        said = run(folder, "-k", "test_a_plugin and 2.0 or test_a_world and not Class", "--simkit-report", "pages")
    finally:
        (folder / "puck.sdf").write_text(PUCK)
    assert "2 failed" in said, said
    text = said.partition("test_a_plugin[2.0] ___")[2]
    lines = [line for line in text.splitlines()[1:] if line.strip()]
    assert lines[0].startswith("/imu.linear_acceleration"), text  # x = F / m
    assert "mass 1 → 1.25" in "\n".join(lines[:4]), text
    assert re.search(r"^  golden  golden/test_puck/test_a_plugin-2.0$", text, re.MULTILINE)
    assert "--simkit-update-golden" in text
    assert "in_tests.py" not in said  # the report has no line of simkit's code
    pages = sorted(p.name for p in (folder / "pages").iterdir())
    assert pages == ["test_puck-test_a_plugin-2.0.html", "test_puck-test_a_world.html"]
    assert "mass 1 → 1.25" in (folder / "pages" / pages[0]).read_text(encoding="utf-8")
    assert golden(folder) == before


def test_a_missing_golden_run_shows_the_command_that_writes_it(folder: Path) -> None:
    (folder / "test_new.py").write_text("def test_it(sensor_regression):\n    sensor_regression('puck.sdf')\n")
    said = run(folder, "test_new.py")
    assert "there is no golden run golden/test_new/test_it yet" in said
    assert "help: pytest test_new.py::test_it --simkit-update-golden" in said
    assert not (folder / "golden" / "test_new").exists()


# ---------------------------------------------------------------------- arguments


@pytest.fixture
def regression(tmp_path: Path) -> SensorRegression:
    def keep(sim: Simulation, label: str) -> None:
        sim.close()

    (tmp_path / "puck.sdf").write_text(PUCK)
    place = GoldenLocation(tmp_path / "golden" / "test_x", "test_y", tmp_path, "test_x.py::test_y", reason="new")
    return SensorRegression(place, keep)


@pytest.mark.parametrize("pattern", ["/imu", "imu"])
@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (0.5, Tolerance("/imu", absolute=0.5)),
        ("ignore", Tolerance("/imu", ignore=True)),
        ({"relative": 0.01, "share": 0.1}, Tolerance("/imu", relative=0.01, share=0.1)),
        (Tolerance("", absolute=2.0), Tolerance("/imu", absolute=2.0)),
    ],
)
def test_tolerances_are_given_in_one_argument(
    regression: SensorRegression, pattern: str, given: object, expected: Tolerance
) -> None:
    verdict = regression(RunSpec("puck.sdf", duration=0.02), tolerances={pattern: given})
    assert verdict.run.scenario.tolerances == (expected,)


def test_a_numeric_tolerance_applies_on_the_same_machine(tmp_path: Path) -> None:
    def judged(mass: str, reason: str | None = None, **more: Any) -> None:
        (tmp_path / "puck.sdf").write_text(PUCK.replace("<mass>1</mass>", f"<mass>{mass}</mass>"))
        place = GoldenLocation(tmp_path / "golden" / "test_x", "test_y", tmp_path, "test_x.py::test_y", reason=reason)
        regression = SensorRegression(place, lambda sim, label: sim.close())
        scenario = RunSpec("puck.sdf", duration=0.05)
        with simkit.load(tmp_path / "puck.sdf", plugins=[_Push()]) as sim, regression.of(sim, **more):
            sim.run(scenario.duration)

    near = {"/imu": 0.05}
    judged("1", "new", tolerances=near)
    judged("1.01", tolerances=near)  # an acceleration of 2 m/s² is 0.02 m/s² less
    with pytest.raises(pytest.fail.Exception, match=r"linear_acceleration.x: 2 m/s² became 1.98"):
        judged("1.01")
    with pytest.raises(pytest.fail.Exception, match=r"linear_acceleration.x"):
        judged("1.01", tolerances={"/imu": {"relative": 0.001}})
    with pytest.raises(pytest.fail.Exception, match=r"linear_acceleration.x"):
        judged("1.01", tolerances={"/tf": "ignore"})
    assert not read_golden(tmp_path / "golden" / "test_x" / "test_y").scenario.bits


class _Push(simkit.WorldPlugin):
    def load(self, sim: object, params: object) -> None:
        self.link = self.sim.link("puck::body")

    def before_step(self) -> None:
        self.link.apply_wrench((2.0, 0.0, 0.0))


@pytest.mark.parametrize(
    "given",
    [
        "sometimes",
        -1.0,
        True,
        None,
        {"absolut": 1.0},
        {"absolute": "5 mm"},
        {"share": -1},
        {"ignore": "no"},
        {3: 4},
        float("nan"),
    ],
)
def test_an_invalid_tolerance_lists_the_allowed_values(regression: SensorRegression, given: object) -> None:
    with pytest.raises(InputError, match=r"SK-GOLDEN-021 .*tolerances\['/imu'\]: found .*expected a number"):
        regression("puck.sdf", tolerances={"/imu": given})


def test_an_argument_overrides_the_scenario(regression: SensorRegression) -> None:
    verdict = regression(RunSpec("puck.sdf", duration=5.0, seed=1, topics=("/none",)), duration=0.02, topics="imu")
    scenario = verdict.run.scenario
    assert (scenario.duration, scenario.seed, scenario.topics) == (0.02, 1, ("/imu",))
    assert list(verdict.run.streams) == ["/imu"]


def test_two_runs_of_one_test_need_different_names(regression: SensorRegression) -> None:
    regression("puck.sdf", duration=0.01)
    regression("puck.sdf", duration=0.01, name="b")
    with pytest.raises(InputError, match="SK-GOLDEN-020"):
        regression("puck.sdf", duration=0.01)


def test_arguments_of_loading_are_rejected_for_a_loaded_simulation(
    regression: SensorRegression, tmp_path: Path
) -> None:
    import simkit

    sim = simkit.load(tmp_path / "puck.sdf")
    with (
        sim,
        pytest.raises(
            InputError, match="SK-GOLDEN-021 sensor_regression: plugins, seed: not possible for a simulation"
        ),
    ):
        regression(sim, seed=3, plugins=[])
    with pytest.raises(InputError, match="SK-GOLDEN-021 sensor_regression: found int"):
        regression(3)  # type: ignore[arg-type]


def test_a_run_with_a_failed_check_cannot_become_golden(regression: SensorRegression, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text("world: puck.sdf\nduration: 0.05\nat_end: [time > 1]\n")
    with pytest.raises(InputError, match="SK-GOLDEN-007 .*a check failed"):
        regression("s.yaml")
    assert not (tmp_path / "golden").exists()


@pytest.mark.parametrize(
    ("name", "folder"),
    [
        ("test_a", "test_a"),
        ("test_a[2.0-left]", "test_a-2.0-left"),
        ("TestX.test_a", "TestX.test_a"),
    ],
)
def test_a_name_without_unsafe_characters_is_the_folder_name(name: str, folder: str) -> None:
    assert safe_name(name) == folder


def test_different_names_give_different_safe_folders() -> None:
    names = ["test_a[a/b]", "test_a[a-b]", "test_a[a b]", "test_a[../..]", "test_a[..]", "test_a[é]", "test_a[\ud800]"]
    names += [f"test_a[{'x' * 300}{number}]" for number in range(2)]
    folders = [safe_name(name) for name in names]
    assert len(set(folders)) == len(names)
    assert all(re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_.=-]{0,95}", folder) for folder in folders)
