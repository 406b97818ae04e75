"""Joints at a commanded position."""

from __future__ import annotations

import math

import numpy as np
import pytest
from joint_worlds import INERTIA, codes, load, position, rotor

import simkit
from simkit import LoadError, SimulationDiverged

A, B = "<joint_name>j_a</joint_name>", "<joint_name>j_b</joint_name>"
CMD = "/model/m/joint/j_a/0/cmd_pos"
FAST = "<use_velocity_commands>true</use_velocity_commands>"


def expected_positions(
    steps: int, target: float, p: float, i: float, d: float, most: float, held: float
) -> list[float]:
    """Return the positions under gz-math's PID, integrated as the engine does; the first step has no command."""
    dt, q, v, last, integral, found = 0.001, 0.0, 0.0, 0.0, 0.0, []
    for k in range(steps):
        if k:
            error = q - target
            integral = min(held, max(-held, integral + i * dt * error))
            effort = -p * error - integral - d * (error - last) / dt
            last = error
            v += dt * min(most, max(-most, effort)) / INERTIA
        q += dt * v
        found.append(q)
    return found


@pytest.mark.parametrize(
    ("numbers", "elements"),
    [
        ((1.0, 0.1, 0.01, 1000.0, 1.0), ""),
        ((20.0, 5.0, 2.0, 3.0, 0.2), "<p_gain>20</p_gain><i_gain>5</i_gain><d_gain>2</d_gain><i_max>0.2</i_max>"
         "<i_min>-0.2</i_min><cmd_max>3</cmd_max><cmd_min>-3</cmd_min>"),
    ],
)  # fmt: skip
def test_the_joint_follows_the_formula_of_gazebos_pid(numbers: tuple[float, ...], elements: str) -> None:
    sim = load(rotor("a"), position(f"{A}{elements}<initial_position>0.8</initial_position>"))
    found = []
    for _ in range(1500):
        sim.step()
        found.append(sim.joint("m::j_a").position)
    np.testing.assert_allclose(found, expected_positions(1500, 0.8, *numbers), atol=1e-9)


def test_an_offset_carries_a_hanging_load() -> None:
    # a pendulum of 1 kg at 0.5 m, held level
    arm = """<link name="a"><pose>0.5 0 0 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy>
    <izz>0.01</izz></inertia></inertial></link><joint name="j_a" type="revolute"><pose>-0.5 0 0 0 0 0</pose>
    <parent>world</parent><child>a</child><axis><xyz>0 -1 0</xyz></axis></joint>"""
    torque = 9.81 * 0.5
    gains = f"<p_gain>50</p_gain><i_gain>0</i_gain><d_gain>5</d_gain><cmd_offset>{torque}</cmd_offset>"
    sim = load(arm, position(f"{A}{gains}"), gravity="0 0 -9.81")
    sim.run(2.0)
    assert sim.joint("m::j_a").position == pytest.approx(0.0, abs=1e-4)
    assert sim.joint("m::j_a").effort == pytest.approx(torque, rel=1e-3)


def test_the_first_joints_error_pushes_all() -> None:
    sim = load(rotor("a"), rotor("b", inertia=0.4), position(f"{A}{B}<sub_topic>grip</sub_topic><p_gain>3</p_gain>"))
    sim.publish("/model/m/grip", {"data": 1.0})
    sim.step(300)
    a, b = (sim.joint(f"m::j_{n}") for n in "ab")
    assert a.position == pytest.approx(2.0 * b.position, rel=1e-9)


def test_with_velocity_commands_the_position_is_reached_within_one_step() -> None:
    sim = load(rotor("a"), position(f"{A}{FAST}<initial_position>-2</initial_position>"))
    sim.step(2)
    assert sim.joint("m::j_a").position == pytest.approx(-2.0, abs=1e-4)
    sim.publish(CMD, {"data": 2.0})
    sim.step(2)
    assert sim.joint("m::j_a").position == pytest.approx(2.0, abs=1e-4)
    assert sim.joint("m::j_a").velocity == pytest.approx(0.0, abs=1e-2)


