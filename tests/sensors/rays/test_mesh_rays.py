"""Rays against collisions hit the triangles of a mesh, also where the mesh collides as hulls, pieces or a cylinder."""

from __future__ import annotations

import importlib.util
import math
import pathlib
from typing import Any

import mujoco
import numpy as np
import pytest
import trimesh
from sensor_worlds import depths, sensor, world

import simkit
from simkit.compiler.geom_groups import COLLISION_CONTACT, COLLISION_RAY
from simkit.compiler.shape_geometry import polyline_triangles
from simkit.scene import Polyline
from simkit.sensors.rays.embree_rays import has_embree

L_SHAPE = ((0.0, 0.0), (1.0, 0.0), (1.0, 0.3), (0.3, 0.3), (0.3, 1.0), (0.0, 1.0))
NOTCH = 0.3  # x of the wall behind the notch of the L, which is 1 m wide; its hull is at 0.65 there
CORPUS = pathlib.Path(__file__).resolve().parents[4] / "shared" / "corpus" / "files"
PAL = ("pal-robotics+tiago_robot", "pal-robotics+pmb2_robot", "pal-robotics+pal_gripper")
RAY = """<lidar><scan><horizontal><samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle></horizontal>
  </scan><range><min>0.01</min><max>9</max></range></lidar>"""
LOOKS_BACK = f"2 0.65 1.2 0 0 {math.pi}"  # along -x, through the notch


