"""Unused parameters in a parameter file are reported with their line and the closest name."""

from __future__ import annotations

from pathlib import Path

import pytest
from control_robots import POSITIONS, arm, opened, reported_messages, states

import simkit

TYPE = "      type: position_controllers/JointGroupPositionController\n"


@pytest.mark.parametrize(
    ("type_line", "message"),
    [
        ("      rate: 1\n", "is not defined"),
        ("", "is not defined"),
        ('      type: ""\n', "is empty"),
        ("      type: [a, b]\n", "is not a string"),
        ("      type: {a: b}\n", "is not a string"),
        (TYPE.replace("type", "tpye"), "is not defined"),
    ],
)
def test_a_controller_without_a_type_is_a_warning(tmp_path: Path, type_line: str, message: str) -> None:
    with opened(tmp_path, yaml=POSITIONS.replace(TYPE, type_line)) as sim:
        assert states(sim) == {"joint_state_broadcaster": "active"}
        found = next(d for d in sim.diagnostics if d.code == "SK-CONTROL-013")
        assert found.line in (7, 8)
        assert f"the 'type' param of controller 'arm_controller' {message}" in found.message
        assert ("'tpye'" in found.hint) == ("tpye" in type_line)


def test_a_misspelt_manager_is_a_warning_with_a_suggestion(tmp_path: Path) -> None:
    with opened(tmp_path, yaml=POSITIONS.replace("controller_manager:", "controler_manager:")) as sim:
        assert states(sim) == {}
        found = next(d for d in sim.diagnostics if d.code == "SK-CONTROL-003")
        assert "arm.yaml declares no controller for '/controller_manager'" in found.message
        assert found.hint == "did you mean '/controler_manager'?"


def test_a_namespace_missing_in_the_file_is_a_warning(tmp_path: Path) -> None:
    plugin = "<ros><namespace>/r1</namespace></ros><parameters>arm.yaml</parameters>"
    with opened(tmp_path, arm(plugin=plugin)) as sim:
        assert "declares no controller for '/r1/controller_manager'" in reported_messages(sim, "SK-CONTROL-003")[0]


def test_a_misspelt_parameter_of_the_manager_is_a_warning(tmp_path: Path) -> None:
    with opened(tmp_path, yaml=POSITIONS.replace("update_rate", "updat_rate")) as sim:
        assert "the controller manager ignores parameter <updat_rate>" in reported_messages(sim, "SK-CONTROL-011")[0]


def test_parameters_next_to_the_type_of_a_controller_are_a_warning(tmp_path: Path) -> None:
    with opened(tmp_path, yaml=POSITIONS.replace(TYPE, TYPE + "      joints: [j1]\n")) as sim:
        assert (
            "'joints' next to the type of 'arm_controller' is ignored; set it in the controller's own node"
            in reported_messages(sim, "SK-CONTROL-011")[0]
        )


def test_a_controller_rate_above_the_managers_is_a_warning(tmp_path: Path) -> None:
    with opened(tmp_path, yaml=POSITIONS + "    update_rate: 500\n") as sim:
        message = reported_messages(sim, "SK-CONTROL-017")[0]
        assert "'arm_controller' has an update rate of 500 Hz, above the manager's 100 Hz" in message


def test_a_valid_file_has_no_diagnostics(tmp_path: Path) -> None:
    yaml = POSITIONS + "control:\n  ros__parameters: {pid_gains: {position: {j1: {kp: 1000.0}}}}\n"
    with opened(tmp_path, yaml=yaml) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note" and d.code.startswith("SK-CONTROL")]


def test_a_joint_that_is_named_twice_stops_the_load(tmp_path: Path) -> None:
    with pytest.raises(simkit.LoadError, match=r"arm.yaml:11: error SK-PARAM-002: 'j1' occurs twice in 'joints'"):
        opened(tmp_path, yaml=POSITIONS.replace("[j1, j2]", "[j1, j1]"))


