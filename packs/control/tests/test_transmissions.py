"""Transmissions: what actuators do, of what joints do, against the published laws."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from control_robots import POSITIONS, arm, command, interfaces, opened, reported_messages

from simkit.extend import Diagnostics
from simkit.scene.actuation import Transmission, TransmissionEnd
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT, POSITION, VELOCITY
from simkit_control.plugins.ros2_control.transmissions import transmission_laws

BOTH = "".join(f'<joint name="{j}">{interfaces(("position",))}</joint>' for j in ("j1", "j2"))


def law(kind: str, actuators: tuple[float, ...], joints: tuple[float, ...], offsets: tuple[float, ...]) -> Any:
    ends = tuple(TransmissionEnd(f"j{i}", n, o) for i, (n, o) in enumerate(zip(joints, offsets, strict=True)))
    motors = tuple(TransmissionEnd(f"m{i}", n) for i, n in enumerate(actuators))
    found = transmission_laws([Transmission("t", kind, kind, ends, motors)], ["j0", "j1"], Diagnostics())
    return found[0]


def test_a_simple_transmission_multiplies_position_minus_offset_and_divides_effort() -> None:
    made = law("simple", (1.0,), (50.0,), (0.2,))
    assert made.actuate(POSITION, np.array([0.7])) == pytest.approx([25.0])
    assert made.actuate(VELOCITY, np.array([0.1])) == pytest.approx([5.0])
    assert made.actuate(EFFORT, np.array([100.0])) == pytest.approx([2.0])


def test_a_differential_transmission_adds_and_subtracts() -> None:
    made = law("differential", (10.0, -10.0), (2.0, 3.0), (0.1, -0.1))
    x1, x2 = 0.5 - 0.1, 0.2 + 0.1
    assert made.actuate(POSITION, np.array([0.5, 0.2])) == pytest.approx(
        [10 * (2 * x1 + 3 * x2), -10 * (2 * x1 - 3 * x2)]
    )
    # τ_j1 = n_j1 (n_a1 τ_a1 + n_a2 τ_a2), τ_j2 = n_j2 (n_a1 τ_a1 − n_a2 τ_a2)
    t1, t2 = made.actuate(EFFORT, np.array([4.0, 9.0]))
    assert [2 * (10 * t1 - 10 * t2), 3 * (10 * t1 + 10 * t2)] == pytest.approx([4.0, 9.0])


def test_a_four_bar_linkage_moves_the_second_with_the_first() -> None:
    made = law("four_bar_linkage", (10.0, 20.0), (2.0, 3.0), (0.0, 0.0))
    assert made.actuate(POSITION, np.array([0.5, 0.2])) == pytest.approx([10.0, 20 * (0.5 + 3 * 0.2)])
    t1, t2 = made.actuate(EFFORT, np.array([4.0, 9.0]))
    assert [2 * 10 * t1, 3 * (20 * t2 - 2 * 10 * t1)] == pytest.approx([4.0, 9.0])


def test_transmissions_conserve_power() -> None:
    made = law("differential", (10.0, 20.0), (2.0, 3.0), (0.0, 0.0))
    rates, efforts = np.array([0.3, -0.7]), np.array([4.0, 9.0])
    assert made.actuate(VELOCITY, rates) @ made.actuate(EFFORT, efforts) == pytest.approx(rates @ efforts)


def test_actuators_are_state_interfaces_and_no_joints_of_joint_states(tmp_path: Path) -> None:
    gear = (
        '<transmission name="t"><plugin>transmission_interface/SimpleTransmission</plugin>'
        '<actuator name="motor" role="actuator1"/><joint name="j1" role="joint1">'
        "<mechanical_reduction>100</mechanical_reduction><offset>0.1</offset></joint></transmission>"
    )
    with opened(tmp_path, arm(BOTH + gear)) as sim:
        messages = sim.subscribe("/joint_states")
        command(sim, "arm_controller", 0.5, 0.0)
        sim.run(2.0)
        assert list(messages.messages[-1].name) == ["j1", "j2"]
        names = [i.name for i in sim.call("/controller_manager/list_hardware_interfaces").state_interfaces]
        assert names[-3:] == ["motor/position", "motor/velocity", "motor/effort"]
        host = next(p for p in sim.engine.structure.all_plugins() if hasattr(p, "manager"))
        host.hardware.set_read_interfaces(["motor/position", "motor/effort", "j1/effort"])
        host.hardware.read()
        states = host.hardware.states
        position, effort, of_joint = states.select(["motor/position", "motor/effort", "j1/effort"]).values
        assert position == pytest.approx(100 * (0.5 - 0.1), abs=0.01)
        assert effort == pytest.approx(of_joint / 100)


def test_an_invalid_transmission_is_a_warning(tmp_path: Path) -> None:
    wrong = (
        '<transmission name="t"><plugin>transmission_interface/DifferentialTransmission</plugin>'
        '<actuator name="m"/><joint name="j1"/></transmission>'
    )
    with opened(tmp_path, arm(BOTH + wrong), POSITIONS) as sim:
        assert "has 1 joint(s) and 1 actuator(s)" in reported_messages(sim, "SK-CONTROL-008")[0]
