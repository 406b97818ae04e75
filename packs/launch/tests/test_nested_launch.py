"""`ros2 launch` inside a launch file includes that file, with launch configurations of its own."""

from __future__ import annotations

from pathlib import Path

from simkit_launch.launch_file import read_launch_file

OUTER = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess

def generate_launch_description():
    command = ["ros2", "launch", {inner!r}, "name:=hello"]
    return LaunchDescription([DeclareLaunchArgument("topic", default_value="outer"), ExecuteProcess(cmd=command)])
"""
INNER = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def generate_launch_description():
    remappings = [("chatter", LaunchConfiguration("topic"))]
    node = Node(
        package="demo_nodes_cpp", executable="talker", name=LaunchConfiguration("name"), remappings=remappings
    )
    arguments = [DeclareLaunchArgument("name"), DeclareLaunchArgument("topic", default_value="inner")]
    return LaunchDescription([*arguments, node])
"""


def test_a_nested_launch_file_has_its_own_arguments(tmp_path: Path) -> None:
    (tmp_path / "inner.launch.py").write_text(INNER)
    (tmp_path / "outer.launch.py").write_text(OUTER.format(inner=str(tmp_path / "inner.launch.py")))
    (process,) = read_launch_file(tmp_path / "outer.launch.py", {}).processes
    assert (process.source, process.name, process.remappings) == (
        "demo_nodes_cpp/talker",
        "hello",
        (("chatter", "inner"),),
    )


def test_a_nested_launch_file_that_is_not_there_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "outer.launch.py").write_text(OUTER.format(inner=str(tmp_path / "nowhere.launch.py")))
    plan = read_launch_file(tmp_path / "outer.launch.py", {})
    assert plan.processes == []
    assert [each.code for each in plan.diagnostics if each.severity == "warning"] == ["SK-LAUNCH-003"]
