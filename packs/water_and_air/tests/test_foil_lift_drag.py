"""Sails and rudders: the coefficients at every angle, wind and still water, a boat that sails and steers."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit

MASS, AREA = 2.0, 0.5
FOIL = 'filename="libasv_sim2-foil-lift-drag-system.so" name="gz::sim::systems::FoilLiftDrag"'
SAIL = 'filename="libasv_sim2-sail-lift-drag-system.so" name="gz::sim::systems::SailLiftDrag"'
STALL, BEYOND = 1 / (2 * math.pi), -2 * math.pi / (math.pi**2 - 1)


def world(names: str = FOIL, parameters: str = "<cp>0 0 0</cp>", wind: str = "0 0 0") -> str:
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
      <wind><linear_velocity>{wind}</linear_velocity></wind>
      <model name="boat"><link name="foil"><inertial><mass>{MASS}</mass>
      <inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
      <plugin {names}><link_name>foil</link_name><area>{AREA}</area><fluid_density>1000</fluid_density>{parameters}
      </plugin></model></world></sdf>"""


def force(sim: simkit.Simulation, velocity: tuple[float, ...]) -> np.ndarray:
    sim.model("boat").set_velocity(velocity, (0, 0, 0))
    sim.step()
    return (sim.link("boat::foil").linear_velocity - velocity) * MASS / sim.timestep


@pytest.mark.parametrize("degrees", [-170, -120, -91, -45, -5, 0, 3, 9, 10, 30, 89, 91, 150, 179])
def test_lift_and_drag_at_every_angle_of_attack(degrees: float) -> None:
    angle, speed = math.radians(degrees), 0.3
    velocity = speed * math.cos(angle), 0.0, -speed * math.sin(angle)
    attack = abs(angle)
    front = attack if attack < math.pi / 2 else math.pi - attack
    lift = 2 * math.pi * front if front < STALL else 1 + BEYOND * (front - STALL)
    lift *= math.copysign(1, angle) * (1 if attack < math.pi / 2 else -1)
    drag = 2 / math.pi * front
    along, up = np.array((velocity[0], 0, velocity[2])) / speed, np.array((math.sin(angle), 0, math.cos(angle)))
    expected = 0.5 * 1000 * speed**2 * AREA * (lift * up - drag * along)
    with simkit.load(world()) as sim:
        np.testing.assert_allclose(force(sim, velocity), expected, rtol=1e-9, atol=1e-6)


def test_a_stream_along_the_span_has_no_effect_and_water_does_not_move_with_the_wind() -> None:
    with simkit.load(world()) as sim:
        assert not force(sim, (0, 3.0, 0)).any()
    with simkit.load(world(FOIL, wind="4 0 0")) as sim:
        assert not force(sim, (0, 0, 0)).any()
    with simkit.load(world(SAIL, "<cp>0 0 1</cp><upward>0 1 0</upward>", wind="-4 0 0")) as sim:
        assert np.abs(force(sim, (0, 0, 0))).max() < 1e-6  # straight from ahead
        sim.model("boat").set_pose(simkit.Pose.from_rpy(0, 0, 0, 0, 0, -0.1))
        pushed = force(sim, (0, 0, 0))
        attack = 0.1
        pressed = 0.5 * 1000 * 16 * AREA
        assert pushed[:2] == pytest.approx([-2 / math.pi * attack * pressed, -2 * math.pi * attack * pressed], rel=1e-6)


def test_a_rudder_turns_a_boat_at_the_rate_at_which_its_moment_balances_the_drag() -> None:
    # the moment of a small rudder angle δ at the distance d is ½ρv²·A·2π·δ_eff·d, with δ_eff = δ - r·d/v
    drag = """<plugin filename="libSimpleHydrodynamics.so" name="vrx::SimpleHydrodynamics"><link_name>hull</link_name>
      <xU>0</xU><yV>20000</yV><nR>300</nR></plugin>"""
    area, distance, speed, angle = 0.02, 1.0, 2.0, 0.08
    text = f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="boat">
      <link name="hull"><inertial><mass>100</mass><inertia><ixx>20</ixx><iyy>20</iyy><izz>20</izz></inertia></inertial>
      </link><link name="rudder"><pose>{-distance} 0 0 0 0 0</pose><inertial><mass>0.1</mass>
      <inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>
      <joint name="helm" type="revolute"><parent>hull</parent><child>rudder</child><axis><xyz>0 0 1</xyz></axis></joint>
      <plugin filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController">
        <joint_name>helm</joint_name><topic>helm</topic><p_gain>200</p_gain><d_gain>10</d_gain></plugin>{drag}
      <plugin {FOIL}><link_name>rudder</link_name><cp>0 0 0</cp><upward>0 1 0</upward><area>{area}</area>
        <cda>0</cda><fluid_density>1000</fluid_density></plugin></model></world></sdf>"""
    with simkit.load(text) as sim:
        sim.publish("/helm", {"data": angle})
        for _ in range(12):
            sim.run(0.1)
            hull = sim.link("boat::hull")
            heading = hull.pose.rpy[2]
            turning = hull.angular_velocity
            sim.model("boat").set_velocity((speed * math.cos(heading), speed * math.sin(heading), 0), turning)
        slope = 0.5 * 1000 * speed**2 * area * 2 * math.pi * distance
        rate = -slope * sim.joint("boat::helm").position / (300 + slope * distance / speed)
        assert hull.angular_velocity[2] == pytest.approx(rate, rel=0.05)
        assert rate < -0.03


@pytest.mark.parametrize(
    ("parameters", "code"),
    [("", "SK-PARAM-001"), ("<cp>0 0 0</cp><radial_symmetry>false</radial_symmetry>", "SK-PARAM-002")],
)
def test_wrong_parameters_are_errors(parameters: str, code: str) -> None:
    with pytest.raises(simkit.LoadError, match=code):
        simkit.load(world(FOIL, parameters))
