"""Gravity compensation: a compensated arm holds its position, and a spring arm yields and returns."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from control_robots import arm, interfaces, opened, reported_messages, states

import simkit

BOTH = "".join(f'<joint name="{j}">{interfaces(("position", "effort"))}</joint>' for j in ("j1", "j2"))
YAML = """
controller_manager:
  ros__parameters:
    update_rate: 200
    arm_controller: {type: position_controllers/JointGroupPositionController}
    weightless: {type: pal_controllers/GravityCompensationController}
    springy: {type: impedance_controllers/JointTrajectoryController}
arm_controller:
  ros__parameters: {joints: [j1, j2]}
weightless:
  ros__parameters:
    command_joints: [j1, j2]
    reduction_ratios: [100.0, 100.0]
    motor_torque_constants: [0.1, -0.1]
    torque_gain: 1.0
springy:
  ros__parameters:
    joints: [j1, j2]
    impedance_gains:
      j1: {kp: 0.5, kd: 0.05}
      j2: {kp: -0.5, kd: -0.05}
    motor_params:
      j1: {reduction_ratio: 100.0}
      j2: {reduction_ratio: 100.0}
"""


def switched(sim: simkit.Simulation, on: str, off: str) -> None:
    """Deactivate one controller and activate another."""
    assert sim.call(
        "/controller_manager/switch_controller",
        {"activate_controllers": [on], "deactivate_controllers": [off], "strictness": 2},
    ).ok


def held_out(folder: Path, yaml: str = YAML, losses: str = "") -> simkit.Simulation:
    """Return the arm at a pose where its weight acts on both joints."""
    dynamics = losses or '<dynamics damping="0.5" friction="0"/>'
    robot = arm(BOTH, second=dynamics).replace('velocity="3"/>\n</joint>', f'velocity="3"/>{dynamics}</joint>', 1)
    sim = opened(folder, robot, yaml)
    sim.publish("/arm_controller/commands", simkit.msgs.make("std_msgs/msg/Float64MultiArray", data=[0.7, 0.5]))
    sim.run(2.0)
    return sim


def at(sim: simkit.Simulation) -> np.ndarray:
    """Return the positions of the joints [rad]."""
    return np.array([sim.joint("arm::j1").position, sim.joint("arm::j2").position])


def test_other_controllers_claim_the_joints_first(tmp_path: Path) -> None:
    sim = held_out(tmp_path)
    assert states(sim) == {"arm_controller": "active", "weightless": "inactive", "springy": "inactive"}


def test_a_compensated_arm_holds_and_a_push_moves_it_freely(tmp_path: Path) -> None:
    sim = held_out(tmp_path)
    before = at(sim)
    switched(sim, "weightless", "arm_controller")
    sim.run(5.0)
    assert at(sim) == pytest.approx(before, abs=2e-3)
    for _ in range(200):
        sim.joint("arm::j2").set_effort(1.0)
        sim.step()
    assert at(sim)[1] - before[1] > 0.01


def test_without_compensation_the_same_arm_falls(tmp_path: Path) -> None:
    sim = held_out(tmp_path, YAML.replace("torque_gain: 1.0", "control_type: [ZERO_TORQUE, ZERO_TORQUE]"))
    before = at(sim)
    switched(sim, "weightless", "arm_controller")
    sim.run(1.0)
    assert np.abs(at(sim) - before).max() > 0.3


def test_dry_friction_is_compensated_in_motion(tmp_path: Path) -> None:
    sim = held_out(tmp_path, YAML.replace("torque_gain: 1.0", "viscous_frictions: [0.5, 0.5]"))
    switched(sim, "weightless", "arm_controller")
    sim.joint("arm::j2").set_velocity(0.3)
    sim.run(1.0)
    assert sim.joint("arm::j2").velocity > 0.2  # without, 0.5 N·m·s/rad would have stopped it


def test_a_wrong_number_of_control_types_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(simkit.LoadError, match="SK-CONTROL-050"):
        held_out(tmp_path, YAML.replace("torque_gain: 1.0", "control_type: [COMMAND]"))


def test_a_spring_arm_yields_by_effort_over_stiffness_and_returns(tmp_path: Path) -> None:
    sim = held_out(tmp_path)
    before = at(sim)
    switched(sim, "springy", "arm_controller")
    sim.run(2.0)
    assert at(sim) == pytest.approx(before, abs=5e-3)
    for _ in range(3000):
        sim.joint("arm::j2").set_effort(2.0)
        sim.step()
    # 50 N·m/rad
    assert at(sim)[1] - before[1] == pytest.approx(2.0 / 50.0, rel=0.1)
    sim.run(3.0)
    assert at(sim) == pytest.approx(before, abs=5e-3)
    assert not reported_messages(sim, "SK-CONTROL-011")


def test_a_spring_arm_follows_a_trajectory(tmp_path: Path) -> None:
    sim = held_out(tmp_path)
    switched(sim, "springy", "arm_controller")
    point = {"positions": [0.2, 0.9], "velocities": [0.0, 0.0], "time_from_start": {"sec": 2, "nanosec": 0}}
    goal = sim.send_goal(
        "/springy/follow_joint_trajectory", {"trajectory": {"joint_names": ["j1", "j2"], "points": [point]}}
    )
    sim.run(4.0)
    assert goal.result.error_code == 0
    assert at(sim) == pytest.approx([0.2, 0.9], abs=5e-3)
