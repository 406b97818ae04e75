"""Optical properties of surfaces are read from files, written back, changed by overrides and found by geom."""

from __future__ import annotations

import numpy as np
import pytest

import simkit
from simkit.scene import DEFAULT_REFLECTIVITY
from simkit.sensors.surface_optics import surface_optics

BOX = "<geometry><box><size>1 1 1</size></box></geometry>"
PAINT = "<simkit:reflectivity>0.1</simkit:reflectivity>"
GLASS = "<simkit:transmittance>0.8</simkit:transmittance><simkit:specularity>0.1</simkit:specularity>"
WORLD = f"""
<sdf version="1.9" xmlns:simkit="simkit"><world name="w"><model name="m"><static>true</static><link name="l">
  <collision name="dark">{BOX}{PAINT}</collision><collision name="plain">{BOX}</collision>
  <visual name="pane">{BOX}{GLASS}</visual></link></model></world></sdf>"""


def optics_by_name(sim: simkit.Simulation, *, of_visuals: bool) -> dict[str, tuple[float, ...]]:
    compiled = sim.engine.compiled
    table = surface_optics(compiled, of_visuals=of_visuals)
    link = compiled.names.link("m::l")
    geoms = link.visuals if of_visuals else link.ray_geoms
    return {compiled.names.geom_owner(geom)[1]: tuple(float(c[geom]) for c in table) for geom in geoms}


def test_collisions_and_visuals_have_their_own_optics_and_a_default() -> None:
    with simkit.load(WORLD) as sim:
        assert not sim.diagnostics
        collisions = optics_by_name(sim, of_visuals=False)
        assert collisions["m::l::dark"] == (0.1, 0.0, 0.0)
        assert collisions["m::l::plain"] == (DEFAULT_REFLECTIVITY, 0.0, 0.0)
        # a pane scatters the default share of what it neither transmits nor reflects
        pane = optics_by_name(sim, of_visuals=True)["m::l::pane"]
        assert pane == pytest.approx((DEFAULT_REFLECTIVITY * 0.1, 0.8, 0.1))


def test_no_geom_has_no_optics() -> None:
    with simkit.load(WORLD) as sim:
        assert np.array([c[-1] for c in surface_optics(sim.engine.compiled, of_visuals=False)]).tolist() == [0, 0, 0]


def test_an_override_sets_the_optics() -> None:
    with simkit.load(WORLD, overrides=["m::l::plain.reflectivity=0.9", "m::l::pane.transmittance=0.5"]) as sim:
        assert optics_by_name(sim, of_visuals=False)["m::l::plain"][0] == 0.9
        assert optics_by_name(sim, of_visuals=True)["m::l::pane"][1] == 0.5


def test_a_urdf_file_gives_optics_in_its_gazebo_block() -> None:
    robot = f"""<robot name="m"><link name="l"><collision name="c"><geometry><sphere radius="1"/></geometry></collision>
    </link><gazebo reference="l"><collision>{PAINT.replace("simkit:", "")}</collision></gazebo></robot>"""
    with simkit.load(robot) as sim:
        assert [o[0] for o in optics_by_name(sim, of_visuals=False).values()] == [0.1]


@pytest.mark.parametrize("value", ["-0.1", "nan", "2000"])
def test_an_impossible_reflectivity_is_an_error(value: str) -> None:
    with pytest.raises(simkit.errors.SimkitError, match="reflectivity"):
        simkit.load(WORLD.replace("0.1</simkit:refl", value + "</simkit:refl"))
