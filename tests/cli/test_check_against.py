"""`simkit check --against`: a second reader's values, as diagnostics with lines and an exit code."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from simkit.cli import app

pytest.importorskip("yourdfpy")

LINK = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
ARM = f"""<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="reach" default="1"/>
  <link name="base">{LINK}</link>
  <link name="upper">{LINK}
    <visual><geometry><mesh filename="meshes/upper.stl" scale="0.001 0.001 0.001"/></geometry></visual>
  </link>
  <joint name="shoulder" type="revolute">
    <origin xyz="$(arg reach) 0 0"/><parent link="base"/><child link="upper"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""
SPACE = f"""<robot name="finger">
  <link name="hand">{LINK}</link>
  <link name="tip">{LINK}</link>
  <joint name="tip_joint" type="continuous">
    <parent link="hand "/>
    <child link="tip"/>
  </joint>
</robot>
"""


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["check", *map(str, arguments)], catch_exceptions=False)


@pytest.mark.parametrize("robot", ["burger", "waffle", "waffle_pi"])
def test_a_robot_of_simkit_is_read_equally(robot: str) -> None:
    found = run(f"turtlebot3_{robot}.urdf", "--against", "yourdfpy")
    assert found.exit_code == 0
    assert "at 9 sets of joint positions: 0 differences" in found.stdout


def test_simkit_expands_xacro_for_the_second_reader(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf.xacro"
    file.write_text(ARM)
    found = run(file, "--against", "yourdfpy", "--xacro-arg", "reach=2")
    assert "2 links, 1 joint, 0 collisions, 1 visual at 9 sets of joint positions: 0 differences" in found.stdout


def test_a_difference_is_an_error_with_its_line_and_both_values(tmp_path: Path) -> None:
    """yourdfpy keeps the space at the end of a name."""
    file = tmp_path / "finger.urdf"
    file.write_text(SPACE)
    found = run(file, "--against", "yourdfpy")
    message = "error SK-READER-001: joint 'tip_joint': parent link is 'hand' in simkit, 'hand ' in yourdfpy"
    assert f"finger.urdf:5: {message}" in " ".join(found.stdout.split())
    assert found.exit_code == 2
    listed = json.loads(run(file, "--against", "yourdfpy", "--json").stdout)
    assert [(d["line"], d["severity"]) for d in listed if d["code"] == "SK-READER-001"] == [(5, "error")]


def test_a_difference_in_a_line_with_a_diagnostic_is_a_note(tmp_path: Path) -> None:
    file = tmp_path / "finger.urdf"
    file.write_text(
        SPACE.replace('"hand "', '"hand"').replace('<child link="tip"/>', '<child link="tip"/><mimic joint="j"/>')
    )
    found = run(file, "--against", "yourdfpy")
    assert "note SK-READER-002: joint 'tip_joint': mimic is 'none' in simkit, '1 · j + 0' in yourdfpy" in " ".join(
        found.stdout.split()
    )
    assert found.exit_code == 0


def test_a_file_that_the_second_reader_cannot_read_is_an_error(tmp_path: Path) -> None:
    file = tmp_path / "can.urdf"
    capsule = '<collision><geometry><capsule radius="0.1" length="1"/></geometry></collision>'
    file.write_text(f'<robot name="can"><link name="body">{LINK}{capsule}</link></robot>')
    found = run(file, "--against", "yourdfpy")
    assert "can.urdf:1: error SK-READER-003: yourdfpy cannot read the file, so nothing was compared" in found.stdout
    assert found.exit_code == 2


def test_nothing_is_compared_if_the_file_has_errors(tmp_path: Path) -> None:
    file = tmp_path / "finger.urdf"
    file.write_text(SPACE.replace("continuous", "revolut"))
    found = run(file, "--against", "yourdfpy")
    assert "yourdfpy: nothing was compared, because the file has errors" in found.stdout
    assert found.exit_code == 2


@pytest.mark.parametrize(
    ("arguments", "code"),
    [(("empty", "--against", "yourdfpy"), "SK-CLI-060"), (("empty", "--against", "urdfpy"), "SK-CLI-018")],
)
def test_an_unsuitable_argument_is_refused(arguments: tuple[str, ...], code: str) -> None:
    found = run(*arguments)
    assert found.exit_code == 2
    assert code in found.output


def test_a_missing_second_reader_is_an_error_with_the_command_that_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "yourdfpy", None)  # as if it was not installed
    found = run("turtlebot3_burger.urdf", "--against", "yourdfpy")
    assert found.exit_code == 2
    assert "SK-CLI-059" in found.output
    assert "simkit-robotics[second-reader]" in found.output
