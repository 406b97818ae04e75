"""Links with a mass and zero moments of inertia get the inertia of their collisions."""

from __future__ import annotations

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh

import simkit
from simkit.compiler.collision_inertia import collision_inertia
from simkit.diagnostics import Diagnostics
from simkit.pose import Pose
from simkit.scene import Box, Inertial, Mesh, Plane, SceneCollision, SceneLink, Sphere

ZEROS = "<inertia><ixx>0</ixx><iyy>0</iyy><izz>0</izz></inertia>"
CAN = "<cylinder><radius>0.033</radius><length>0.12</length></cylinder>"
GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
  </collision></link></model>"""


def link(*collisions: tuple[Box | Sphere | Mesh | Plane, Pose], pose: Pose | None = None) -> SceneLink:
    shapes = tuple(SceneCollision("c", "m::l::c", place, shape) for shape, place in collisions)
    return SceneLink("l", "m::l", pose or Pose(), Inertial(2.0, (0.0, 0.0, 0.0), (0.0,) * 6), collisions=shapes)


def thing(shape: str, mass: float, pose: str, inertia: str = ZEROS) -> str:
    return f"""<model name="thing"><pose>{pose}</pose><link name="l"><inertial><mass>{mass}</mass>
      {inertia}</inertial><collision name="c"><geometry>{shape}</geometry></collision></link></model>"""


def world(*models: str) -> str:
    return f'<sdf version="1.9"><world name="w">{GROUND}{"".join(models)}</world></sdf>'


def test_the_inertia_is_that_of_the_shape_at_the_mass() -> None:
    found = collision_inertia([link((Box((0.4, 0.3, 0.2)), Pose()))], 6.0, Diagnostics())
    assert found == pytest.approx(np.diag((0.065, 0.1, 0.125)), abs=1e-12)


def test_several_shapes_share_the_mass_by_volume() -> None:
    """Two balls of 1 kg, 0.8 m apart along y of a link that is rotated by 90 degrees about z."""
    places = [Pose((0.0, side, 3.0)) for side in (-0.4, 0.4)]
    turned = Pose.from_rpy(5.0, 0.0, 0.0, 0.0, 0.0, math.pi / 2)
    found = collision_inertia([link(*((Sphere(0.1), at) for at in places), pose=turned)], 2.0, Diagnostics())
    own = 2 * 0.4 * 0.1**2
    assert found == pytest.approx(np.diag((own, own + 2 * 0.16, own + 2 * 0.16)), abs=1e-12)


def test_a_mesh_that_is_not_closed_counts_as_its_hull(tmp_path: Path) -> None:
    box = trimesh.creation.box((0.4, 0.3, 0.2))
    box.update_faces(np.arange(len(box.faces)) > 1)
    box.export(tmp_path / "open.stl")
    shape = Mesh(tmp_path / "open.stl", "open.stl", scale=(2.0, 2.0, 2.0))
    found = collision_inertia([link((shape, Pose((1.0, 0.0, 0.0))))], 6.0, Diagnostics())
    assert found == pytest.approx(4 * np.diag((0.065, 0.1, 0.125)), abs=1e-6)


@pytest.mark.parametrize("shapes", [(), ((Plane(), Pose()),)], ids=["no collision", "a plane"])
def test_without_a_volume_there_is_none(shapes: tuple[tuple[Plane, Pose], ...]) -> None:
    assert collision_inertia([link(*shapes)], 2.0, Diagnostics()) is None


def test_the_engine_gets_it_and_a_warning_names_link_line_and_numbers() -> None:
    with simkit.load(world(thing(CAN, 0.25, "0 0 0.06 0 0 0"))) as sim:
        body = mujoco.mj_name2id(sim.mj_model, mujoco.mjtObj.mjOBJ_BODY, "thing::l")
        assert sorted(sim.mj_model.body_inertia[body]) == pytest.approx((0.000136, 0.000368, 0.000368), rel=2e-3)
        assert not any(record.exact for record in sim.engine.compiled.builder.records.values())  # exports have it too
        (warning,) = [d for d in sim.diagnostics if d.code == "SK-PHYS-011"]
        assert warning.severity == "warning" and warning.line == 2
        assert "(0.0001361, 0.0003681, 0.0003681) are used" in warning.message
        assert "those of its collisions at 0.25 kg" in warning.message


def test_a_link_without_collisions_stays_a_point() -> None:
    text = f"""<sdf version="1.9"><world name="w"><model name="thing"><link name="l"><inertial><mass>2</mass>
      {ZEROS}</inertial></link></model></world></sdf>"""
    with simkit.load(text) as sim:
        assert sim.mj_model.body_inertia[1] == pytest.approx((2e-8,) * 3)


def test_moments_that_the_file_gives_are_kept() -> None:
    given = "<inertia><ixx>0</ixx><iyy>0</iyy><izz>0.1</izz></inertia>"
    with simkit.load(world(thing(CAN, 10, "0 0 0.06 0 0 0", given))) as sim:
        body = mujoco.mj_name2id(sim.mj_model, mujoco.mjtObj.mjOBJ_BODY, "thing::l")
        assert sorted(sim.mj_model.body_inertia[body]) == pytest.approx((0.05, 0.05, 0.1))


@pytest.mark.parametrize("mass", [0.25, 20.0])
@pytest.mark.parametrize("shape", [CAN, "<box><size>0.4 0.3 1.2</size></box>", "<sphere><radius>0.1</radius></sphere>"])
def test_a_thing_with_zero_inertia_that_falls_askew_comes_to_rest(shape: str, mass: float) -> None:
    """With the inertia of a point, such things reach hundreds of metres a second, or the run diverges."""
    with simkit.load(world(thing(shape, mass, "0 0 0.8 0.3 0.2 0"))) as sim:
        fastest = 0.0
        for _ in range(60):
            sim.run(0.05)
            fastest = max(fastest, math.hypot(*sim.link("thing::l").linear_velocity))
        assert fastest < math.sqrt(2 * 9.81 * 0.8)
        assert math.hypot(*sim.link("thing::l").linear_velocity) < 0.25  # a ball may roll on