def test_with_velocity_commands_the_speed_is_limited() -> None:
    sim = load(rotor("a"), position(f"{A}{FAST}<cmd_max>4</cmd_max>"))
    sim.step()
    sim.publish(CMD, {"data": 1.0})
    sim.run(0.2)
    assert sim.joint("m::j_a").position == pytest.approx(0.8, abs=1e-4)
    sim.run(0.1)
    assert sim.joint("m::j_a").position == pytest.approx(1.0, abs=1e-4)
    node = "/model/m/joint/j_a/position_controller"
    sim.set_parameter(node, "cmd_max", 0.5)
    sim.publish(CMD, {"data": 0.0})
    sim.run(1.0)
    assert sim.joint("m::j_a").position == pytest.approx(0.5, abs=1e-3)


def test_a_slider_reaches_a_length() -> None:
    sim = load(rotor("a", kind="prismatic"), position(f"{A}<p_gain>100</p_gain><d_gain>20</d_gain>"), gravity="0 0 -2")
    sim.publish(CMD, {"data": 0.3})
    sim.run(3.0)
    # the integral is at most 1 N of the 2 N that it weighs
    assert sim.joint("m::j_a").position == pytest.approx(0.3 - (2.0 - sim_integral(3.0)) / 100.0, abs=2e-3)


def sim_integral(seconds: float) -> float:
    """Return the approximate integral term for a gain of 0.1 and an error of 0.02 m."""
    return 0.1 * 0.02 * seconds


def test_joint_index_is_the_axis_of_a_joint_with_two() -> None:
    joint = """<link name="a"><inertial><mass>1</mass><inertia><ixx>0.2</ixx><iyy>0.2</iyy><izz>0.2</izz></inertia>
    </inertial></link><joint name="j_a" type="universal"><parent>world</parent><child>a</child><axis><xyz>1 0 0</xyz>
    </axis><axis2><xyz>0 1 0</xyz></axis2></joint>"""
    gains = "<p_gain>10</p_gain><d_gain>3</d_gain><i_gain>0</i_gain>"
    controllers = [position(f"{A}<joint_index>{k}</joint_index>{gains}") for k in (0, 1)]
    sim = load(joint, *controllers)
    sim.publish("/model/m/joint/j_a/1/cmd_pos", {"data": 0.4})
    sim.run(3.0)
    assert sim.joint("m::j_a").position == pytest.approx([0.0, 0.4], abs=2e-3)
    node = "/model/m/joint/j_a/position_controller"
    assert list(sim.communication.parameters) == [node, f"{node}_1"]
    with pytest.raises(LoadError, match="universal and has 2 axes; the plugin needs a joint with axis number 2"):
        load(joint, position(f"{A}<joint_index>2</joint_index>"))


def test_a_scoped_name_is_that_of_a_nested_joint() -> None:
    nested = f'<model name="in">{rotor("a")}</model>'
    sim = load(rotor("a"), nested, position("<joint_name>in::j_a</joint_name><p_gain>5</p_gain>"))
    sim.publish("/model/m/joint/in::j_a/0/cmd_pos", {"data": 1.0})
    sim.run(0.1)
    assert sim.joint("m::in::j_a").position > 0.05
    assert sim.joint("m::j_a").position == 0.0


def test_an_actuator_message_commands_by_number() -> None:
    number = "<use_actuator_msg>true</use_actuator_msg><actuator_number>1</actuator_number>"
    sim = load(rotor("a"), position(f"{A}{FAST}{number}"))
    sim.publish("/actuators", {"position": [0.0, 0.7]})
    sim.step(3)
    assert sim.joint("m::j_a").position == pytest.approx(0.7, abs=1e-4)


def test_gains_without_effect_under_velocity_commands_are_reported() -> None:
    sim = load(rotor("a"), position(f"{A}{FAST}<p_gain>2</p_gain><cmd_max>3</cmd_max>"))
    (message,) = codes(sim.diagnostics, "SK-PLUGIN-043")
    assert message.endswith("<p_gain> has no effect with <use_velocity_commands>")
    with pytest.raises(LoadError, match="at least 0"):
        load(rotor("a"), position(f"{A}{FAST}<cmd_max>-3</cmd_max>"))