@pytest.fixture(autouse=True)
def own_folder(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    """Put `corner.stl`, an L of 1 m x 1 m that is 0.4 m thick, into a folder, with a mesh cache of its own."""
    monkeypatch.setenv("SIMKIT_CACHE_DIR", str(tmp_path / "cache"))
    trimesh.Trimesh(*polyline_triangles(Polyline((L_SHAPE,), 0.4)), process=False).export(tmp_path / "corner.stl")
    return tmp_path


def mesh(file: str = "corner.stl", inside: str = "", attributes: str = "") -> str:
    return f"<geometry><mesh{attributes}><uri>{file}</uri>{inside}</mesh></geometry>"


def floating(shape: str, pose: str, static: bool = False, visual: bool = False) -> str:
    inertial = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
    drawn = f'<visual name="v">{shape}</visual>' if visual else ""
    return f"""<model name="thing"><static>{str(static).lower()}</static><pose>{pose}</pose><link name="l">
      <gravity>false</gravity>{inertial}<collision name="c">{shape}</collision>{drawn}</link></model>"""


def load(folder: pathlib.Path, text: str, **more: Any) -> simkit.Simulation:
    (folder / "w.sdf").write_text(text)
    return simkit.load(folder / "w.sdf", **more)


def distance(sim: simkit.Simulation) -> float:
    sim.run(0.02)
    return float(sim.sensor("m::l::s").measure_now().ranges[0])


def watched(shape: str, pose: str = "0 0 1 0 0 0", static: bool = False, beam: str = LOOKS_BACK) -> str:
    """Return a world with the shape and a lidar of one ray."""
    return world(sensor("lidar", RAY), others=floating(shape, pose, static), pose=beam)


@pytest.mark.parametrize("static", [False, True], ids=["moving", "static"])
def test_a_ray_enters_the_notch_of_a_mesh(own_folder: pathlib.Path, static: bool) -> None:
    with load(own_folder, watched(mesh(), static=static)) as sim:
        assert distance(sim) == pytest.approx(2.0 - NOTCH, abs=1e-6)


def test_a_moved_mesh_is_hit_where_it_is(own_folder: pathlib.Path) -> None:
    with load(own_folder, watched(mesh())) as sim:
        assert distance(sim) == pytest.approx(2.0 - NOTCH, abs=1e-6)
        sim.model("thing").set_pose(simkit.Pose((-1.0, 0.0, 1.0)))
        assert distance(sim) == pytest.approx(3.0 - NOTCH, abs=1e-6)
        sim.model("thing").set_pose(simkit.Pose.from_rpy(0.0, 1.0, 1.0, 0.0, 0.0, -math.pi / 2))  # x of the mesh is -y
        assert distance(sim) == pytest.approx(2.0 - NOTCH, abs=1e-6)


@pytest.mark.parametrize(
    ("scale", "beam", "expected"),
    [
        ((2.0, 2.0, 1.0), f"4 1.3 1.2 0 0 {math.pi}", 4.0 - 2 * NOTCH),
        ((0.5, 1.0, 0.5), f"2 0.65 1.1 0 0 {math.pi}", 2.0 - NOTCH / 2),
        ((-1.0, 1.0, 1.0), "-2 0.65 1.2 0 0 0", 2.0 - NOTCH),
    ],
    ids=["larger", "uneven", "mirrored"],
)
@pytest.mark.parametrize("static", [False, True], ids=["moving", "static"])
def test_the_scale_of_a_mesh_counts(
    own_folder: pathlib.Path, scale: tuple[float, float, float], beam: str, expected: float, static: bool
) -> None:
    shape = mesh(inside=f"<scale>{scale[0]} {scale[1]} {scale[2]}</scale>")
    with load(own_folder, watched(shape, static=static, beam=beam)) as sim:
        assert distance(sim) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("optimization", ["convex_hull", "convex_decomposition"])
@pytest.mark.parametrize("static", [False, True], ids=["moving", "static"])
def test_an_optimisation_of_the_contacts_changes_no_ray(
    own_folder: pathlib.Path, optimization: str, static: bool
) -> None:
    if optimization == "convex_decomposition" and importlib.util.find_spec("coacd") is None:
        pytest.skip("the extra `decompose` is not installed")
    with load(own_folder, watched(mesh(attributes=f' optimization="{optimization}"'), static=static)) as sim:
        assert distance(sim) == pytest.approx(2.0 - NOTCH, abs=1e-6)


def test_a_spawned_urdf_shows_its_triangles(own_folder: pathlib.Path) -> None:
    (own_folder / "thing.urdf").write_text("""<robot name="thing"><link name="l">
      <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
      <collision><geometry><mesh filename="corner.stl" scale="2 2 1"/></geometry></collision></link></robot>""")
    beam = f"4 1.3 1.2 0 0 {math.pi}"
    with load(own_folder, world(sensor("lidar", RAY), pose=beam, top="<gravity>0 0 0</gravity>")) as sim:
        sim.spawn(own_folder / "thing.urdf", pose=simkit.Pose((0.0, 0.0, 1.0)))
        assert distance(sim) == pytest.approx(4.0 - 2 * NOTCH, abs=1e-6)


@pytest.mark.parametrize("joint", ["", '<joint type="hinge" axis="0 0 1" pos="0 0 0"/>'], ids=["static", "moving"])
def test_an_mjcf_model_shows_its_triangles(own_folder: pathlib.Path, joint: str) -> None:
    (own_folder / "thing.xml").write_text(f"""<mujoco model="thing">
      <asset><mesh name="corner" file="corner.stl" scale="2 2 1"/></asset>
      <worldbody><body name="l">{joint}<geom type="mesh" mesh="corner"/></body></worldbody></mujoco>""")
    with load(own_folder, world(sensor("lidar", RAY), pose=f"4 1.3 1.2 0 0 {math.pi}")) as sim:
        sim.spawn(own_folder / "thing.xml", pose=simkit.Pose((0.0, 0.0, 1.0)))
        assert distance(sim) == pytest.approx(4.0 - 2 * NOTCH, abs=1e-6)


@pytest.mark.parametrize("kind", ["fixed", "revolute"])
@pytest.mark.parametrize("static", [False, True], ids=["moving", "static"])
def test_a_sensor_in_the_notch_of_its_own_robot_looks_out(own_folder: pathlib.Path, kind: str, static: bool) -> None:
    if static and kind == "revolute":
        pytest.skip("a static model has no joints")
    axis = "<axis><xyz>0 0 1</xyz></axis>" if kind == "revolute" else ""
    inertial = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
    text = f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
      <model name="m"><static>{str(static).lower()}</static>
        <link name="base">{inertial}<collision name="c">{mesh()}</collision></link>
        <link name="l"><pose>0.5 0.5 0.2 0 0 0</pose>{inertial}{sensor("lidar", RAY)}</link>
        <joint name="j" type="{kind}"><parent>base</parent><child>l</child>{axis}</joint></model>
      <model name="wall"><static>true</static><pose>3 0 0 0 0 0</pose><link name="l"><collision name="c">
        <geometry><box><size>1 9 9</size></box></geometry></collision></link></model></world></sdf>"""
    with load(own_folder, text) as sim:
        assert distance(sim) == pytest.approx(2.0, abs=1e-6)
        assert sim.sensor("m::l::s").hits[0] == "wall::l::c"


def test_a_sonar_hears_the_bottom_of_a_notch(own_folder: pathlib.Path) -> None:
    block = "<sonar><min>0.02</min><max>4</max><radius>0.01</radius><axis>1 0 0</axis></sonar>"
    with load(
        own_folder, world(sensor("sonar", block), others=floating(mesh(), "0 0 1 0 0 0"), pose=LOOKS_BACK)
    ) as sim:
        sim.run(0.02)
        assert sim.sensor("m::l::s").latest.range == pytest.approx(2.0 - NOTCH, abs=1e-4)


def test_a_depth_camera_sees_the_bottom_of_a_notch(own_folder: pathlib.Path) -> None:
    camera = """<camera><horizontal_fov>0.1</horizontal_fov><image><width>9</width><height>9</height></image>
      <clip><near>0.1</near><far>9</far></clip></camera>"""
    thing = floating(mesh(), "0 0 1 0 0 0", visual=True)
    with load(
        own_folder, world(sensor("depth_camera", camera), others=thing, pose=LOOKS_BACK), renderer="software"
    ) as sim:
        sim.run(0.02)
        image = depths(sim.sensor("m::l::s").latest)
        assert image[4, 4] == pytest.approx(2.0 - NOTCH, abs=1e-4)


def test_a_narrow_hole_in_an_almost_convex_mesh_is_open(own_folder: pathlib.Path) -> None:
    """The hole of 2 cm has 0.06 % of the volume of the cube, whose hull collides."""
    outline, hole = ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)), 0.01
    rings = (outline, ((-hole, -hole), (hole, -hole), (hole, hole), (-hole, hole)))
    block = trimesh.Trimesh(*polyline_triangles(Polyline(rings, 1.0)), process=False)
    block.export(own_folder / "drilled.stl")
    with load(own_folder, watched(mesh("drilled.stl"), beam="0 0 4 0 1.5707963267948966 0")) as sim:
        assert distance(sim) == math.inf
        assert [int(sim.mj_model.geom_group[g]) for g in sim.engine.names.link("thing::l").geoms] == [COLLISION_CONTACT]


def test_a_convex_mesh_needs_no_copy_for_rays(own_folder: pathlib.Path) -> None:
    trimesh.creation.icosphere(3).export(own_folder / "ball.stl")
    two = [trimesh.creation.box((1, 1, 1)), trimesh.creation.box((1, 1, 1))]
    two[1].apply_translation((3, 0, 0))
    trimesh.util.concatenate(two).export(own_folder / "two.stl")
    for file in ("ball.stl", "two.stl"):
        with load(own_folder, watched(mesh(file))) as sim:
            assert COLLISION_RAY not in sim.mj_model.geom_group


def spoked_wheel(folder: pathlib.Path) -> None:
    """Write a tyre about z with a hole of 0.2 m and one spoke of 4 cm along x."""
    tyre = trimesh.creation.annulus(0.2, 0.3, 0.1, sections=96)
    spoke = trimesh.creation.box((0.42, 0.04, 0.04))
    trimesh.util.concatenate([tyre, spoke]).export(folder / "wheel.stl")


@pytest.mark.parametrize(("height", "expected"), [(0.0, 1.48), (0.1, math.inf), (0.25, 1.45)])
def test_rays_pass_between_the_spokes_of_a_wheel_that_collides_as_a_cylinder(
    own_folder: pathlib.Path, height: float, expected: float
) -> None:
    spoked_wheel(own_folder)
    inertial = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
    cart = f"""<model name="cart"><pose>0 0 1 0 0 0</pose><link name="frame">{inertial}</link>
      <link name="wheel"><pose>0 0 0 -1.5707963267948966 0 0</pose>{inertial}
      <collision name="c">{mesh("wheel.stl")}</collision></link>
      <joint name="axle" type="continuous"><parent>frame</parent><child>wheel</child><axis><xyz>0 0 1</xyz></axis>
      </joint></model>"""
    beam = f"0 -1.5 {1 + height} 0 0 1.5707963267948966"
    text = world(sensor("lidar", RAY), others=cart, pose=beam, top="<gravity>0 0 0</gravity>")
    with load(own_folder, text) as sim:
        wheel = sim.engine.names.link("cart::wheel")
        assert [int(sim.mj_model.geom_type[g]) for g in wheel.geoms] == [int(mujoco.mjtGeom.mjGEOM_CYLINDER)]
        assert distance(sim) == pytest.approx(expected, abs=1e-5)


@pytest.mark.skipif(not has_embree(), reason="embreex is not installed")
def test_the_engine_and_embree_agree_on_moving_meshes(own_folder: pathlib.Path) -> None:
    block = """<lidar><scan><horizontal><samples>180</samples><min_angle>-3</min_angle><max_angle>3</max_angle>
      </horizontal></scan><range><min>0.01</min><max>9</max></range></lidar>"""
    thing = floating(mesh(), "-0.4 -0.5 0.85 0.1 0.2 0.3")
    with load(own_folder, world(sensor("lidar", block), others=thing, pose="0.7 0.6 1 0 0 0")) as sim:
        sim.run(0.02)
        device = sim.sensor("m::l::s")
        by_embree = device.measure_now().ranges.copy()
        device.fan.targets.needs_engine = True  # the engine alone casts all rays
        assert 0.2 < np.isfinite(by_embree).mean() < 1.0
        np.testing.assert_allclose(device.measure_now().ranges, by_embree, atol=1e-6)


def test_the_hull_of_a_moving_mesh_collides_and_its_copy_for_rays_does_not(own_folder: pathlib.Path) -> None:
    with load(own_folder, watched(mesh())) as sim:
        groups = sim.mj_model.geom_group
        assert [int(groups[g]) for g in sim.engine.names.link("thing::l").geoms] == [COLLISION_CONTACT]
        (copy,) = np.flatnonzero(groups == COLLISION_RAY).tolist()
        assert sim.engine.names.link("thing::l").ray_geoms == (copy,)
        assert (sim.mj_model.geom_contype[copy], sim.mj_model.geom_conaffinity[copy]) == (0, 0)


@pytest.mark.slow
@pytest.mark.skipif(not (CORPUS / PAL[0]).is_dir(), reason="needs the corpus in ../shared")
def test_the_laser_of_pals_tiago_sees_nothing_of_its_own_base(monkeypatch: pytest.MonkeyPatch) -> None:
    """The laser is in a slot of the base; the hull of the base covered 552 of its 666 rays."""
    packages = {
        name: CORPUS / folder / name
        for folder, name in zip(PAL, ("tiago_description", "pmb2_description", "pal_gripper_description"), strict=True)
    }
    with simkit.load("empty", package_paths=packages) as sim:
        sim.spawn(CORPUS / "expanded" / "tiago_gripper_sim.urdf", name="tiago")
        sim.run(0.01)
        reading = sim.sensor("tiago::base_laser_link::base_laser").measure_now()
        assert len(reading.ranges) == 666
        names = reading.names[reading.geoms[reading.hits]]
        assert sum(str(name).startswith("tiago::") for name in names) == 0
