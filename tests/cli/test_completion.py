"""What a shell completes: names of the running simulation and of bags; nothing, and no error, where none answers."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

from simkit.cli import app

MAIN = "from simkit.cli import main; main()"


def completed(line: str) -> list[str]:
    """What bash offers behind a line."""
    words = line.split()
    at = len(words) if line.endswith(" ") else len(words) - 1
    result = CliRunner().invoke(
        app,
        [],
        prog_name="simkit",
        env={"_SIMKIT_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(at)},
    )
    return [text for text in result.output.splitlines() if text]


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("simkit to", ["topic"]),
        ("simkit topic ec", ["echo"]),
        ("simkit topic echo /o", ["/odom"]),
        ("simkit topic echo od", ["odom"]),
        ("simkit topic echo /odom --field pose.po", ["pose.pose"]),
        ("simkit topic echo /odom --field pose.pose.position.", [f"pose.pose.position.{c}" for c in "xyz"]),
        ("simkit topic pub /cmd_vel ", ["geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"]),
        ("simkit topic find sensor_msgs/msg/Im", ["sensor_msgs/msg/Image", "sensor_msgs/msg/Imu"]),
        ("simkit service call /la", ["/lamp"]),
        ("simkit service call /lamp ", ["std_srvs/srv/SetBool"]),
        ("simkit service call /lamp std_srvs/srv/SetBool ", ["{data: false}"]),
        ("simkit action send_goal /c", ["/countdown"]),
        ("simkit action send_goal /countdown example_interfaces/action/Fibonacci ", ["{order: 0}"]),
        ("simkit param get /T", ["/Tuner"]),
        ("simkit param get /Tuner p", ["p_gain"]),
        ("simkit node info /Cou", ["/Countdown"]),
        ("simkit model pose r", ["rover"]),
        ("simkit model joint rover l", ["left_wheel"]),
        ("simkit model pose rover ri", ["right"]),
        ("simkit tf echo b", ["base"]),
        ("simkit topic list --sim y", ["yard"]),
    ],
)
def test_names_are_completed(line: str, offered: list[str], yard: Any) -> None:
    assert completed(line) == offered


@pytest.mark.parametrize(
    "command",
    [
        "run",
        "check",
        "inspect",
        "bench",
        "convert",
        "vendor",
        "fetch",
        "bundle",
        "certify",
        "golden record",
        "run empty --spawn",
    ],
)
def test_the_names_of_bundled_worlds_are_completed(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert completed(f"simkit {command} turtlebot3_w") == [
        "turtlebot3_waffle",
        "turtlebot3_waffle_pi",
        "turtlebot3_world",
    ]


def test_files_are_completed_by_their_suffix_and_a_single_folder_by_its_content(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "labs" / "one").mkdir(parents=True)
    for name in ("labs/one/maze.world", "labs/one/maze.txt", "mazes.yaml", "maze.sdf", ".maze.sdf"):
        (tmp_path / name).touch()
    monkeypatch.chdir(tmp_path)
    assert completed("simkit run maz") == ["maze.sdf"]
    assert completed("simkit golden record maz") == ["maze.sdf", "mazes.yaml"]
    assert completed("simkit run la") == ["labs/one/maze.world"]
    (tmp_path / "labs" / "two").mkdir()
    assert completed("simkit run la") == ["labs/one/", "labs/two/"]
    assert completed("simkit run no/such/folder/") == []


@pytest.mark.parametrize(
    "line", ["run", "topic echo", "golden check", pytest.param("plugin new", marks=pytest.mark.needs_packs), ""]
)
def test_h_is_the_same_as_help(line: str) -> None:
    short, long = (CliRunner().invoke(app, [*line.split(), option]) for option in ("-h", "--help"))
    assert short.exit_code == 0
    assert short.stdout == long.stdout
    assert "Usage: " in short.stdout


def test_the_script_of_a_named_shell_is_shown_and_an_unknown_shell_is_an_error() -> None:
    for shell in ("bash", "zsh", "fish"):
        shown = CliRunner().invoke(app, ["--show-completion", shell], prog_name="simkit")
        assert f"_SIMKIT_COMPLETE=complete_{shell}" in shown.stdout
    unknown = CliRunner().invoke(app, ["--show-completion", "tcsh"], prog_name="simkit")
    assert unknown.exit_code == 2
    assert "'tcsh' is not one of bash, zsh, fish" in unknown.stderr


def test_without_a_simulation_completion_offers_and_prints_nothing(place: Any) -> None:
    assert completed("simkit topic echo /o") == []
    assert completed("simkit topic echo --bag no_such.mcap /o") == []


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
def test_a_shell_can_be_taught(place: Any) -> None:
    """Which shell it is, is seen from the process above."""
    named = f"import sys; sys.argv[0] = 'simkit'; {MAIN}"
    line = ["bash", "-c", '"$0" -c "$1" --show-completion; exit $?', sys.executable, named]
    told = subprocess.run(line, stdout=subprocess.PIPE, text=True, check=True).stdout
    assert "_SIMKIT_COMPLETE=complete_bash" in told
    assert typer.main.get_command(app).name == "simkit"


@pytest.mark.skipif(os.name == "nt", reason="no such signals there")
def test_an_interrupt_ends_a_command_without_output(yard: Any) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", MAIN, "topic", "echo", "/imu", "--csv", "--sim", "yard"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as running:
        assert running.stdout is not None and running.stderr is not None
        assert running.stdout.readline()
        running.send_signal(signal.SIGINT)
        _, told = running.communicate(timeout=20)
    assert running.returncode == 130
    assert told == b""


def test_a_closed_pipe_ends_a_command_without_output(yard: Any) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", MAIN, "topic", "echo", "/imu", "--csv", "--sim", "yard"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as running:
        assert running.stdout is not None and running.stderr is not None
        assert running.stdout.readline()
        running.stdout.close()
        told = running.stderr.read()
        assert running.wait(20) == 0
    assert told == b""
