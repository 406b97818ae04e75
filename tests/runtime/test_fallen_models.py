"""Warning about models that fell out of the world."""

from __future__ import annotations

import pytest

import simkit
from simkit.runtime.fallen_models import find_fallen_models

BALL = """<model name="ball"><pose>{} 0 1 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>
<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link></model>"""
FLOOR = """<model name="floor"><static>true</static><link name="l"><collision name="c"><geometry>
<box><size>4 4 0.2</size></box></geometry></collision></link></model>"""


def world(x: float) -> str:
    return f'<sdf version="1.9"><world name="w">{FLOOR}{BALL.format(x)}</world></sdf>'


def test_a_model_that_fell_beside_the_floor_is_named_with_its_height_and_the_time_of_its_fall() -> None:
    with simkit.load(world(5.0)) as sim:
        sim.run(0.5)
        assert not list(find_fallen_models(sim))  # 0.2 m below the start
        sim.run(1.5)
        (warning,) = find_fallen_models(sim)
        assert warning.code == "SK-SPAWN-007" and warning.severity == "warning"
        height = float(sim.model("ball").pose.position[2])
        assert height == pytest.approx(1.0 - 9.8 * 2.0**2 / 2, abs=0.02)
        assert (
            f"ball fell out of the world, freely since about t = 0.00 s: it is at z = {height:.4g} m" in warning.message
        )
        assert "above -0.1 m" in warning.message


def test_a_model_on_the_floor_and_one_without_gravity_have_not_fallen() -> None:
    with simkit.load(world(0.0)) as sim:
        sim.run(2.0)
        assert not list(find_fallen_models(sim))
    with simkit.load(world(5.0).replace('name="w">', 'name="w"><gravity>0 0 0</gravity>')) as sim:
        sim.run(2.0)
        assert not list(find_fallen_models(sim))


def test_a_model_without_collisions_is_told_to_have_none() -> None:
    text = world(0.0)
    first, last = text.rindex("<collision"), text.rindex("</collision>") + len("</collision>")
    with simkit.load(text[:first] + text[last:]) as sim:
        sim.run(2.0)
        (warning,) = find_fallen_models(sim)
        assert "<collision>" in warning.hint


def test_a_model_whose_collision_meshes_are_missing_is_told_so_and_not_to_have_no_ground() -> None:
    text = world(0.0)
    first, last = text.rindex("<geometry>"), text.rindex("</geometry>") + len("</geometry>")
    mesh = "<geometry><mesh><uri>model://nowhere/ball.dae</uri></mesh></geometry>"
    with simkit.load(text[:first] + mesh + text[last:]) as sim:
        sim.run(2.0)
        (warning,) = find_fallen_models(sim)
        assert warning.hint.startswith("its collisions are left out")


def test_a_model_that_a_hit_or_a_divergence_threw_below_the_world_is_not_told_to_have_no_ground() -> None:
    with simkit.load(world(0.0)) as sim:
        sim.model("ball").set_pose(simkit.Pose((0.0, 0.0, -5.0)))
        sim.model("ball").set_velocity((0.0, 0.0, -300.0))
        sim.run(0.2)
        assert [d.code for d in sim.diagnostics if d.severity == "warning"] == ["SK-PHYS-032"]
        assert not list(find_fallen_models(sim))
    with simkit.load(world(0.0)) as sim:
        sim.model("ball").set_pose(simkit.Pose((0.0, 0.0, -50.0)))
        sim.model("ball").set_velocity((0.0, 0.0, -1e12))
        with pytest.raises(simkit.SimulationDiverged):
            sim.run(0.2)
        assert not list(find_fallen_models(sim))