def test_each_controller_of_a_model_has_its_parameters() -> None:
    parts = [rotor(n) for n in "abc"]
    names = [position(f"<joint_name>j_{n}</joint_name>", name="lift" if n == "c" else "") for n in "abc"]
    sim = load(*parts, *names)
    assert list(sim.communication.parameters) == [
        "/lift", "/model/m/joint/j_a/position_controller", "/model/m/joint/j_b/position_controller",
    ]  # fmt: skip
    assert {n: sim.communication.parameters["/lift"][n].value for n in ("p_gain", "i_gain", "d_gain", "cmd_max")} == {
        "p_gain": 1.0, "i_gain": 0.1, "d_gain": 0.01, "cmd_max": 1000.0,
    }  # fmt: skip


def test_a_larger_live_gain_makes_the_joint_faster() -> None:
    def rise(gain: float | None) -> float:
        sim = load(rotor("a", damping=0.5), position(f"{A}<i_gain>0</i_gain><d_gain>0</d_gain>", name="pid"))
        if gain is not None:
            sim.set_parameter("/pid", "p_gain", gain)
        sim.publish(CMD, {"data": 1.0})
        sim.run(0.3)
        return float(sim.joint("m::j_a").position)

    # I q'' + c q' + p (q - 1) = 0
    def answer(p: float) -> float:
        a, t = 0.5 / (2 * INERTIA), 0.299
        w = math.sqrt(p / INERTIA - a * a)
        return 1.0 - math.exp(-a * t) * (math.cos(w * t) + a / w * math.sin(w * t))

    assert rise(None) == pytest.approx(answer(1.0), abs=2e-3)
    assert rise(8.0) == pytest.approx(answer(8.0), abs=6e-3)


# ---------------------------------------------------------------------- unstable PID


def test_an_unstable_pid_is_reported_once_with_plugin_and_joint() -> None:
    sim = load(rotor("a"), position(f"{A}<p_gain>1e6</p_gain><initial_position>1</initial_position>", name="elbow"))
    sim.run(1.0)
    (message,) = codes(sim.diagnostics, "SK-PLUGIN-040")
    assert "plugin 'elbow'" in message and "joint 'm::j_a'" in message and "p_gain 1e+06" in message
    sim.reset()
    sim.run(1.0)
    assert len(codes(sim.diagnostics, "SK-PLUGIN-040")) == 1


@pytest.mark.parametrize("gains", ["<p_gain>20</p_gain>", "<p_gain>5</p_gain><d_gain>1</d_gain>"])
def test_a_pid_that_oscillates_and_settles_is_not_reported(gains: str) -> None:
    sim = load(rotor("a", damping=0.05), position(f"{A}{gains}<initial_position>1</initial_position>"))
    sim.run(8.0)
    assert not codes(sim.diagnostics, "SK-PLUGIN-040")


def test_a_divergence_message_names_the_plugin_of_the_joint() -> None:
    wild = "<p_gain>1e9</p_gain><cmd_max>1e30</cmd_max><cmd_min>-1e30</cmd_min><initial_position>1</initial_position>"
    sim = load(rotor("a"), rotor("b"), position(f"{A}{wild}", name="elbow"), position(B, name="wrist"))
    with pytest.raises(SimulationDiverged, match="plugin 'elbow' .* drives joint 'm::j_a' by a PID") as caught:
        sim.run(1.0)
    assert "wrist" not in str(caught.value)
    assert "p_gain 1e+09" in caught.value.hint


def test_gz_worlds_of_the_ignition_time_load_unchanged() -> None:
    plugin = (
        '<plugin filename="ignition-gazebo-joint-position-controller-system" '
        f'name="ignition::gazebo::systems::JointPositionController">{A}</plugin>'
    )
    sim: simkit.Simulation = load(rotor("a"), plugin)
    assert CMD in sim.topics()


def test_errors_do_not_hide_each_other() -> None:
    text = """<sdf version="1.9"><world name="w"><model name="m"><link name="l"/><link name="k"/>
      <joint name="j" type="revolute"><parent>l</parent><child>k</child><axis/></joint>
      <plugin filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController">
        <joint_name>jj</joint_name><i_gain>many</i_gain></plugin>
      <plugin filename="gz-sim-joint-state-publisher-system" name="gz::sim::systems::JointStatePublisher">
        <topik>/joints</topik></plugin></model></world></sdf>"""
    found = [(d.code, d.severity) for d in simkit.check(text) if d.severity != "note"]
    assert sorted(found) == [("SK-PARAM-002", "error"), ("SK-PARAM-003", "warning"), ("SK-PLUGIN-003", "error")]
