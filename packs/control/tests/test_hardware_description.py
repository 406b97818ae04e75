"""Unknown names, invalid numbers and unknown elements in `<ros2_control>` are reported."""

from __future__ import annotations

from pathlib import Path

import pytest
from control_robots import ALL, arm, command, interfaces, opened, position, reported_messages

import simkit

OTHER = f'<joint name="j2">{interfaces(ALL)}</joint>'


def hardware(inside: str) -> str:
    """A robot whose first joint has this more in its hardware."""
    return arm(f'<joint name="j1">{inside}{interfaces(ALL)}</joint>{OTHER}')


def test_an_unsupported_state_interface_is_reported_and_ignored(tmp_path: Path) -> None:
    with opened(tmp_path, hardware('<state_interface name="temperature"/>')) as sim:
        assert "state interface 'temperature' is not supported" in reported_messages(sim, "SK-CONTROL-009")[0]
        names = [one.name for one in sim.call("/controller_manager/list_hardware_interfaces").state_interfaces]
        assert "j1/temperature" not in names


def test_an_initial_position_outside_the_limits_is_clamped(tmp_path: Path) -> None:
    first = '<state_interface name="position"><param name="initial_value">100</param></state_interface>'
    robot = arm(f'<joint name="j1"><command_interface name="position"/>{first}</joint>{OTHER}')
    with opened(tmp_path, robot) as sim:
        assert "the initial_value 100 is outside its limits [-2, 2]" in reported_messages(sim, "SK-CONTROL-008")[0]
        sim.run(0.2)
        assert position(sim, "j1") == pytest.approx([2.0], abs=0.01)


@pytest.mark.parametrize("word", ["pos_kp", "pos_ki", "multiplier", "offset"])
@pytest.mark.parametrize("value", ["abc", "nan", "1e400", "1e300"])
def test_a_value_that_is_not_a_finite_number_stops_the_load(tmp_path: Path, word: str, value: str) -> None:
    inside = f'<param name="pos_kp">1</param><param name="{word}">{value}</param>'
    with pytest.raises(simkit.LoadError, match=f"SK-PARAM-002: found '{value}'; expected a number"):
        opened(tmp_path, hardware(inside))


def test_a_joint_that_mimics_itself_has_no_leader(tmp_path: Path) -> None:
    with opened(tmp_path, hardware('<param name="mimic">j1</param>')) as sim:
        assert "joint 'j1' mimics 'j1'; the mimic is ignored" in reported_messages(sim, "SK-CONTROL-008")[0]
        command(sim, "arm_controller", 0.3, 0.1)
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.3, 0.1], abs=1e-3)


def test_one_of_two_joints_that_mimic_each_other_leads(tmp_path: Path) -> None:
    first, second = (f'<param name="mimic">{leader}</param>{interfaces(ALL)}' for leader in ("j2", "j1"))
    robot = arm(f'<joint name="j1">{first}</joint><joint name="j2">{second}</joint>')
    with opened(tmp_path, robot) as sim:
        assert (
            "joint 'j1' mimics 'j2' which mimics 'j1'; the mimic is ignored"
            in reported_messages(sim, "SK-CONTROL-008")[0]
        )
        command(sim, "arm_controller", 0.3, -1.0)
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.3, 0.3], abs=2e-3)


@pytest.mark.parametrize(
    ("inside", "near"),
    [
        ('<param name="pos_kpp">1</param>', "'pos_kp'"),
        ('<comand_interface name="x"/>', "'command_interface'"),
    ],
)
def test_a_misspelt_element_of_a_joint_is_a_warning(tmp_path: Path, inside: str, near: str) -> None:
    with opened(tmp_path, hardware(inside)) as sim:
        found = next(d for d in sim.diagnostics if d.code == "SK-CONTROL-008")
        assert "is not known and is ignored" in found.message
        assert found.hint == f"did you mean {near}?"


def test_parameters_of_another_driver_are_no_warning(tmp_path: Path) -> None:
    with opened(tmp_path, hardware('<param name="device_id">7</param>')) as sim:
        assert reported_messages(sim, "SK-CONTROL-008") == []


def test_a_misspelt_element_is_a_warning(tmp_path: Path) -> None:
    with opened(tmp_path, arm(f'<joint name="j1">{interfaces(ALL)}</joint>{OTHER}<sensr name="imu"/>')) as sim:
        assert "<sensr> is not known and is ignored" in reported_messages(sim, "SK-CONTROL-008")[0]
