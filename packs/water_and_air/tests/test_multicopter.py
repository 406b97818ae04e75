"""Quadrotor: thrust balance, the rotor's time constants, drag, and the velocity controller."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit

THRUST, MOMENT = 8.5e-6, 0.016
BASE, ROTOR = 1.5, 0.005
MASS = BASE + 4 * ROTOR
G = 9.8
HOVER = math.sqrt(MASS * G / (4 * THRUST))
PLACES = ((0.2, -0.2, "ccw"), (-0.2, 0.2, "ccw"), (0.2, 0.2, "cw"), (-0.2, -0.2, "cw"))
MOTOR = 'filename="gz-sim-multicopter-motor-model-system" name="gz::sim::systems::MulticopterMotorModel"'
CONTROL = 'filename="gz-sim-multicopter-control-system" name="gz::sim::systems::MulticopterVelocityControl"'


def rotor(number: int, more: str) -> str:
    x, y, way = PLACES[number]
    return f"""<link name="r{number}"><pose>{x} {y} 0 0 0 0</pose><inertial><mass>{ROTOR}</mass>
      <inertia><ixx>1e-5</ixx><iyy>1e-5</iyy><izz>2e-5</izz></inertia></inertial></link>
    <joint name="j{number}" type="continuous"><parent>base</parent><child>r{number}</child>
      <axis><xyz>0 0 1</xyz></axis></joint>
    <plugin {MOTOR}><jointName>j{number}</jointName><linkName>r{number}</linkName><motorNumber>{number}</motorNumber>
      <turningDirection>{way}</turningDirection><motorConstant>{THRUST}</motorConstant>
      <momentConstant>{MOMENT}</momentConstant>{more}</plugin>"""


def controller(more: str = "", rotors: int = 4) -> str:
    listed = "".join(
        f"<rotor><jointName>j{i}</jointName><forceConstant>{THRUST}</forceConstant><momentConstant>{MOMENT}</momentConstant>"
        f"<direction>{1 if PLACES[i][2] == 'ccw' else -1}</direction></rotor>"
        for i in range(rotors)
    )
    return f"""<plugin {CONTROL}><robotNamespace>quad</robotNamespace><comLinkName>base</comLinkName>
      <velocityGain>2.7 2.7 2.7</velocityGain><attitudeGain>2 3 0.15</attitudeGain>
      <angularRateGain>0.4 0.52 0.18</angularRateGain><maximumLinearAcceleration>2 2 2</maximumLinearAcceleration>
      <rotorConfiguration>{listed}</rotorConfiguration>{more}</plugin>"""


def world(plugins: str = "", rotors: str = "", wind: str = "0 0 0", gravity: float = -G) -> str:
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 {gravity}</gravity>
      <physics name="p" type="ode"><max_step_size>0.002</max_step_size></physics>
      <wind><linear_velocity>{wind}</linear_velocity></wind><model name="quad"><pose>0 0 5 0 0 0</pose>
      <link name="base"><inertial><mass>{BASE}</mass>
        <inertia><ixx>0.03</ixx><iyy>0.05</iyy><izz>0.08</izz></inertia></inertial></link>
      {"".join(rotor(i, rotors) for i in range(4))}{plugins}</model></world></sdf>"""


NO_DRAG = "<rotorDragCoefficient>0</rotorDragCoefficient><rollingMomentCoefficient>0</rollingMomentCoefficient>"


def turn(sim: simkit.Simulation, *speeds: float) -> None:
    sim.publish("/quad/command/motor_speed", {"velocity": list(speeds)})


def fly(sim: simkit.Simulation, x: float = 0.0, y: float = 0.0, z: float = 0.0, yaw: float = 0.0) -> None:
    sim.publish("/quad/cmd_vel", {"linear": {"x": x, "y": y, "z": z}, "angular": {"x": 0.0, "y": 0.0, "z": yaw}})


