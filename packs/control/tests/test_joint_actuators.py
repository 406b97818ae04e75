"""Drives follow moving positions without a staircase, within their limits, at every pose and step."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from control_robots import arm, command, files, interfaces

import simkit

EFFORTS = """
controller_manager:
  ros__parameters:
    update_rate: 100
    pushed: {type: effort_controllers/JointGroupEffortController}
pushed:
  ros__parameters: {joints: [j1, j2]}
"""
SPEEDS = """
controller_manager:
  ros__parameters:
    update_rate: 100
    turned: {type: velocity_controllers/JointGroupVelocityController}
turned:
  ros__parameters: {joints: [j1]}
"""


def world(robot: Path, step: float) -> simkit.Simulation:
    """The robot alone, with a step of its own."""
    if step == 0.001:
        return simkit.load(robot)
    sim = simkit.load(
        f"""<sdf version="1.9"><world name="w"><physics type="ode"><max_step_size>{step}</max_step_size></physics>
        </world></sdf>"""
    )
    sim.spawn(robot, name="arm")
    return sim


def one(kind: str, *joints: str) -> str:
    """Hardware with one command interface for each joint."""
    return "".join(f'<joint name="{j}">{interfaces((kind,))}</joint>' for j in joints)


@pytest.mark.parametrize("step", [0.001, 0.002])
def test_a_commanded_sine_is_followed_to_a_thousandth_of_a_radian(tmp_path: Path, step: float) -> None:
    sim = world(files(tmp_path, arm()), step)
    joint = sim.joint("arm::j1")
    worst = 0.0

    def wanted(time: float) -> float:
        return 0.8 * (1.0 - math.cos(1.5 * time))

    for k in range(400):
        command(sim, "arm_controller", wanted((k + 1) * 0.01), 0.3)
        sim.run(0.01)
        if k > 100:  # j2 has arrived
            worst = max(worst, abs(joint.position - wanted((k + 1) * 0.01)))  # a command is for the end of its period
    assert worst < 1e-3


def test_an_arm_held_out_does_not_sag(tmp_path: Path) -> None:
    sim = world(files(tmp_path, arm()), 0.001)
    command(sim, "arm_controller", math.pi / 2, 0.0)
    sim.run(4.0)
    at = sim.joint("arm::j1").position
    assert at == pytest.approx(math.pi / 2, abs=1e-5)
    assert sim.joint("arm::j1").effort == pytest.approx(-2 * 9.8 * 0.5, rel=0.02)  # 1 kg at 0.25 m, 1 kg at 0.75 m
    sim.run(10.0)
    assert sim.joint("arm::j1").position == pytest.approx(at, abs=1e-6)


def test_a_command_far_away_is_approached_at_the_velocity_limit(tmp_path: Path) -> None:
    sim = world(files(tmp_path, arm()), 0.001)
    joint = sim.joint("arm::j2")
    command(sim, "arm_controller", 0.0, 1.8)
    fastest = 0.0
    for _ in range(100):
        sim.run(0.01)
        fastest = max(fastest, abs(joint.velocity))
    assert 2.9 < fastest < 3.15  # the limit is 3 rad/s
    assert joint.position == pytest.approx(1.8, abs=1e-4)


def test_a_commanded_position_beyond_the_limits_stops_at_the_limits(tmp_path: Path) -> None:
    sim = world(files(tmp_path, arm()), 0.001)
    command(sim, "arm_controller", 0.0, 5.0)
    sim.run(2.0)
    assert sim.joint("arm::j2").position == pytest.approx(2.0, abs=1e-3)


def test_the_effort_stays_within_its_limit(tmp_path: Path) -> None:
    weak = arm().replace('effort="40"', 'effort="6"')
    sim = world(files(tmp_path, weak), 0.001)
    command(sim, "arm_controller", math.pi / 2, 0.0)
    efforts = []
    for _ in range(300):
        sim.run(0.01)
        efforts.append(sim.joint("arm::j1").effort)
    assert max(map(abs, efforts)) <= 6.0 + 1e-9


def test_a_joints_own_damping_slows_no_position_drive_and_damps_an_effort(tmp_path: Path) -> None:
    thick = arm(second='<dynamics damping="30" friction="1"/>')
    sim = world(files(tmp_path, thick), 0.001)
    command(sim, "arm_controller", 0.0, 1.5)
    sim.run(0.7)  # 0.5 s at 3 rad/s, where 30 N·m·s/rad would take 90 N·m of the 40
    assert sim.joint("arm::j2").position == pytest.approx(1.5, abs=2e-3)
    pushed = arm(one("effort", "j1", "j2"), second='<dynamics damping="30" friction="1"/>')
    sim = world(files(tmp_path, pushed, EFFORTS), 0.001)
    command(sim, "pushed", 0.0, 10.0)
    sim.run(0.3)
    assert sim.joint("arm::j2").velocity == pytest.approx((10.0 - 1.0) / 30.0, rel=0.2)


@pytest.mark.parametrize("step", [0.001, 0.002])
def test_a_velocity_under_load_loses_no_angle(tmp_path: Path, step: float) -> None:
    sim = world(files(tmp_path, arm(one("velocity", "j1")), SPEEDS), step)
    sim.run(0.5)
    start = sim.joint("arm::j1").position
    command(sim, "turned", 0.4)
    sim.run(2.0)  # up against gravity
    command(sim, "turned", 0.0)
    sim.run(1.0)
    end = sim.joint("arm::j1").position
    # the command is taken up at the next update, and so is the end of it
    assert end - start == pytest.approx(0.8, abs=5e-3)
    sim.run(10.0)
    assert sim.joint("arm::j1").position == pytest.approx(end, abs=1e-5)


def test_a_joint_without_command_holds_and_does_not_jump_at_a_reset(tmp_path: Path) -> None:
    sim = world(files(tmp_path, arm()), 0.001)
    sim.run(0.5)
    assert sim.joint("arm::j1").position == pytest.approx(0.0, abs=1e-6)
    command(sim, "arm_controller", 1.0, 0.5)
    sim.run(1.5)
    sim.reset()
    sim.run(0.02)
    assert sim.joint("arm::j1").position == pytest.approx(0.0, abs=1e-6)


def test_a_restored_motion_continues_with_the_same_bits(tmp_path: Path) -> None:
    sim = world(files(tmp_path, arm()), 0.001)
    command(sim, "arm_controller", 1.0, 0.5)
    sim.run(0.1234)
    kept = sim.snapshot()
    sim.run(1.0)
    first = np.array(sim.mj_data.qpos)
    sim.restore(kept)
    sim.run(1.0)
    assert np.array_equal(first, sim.mj_data.qpos)


def test_observers_change_no_motion(tmp_path: Path) -> None:
    ends = []
    for looks in (False, True):
        sim = world(files(tmp_path, arm()), 0.001)
        command(sim, "arm_controller", 1.0, 0.5)
        for _ in range(70):
            sim.run(0.01)
            if looks:
                sim.engine.physics.fresh()
        ends.append(np.array(sim.mj_data.qpos))
    assert np.array_equal(*ends)


def test_a_spawned_robot_leaves_the_motion_of_another_as_it_is(tmp_path: Path) -> None:
    ends = []
    for spawns in (False, True):
        sim = world(files(tmp_path, arm()), 0.001)
        command(sim, "arm_controller", 1.0, 0.5)
        sim.run(0.2)
        if spawns:
            sim.spawn(
                '<sdf version="1.9"><model name="ball"><pose>5 0 1 0 0 0</pose><link name="l"/></model></sdf>',
                name="ball",
            )
        sim.run(1.0)
        ends.append(sim.joint("arm::j1").position)
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)


def test_a_displaced_joint_returns_at_its_velocity_limit(tmp_path: Path) -> None:
    sim = world(files(tmp_path, arm()), 0.001)
    sim.run(0.1)
    joint = sim.joint("arm::j2")
    joint.set_position(1.8)
    fastest = 0.0
    for _ in range(200):
        command(sim, "arm_controller", 0.0, 0.0)
        sim.run(0.01)
        fastest = max(fastest, abs(joint.velocity))
    assert fastest < 1.3 * 3.0
    assert joint.position == pytest.approx(0.0, abs=1e-4)
