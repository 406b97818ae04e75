"""Rays: all methods of casting give the same distances, which agree with geometry."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from PIL import Image
from sensor_worlds import box, sensor, world

import simkit
from simkit.compiler.geom_groups import COLLISION, COLLISION_RAY, DRAWN_COLLISION
from simkit.sensors.rays.embree_rays import has_embree
from simkit.sensors.rays.numpy_rays import FanDirections
from simkit.sensors.rays.ray_fan import MANY_RAYS, RayFan, fan_directions

GROUPS = (COLLISION, COLLISION_RAY, DRAWN_COLLISION)
FEW, MANY = (5, 120), (20, 240)  # rows and columns
AGREE = 1e-9  # [m]
needs_embree = pytest.mark.skipif(not has_embree(), reason="embreex is not installed")


def model(name: str, shape: str, pose: str, static: bool = True) -> str:
    return f"""<model name="{name}"><static>{str(static).lower()}</static><pose>{pose}</pose>
      <link name="l"><gravity>false</gravity><collision name="c"><geometry>{shape}</geometry></collision></link>
      </model>"""


SHAPES = {
    "ball": "<sphere><radius>0.6</radius></sphere>",
    "pill": "<capsule><radius>0.3</radius><length>0.8</length></capsule>",
    "egg": "<ellipsoid><radii>0.3 0.5 0.9</radii></ellipsoid>",
    "can": "<cylinder><radius>0.4</radius><length>0.9</length></cylinder>",
    "crate": "<box><size>0.5 0.9 0.7</size></box>",
    "ground": "<plane><normal>0 0 1</normal></plane>",
}
TRIANGLES = {"hat": "<cone><radius>0.5</radius><length>1.1</length></cone>"}


def scattered(shapes: dict[str, str], moving: bool) -> str:
    """Return three copies of each shape around the origin, with different rotations."""
    random = np.random.default_rng(7)
    text = model("ground", SHAPES["ground"], "0 0 -1.5 0 0 0")
    for name, shape in shapes.items():
        for i in range(3) if name != "ground" else ():
            angle, far = random.uniform(-3, 3), random.uniform(1.5, 5)
            place = (far * math.cos(angle), far * math.sin(angle), random.uniform(-1, 1), *random.uniform(-3, 3, 3))
            text += model(f"{name}{i}", shape, " ".join(map(str, place)), static=not (moving and i))
    return f'<sdf version="1.9"><world name="w">{text}</world></sdf>'


def fan_of(grid: tuple[int, int], reach: float = 20.0, **how: Any) -> RayFan:
    elevations, azimuths = np.linspace(-0.6, 0.5, grid[0]), np.linspace(-3.1, 3.2, grid[1])
    directions = fan_directions(azimuths, elevations)
    return RayFan(directions, GROUPS, reach, grid=(elevations, azimuths), **how)


TURN = simkit.Pose.from_rpy(0, 0, 0, 0.1, -0.2, 0.7).matrix


def cast(sim: Any, fan: RayFan, origin: Any = (0.1, 0.2, 0.1), start: float = 0.0) -> RayFan:
    fan.bind(sim.mj_model, sim.engine.names, 0, ())
    fan.cast(sim.mj_model, sim.engine.physics.fresh(), np.array(origin, float), TURN, start)
    return fan


@pytest.mark.parametrize("start", [0.0, 2.5])
@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("shapes", [SHAPES, SHAPES | TRIANGLES], ids=["shapes", "triangles"])
def test_all_methods_of_casting_agree(shapes: dict[str, str], moving: bool, start: float) -> None:
    assert FEW[0] * FEW[1] < MANY_RAYS <= MANY[0] * MANY[1]
    with simkit.load(scattered(shapes, moving)) as sim:
        for grid in (FEW, MANY):
            fan, other = cast(sim, fan_of(grid), start=start), fan_of(grid, use_embree=False)
            other.bind(sim.mj_model, sim.engine.names, 0, ())
            other.targets.needs_engine = True  # the engine alone casts all rays
            other.cast(sim.mj_model, sim.engine.physics.fresh(), np.array((0.1, 0.2, 0.1)), TURN, start)
            assert 0.2 < np.isfinite(fan.distances).mean() < 1.0
            np.testing.assert_allclose(fan.distances, other.distances, atol=AGREE)
            np.testing.assert_array_equal(fan.geoms, other.geoms)
            np.testing.assert_array_equal(fan.infinite, np.isinf(fan.distances))


@pytest.mark.parametrize("use_embree", [True, False])
def test_a_heightmap_is_the_engines(tmp_path: Path, use_embree: bool) -> None:
    heights = np.random.default_rng(3).integers(0, 255, (17, 17), dtype=np.uint8)
    Image.fromarray(heights).save(tmp_path / "hills.png")
    shape = "<heightmap><uri>hills.png</uri><size>12 10 1.2</size><pos>0 0 -1</pos></heightmap>"
    path = tmp_path / "hills.sdf"
    path.write_text(f'<sdf version="1.9"><world name="w">{model("hills", shape, "0 0 0 0 0 0.3")}</world></sdf>')
    with simkit.load(path) as sim:
        fan = cast(sim, fan_of(MANY, use_embree=use_embree), origin=(0, 0, 1.0))
        geom = np.empty(1, np.int32)
        for i in range(0, fan.count, 37):
            found = _alone(sim, (0.0, 0.0, 1.0), TURN @ fan.directions[i], geom)
            assert fan.distances[i] == pytest.approx(found, abs=AGREE)


def _alone(sim: Any, origin: Any, direction: Any, geom: Any) -> float:
    """Cast one ray with the engine."""
    groups = np.zeros(6, np.uint8)
    groups[list(GROUPS)] = 1
    args = sim.mj_model, sim.engine.physics.fresh(), np.array(origin, float), direction, groups, 1, -1, geom, None
    found = mujoco.mj_ray(*args)
    return found if 0 <= found <= 20 else math.inf


@pytest.mark.parametrize("grid", [(1, 3), (1, MANY_RAYS + 1)], ids=["few", "many"])
@pytest.mark.parametrize(
    ("shape", "pose", "distance"),
    [
        ("ball", "100 0 0 0 0 0", 99.4),
        ("ball", "3 0.3 0 0 0 0", 3 - math.sqrt(0.36 - 0.09)),
        ("pill", "3 0 0.55 0 0 0", 3 - math.sqrt(0.09 - 0.15**2)),  # on its cap
        ("pill", "3 0 0.2 0 0 0", 2.7),
        ("egg", "3 0 0 0 0 0", 2.7),
        ("egg", "3 0 0 0 0 1.5707963267948966", 2.5),
        ("can", "3 0.24 0 0 0 0", 3 - 0.32),
        ("can", "3 0 0 0 1.5707963267948966 0", 2.55),  # on its end
        ("crate", "3 0 0 0 0 0.7853981633974483", 3 - 0.25 * math.sqrt(2)),
        ("crate", "3 0 0 0 0 0", 2.75),
        ("ground", "0 0 -1 0 -0.1 0", 1 / math.tan(0.1)),
    ],
)
def test_distances_are_geometrys(shape: str, pose: str, distance: float, grid: tuple[int, int]) -> None:
    reach = np.array((0.0,)), np.linspace(-0.4, 0.4, grid[1])
    fan = RayFan(fan_directions(reach[1], reach[0]), GROUPS, 200.0, grid=reach)
    text = f'<sdf version="1.9"><world name="w">{model("m", SHAPES[shape], pose)}</world></sdf>'
    with simkit.load(text) as sim:
        fan.bind(sim.mj_model, sim.engine.names, 0, ())
        fan.cast(sim.mj_model, sim.engine.physics.fresh(), np.zeros(3), np.eye(3))
        ahead = grid[1] // 2
        assert fan.directions[ahead, 0] == pytest.approx(1.0)
        assert fan.distances[ahead] == pytest.approx(distance, abs=1e-6)


@needs_embree
def test_no_ray_slips_between_triangles() -> None:
    """The rays hit corners and edges of a wall that consists of many triangles."""
    from simkit.sensors.rays.embree_rays import TriangleScene

    side = 40
    y, z = np.meshgrid(np.linspace(-1, 1, side + 1), np.linspace(-1, 1, side + 1))
    corners = np.column_stack((np.full(y.size, 2.0), y.ravel(), z.ravel()))
    cell = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    faces = np.vstack(
        (np.column_stack((cell, cell + 1, cell + side + 2)), np.column_stack((cell, cell + side + 2, cell + side + 1)))
    )
    scene = TriangleScene(corners, faces.astype(np.int32))
    inner = corners[(np.abs(corners[:, 1:]) < 0.99).all(axis=1)]
    targets = np.vstack((inner, (inner[1:] + inner[:-1]) / 2))
    directions = targets / np.linalg.norm(targets, axis=1, keepdims=True)
    limit = np.full(len(directions), 9.0, np.float32)
    which, distances, _ = scene.nearest(np.zeros(3), directions, 0.0, limit)
    assert len(which) == len(directions)
    np.testing.assert_allclose(distances, np.linalg.norm(targets, axis=1), atol=1e-12)


@needs_embree
def test_a_mesh_far_away_is_exact() -> None:
    """Embree finds the triangle in float32; the distance to its plane is computed in float64."""
    with simkit.load(
        f'<sdf version="1.9"><world name="w">{model("m", TRIANGLES["hat"], "150 80 0 0 0.7 0.2")}</world></sdf>'
    ) as sim:
        way = np.array((150.0, 80.0, 0.0)) / 170.0
        elevations, azimuths = np.zeros(1), np.linspace(-0.001, 0.001, 50) + math.atan2(80, 150)
        fan = RayFan(fan_directions(azimuths, elevations), GROUPS, 300.0, grid=(elevations, azimuths))
        fan.bind(sim.mj_model, sim.engine.names, 0, ())
        fan.cast(sim.mj_model, sim.engine.physics.fresh(), np.zeros(3), np.eye(3))
        assert way @ fan.directions[25] == pytest.approx(1.0, abs=1e-6)
        geom = np.empty(1, np.int32)
        for i in range(fan.count):
            found = mujoco.mj_ray(
                sim.mj_model, sim.engine.physics.fresh(), np.zeros(3), fan.directions[i], None, 1, -1, geom, None
            )
            assert fan.distances[i] == pytest.approx(found if found >= 0 else math.inf, abs=1e-6)


@pytest.mark.parametrize("grid", [None, (np.linspace(-0.7, 0.9, 13), np.linspace(-4.0, 5.0, 60))])
def test_a_fan_finds_every_ray_towards_a_sphere(grid: Any) -> None:
    """Spheres are also behind the sensor, over the pole and around the sensor, and fans may exceed one turn."""
    elevations, azimuths = grid or (np.linspace(-0.7, 0.9, 13), np.linspace(-4.0, 5.0, 60))
    directions = fan_directions(azimuths, elevations)
    fan = FanDirections(directions, grid)
    centres = np.array(((2, 0, 0), (-2, 0.01, 0.3), (0.1, 0.1, 2), (0.2, 0, 0), (0, -3, -1), (0.5, 0.5, -9)), float)
    radii = np.array((0.5, 0.3, 0.4, 0.5, 0.01, 0.2))
    listed = [set() for _ in centres]
    for of, rays in fan.pairs(centres, radii):
        for sphere, ray in zip(np.broadcast_to(of, rays.shape).tolist(), rays.tolist(), strict=True):
            listed[sphere].add(ray)
    for centre, radius, found in zip(centres, radii, listed, strict=True):
        along = directions @ centre
        apart = np.linalg.norm(centre - np.maximum(along, 0)[:, None] * directions, axis=1)
        assert set(np.flatnonzero(apart <= radius).tolist()) <= found


ARM = """<model name="robot"><pose>0 0 0.5 0 0 0</pose><link name="base">
  <collision name="c"><geometry><box><size>0.6 0.6 0.4</size></box></geometry></collision></link>
  <link name="head"><pose>0 0 0.5 0 0 0</pose>{sensor}
    <collision name="c"><geometry><sphere><radius>0.05</radius></sphere></geometry></collision></link>
  <link name="arm"><pose>0.5 0 0 0 0 0</pose><collision name="c"><pose>0.25 0 0 0 0 0</pose><geometry><box>
    <size>0.5 0.1 0.1</size></box></geometry></collision></link>
  <joint name="neck" type="fixed"><parent>base</parent><child>head</child></joint>
  <joint name="shoulder" type="revolute"><parent>base</parent><child>arm</child><axis><xyz>0 -1 0</xyz></axis></joint>
  <joint name="stand" type="fixed"><parent>world</parent><child>base</child></joint></model>"""
SCAN = """<lidar><scan><horizontal>
  <samples>3</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle></horizontal></scan><range><min>0.02</min><max>9</max></range></lidar>"""


def test_an_arm_is_seen_when_it_is_raised_into_the_fan() -> None:
    """Geoms that the fan can never hit are left out; the arm is not, because it can reach the fan."""
    text = f'<sdf version="1.9"><world name="w">{ARM.format(sensor=sensor("lidar", SCAN))}</world></sdf>'
    with simkit.load(text) as sim:
        lidar = sim.sensor("robot::head::s")
        sim.run(0.02)
        assert lidar.latest.ranges[1] == math.inf
        shapes = lidar.fan.targets.shapes_by_engine
        looked_at = lidar.fan.targets.geoms[
            shapes.reachable_movers(lidar.fan.carrier, lidar.fan.body, lidar._offset, 0, 0)
        ]
        assert len(looked_at) == 1  # the arm; neither the base nor the head itself
        sim.joint("robot::shoulder").set_position(math.pi / 2 - 1e-9)
        sim.step(20)
        assert lidar.latest.ranges[1] == pytest.approx(0.45, abs=2e-3)
        assert lidar.hits.tolist() == ["", "robot::arm::c", ""]


def test_other_links_of_the_robot_are_seen_and_the_own_one_is_not() -> None:
    low = sensor("lidar", SCAN, pose="0 0 -0.3 0 0 0")  # within the base
    with simkit.load(f'<sdf version="1.9"><world name="w">{ARM.format(sensor=low)}</world></sdf>') as sim:
        sim.run(0.02)
        lidar = sim.sensor("robot::head::s")
        assert lidar.hits.tolist() == ["robot::base::c"] * 3
        assert lidar.latest.ranges[1] == pytest.approx(0.3, abs=1e-6)


def test_a_static_housing_hides_no_other_object() -> None:
    """A static sensor does not hit its own link, but hits all other static models, in a scan and in a dense cloud."""
    dense = SCAN.replace("<samples>3</samples>", f"<samples>{MANY_RAYS + 1}</samples>")
    can = "<geometry><cylinder><radius>0.2</radius><length>0.4</length></cylinder></geometry>"
    shell = f'<collision name="c">{can}</collision>'
    for block in (SCAN, dense):
        others = box("ahead", "3.5 0 1 0 0 0", "1 9 1")
        with simkit.load(world(sensor("lidar", block), others=others, body=shell)) as sim:
            sim.run(0.02)
            assert set(sim.sensor("m::l::s").hits) == {"ahead::l::c"}
