"""TIAGo as others publish it: the files of the package example-robot-data open unchanged, meshes and all.

`tiago.urdf` is an older robot with a five-fingered hand, `tiago_no_hand.urdf` the same without, `tiago_dual.urdf` the
one with two arms.
"""

from __future__ import annotations

import re
from collections import Counter
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import simkit
from simkit.compiler.geom_groups import VISUAL

NAMES = ("tiago", "tiago_no_hand", "tiago_dual")
LINKS = {"tiago": 78, "tiago_no_hand": 38, "tiago_dual": 130}
MOVING = {"tiago": 48, "tiago_no_hand": 12, "tiago_dual": 101}


def published() -> dict[str, Path]:
    """The three files; none where the package is not installed."""
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        return {}
    located = (Path(str(f.locate())) for f in files if f.parent.parts[-2:] == ("tiago_description", "robots"))
    return {p.stem: p for p in located if p.suffix == ".urdf"}


ROBOTS = published()
pytestmark = pytest.mark.skipif(not ROBOTS, reason="example-robot-data is not installed")


@cache
def text_of(name: str) -> str:
    return re.sub(r"<!--.*?-->", "", ROBOTS[name].read_text(encoding="utf-8"), flags=re.DOTALL)


@pytest.fixture(scope="module", params=NAMES)
def robot(request: pytest.FixtureRequest) -> Any:
    """Its name, and it held by its base with all joints at zero."""
    with simkit.load(ROBOTS[request.param], base="fixed") as sim:
        yield request.param, sim


def test_every_link_and_joint_of_the_file_is_there(robot: Any) -> None:
    name, sim = robot
    model = next(iter(sim.models.values()))
    links = re.findall(r"<link name=\"([^\"]+)\"", text_of(name))
    moving = re.findall(r"<joint name=\"([^\"]+)\" type=\"(?!fixed)", text_of(name))
    assert (len(links), len(moving)) == (LINKS[name], MOVING[name])
    for link in links:
        assert model.link(link).name == link
    for joint in moving:
        assert model.joint(joint).name == joint


def test_nothing_of_it_is_an_error_and_no_mesh_is_missing(robot: Any) -> None:
    name, sim = robot
    assert not [d for d in sim.diagnostics if d.severity == "error"]
    assert not [d for d in sim.diagnostics if "not found" in d.message]
    if name != "tiago_dual":  # that one names `wheel_{side}_joint`, which no joint is called
        assert not [d for d in sim.diagnostics if d.code.startswith("SK-URDF") and d.severity == "warning"]


def test_the_warnings_of_its_report_are_these(robot: Any) -> None:
    """Transmissions of unknown types, no parameter file, a namespace without use, and hulls of concave meshes."""
    name, sim = robot
    unknown = {"tiago": 33, "tiago_dual": 66, "tiago_no_hand": 0}[name]
    expected = {"SK-CONTROL-008": unknown, "SK-CONTROL-018": 1, "SK-PARAM-003": 1}
    expected |= {"SK-MESH-004": 3 if name == "tiago_no_hand" else 4, "SK-URDF-021": 3 if name == "tiago_dual" else 0}
    found = Counter(d.code for d in sim.diagnostics if d.severity == "warning")
    assert found == Counter(expected)
    assert all(d.file == str(ROBOTS[name]) and d.line for d in sim.diagnostics if d.severity == "warning")


def test_its_mass_is_the_sum_of_the_file(robot: Any) -> None:
    name, sim = robot
    written = sum(float(m) for m in re.findall(r"<mass value=\"([^\"]+)\"", text_of(name)))
    assert float(sim.mj_model.body_mass.sum()) == pytest.approx(written, rel=1e-9)


# ---------------------------------------------------------------------- what is drawn


def corners_of_meshes(sim: Any, base: str) -> np.ndarray:
    """The least and the greatest coordinates of every mesh that is drawn, in the frame of the link `base` [m]."""
    model, data = sim.mj_model, sim.mj_data
    points = []
    for geom in np.flatnonzero(model.geom_group == VISUAL):
        if (mesh := model.geom_dataid[geom]) >= 0:
            vertices = model.mesh_vert[model.mesh_vertadr[mesh] :][: model.mesh_vertnum[mesh]]
            points.append(vertices @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom])
    pose = next(iter(sim.models.values())).link(base).pose
    every = (np.concatenate(points) - pose.position) @ pose.matrix
    return np.stack((every.min(axis=0), every.max(axis=0)))


def corners_by_yourdfpy(name: str) -> tuple[str, np.ndarray]:
    """The link that its poses are in, and the same of the meshes as yourdfpy and trimesh read them."""
    yourdfpy = pytest.importorskip("yourdfpy")
    share = ROBOTS[name].parents[4]
    reference = yourdfpy.URDF.load(str(ROBOTS[name]), load_meshes=False, build_scene_graph=True)
    points = []
    for link, entry in reference.link_map.items():
        at = reference.get_transform(link, reference.base_link)
        for shape in entry.visuals:
            if shape.geometry.mesh is None:
                continue
            mesh = trimesh.load_mesh(share / shape.geometry.mesh.filename.removeprefix("package://"))
            here = at @ (shape.origin if shape.origin is not None else np.eye(4))
            points.append(trimesh.transform_points(mesh.vertices, here))
    every = np.concatenate(points)
    return reference.base_link, np.stack((every.min(axis=0), every.max(axis=0)))


def test_its_meshes_are_where_another_reader_sees_them(robot: Any) -> None:
    """Files, units, axes and places of all that is drawn: yourdfpy reckons the poses, trimesh reads the meshes."""
    name, sim = robot
    base, want = corners_by_yourdfpy(name)
    np.testing.assert_allclose(corners_of_meshes(sim, base), want, atol=1e-4)


# ---------------------------------------------------------------------- its sensors and its wheels


def test_the_noise_that_an_older_gazebo_took_for_a_whole_imu_is_each_axis_own(robot: Any) -> None:
    name, sim = robot
    for sensor in ("imu_sensor", "base_imu_sensor"):
        options = sim.sensor(f"{name}::base_imu_link::{sensor}".replace("tiago_no_hand", "tiago")).options
        assert [n.stddev for n in options.angular_velocity] == [2e-4] * 3
        assert [n.bias_mean for n in options.linear_acceleration] == [0.1] * 3
    assert not [d for d in sim.diagnostics if "noise" in d.message]


@pytest.mark.parametrize("name", NAMES)
def test_it_stands_on_its_wheels_though_nobody_moves_its_arm(name: str) -> None:
    with simkit.load("empty") as sim:
        base = sim.spawn(ROBOTS[name], name="robot")
        sim.run(2.0)
        x, y, z = base.pose.position
        assert abs(z) < 0.01
        assert np.hypot(x, y) < 0.2
        assert np.abs(base.pose.rpy[:2]).max() < 0.05
