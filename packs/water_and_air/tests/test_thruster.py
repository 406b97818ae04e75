"""Thrust, propeller speed, limits, dead band, battery and the coefficient of a thruster."""

from __future__ import annotations

import math

import pytest

import simkit

HULL, PROPELLER = 20.0, 0.1
PLUGIN = 'filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster"'
COMMAND = "/model/boat/joint/spin/cmd_thrust"


def world(parameters: str, more: str = "") -> str:
    return f"""<sdf version="1.9"><world name="sea"><gravity>0 0 0</gravity><model name="boat">
      <link name="hull"><inertial><mass>{HULL}</mass>
        <inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
      <link name="propeller"><pose>-0.5 0 0 0 0 0</pose><inertial><mass>{PROPELLER}</mass>
        <inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial></link>
      <joint name="spin" type="continuous"><parent>hull</parent><child>propeller</child>
        <axis><xyz>1 0 0</xyz></axis></joint>
      <plugin {PLUGIN}><joint_name>spin</joint_name>{parameters}</plugin>{more}</model></world></sdf>"""


FAST = "<velocity_control>true</velocity_control><propeller_diameter>0.2</propeller_diameter>"
FAST += "<thrust_coefficient>0.02</thrust_coefficient>"
SCALE = 1000 * 0.02 * 0.2**4


def command(sim: simkit.Simulation, value: float, topic: str = COMMAND) -> None:
    sim.publish(topic, {"data": value})


def test_a_thrust_accelerates_the_vehicle_and_turns_the_propeller() -> None:
    with simkit.load(world(FAST)) as sim:
        command(sim, 8.0)
        sim.run(1.0)
        assert sim.link("boat::hull").linear_velocity[0] == pytest.approx(8.0 / (HULL + PROPELLER), rel=2e-3)
        assert sim.joint("boat::spin").velocity == pytest.approx(math.sqrt(8.0 / SCALE), rel=1e-3)


def test_a_negative_coefficient_turns_the_propeller_the_other_way() -> None:
    with simkit.load(world(FAST.replace("0.02</thrust", "-0.02</thrust"))) as sim:
        command(sim, 8.0)
        sim.run(0.5)
        assert sim.link("boat::hull").linear_velocity[0] > 0
        assert sim.joint("boat::spin").velocity == pytest.approx(-math.sqrt(8.0 / SCALE), rel=1e-3)


def test_a_commanded_speed_gives_the_thrust() -> None:
    with simkit.load(world(FAST + "<use_angvel_cmd>true</use_angvel_cmd>")) as sim:
        thrusts = sim.subscribe("/model/boat/joint/spin/force", keep=1)
        command(sim, -20.0, "/model/boat/joint/spin/cmd_vel")
        sim.run(1.0)
        assert thrusts.messages[-1].data == pytest.approx(-SCALE * 400, rel=1e-9)
        assert sim.link("boat::hull").linear_velocity[0] == pytest.approx(-SCALE * 400 / (HULL + PROPELLER), rel=2e-3)


def test_the_pid_turns_the_propeller_without_velocity_control() -> None:
    slow = FAST.replace("<velocity_control>true", "<velocity_control>false") + "<p_gain>0.001</p_gain>"
    with simkit.load(world(slow)) as sim:
        speeds = sim.subscribe("/model/boat/joint/spin/ang_vel", keep=1)
        command(sim, 8.0)
        sim.run(2.0)
        assert speeds.messages[-1].data == pytest.approx(math.sqrt(8.0 / SCALE), abs=0.11)


def test_commands_stay_within_their_limits() -> None:
    with simkit.load(world(FAST + "<max_thrust_cmd>5</max_thrust_cmd><min_thrust_cmd>-1</min_thrust_cmd>")) as sim:
        command(sim, 80.0)
        sim.run(1.0)
        assert sim.link("boat::hull").linear_velocity[0] == pytest.approx(5.0 / (HULL + PROPELLER), rel=2e-3)
        command(sim, math.nan)
        sim.run(0.1)
        assert "SK-PLUGIN-041" in {found.code for found in sim.diagnostics}


def test_a_dead_band_stops_small_thrusts_until_it_is_disabled() -> None:
    with simkit.load(world(FAST + "<deadband>2</deadband>")) as sim:
        command(sim, 1.0)
        sim.run(0.5)
        assert sim.link("boat::hull").linear_velocity[0] == 0.0
        sim.publish("/model/boat/joint/spin/enable_deadband", {"data": False})
        sim.run(0.5)
        assert sim.link("boat::hull").linear_velocity[0] > 0.02


def test_a_topic_and_a_namespace_replace_the_default_topic() -> None:
    with simkit.load(world(FAST + "<namespace>fleet</namespace><topic>left/thrust</topic>")) as sim:
        command(sim, 8.0, "/fleet/left/thrust")
        sim.run(0.5)
        assert sim.link("boat::hull").linear_velocity[0] > 0.1


def test_the_coefficient_follows_the_speed_of_the_vehicle() -> None:
    alphas = "<velocity_control>true</velocity_control><propeller_diameter>0.2</propeller_diameter>" + (
        "<alpha_1>0.02</alpha_1><alpha_2>-0.01</alpha_2><wake_fraction>0.5</wake_fraction>"
    )
    with simkit.load(world(alphas)) as sim:
        command(sim, 8.0)
        sim.run(2.0)
        speed, turning = sim.link("boat::propeller").linear_velocity[0], sim.joint("boat::spin").velocity
        coefficient = 0.02 - 0.01 * 0.5 * speed / (turning * 0.2)
        assert turning == pytest.approx(math.sqrt(8.0 / (1000 * coefficient * 0.2**4)), rel=1e-3)
        assert coefficient < 0.0199


def test_an_empty_battery_stops_the_thruster() -> None:
    battery = """<plugin filename="gz-sim-linearbatteryplugin-system" name="gz::sim::systems::LinearBatteryPlugin">
      <battery_name>b</battery_name><voltage>12</voltage><open_circuit_voltage_constant_coef>12</open_circuit_voltage_constant_coef>
      <capacity>0.001</capacity><initial_charge>0.001</initial_charge><power_load>0.1</power_load>
      <start_draining>true</start_draining></plugin>"""
    with simkit.load(world(FAST + "<battery_name>b</battery_name><power_load>40</power_load>", battery)) as sim:
        command(sim, 8.0)
        sim.run(3.0)  # 0.001 A·h at 40 W / 12 V last 1.1 s
        before = sim.link("boat::hull").linear_velocity[0]
        sim.run(1.0)
        assert sim.link("boat::hull").linear_velocity[0] == pytest.approx(before, abs=1e-9)
        assert before < 8.0 / HULL * 2


@pytest.mark.parametrize(
    ("parameters", "code"),
    [
        ("<max_thrust_cmd>-5</max_thrust_cmd><min_thrust_cmd>5</min_thrust_cmd>", "SK-PARAM-002"),
        ("<propeller_diameter>0</propeller_diameter>", "SK-PARAM-002"),
        ("<power_load>5</power_load>", "SK-PARAM-001"),
    ],
)
def test_wrong_parameters_are_errors(parameters: str, code: str) -> None:
    with pytest.raises(simkit.InputError, match=code):
        simkit.load(world(parameters))
