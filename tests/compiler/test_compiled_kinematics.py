"""The compiled model against the scene: frames at random joint positions, axes, limits and sizes of meshes."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

import simkit
from simkit.compiler.joints import UNBOUNDED
from simkit.diagnostics import Diagnostics
from simkit.loaders.meshes.mesh_reader import load_mesh
from simkit.loaders.resources.bundled_models import bundled_names
from simkit.scene import Mesh, SceneJoint, SceneModel, SceneVisual
from simkit.scene.kinematics import AXIS_MOTIONS, joint_positions, link_poses

ROOT = Path(__file__).resolve().parents[2]
CORPUS = ROOT.parent / "shared" / "corpus" / "files"
SHIPPED = [name for name in bundled_names() if name != "turtlebot3_house"]  # whose robot is in other worlds as well
SHIPPED += [f"turtlebot3_{robot}.urdf" for robot in ("burger", "waffle", "waffle_pi")]
PUBLISHED = sorted(CORPUS.rglob("*.urdf")) if CORPUS.is_dir() else []
PUBLISHED += [path for path in sorted(CORPUS.rglob("*.sdf")) if "<joint" in path.read_text(errors="ignore")]
pytestmark = pytest.mark.leaves_out


@pytest.fixture(scope="module", params=SHIPPED)
def shipped(request: pytest.FixtureRequest) -> Iterator[simkit.Simulation]:
    with simkit.load(request.param) as simulation:
        yield simulation


def scene_models(sim: simkit.Simulation) -> list[SceneModel]:
    return [model for model in sim.world.models if not model.static and model.moved_by is None and not model.mjcf]


def driven_joints(sim: simkit.Simulation, model: SceneModel) -> list[SceneJoint]:
    """Joints of the tree whose positions can be set, without those that follow others."""
    return [
        joint
        for joint in model.all_joints()
        if AXIS_MOTIONS.get(joint.type) and not joint.axes[0].mimic and not sim.joint(joint.scoped)._binding.is_loop
    ]


def values_of(joint: SceneJoint, generator: random.Random) -> list[float]:
    bounded = [(max(axis.lower, -math.pi), min(axis.upper, math.pi)) for axis in joint.axes]
    return [generator.uniform(*limits) for limits in bounded]


def frame_errors(sim: simkit.Simulation, model: SceneModel, generator: random.Random) -> dict[str, float]:
    """Largest difference of each link's frame, relative to the canonical link, at random joint positions."""
    values = {joint.scoped: values_of(joint, generator) for joint in driven_joints(sim, model)}
    for name, value in values.items():
        sim.joint(name).set_position(value[0] if len(value) == 1 else value)
    first = joint_positions(model, {name: value[0] for name, value in values.items()})
    expected = link_poses(model, {name: (value, *values.get(name, ())[1:]) for name, value in first.items()})
    to_ours, to_theirs = expected[model.canonical_link].inverse(), sim.link(model.canonical_link).pose.inverse()
    errors = {}
    for name, pose in expected.items():
        found, wanted = to_theirs @ sim.link(name).pose, to_ours @ pose
        far = max(1.0, float(np.abs(wanted.position).max()))
        shift = float(np.abs(found.position - wanted.position).max()) / far
        errors[name] = max(shift, float(np.abs(found.matrix - wanted.matrix).max()))
    return errors


def check_frames(sim: simkit.Simulation) -> None:
    for model in scene_models(sim):
        held = [j for j in model.all_joints() if sim.joint(j.scoped)._binding.is_loop or j.type == "gearbox"]
        if held or not model.canonical_link:
            continue
        generator = random.Random(0)
        for _ in range(3):
            errors = frame_errors(sim, model, generator)
            assert {name: error for name, error in errors.items() if error > 1e-9} == {}, model.scoped