def test_at_the_speed_that_balances_the_weight_the_vehicle_accelerates_no_more() -> None:
    with simkit.load(world(rotors=NO_DRAG)) as sim:
        turn(sim, *[HOVER] * 4)
        sim.run(0.5)
        before = sim.link("quad::base").linear_velocity[2]
        sim.run(1.0)
        assert sim.link("quad::base").linear_velocity[2] == pytest.approx(before, abs=1e-3)
        assert np.abs(sim.link("quad::base").angular_velocity).max() < 1e-9


def test_a_rotor_follows_its_command_with_two_time_constants() -> None:
    slow = NO_DRAG + "<timeConstantUp>0.1</timeConstantUp><timeConstantDown>0.2</timeConstantDown>"
    with simkit.load(world(rotors=slow)) as sim:
        turn(sim, 100, 100, 100, 100)
        sim.run(0.1)
        assert sim.joint("quad::j0").velocity == pytest.approx(10 * (1 - math.exp(-1)), rel=0.02)
        assert sim.joint("quad::j2").velocity == pytest.approx(-10 * (1 - math.exp(-1)), rel=0.02)
        sim.run(1.0)
        assert sim.joint("quad::j0").velocity == pytest.approx(10, rel=1e-3)
        turn(sim, 0, 0, 0, 0)
        sim.run(0.2)
        assert sim.joint("quad::j0").velocity == pytest.approx(10 * math.exp(-1), rel=0.02)


def test_rotors_of_one_direction_turn_the_vehicle_by_their_torque() -> None:
    speed, time = 200.0, 1.0
    with simkit.load(world(rotors=NO_DRAG, gravity=0)) as sim:
        turn(sim, speed, speed, 0, 0)
        sim.run(1.0)
        before = sim.link("quad::base").angular_velocity[2]
        sim.run(time)
        torque = -2 * THRUST * speed**2 * MOMENT
        inertia = 0.08 + 4 * ROTOR * (0.2**2 + 0.2**2)  # rotors at a steady speed move with the vehicle
        gained = sim.link("quad::base").angular_velocity[2] - before
        assert gained == pytest.approx(torque * time / inertia, rel=0.01)


def test_wind_drags_the_rotors_along() -> None:
    drag, speed = 1e-4, 100.0
    with simkit.load(
        world(rotors=f"<rotorDragCoefficient>{drag}</rotorDragCoefficient>", wind="2 0 0", gravity=0)
    ) as sim:
        turn(sim, *[speed] * 4)
        sim.run(1.0)
        start = sim.link("quad::base").linear_velocity[0]
        sim.run(0.1)
        gained = sim.link("quad::base").linear_velocity[0] - start
        assert gained == pytest.approx(4 * drag * speed * (2 - start) * 0.1 / MASS, rel=0.01)


@pytest.mark.slow
def test_the_controller_reaches_velocity_and_turning_rate() -> None:
    with simkit.load(world(controller(), NO_DRAG)) as sim:
        base = sim.link("quad::base")
        fly(sim, z=0.5)
        sim.run(3.5)
        assert base.linear_velocity == pytest.approx([0, 0, 0.5], abs=2e-3)
        fly(sim, x=1.0)
        sim.run(6.0)
        assert base.linear_velocity == pytest.approx([1, 0, 0], abs=0.01)
        fly(sim, yaw=0.5)
        sim.run(6.0)
        assert base.angular_velocity == pytest.approx([0, 0, 0.5], abs=0.01)
        assert base.linear_velocity == pytest.approx([0, 0, 0], abs=0.02)


def test_the_climb_follows_the_analytic_response() -> None:
    # m dv/dt = gain (target - v), from the moment at which the error is below maximumLinearAcceleration
    fast = NO_DRAG + "<timeConstantUp>0</timeConstantUp><timeConstantDown>0</timeConstantDown>"
    with simkit.load(world(controller(), fast)) as sim:
        fly(sim)
        sim.run(3.0)
        fly(sim, z=0.5)
        sim.run(1.0)
        assert sim.link("quad::base").linear_velocity[2] == pytest.approx(0.5 * (1 - math.exp(-2.7 / MASS)), rel=0.02)


