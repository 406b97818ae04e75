"""The output of xacro files of launch files, also of those that are not complete."""

from __future__ import annotations

from pathlib import Path

from simkit.diagnostics import NOWHERE, Diagnostics
from simkit_launch.command_output import xacro_output


def test_the_rest_of_a_robot_remains_without_a_missing_file_of_macros(tmp_path: Path) -> None:
    """The macros of the missing file are unknown; calls of other unknown macros stay errors."""
    robot = tmp_path / "robot.urdf.xacro"
    lines = (
        '<robot name="robot" xmlns:xacro="http://www.ros.org/wiki/xacro">',
        '<xacro:include filename="$(find nobody_sensors)/lidar.xacro"/>',
        '<link name="base"/>',
        '<xacro:lidar parent="base"><origin xyz="0 0 1"/></xacro:lidar>',
        "</robot>",
    )
    robot.write_text("\n".join(lines), encoding="utf-8")
    problems = Diagnostics()
    text = xacro_output([str(robot)], NOWHERE, problems)
    assert text is not None
    assert '<link name="base"/>' in text
    assert "lidar" not in text
    warnings = [(each.code, each.line) for each in problems if each.severity == "warning"]
    assert warnings == [("SK-XACRO-008", 2), ("SK-XACRO-008", 4)]
    robot.write_text("\n".join((lines[0], *lines[2:])), encoding="utf-8")
    assert xacro_output([str(robot)], NOWHERE, Diagnostics()) is None
