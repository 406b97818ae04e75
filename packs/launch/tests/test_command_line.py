"""Command lines are split into the programs that they start; nothing is started."""

from __future__ import annotations

import pytest

from simkit_launch.command_line import ShellCommand, run_executable, started_commands


@pytest.mark.parametrize(
    ("words", "programs"),
    [
        (("ros2", "topic", "list"), [("ros2", "topic", "list")]),
        (("ros2 topic pub /x T '{data: a b}'",), [("ros2", "topic", "pub", "/x", "T", "{data: a b}")]),
        (("bash", "-c", "sleep 5; ros2 node list"), [("sleep", "5"), ("ros2", "node", "list")]),
        (("bash", "-c", "source setup.bash && ros2 node list"), [("ros2", "node", "list")]),
        (("xterm", "-hold", "-e", "ros2 node list"), [("ros2", "node", "list")]),
        (("gnome-terminal", "--", "bash", "-c", "ros2 node list; exec bash"), [("ros2", "node", "list")]),
        (("nice", "-n", "10", "ros2", "node", "list"), [("ros2", "node", "list")]),
        (("ruby $(which gz) sim -r a.sdf",), [("gz", "sim", "-r", "a.sdf")]),
        (("/usr/bin/env", "python3", "-u", "drive.py", "--fast"), [("drive.py", "--fast")]),
        (("python3", "-m", "drive"), [("python3", "-m", "drive")]),
        (("bash", "-c", "ls | wc"), [("ls",)]),
        (("echo 'open",), [("echo", "'open")]),
        (("bash",), []),
    ],
)
def test_shells_terminals_and_interpreters_are_taken_away(
    words: tuple[str, ...], programs: list[tuple[str, ...]]
) -> None:
    assert [command.words for command in started_commands(words)] == programs


def test_variables_and_folders_of_a_line_are_those_of_its_commands() -> None:
    line = "A=1; cd sub && B=2 first; export C=3; env D=4 second"
    assert started_commands((line,), is_shell=True) == [
        ShellCommand(("first",), "sub", {"A": "1", "B": "2"}),
        ShellCommand(("second",), "sub", {"A": "1", "C": "3", "D": "4"}),
    ]


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("/opt/ros/jazzy/bin/ros2 run --prefix nice bot drive 1", ("bot", "drive", ("1",))),
        ("rosrun bot drive", ("bot", "drive", ())),
        ("rosrun bot", None),
        ("ros2 topic list", None),
    ],
)
def test_ros2_run_and_rosrun_name_an_executable(line: str, found: tuple[str, str, tuple[str, ...]] | None) -> None:
    assert run_executable(line.split()) == found