def test_a_disabled_controller_stops_the_rotors_and_waits_for_a_new_command() -> None:
    with simkit.load(world(controller(), NO_DRAG)) as sim:
        fly(sim)
        sim.run(2.0)
        assert sim.joint("quad::j0").velocity == pytest.approx(HOVER / 10, rel=0.01)
        sim.publish("/quad/enable", {"data": False})
        sim.run(1.0)
        assert sim.joint("quad::j0").velocity == pytest.approx(0, abs=1e-6)
        sim.publish("/quad/enable", {"data": True})
        sim.run(0.5)
        assert sim.joint("quad::j0").velocity == pytest.approx(0, abs=1e-6)
        fly(sim)
        sim.run(0.5)
        assert sim.joint("quad::j0").velocity > 1


@pytest.mark.slow
def test_commands_stay_within_their_limits_and_nan_is_ignored() -> None:
    limits = "<maximumLinearVelocity>0.3 0.3 0.3</maximumLinearVelocity>"
    limits += "<maximumAngularVelocity>1 1 0.2</maximumAngularVelocity>"
    with simkit.load(world(controller(limits), NO_DRAG)) as sim:
        fly(sim, z=5.0, yaw=-5.0)
        sim.run(5.0)
        fly(sim, z=math.nan)
        sim.run(1.0)
        assert sim.link("quad::base").linear_velocity[2] == pytest.approx(0.3, abs=0.005)
        assert sim.link("quad::base").angular_velocity[2] == pytest.approx(-0.2, abs=0.005)
        assert "SK-PLUGIN-041" in {found.code for found in sim.diagnostics}


def test_noise_of_the_estimates_is_the_same_for_one_seed() -> None:
    noise = "<linearVelocityNoiseStdDev>0.05 0.05 0.05</linearVelocityNoiseStdDev>"

    def height(seed: int) -> float:
        with simkit.load(world(controller(noise), NO_DRAG), seed=seed) as sim:
            fly(sim)
            sim.run(1.0)
            return float(sim.model("quad").pose.position[2])

    assert height(1) == height(1) != height(2)


def test_rotors_of_a_vehicle_of_25_grams_can_fly() -> None:
    """The largest torque of such a rotor at 1 rad/s is 4e-10 N·m."""
    text = world(controller()).replace(str(THRUST), "1.3e-08").replace("0.2 ", "0.03 ")
    with simkit.load(text) as sim:
        assert not [found for found in sim.diagnostics if found.severity == "error"]


def test_three_rotors_cannot_fly_and_this_is_an_error() -> None:
    with pytest.raises(simkit.InputError, match="SK-PLUGIN-116: .* 3 rotors"):
        simkit.load(world(controller(rotors=3)))


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("<motorNumber>0</motorNumber>", "", "SK-PARAM-001"),
        ("<turningDirection>ccw</turningDirection>", "<turningDirection>left</turningDirection>", "SK-PARAM-002"),
        ("<jointName>j0</jointName>", "<jointName>none</jointName>", "SK-PLUGIN-003"),
        ("<comLinkName>base</comLinkName>", "", "SK-PARAM-001"),
    ],
)
def test_a_wrong_parameter_is_an_error(old: str, new: str, code: str) -> None:
    with pytest.raises(simkit.InputError, match=code):
        simkit.load(world(controller()).replace(old, new, 1))


def test_a_short_message_is_ignored_with_a_warning() -> None:
    with simkit.load(world()) as sim:
        turn(sim, 100, 100)
        sim.run(0.2)
        assert sim.joint("quad::j1").velocity > 5 and sim.joint("quad::j3").velocity == pytest.approx(0, abs=1e-6)
        assert sum(found.code == "SK-PLUGIN-041" for found in sim.diagnostics) == 2
