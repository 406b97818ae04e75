"""Bladder of a submarine: force, pump rate, limits and trim at a depth."""

from __future__ import annotations

import math

import pytest

import simkit

MASS, G, RHO, NEUTRAL = 50.0, 9.8, 1025.0, 5e-4
PLUGIN = 'filename="gz-sim-buoyancy-engine-system" name="gz::sim::systems::BuoyancyEngine"'
ENGINE = f"<fluid_density>{RHO}</fluid_density><neutral_volume>{NEUTRAL}</neutral_volume>"
COMMAND = "/buoyancy_engine"


def world(parameters: str, *, depth: float = 10.0, more: str = "") -> str:
    """Return a neutrally buoyant submarine: the box displaces its weight."""
    side = (MASS / RHO) ** (1 / 3)
    return f"""<sdf version="1.9"><world name="sea"><gravity>0 0 {-G}</gravity>
    <physics name="p" type="ode"><max_step_size>0.02</max_step_size></physics>
    <plugin filename="gz-sim-buoyancy-system" name="gz::sim::systems::Buoyancy">
      <uniform_fluid_density>{RHO}</uniform_fluid_density></plugin>
    <model name="sub"><pose>0 0 {-depth} 0 0 0</pose><link name="hull"><inertial><mass>{MASS}</mass>
      <inertia><ixx>2</ixx><iyy>2</iyy><izz>2</izz></inertia></inertial><collision name="c"><geometry><box>
      <size>{side} {side} {side}</size></box></geometry></collision></link>
    <plugin {PLUGIN}><link_name>hull</link_name>{parameters}</plugin>{more}</model></world></sdf>"""


def test_the_force_is_the_weight_of_the_water_that_the_bladder_displaces() -> None:
    with simkit.load(world(ENGINE + "<default_volume>7e-4</default_volume>")) as sim:
        sim.run(1.0)
        assert sim.link("sub::hull").linear_velocity[2] == pytest.approx(RHO * 2e-4 * G / MASS, rel=1e-6)


def test_the_pump_has_a_rate_and_the_volume_has_limits() -> None:
    rates = "<default_volume>5e-4</default_volume><max_inflation_rate>1e-4</max_inflation_rate>"
    with simkit.load(world(ENGINE + rates + "<namespace>sub</namespace><max_volume>8e-4</max_volume>")) as sim:
        volumes = sim.subscribe("/model/sub/buoyancy_engine/current_volume", keep=1)
        sim.publish("/model/sub/buoyancy_engine", {"data": 1.0})
        sim.run(1.0)
        assert volumes.messages[-1].data == pytest.approx(6e-4, rel=2e-3)
        sim.run(5.0)
        assert volumes.messages[-1].data == pytest.approx(8e-4)
        sim.publish("/model/sub/buoyancy_engine", {"data": -1.0})
        sim.run(10.0)
        assert volumes.messages[-1].data == pytest.approx(3e-5)
        sim.publish("/model/sub/buoyancy_engine", {"data": math.nan})
        sim.run(0.1)
        assert "SK-PLUGIN-041" in {found.code for found in sim.diagnostics}


@pytest.mark.slow
def test_a_submarine_rises_at_the_speed_that_its_drag_allows_and_trims() -> None:
    drag = """<plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics">
      <link_name>hull</link_name><zDotW>-40</zDotW><zWabsW>-60</zWabsW><zW>-20</zW></plugin>"""
    engine = ENGINE + "<default_volume>5e-4</default_volume><max_inflation_rate>1e-3</max_inflation_rate>"
    with simkit.load(world(engine, more=drag)) as sim:
        hull = sim.link("sub::hull")
        sim.run(1.0)
        assert hull.pose.position[2] == pytest.approx(-10.0, abs=1e-6)  # trimmed
        sim.publish(COMMAND, {"data": 7e-4})
        sim.run(20.0)
        force = RHO * 2e-4 * G
        speed = (-20 + math.sqrt(400 + 4 * 60 * force)) / 120  # 60·w² + 20·w = force
        assert hull.linear_velocity[2] == pytest.approx(speed, rel=3e-3)
        sim.publish(COMMAND, {"data": NEUTRAL})
        sim.run(40.0)
        assert abs(hull.linear_velocity[2]) < 1e-3  # it stays at its new depth


def test_above_the_surface_only_the_weight_of_the_oil_acts() -> None:
    parameters = ENGINE + "<default_volume>7e-4</default_volume><surface>-20</surface>"
    with simkit.load(world(parameters)) as sim:
        sim.run(1.0)
        assert sim.link("sub::hull").linear_velocity[2] == pytest.approx(-RHO * NEUTRAL * G / MASS, rel=1e-6)


def test_runs_after_a_restore_have_the_same_bits() -> None:
    with simkit.load(world(ENGINE)) as sim:
        sim.publish(COMMAND, {"data": 9e-4})
        sim.run(1.0)
        saved = sim.snapshot()
        ends = []
        for _ in range(2):
            sim.restore(saved)
            sim.run(1.0)
            ends.append(sim.link("sub::hull").pose.position.tolist())
        assert ends[0] == ends[1]


@pytest.mark.parametrize(
    ("bad", "code"),
    [
        ("<min_volume>2</min_volume><max_volume>1</max_volume>", "SK-PARAM-002"),
        ("<default_volume>-1</default_volume>", "SK-PARAM-002"),
    ],
)
def test_wrong_parameters_are_errors(bad: str, code: str) -> None:
    with pytest.raises(simkit.LoadError, match=code):
        simkit.load(world(bad))
