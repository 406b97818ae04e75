"""`simkit launch --processes`: the file's own nodes are processes, which end with the run."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit import RunSpec
from simkit.cli import app
from simkit_launch.cli.processes.node_processes import node_words, split_processes

LAUNCH = """from launch import LaunchDescription
from launch.actions import ExecuteProcess


def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=["python3", PROGRAM], additional_env={"CODE": "3"})])
"""
PROGRAM = "import os\nimport sys\nimport rclpy\nrclpy.init()\nsys.exit(int(os.environ['CODE']))\n"


def test_a_node_is_a_command_line_with_its_names_remaps_and_parameters() -> None:
    node = {
        "program": "bot/talk",
        "args": ("--fast",),
        "name": "talker",
        "namespace": "/robot",
        "remap": {"chatter": "speech"},
        "params": {"word": "yes", "gains": {"p": 1.5}},
    }
    names = ["-r", "chatter:=speech", "-r", "__node:=talker", "-r", "__ns:=/robot"]
    assert node_words(node) == ["--fast", "--ros-args", *names, "-p", 'word:="yes"', "-p", "gains.p:=1.5"]
    assert node_words({"program": "bot/talk"}) == []


def test_known_nodes_stay_in_the_run() -> None:
    nodes = ("robot_state_publisher/robot_state_publisher", {"program": "talk.py", "name": "talker"})
    spec, part = split_processes(RunSpec("empty", nodes=nodes))
    assert spec.nodes == nodes[:1]
    assert [node["program"] for node in part.nodes] == ["talk.py"]


@pytest.mark.slow
def test_a_process_that_fails_fails_the_run(tmp_path: Path) -> None:
    """The run goes on to its end, as it does for a node in lock-step."""
    program, file = tmp_path / "ends.py", tmp_path / "ends.launch.py"
    program.write_text(PROGRAM, encoding="utf-8")
    file.write_text(LAUNCH.replace("PROGRAM", repr(str(program))), encoding="utf-8")
    result = CliRunner().invoke(app, ["launch", str(file), "--duration", "2", "--processes", "--quiet"])
    assert result.exit_code == 4
    assert "SK-SCEN-010 node 'ends.py-1' ended with exit code 3" in result.stderr
