"""`--json` of run, bench, doctor, golden check and certify: one object on standard output, also after an error."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from simkit.cli import app
from simkit.cli.terminal.json_report import error_diagnostics
from simkit.errors import InputError, PluginError, SimulationDiverged

WORLD = """<sdf version="1.9"><world name="w">
  <model name="ball"><pose>0 0 5 0 0 0</pose><link name="body">
    <sensor name="imu" type="imu"><update_rate>100</update_rate><topic>imu</topic></sensor>
  </link></model>
  {extra}
</world></sdf>
"""
NOISY = """
import os
from simkit import WorldPlugin

class Noisy(WorldPlugin):
    filenames = ("noisy",)

    def load(self, sim, params):
        print("printed by a plugin")
        os.system("echo printed by a child process")

    def after_step(self):
        raise ValueError("the wheel fell off")
"""


@pytest.fixture
def world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "ball.sdf"
    path.write_text(WORLD.format(extra=""))
    return path


def report(*words: object) -> tuple[dict[str, Any], int, str]:
    """Run a command with `--json`; return its object, its exit code and its standard error."""
    result = CliRunner().invoke(app, [*map(str, words), "--json"])
    assert result.stdout.count("\n") == 1
    found = json.loads(result.stdout)
    assert found["exit_code"] == result.exit_code
    return found, result.exit_code, result.stderr


def test_a_plugin_folder_that_does_not_exist_is_a_usage_error(world: Path) -> None:
    found, code, words = report("run", world, "--duration", 0.1, "--plugin-path", "nowhere")
    assert code == 2
    assert found["diagnostics"][0]["code"] == "SK-CLI-018"
    assert "'nowhere' does not exist" in found["diagnostics"][0]["message"]
    assert "--plugin-path" in words


def test_a_run_reports_its_topics_state_recording_and_conditions(world: Path) -> None:
    found, code, words = report(
        "run", world, "--duration", 1, "--record", "out.mcap", "--assert", "time > 0.5", "--assert", "time > 2"
    )
    assert code == 5
    assert (found["world"], found["time"], found["steps"], found["end"]) == ("w", 1.0, 1000, "duration")
    imu = next(row for row in found["topics"] if row["topic"] == "/imu")
    assert imu == {"topic": "/imu", "type": "sensor_msgs/msg/Imu", "messages": 101, "rate": pytest.approx(100.0)}
    assert found["recording"]["path"] == "out.mcap"
    assert found["recording"]["messages"] > 100
    assert [c["passed"] for c in found["conditions"]] == [True, False]
    assert f"state {found['state']}" in words
    assert report("run", world, "--duration", 1)[0]["state"] == found["state"]


@pytest.mark.parametrize("words", ["run nothing.sdf", "bench nothing.sdf", "certify nothing.sdf --runs 2"])
def test_a_file_that_is_not_there_is_a_diagnostic(words: str, world: Path) -> None:
    found, code, _ = report(*words.split())
    assert code == 2
    assert [(d["code"], d["severity"], d["file"]) for d in found["diagnostics"]] == [
        ("SK-LOAD-002", "error", "nothing.sdf")
    ]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("run ball.sdf --durration 3", "No such option: --durration"),
        ("run", "no world is given; give a file or a world of simkit: "),
        ("run ball.sdf --seed x", "Invalid value for '--seed'"),
        ("run ball.sdf --timeout 3", "--timeout needs --until"),
        ("golden check", "Missing argument"),
        ("doctor everything", "unexpected extra argument"),
    ],
)
def test_a_wrong_command_line_is_a_diagnostic(words: str, message: str, world: Path) -> None:
    found, code, text = report(*words.split())
    assert code == 2
    assert [d["code"] for d in found["diagnostics"]] == ["SK-CLI-018"]
    assert message in found["diagnostics"][0]["message"]
    assert "Usage: " in text


def test_options_of_gazebo_are_diagnostics(world: Path) -> None:
    found, code, _ = report("run", world, "--levels", "gui:=false")
    assert code == 2
    assert [d["code"] for d in found["diagnostics"]] == ["SK-CLI-052", "SK-CLI-052"]


def test_standard_output_is_only_the_object_whatever_plugins_and_their_processes_print(world: Path) -> None:
    world.with_name("noisy.py").write_text(NOISY)
    world.write_text(WORLD.format(extra='<plugin name="n" filename="noisy"/>'))
    done = subprocess.run(
        [sys.executable, "-m", "simkit", "run", str(world), "--plugin-path", ".", "--duration", "1", "--json"],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        check=False,
    )
    found = json.loads(done.stdout)
    assert done.returncode == found["exit_code"] == 4
    assert "printed by a plugin" in done.stderr
    assert "printed by a child process" in done.stderr
    assert (found["end"], found["steps"]) == ("error", 1)
    (failed,) = [d for d in found["diagnostics"] if d["severity"] == "error"]
    assert (failed["code"], Path(failed["file"]).name, failed["line"]) == ("SK-PLUGIN-004", "ball.sdf", 5)


def test_golden_check_reports_results_and_golden_runs_that_cannot_be_read(world: Path) -> None:
    made, code, _ = report("golden", "record", world, "--out", "golden/ball", "--duration", "0.1")
    files = Path("golden/ball").iterdir()
    assert (code, made["folder"], made["bytes"]) == (0, "golden/ball", sum(path.stat().st_size for path in files))
    assert (made["topics"], made["messages"] > 0, made["checks"]) == (2, True, [])
    again, code, _ = report("golden", "record", world, "--out", "golden/ball")
    assert (code, [d["code"] for d in again["diagnostics"]]) == (2, ["SK-GOLDEN-005"])
    found, code, _ = report("golden", "check", "golden")
    assert (code, found["passed"], found["diagnostics"]) == (0, True, [])
    assert [r["name"] for r in found["results"]] == ["ball"]
    world.write_text(world.read_text().replace("0 0 5", "0 0 4"))
    found, code, _ = report("golden", "check", "golden", "--no-causes")
    assert (code, found["passed"]) == (5, False)
    found, code, _ = report("golden", "check", "nothing")
    assert (code, found["passed"]) == (2, False)
    assert [(d["code"], bool(d["hint"])) for d in found["diagnostics"]] == [("SK-GOLDEN-002", True)]


@pytest.mark.slow
def test_bench_and_doctor_report_what_they_print(world: Path) -> None:
    found, code, words = report("bench", world, "--rounds", 1)
    assert code == 0
    assert found["figures"][0]["name"] == "step, nothing due"
    assert found["figures"][0]["ratio"] == pytest.approx(found["figures"][0]["simkit"] / found["figures"][0]["mujoco"])
    assert isinstance(found["import_time"], float)  # a difference of two measurements
    assert "step, nothing due" in words
    found, code, _ = report("doctor")
    assert {"simkit", "python", "mujoco", "renderer", "picture"} <= set(found["found"])
    assert (found["problems"] == []) == (code == 0) and isinstance(found["notes"], list)


def test_an_error_becomes_a_diagnostic_with_its_place_and_remedy() -> None:
    (found,) = error_diagnostics(InputError("SK-CLI-011", "drive.yaml:3: no list", help="write a list"))
    assert (found.code, found.file, found.line, found.message) == ("SK-CLI-011", "drive.yaml", 3, "no list")
    assert found.hint == "write a list"
    (found,) = error_diagnostics(InputError("SK-CLI-011", "drive.yaml:3: SK-CLI-011 no list", shows_code=False))
    assert (found.file, found.line, found.message) == ("drive.yaml", 3, "no list")
    (found,) = error_diagnostics(PluginError("p", "load", 0.0, "w.sdf:7", "oops"))
    assert (found.file, found.line) == ("w.sdf", 7)
    (found,) = error_diagnostics(SimulationDiverged("arm::elbow", 1.5, "a smaller step"))
    assert (found.code, found.file, found.message[:30]) == ("SK-PHYS-001", None, "the simulation diverged at t=1")
    (found,) = error_diagnostics(ValueError("inside simkit"))
    assert (found.code, found.message) == ("SK-CORE-001", "ValueError: inside simkit")
