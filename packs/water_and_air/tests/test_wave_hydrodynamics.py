"""Boats of asv_wave_sim in calm water."""

from __future__ import annotations

import pytest

import simkit

G, RHO = 9.8, 1025.0
SHAPES = {
    "box": ("<box><size>2 1 0.5</size></box>", 2.0),
    "cylinder": ("<cylinder><radius>0.5</radius><length>0.5</length></cylinder>", 0.7764571),  # area of 24 sides
}


def world(shape: str, mass: float, drag: str = "") -> str:
    return f"""<sdf version="1.9"><world name="sea"><gravity>0 0 {-G}</gravity>
      <physics name="p" type="ode"><max_step_size>0.005</max_step_size></physics><model name="raft">
      <link name="hull"><inertial><mass>{mass}</mass>
      <inertia><ixx>{mass}</ixx><iyy>{mass}</iyy><izz>{mass}</izz></inertia>
      </inertial><collision name="c"><geometry>{SHAPES[shape][0]}</geometry></collision></link>
      <plugin filename="gz-waves1-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics">
        <enable>raft::hull</enable><hydrodynamics>{drag}</hydrodynamics></plugin></model></world></sdf>"""


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES)
def test_a_raft_floats_at_the_draught_of_archimedes(shape: str) -> None:
    mass, area = 200.0, SHAPES[shape][1]
    with simkit.load(world(shape, mass, "<cDampL1>400</cDampL1><cDampR1>400</cDampR1>")) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        sim.run(15.0)
        hull = sim.link("raft::hull")
        assert 0.25 - hull.pose.position[2] == pytest.approx(mass / (RHO * area), rel=1e-3)
        assert hull.pose.rpy == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


@pytest.mark.slow
def test_a_heeled_raft_comes_upright() -> None:
    with simkit.load(world("box", 200.0, "<cDampL1>400</cDampL1><cDampR1>400</cDampR1>")) as sim:
        sim.model("raft").set_pose(simkit.Pose.from_rpy(0, 0, 0.15, 0.2, 0.1, 0))
        sim.run(20.0)
        assert sim.link("raft::hull").pose.rpy[:2] == pytest.approx((0.0, 0.0), abs=1e-2)


@pytest.mark.slow
def test_drag_stops_a_raft() -> None:
    with simkit.load(world("box", 200.0)) as sim:
        hull = sim.link("raft::hull")
        sim.run(2.0)
        hull.set_velocity((2.0, 0.0, 0.0))
        sim.run(0.1)
        assert hull.linear_velocity[0] < 2.0
        sim.run(20.0)
        assert 0.0 <= hull.linear_velocity[0] < 0.5
