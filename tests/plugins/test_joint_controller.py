"""Joints at a commanded velocity."""

from __future__ import annotations

import pytest

import simkit
from simkit.plugins.pid import Pid


def rotor(name: str, limit: str = "") -> str:
    return f"""<link name="{name}"><inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.2</izz></inertia>
    </inertial></link><joint name="j_{name}" type="revolute"><parent>world</parent><child>{name}</child><axis>
    <xyz>0 0 1</xyz>{limit}<dynamics><damping>0.05</damping></dynamics></axis></joint>"""


def load(parameters: str, limit: str = "") -> simkit.Simulation:
    text = f"""<sdf version="1.9"><world name="w"><model name="m">{rotor("a", limit)}{rotor("b")}
    <plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">{parameters}</plugin>
    </model></world></sdf>"""
    return simkit.load(text)


def test_a_velocity_is_reached_within_one_step_and_held() -> None:
    sim = load("<joint_name>j_a</joint_name><initial_velocity>5</initial_velocity>")
    sim.step()
    assert sim.joint("m::j_a").velocity == pytest.approx(5.0, abs=1e-6)
    sim.publish("/model/m/joint/j_a/cmd_vel", {"data": -2.0})
    sim.step(500)
    assert sim.joint("m::j_a").velocity == pytest.approx(-2.0, abs=1e-6)


def test_an_effort_limit_makes_it_take_its_time() -> None:
    limited = "<limit><effort>0.4</effort></limit>"
    sim = load("<joint_name>j_a</joint_name><initial_velocity>5</initial_velocity>", limited)
    sim.run(0.5)
    assert sim.joint("m::j_a").velocity == pytest.approx(0.4 / 0.2 * 0.5, rel=0.07)  # damping takes its part
    assert sim.joint("m::j_a").effort == pytest.approx(0.4)


def test_one_topic_commands_several_joints() -> None:
    sim = load("<joint_name>j_a</joint_name><joint_name>j_b</joint_name><sub_topic>both</sub_topic>")
    sim.publish("/model/m/both", {"data": 3.0})
    sim.step(5)
    assert [sim.joint(f"m::j_{n}").velocity for n in "ab"] == pytest.approx([3.0, 3.0], abs=1e-6)


def test_an_actuator_message_commands_by_number() -> None:
    sim = load(
        "<joint_name>j_a</joint_name><use_actuator_msg>true</use_actuator_msg><actuator_number>1</actuator_number>"
    )
    sim.publish("/actuators", {"velocity": [1.0, 4.0]})
    sim.step(2)
    assert sim.joint("m::j_a").velocity == pytest.approx(4.0, abs=1e-6)


def test_by_force_a_pid_brings_it_there_and_may_leave_out_braking() -> None:
    gains = "<use_force_commands>true</use_force_commands><p_gain>2</p_gain><i_gain>0.5</i_gain>"
    sim = load(f"<joint_name>j_a</joint_name>{gains}")
    sim.publish("/model/m/joint/j_a/cmd_vel", {"data": 4.0})
    sim.run(20.0)
    assert sim.joint("m::j_a").velocity == pytest.approx(4.0, abs=0.02)
    coasting = load(f"<joint_name>j_a</joint_name>{gains}<disable_braking>true</disable_braking>")
    coasting.joint("m::j_a").set_velocity(8.0)
    coasting.publish("/model/m/joint/j_a/cmd_vel", {"data": 1.0})
    coasting.run(1.0)
    assert coasting.joint("m::j_a").velocity == pytest.approx(8.0 * 0.7788, rel=0.01)  # damping alone: exp(-0.05 / 0.2)


def test_the_pid_is_that_of_gz() -> None:
    pid = Pid(2.0, 10.0, 0.1, 0.5, -0.5, 100.0, -100.0)
    # p = 2, i = 10 · 0.01, d = 0.1 · 1 / 0.01: the first call differentiates from zero
    assert pid.update(1.0, 0.01) == pytest.approx(-(2.0 + 0.1 + 10.0))
    assert pid.update(1.0, 0.01) == pytest.approx(-(2.0 + 0.2))
    for _ in range(100):
        pid.update(1.0, 0.01)
    assert pid.integral == 0.5
    assert pid.update(float("nan"), 0.01) == 0.0