@pytest.mark.parametrize("joints", ["[]", "", '""', "[~]"])
def test_an_empty_list_stops_the_load(tmp_path: Path, joints: str) -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001: <arm_controller> needs <joints>: a list of names"):
        opened(tmp_path, yaml=POSITIONS.replace("[j1, j2]", joints))


@pytest.mark.parametrize(("gains", "message"), [("", "No p gain"), ("    gains: 5\n", "found '5' for 'gains'")])
def test_a_loop_without_gains_stops_the_load(tmp_path: Path, gains: str, message: str) -> None:
    yaml = POSITIONS.replace("position_controllers", "effort_controllers") + gains
    hardware = "".join(
        f'<joint name="{j}"><command_interface name="effort"/><state_interface name="position"/>'
        '<state_interface name="velocity"/></joint>'
        for j in ("j1", "j2")
    )
    with pytest.raises(simkit.LoadError, match=message):
        opened(tmp_path, arm(hardware), yaml)


def test_gains_for_an_unknown_joint_are_a_warning(tmp_path: Path) -> None:
    gains = "{position: {j1: {kp: 1000.0, kq: 1}, j3: {kp: 1}}, velocty: {j1: {kp: 1}}}"
    with opened(tmp_path, yaml=POSITIONS + f"control:\n  ros__parameters: {{pid_gains: {gains}}}\n") as sim:
        assert "pid_gains names joint 'j3'" in reported_messages(sim, "SK-CONTROL-008")[0]
        unused = reported_messages(sim, "SK-CONTROL-011")
        assert [word for word in ("<kq>", "<velocty>") if any(word in m for m in unused)] == ["<kq>", "<velocty>"]


def test_an_impossible_file_name_is_not_found(tmp_path: Path) -> None:
    with opened(tmp_path, arm(plugin=f"<parameters>{'a' * 5000}</parameters>")) as sim:
        assert "is not found" in reported_messages(sim, "SK-CONTROL-015")[0]


@pytest.mark.parametrize(("more", "line"), [("# \xe9".encode("latin-1"), 12), (b"\x07", 12)])
def test_an_invalid_character_is_reported_with_its_line(tmp_path: Path, more: bytes, line: int) -> None:
    opened(tmp_path)
    (tmp_path / "arm.yaml").write_bytes(POSITIONS.encode() + more)
    with pytest.raises(simkit.LoadError, match=rf"arm.yaml:{line}: error SK-CONTROL-002"):
        simkit.load(tmp_path / "arm.urdf")


def test_two_control_plugins_on_one_robot_are_a_warning(tmp_path: Path) -> None:
    again = '<gazebo><plugin filename="libgazebo_ros2_control.so" name="second"/></gazebo>'
    with opened(tmp_path, arm().replace("</robot>", f"{again}</robot>")) as sim:
        (message,) = reported_messages(sim, "SK-CONTROL-004")
        assert message.startswith("joints 'j1', 'j2' are already driven by plugin 'control'")


def test_a_drive_after_the_control_plugin_is_a_warning_too(tmp_path: Path) -> None:
    drive = """<gazebo><plugin filename="libgazebo_ros_diff_drive.so" name="drive"><left_joint>j1</left_joint>
      <right_joint>j2</right_joint><wheel_separation>1</wheel_separation><wheel_diameter>1</wheel_diameter></plugin>
      </gazebo></robot>"""
    with opened(tmp_path, arm().replace("</robot>", drive)) as sim:
        (message,) = reported_messages(sim, "SK-CONTROL-004")
        assert message.startswith("joints 'j1', 'j2' are also driven by plugin 'drive'")


def test_a_manager_without_controllers_gets_no_suggestion_of_its_own_name(tmp_path: Path) -> None:
    with opened(tmp_path, yaml="controller_manager:\n  ros__parameters:\n    update_rate: 100\n") as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-CONTROL-003"]
        assert found.hint.startswith("a controller needs a type below this name")