def check_axes_and_limits(sim: simkit.Simulation) -> None:
    """Axes in the child link's frame, and ranges of MuJoCo's joints, which are at least 2 µrad or 2 µm wide."""
    model, data = sim.mj_model, sim.mj_data
    for joint in itertools.chain.from_iterable(driven_joints(sim, m) for m in scene_models(sim)):
        binding = sim.joint(joint.scoped)._binding
        sign = -1.0 if binding.is_reversed else 1.0
        for axis, index in zip(joint.axes, binding.joint_ids, strict=True):
            where = f"{joint.scoped} of type {joint.type}"
            if joint.type in ("revolute", "continuous", "prismatic"):
                local = sim.link(joint.child_link).pose.inverse().rotate(data.xaxis[index])
                wanted = next(m for m in scene_models(sim) if joint in m.all_joints())
                link = next(one for one in wanted.all_links() if one.scoped == joint.child_link)
                assert local * sign == pytest.approx(link.pose_world.inverse().rotate(axis.xyz_world), abs=1e-9), where
            if joint.type in ("revolute", "prismatic") and max(-axis.lower, axis.upper) < UNBOUNDED:
                limits = sorted(sign * limit for limit in (axis.lower, axis.upper))
                assert model.jnt_limited[index], where
                assert model.jnt_range[index] == pytest.approx(limits, abs=1.1e-6), where


def corners(points: np.ndarray) -> np.ndarray:
    return np.stack((points.min(axis=0), points.max(axis=0)))


def compiled_corners(sim: simkit.Simulation, link: str, geoms: tuple[int, ...]) -> np.ndarray:
    """Least and greatest coordinates of drawn meshes in the frame of their link [m]."""
    model, data, pose = sim.mj_model, sim.mj_data, sim.link(link).pose
    points = []
    for geom in geoms:
        mesh = model.geom_dataid[geom]
        vertices = model.mesh_vert[model.mesh_vertadr[mesh] :][: model.mesh_vertnum[mesh]]
        in_world = vertices @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
        points.append((in_world - pose.position) @ pose.matrix)
    return corners(np.concatenate(points))


def file_corners(visual: SceneVisual, mesh: Mesh) -> np.ndarray:
    parts = load_mesh(replace(mesh, scale=(1.0, 1.0, 1.0)), Diagnostics(), visual.where)
    points = np.concatenate([part.vertices[np.unique(part.faces)] for part in parts]) * mesh.scale
    return corners(points @ visual.pose_link.matrix.T + visual.pose_link.position)


def check_meshes(sim: simkit.Simulation) -> int:
    """Boxes around the drawn meshes; MuJoCo stores vertices as floats of 32 bits."""
    compared = 0
    mujoco.mj_kinematics(sim.mj_model, sim.mj_data)
    for link in itertools.chain.from_iterable(m.all_links() for m in scene_models(sim)):
        drawn = sim.engine.compiled.names.drawn(link.scoped)
        for visual in link.visuals:
            mesh, geoms = visual.geometry, drawn.get(visual.scoped, ())
            if isinstance(mesh, Mesh) and not (mesh.missing or mesh.submesh or mesh.bone) and geoms:
                wanted = file_corners(visual, mesh)
                size = float((wanted[1] - wanted[0]).max())
                found = compiled_corners(sim, link.scoped, geoms)
                assert found == pytest.approx(wanted, abs=1e-5 * max(1.0, size)), visual.scoped
                compared += 1
    return compared


def test_links_of_shipped_robots_are_where_the_scene_has_them(shipped: simkit.Simulation) -> None:
    check_frames(shipped)


def test_axes_and_limits_of_shipped_robots_are_those_of_the_scene(shipped: simkit.Simulation) -> None:
    check_axes_and_limits(shipped)


def test_meshes_of_shipped_robots_have_the_sizes_of_their_files(shipped: simkit.Simulation) -> None:
    check_meshes(shipped)


@pytest.mark.slow
@pytest.mark.skipif(not PUBLISHED, reason="the corpus of published files is not there")
@pytest.mark.parametrize("file", PUBLISHED, ids=lambda path: "/".join(path.relative_to(CORPUS).parts[-3:]))
def test_published_files_are_compiled_as_the_scene_has_them(file: Path) -> None:
    try:
        sim = simkit.load(file, resource_paths=[CORPUS, *CORPUS.glob("*")])
    except simkit.LoadError as error:
        pytest.skip(f"refused: {error.diagnostics[-1].code}")
    with sim:
        check_axes_and_limits(sim)
        check_frames(sim)
        check_meshes(sim)
