"""Command lines of launch files: which of them are nodes or known commands."""

from __future__ import annotations

import pytest

from simkit_launch.command_nodes import resolved_process
from simkit_launch.launch_plan import LaunchedProcess


@pytest.mark.parametrize(
    ("words", "source", "arguments"),
    [
        ("ros2 run topic_tools relay /a /b", "topic_tools/relay", ("/a", "/b")),
        ("rosrun topic_tools relay /a", "topic_tools/relay", ("/a",)),
        (
            "/opt/ros/jazzy/bin/ros2 control list_controllers",
            "ros2 control list_controllers",
            ("control", "list_controllers"),
        ),
    ],
)
def test_known_commands_are_nodes(words: str, source: str, arguments: tuple[str, ...]) -> None:
    process = resolved_process(LaunchedProcess(1, "command", arguments=tuple(words.split())))
    assert (process.kind, process.source, process.arguments) == ("node", source, arguments)


def test_other_commands_stay_commands() -> None:
    process = LaunchedProcess(1, "command", arguments=("my_driver", "--port", "1"))
    assert resolved_process(process) == process


def test_a_nodelet_is_a_node_of_its_class() -> None:
    words = ("load", "depth_image_proc/point_cloud_xyz", "manager")
    process = resolved_process(LaunchedProcess(1, "node", "nodelet", "nodelet", arguments=words))
    assert (process.source, process.arguments) == ("depth_image_proc/point_cloud_xyz", ())
    manager = LaunchedProcess(2, "node", "nodelet", "nodelet", arguments=("manager",))
    assert resolved_process(manager) == manager
