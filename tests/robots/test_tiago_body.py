"""TIAGo's body: nothing of it meets itself, its sensors do not see it, it looks like one, and it stands."""

from __future__ import annotations

import itertools
import math
from typing import Any

import mujoco
import numpy as np
import pytest

import simkit

ARM = tuple(f"arm_{k}_joint" for k in range(1, 8))
HOME = dict(zip(("torso_lift_joint", *ARM), (0.15, 0.2, -1.34, -0.2, 1.94, -1.57, 1.37, 0.0), strict=True))
FLOOR = dict(zip(("torso_lift_joint", *ARM), (0.16, 1.6, -0.55, 0.0, 1.03, -1.57, -0.07, 0.0), strict=True))
REACH = dict(zip(("torso_lift_joint", *ARM), (0.35, 0.9, 1.0, -3.45, 0.45, 2.05, 1.0, 0.0), strict=True))
WAVE = dict(zip(("torso_lift_joint", *ARM), (0.15, 0.09, -0.7, -2.94, 1.83, -1.12, -0.031, -2.0), strict=True))
OPEN = {f"gripper_{side}_finger_joint": 0.044 for side in ("left", "right")}


def moving_body(model: Any, body: int) -> int:
    """The body that a body is rigidly part of."""
    while body and model.body_jntnum[body] == 0:
        body = int(model.body_parentid[body])
    return body


@pytest.fixture(scope="module")
def engine() -> Any:
    with simkit.load("tiago.urdf", base="fixed") as sim:
        yield sim.mj_model


@pytest.fixture(scope="module")
def pairs(engine: Any) -> list[tuple[int, int]]:
    """Collision shapes of links that no joint connects."""
    shapes = [g for g in range(engine.ngeom) if engine.geom_contype[g] or engine.geom_conaffinity[g]]
    found = []
    for one, other in itertools.combinations(shapes, 2):
        a, b = (moving_body(engine, int(engine.geom_bodyid[g])) for g in (one, other))
        above = {moving_body(engine, int(engine.body_parentid[x])): x for x in (a, b) if x}
        if a != b and a not in above and b not in above:
            found.append((one, other))
    return found


def meetings(model: Any, pairs: list[tuple[int, int]], pose: dict[str, float]) -> list[tuple[str, str]]:
    """Names of the shapes that penetrate each other in a pose."""
    data = mujoco.MjData(model)
    for name, value in pose.items():
        data.qpos[model.joint(f"tiago::{name}").qposadr[0]] = value
    mujoco.mj_forward(model, data)
    found = []
    for one, other in pairs:
        apart = np.linalg.norm(data.geom_xpos[one] - data.geom_xpos[other])
        near = apart < model.geom_rbound[one] + model.geom_rbound[other]
        if near and mujoco.mj_geomDistance(model, data, one, other, 0.01, np.zeros(6)) < 0:
            found.append((model.geom(one).name, model.geom(other).name))
    return found


@pytest.mark.parametrize("pose", [{}, HOME, FLOOR, REACH, WAVE, {**HOME, **OPEN}], ids=str)
def test_no_two_links_meet_in_a_pose_of_the_robot(
    engine: Any, pairs: list[tuple[int, int]], pose: dict[str, float]
) -> None:
    assert len(pairs) > 500
    assert meetings(engine, pairs, pose) == []


def test_an_arm_swung_through_the_head_meets_it(engine: Any, pairs: list[tuple[int, int]]) -> None:
    """The other way round: the shapes are there."""
    swung = dict(zip(ARM, (1.3, 1.1, -2.6, 2.3, 1.3, -0.1, 1.3), strict=True))
    assert ("tiago::head_2_link::skull#0", "tiago::arm_4_link::forearm#0") in meetings(engine, pairs, swung)


def test_collisions_are_few_and_simple(engine: Any) -> None:
    shapes = [g for g in range(engine.ngeom) if engine.geom_contype[g] or engine.geom_conaffinity[g]]
    assert len(shapes) <= 45
    assert all(engine.geom_type[g] != mujoco.mjtGeom.mjGEOM_MESH for g in shapes)


WORLD = """<sdf version="1.12"><world name="w"><include><uri>model://ground_plane</uri></include>{}</world></sdf>"""
WALL = """<model name="wall"><static>true</static><pose>2.05 0 1 0 0 0</pose><link name="l"><collision name="c">
<geometry><box><size>0.1 8 2</size></box></geometry></collision></link></model>"""


@pytest.mark.parametrize("robot", ["tiago", "tiago_no_arm", "pmb2"])
def test_laser_and_sonars_do_not_see_the_robot_itself(robot: str) -> None:
    with simkit.load(WORLD.format("")) as sim:
        sim.spawn(robot)
        scans: list[Any] = []
        sonars: list[Any] = []
        sim.subscribe("/scan_raw", scans.append)
        sim.subscribe("/sonar_base", sonars.append)
        sim.run(0.3)
    assert len(scans[-1].ranges) == 666 and np.isinf(scans[-1].ranges).all()
    assert {m.header.frame_id for m in sonars} == {f"base_sonar_0{k}_link" for k in (1, 2, 3)}
    assert all(math.isinf(m.range) for m in sonars)


def test_laser_measures_the_wall_before_it() -> None:
    with simkit.load(WORLD.format(WALL)) as sim:
        sim.spawn("pmb2")
        scans: list[Any] = []
        sim.subscribe("/scan_raw", scans.append)
        sim.run(2.0)
    middle = np.array([scan.ranges for scan in scans])[:, 332:334]
    assert scans[-1].header.frame_id == "base_laser_link"
    assert middle.mean() == pytest.approx(2.0 - 0.202, abs=0.03)
    assert 0.03 < middle.std() < 0.09


@pytest.mark.parametrize("step", ["0.001", "0.002"])
@pytest.mark.parametrize("robot", ["tiago", "tiago_no_arm", "pmb2"])
def test_the_robot_stands(robot: str, step: str) -> None:
    physics = f'<physics name="p" type="ignored"><max_step_size>{step}</max_step_size></physics>'
    with simkit.load(WORLD.format(physics)) as sim:
        model = sim.spawn(robot)
        sim.run(2.0)
        x, y, z = model.pose.position
        assert math.hypot(x, y) < 1e-3 and abs(z) < 1e-3
        assert abs(model.pose.rpy[0]) < 2e-3 and abs(model.pose.rpy[1]) < 2e-3
        data = sim.mj_data
        assert all(contact.dist > -1e-3 for contact in data.contact)
