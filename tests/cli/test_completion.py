"""What a shell completes: names of the running simulation and of bags; nothing, and no error, where none answers."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

import simkit
from simkit.cli import app
from simkit.recording import Recorder

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
        ("simkit node ping /Cou", ["/Countdown"]),
        ("simkit bag record --topics /od", ["/odom"]),
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


def test_plots_complete_bags_and_then_their_topics(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with simkit.load("turtlebot3_empty") as sim, Recorder(sim, Path("drive.mcap")):
        sim.run(0.1)
    for command in ("plot", "bag plot", "bag info"):
        assert completed(f"simkit {command} dri") == ["drive.mcap"]
    assert completed("simkit plot drive.mcap /o") == ["/odom"]


YARD = """<sdf version="1.9"><world name="w"><model name="m"><link name="l">
<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
<sensor name="imu" type="imu"><topic>feel</topic></sensor></link></model></world></sdf>"""


def test_topic_and_skip_of_a_run_complete_topics_of_its_bag_or_world(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("w.sdf").write_text(YARD, encoding="utf-8")
    Path("s.yaml").write_text("world: w.sdf\n", encoding="utf-8")
    Path("s.py").write_text("raise SystemExit(1)\n", encoding="utf-8")
    with simkit.load("w.sdf") as sim, Recorder(sim, Path("drive.mcap"), topics=("/feel",)):
        sim.run(0.1)
    assert completed("simkit bag play drive.mcap --topics /") == ["/feel"]
    for line in ("run w.sdf --topic", "golden record s.yaml --skip", "run empty --spawn w.sdf:0,0,0 --skip"):
        assert completed(f"simkit {line} /fe") == ["/feel"], line
    assert completed("simkit golden record s.py --topic /") == []
    assert completed("simkit run no_such.sdf --topic /") == []


@pytest.mark.slow
@pytest.mark.needs_packs
def test_motions_and_plugins_are_completed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert completed("simkit plugin info libgazebo_ros_diff") == ["libgazebo_ros_diff_drive.so"]
    assert completed("simkit motion play home unfold_") == ["unfold_arm"]
    assert completed("simkit motion play --robot no_such un") == []


SHELLS = {
    "bash": """
source ./script
COMP_WORDS=($LINE); COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
_simkit_completion simkit
printf '%s\\n' "${COMPREPLY[@]}"
""",
    "zsh": """
compdef() { }
source ./script
_arguments() { print -r -- "$@" }
words=(${=LINE}); CURRENT=${#words}
_simkit_completion
""",
    "fish": """
source ./script
complete -C "$LINE"
""",
}
"""For each shell: a program that loads the script of `--show-completion` and prints what it offers for a line."""


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="these shells run elsewhere")
@pytest.mark.parametrize("shell", SHELLS)
def test_each_shell_offers_worlds_bags_and_topics(shell: str, place: Path, start: Callable[..., Any]) -> None:
    program = shutil.which(shell)
    if program is None:
        pytest.skip(f"{shell} is not installed")
    start("yard")
    (place / "drive.mcap").touch()
    (place / "bin").mkdir()
    command = place / "bin" / "simkit"
    command.write_text(f'#!/bin/sh\nexec {sys.executable} -P -m simkit "$@"\n')
    command.chmod(0o755)
    ours = {**os.environ, "PATH": f"{place}/bin{os.pathsep}{os.environ['PATH']}", "HOME": str(place)}
    with (place / "script").open("wb") as script:
        subprocess.run([command, "--show-completion", shell], stdout=script, env=ours, cwd=place, check=True)
    for line, offered in (
        ("simkit run turtlebot3_w", ["turtlebot3_waffle", "turtlebot3_waffle_pi", "turtlebot3_world"]),
        ("simkit bag info dr", ["drive.mcap"]),
        ("simkit topic echo /od", ["/odom"]),
        ("simkit run turtlebot3_empty --skip /od", ["/odom"]),
    ):
        answer = subprocess.run(
            [program, "-c", SHELLS[shell]],
            env={**ours, "LINE": line},
            cwd=place,
            capture_output=True,
            text=True,
            check=True,
        )
        assert re.findall(r"[\w./]+", answer.stdout.removeprefix("*: :")) == offered, answer


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_protocol_of_each_shell_is_answered(shell: str) -> None:
    line = "simkit run turtlebot3_wo"
    environment = {
        "bash": {"COMP_WORDS": line, "COMP_CWORD": "2"},
        "zsh": {"_TYPER_COMPLETE_ARGS": line},
        "fish": {"_TYPER_COMPLETE_ARGS": line, "_TYPER_COMPLETE_FISH_ACTION": "get-args"},
    }[shell]
    environment["_SIMKIT_COMPLETE"] = f"complete_{shell}"
    answer = CliRunner().invoke(app, [], prog_name="simkit", env=environment).output
    assert answer.strip() in ("turtlebot3_world", "_arguments '*: :((\"turtlebot3_world\"))'")


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
