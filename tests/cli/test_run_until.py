"""`simkit run --until`, `--timeout`, `--wall-timeout`, `--assert` and `--junit`: exit codes, words, and the file."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from typer.testing import CliRunner, Result

from simkit.cli import app

YARD = """<sdf version="1.9"><world name="yard"><physics type="ode"><max_step_size>0.002</max_step_size></physics>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
</link></model>
<model name="ball"><pose>0 0 1.25 0 0 0</pose><link name="base"><inertial><mass>1</mass></inertial>
  <collision name="c"><geometry><sphere><radius>0.25</radius></sphere></geometry></collision>
  <sensor name="imu" type="imu"><update_rate>50</update_rate><topic>/imu</topic></sensor></link></model>
%s</world></sdf>"""


@pytest.fixture
def yard(tmp_path: Path) -> Path:
    path = tmp_path / "yard.sdf"
    path.write_text(YARD % "")
    return path


def run(*words: object) -> Result:
    return CliRunner().invoke(app, ["run", *map(str, words), "-q"])


def cases(path: Path) -> dict[str, str]:
    """Case -> what became of it: failure, error or passed."""
    root = ElementTree.parse(path).getroot()
    found = {}
    for case in root.iter("testcase"):
        tags = [child.tag for child in case if child.tag in ("failure", "error")]
        found[case.attrib["name"]] = tags[0] if tags else "passed"
    return found


def test_a_run_ends_with_0_as_soon_as_it_is_there(yard: Path, tmp_path: Path) -> None:
    file = tmp_path / "reports" / "out.xml"
    holds, count = "contact('ball', 'ground')", "count('/imu') > 20"
    result = run(yard, "--until", holds, "--timeout", "30s", "--assert", count, "--junit", file)
    assert result.exit_code == 0, result.output
    # 1 m of falling takes sqrt(2 / 9.8) = 0.452 s
    assert "passed  contact('ball', 'ground'): was reached at t = 0.45" in result.stdout
    assert "ball::base touches ground::l" in result.stdout and "simulated 0.45" in result.stdout
    assert cases(file) == {"run": "passed", holds: "passed", count: "passed"}


def test_a_failed_condition_ends_with_5_and_the_measured_numbers(yard: Path, tmp_path: Path) -> None:
    file = tmp_path / "out.xml"
    words = ("--until", "pose('ball').z > 3", "--timeout", "300ms", "--assert", "pose('ball').z < 0.5", "--junit", file)
    result = run(yard, *words)
    assert result.exit_code == 5
    assert "FAILED  pose('ball').z > 3: was not reached by t = 0.3 s: pose('ball').z was 0.80" in result.stdout
    assert "FAILED  pose('ball').z < 0.5: pose('ball').z was 0.80" in result.stdout
    assert cases(file) == {"run": "passed", "pose('ball').z > 3": "failure", "pose('ball').z < 0.5": "failure"}


def test_a_duration_ends_the_waiting_too(yard: Path) -> None:
    result = run(yard, "--until", "time > 9", "--duration", "0.2", "--timeout", "1")
    assert result.exit_code == 5 and "was not reached by t = 0.2 s" in result.stdout


def test_an_invalid_expression_is_reported_before_the_first_step(yard: Path, tmp_path: Path) -> None:
    file, bag = tmp_path / "out.xml", tmp_path / "run.mcap"
    words = ("--until", "pose('bal').z > 3", "--assert", "tim > 2", "--duration", "9", "--junit", file, "--record", bag)
    result = run(yard, *words)
    assert result.exit_code == 2 and "SK-COND-005" in result.stderr and "SK-COND-002" in result.stderr
    assert "simulated" not in result.stdout and not bag.exists()
    assert cases(file) == {"run": "error"}


def test_a_file_is_written_where_the_world_cannot_be_loaded(tmp_path: Path) -> None:
    result = run("nowhere.sdf", "--junit", tmp_path / "out.xml")
    assert result.exit_code == 2 and cases(tmp_path / "out.xml") == {"run": "error"}


def test_an_unwritable_file_is_reported_before_the_run(yard: Path, tmp_path: Path) -> None:
    bag = tmp_path / "run.mcap"
    for place in (tmp_path, yard / "out.xml"):  # a folder, and one that would be in a file
        result = run(yard, "--duration", "0.1", "--junit", place, "--record", bag)
        assert result.exit_code == 2 and "SK-CLI-016" in result.stderr
        assert "simulated" not in result.stdout and not bag.exists()


@pytest.mark.parametrize("words", [("--timeout", "3"), ("--until", "time > 1", "--timeout", "3 h")])
def test_a_timeout_is_a_time_and_waits_for_something(words: tuple[str, ...], yard: Path) -> None:
    result = run(yard, *words)
    assert result.exit_code == 2 and "--timeout" in result.stderr


def test_the_wall_time_limit_ends_a_paused_run(yard: Path) -> None:
    result = run(yard, "--paused", "--wall-timeout", "500ms", "--assert", "time > 1", "--duration", "2")
    assert result.exit_code == 5
    assert "FAILED  the run was stopped after 0.5 s of wall time (--wall-timeout)" in result.stdout
    assert "FAILED  time > 1: was not evaluated" in result.stdout


@pytest.mark.slow
def test_a_plugin_that_never_comes_back_is_interrupted_and_named(tmp_path: Path) -> None:
    (tmp_path / "stuck.py").write_text(
        "import time\nimport simkit\n\n\nclass Stuck(simkit.WorldPlugin):\n    def load(self, sim, params):\n"
        "        time.sleep(1000)\n"
    )
    yard, file = tmp_path / "yard.sdf", tmp_path / "out.xml"
    yard.write_text(YARD % '<plugin name="stuck" filename="stuck.py"/>')
    words = ["run", yard, "--plugin-path", tmp_path, "--duration", "2", "--wall-timeout", "0.5", "--junit", file]
    command = [sys.executable, "-m", "simkit", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 5, done.stderr
    assert "interrupting plugin 'stuck'" in done.stderr and "stuck.py:7 in load" in done.stderr
    assert cases(file) == {"run": "failure"}


@pytest.mark.parametrize("option", ["--until", "--assert"])
def test_a_condition_that_is_empty_asks_for_nothing_and_is_no_success(yard: Path, option: str) -> None:
    """As of a variable of a script that was never set."""
    done = run(yard, "--duration", 0.1, option, "")
    assert done.exit_code == 2 and "the expression is empty" in done.stderr
