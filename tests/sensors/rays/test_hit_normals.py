"""Normals of the surfaces that rays hit agree with MuJoCo's, for all shapes and both kinds of casters."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

import simkit
from simkit.compiler.geom_groups import COLLISION, COLLISION_RAY, DRAWN_COLLISION
from simkit.sensors.rays.embree_rays import has_embree
from simkit.sensors.rays.hit_normals import InstantFrames, hit_normals
from simkit.sensors.rays.mujoco_rays import WholeModelCaster
from simkit.sensors.rays.ray_fan import RayFan, fan_directions

GROUPS = (COLLISION, COLLISION_RAY, DRAWN_COLLISION)
FEW, MANY = (5, 120), (20, 240)  # rows and columns
needs_embree = pytest.mark.skipif(not has_embree(), reason="embreex is not installed")
SHAPES = {
    "ball": "<sphere><radius>0.6</radius></sphere>",
    "pill": "<capsule><radius>0.3</radius><length>0.8</length></capsule>",
    "egg": "<ellipsoid><radii>0.3 0.5 0.9</radii></ellipsoid>",
    "can": "<cylinder><radius>0.4</radius><length>0.9</length></cylinder>",
    "crate": "<box><size>0.5 0.9 0.7</size></box>",
}
TRIANGLES = {"hat": "<cone><radius>0.5</radius><length>1.1</length></cone>"}
AGREE = 1e-7
ORIGIN = np.array((0.1, -0.2, 0.3))


def scattered(shapes: dict[str, str], moving: bool) -> str:
    """Return copies of shapes around the origin, with different rotations, above a plane."""
    random, text = np.random.default_rng(7), ""
    for i, shape in enumerate([*shapes.values()] * 3):
        angle = 2 * i / len(shapes) + 0.1 * i
        place = (3 * math.cos(angle), 3 * math.sin(angle), 0.2, *random.uniform(-3, 3, 3))
        pose, is_static = " ".join(map(str, place)), str(not moving).lower()
        text += f"""<model name="m{i}"><static>{is_static}</static><pose>{pose}</pose>
          <link name="l"><gravity>false</gravity><collision name="c"><pose>0.1 0.2 0.1 0.3 0.2 0.1</pose>
          <geometry>{shape}</geometry></collision></link></model>"""
    ground = """<model name="ground"><static>true</static><pose>0 0 -1.5 0.1 0 0</pose><link name="l">
      <collision name="c"><geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link></model>"""
    return f'<sdf version="1.9"><world name="w">{text}{ground}</world></sdf>'


def fan_of(grid: tuple[int, int], use_embree: bool = True) -> RayFan:
    elevations, azimuths = np.linspace(-0.6, 0.5, grid[0]), np.linspace(-3.1, 3.2, grid[1])
    directions = fan_directions(azimuths, elevations)
    return RayFan(directions, GROUPS, 20.0, grid=(elevations, azimuths), use_embree=use_embree)


def normals_of(sim: simkit.Simulation, fan: RayFan) -> np.ndarray:
    model, data = sim.mj_model, sim.mj_data
    mujoco.mj_kinematics(model, data)
    fan.bind(model, sim.engine.compiled.names, 0, ())
    fan.cast(model, data, ORIGIN, np.eye(3), 0.0)
    return hit_normals(fan, InstantFrames(data), ORIGIN, fan.directions)


def engine_normals(sim: simkit.Simulation, fan: RayFan) -> tuple[np.ndarray, np.ndarray]:
    seen = fan.groups[sim.mj_model.geom_group] > 0
    whole = WholeModelCaster(sim.mj_model, seen).model
    count = fan.count
    geoms, distances, normals = np.empty(count, np.int32), np.empty(count), np.empty(3 * count)
    groups = np.array((1, 0, 0, 0, 0, 0), np.uint8)
    rays = fan.directions.reshape(-1)
    mujoco.mj_multiRay(whole, sim.mj_data, ORIGIN, rays, groups, 1, -1, geoms, distances, normals, count, fan.reach)
    return np.where((distances < 0) | (distances > fan.reach), np.inf, distances), normals.reshape(-1, 3)


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("grid", [FEW, MANY])
def test_normals_of_shapes_are_those_of_the_engine(grid: tuple[int, int], moving: bool) -> None:
    check(scattered(SHAPES, moving), fan_of(grid), 0)


@needs_embree
@pytest.mark.parametrize("grid", [FEW, MANY])
def test_normals_of_triangles_are_those_of_the_engine(grid: tuple[int, int]) -> None:
    # Embree sees the edge between two triangles in float32: a few rays take the other triangle
    check(scattered(SHAPES | TRIANGLES, moving=True), fan_of(grid), 0.002)


def test_triangles_have_normals_without_embree() -> None:
    check(scattered(TRIANGLES, moving=True), fan_of(FEW, use_embree=False), 0)


def check(text: str, fan: RayFan, share: float) -> None:
    with simkit.load(text) as sim:
        normals = normals_of(sim, fan)
        distances, expected = engine_normals(sim, fan)
        is_hit = np.isfinite(distances)
        assert is_hit.sum() > 50
        np.testing.assert_allclose(fan.distances[is_hit], distances[is_hit], atol=1e-4)
        assert (normals[~is_hit] == 0).all()
        facing = (expected * fan.directions).sum(axis=1, keepdims=True)
        expected = np.where(facing > 0, -expected, expected)
        differs = np.abs(normals - expected)[is_hit].max(axis=1) > AGREE
        assert differs.mean() <= share
        assert ((normals * fan.directions).sum(axis=1)[is_hit] <= 0).all()
