"""Curved parts of large static meshes collide as height fields that lie in the solid, within the stated error."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
import trimesh

import simkit
from simkit.compiler.meshes.box_overlaps import overlaps
from simkit.compiler.meshes.surface_patches import large_surface_pieces
from simkit.pose import Pose
from simkit.scene import Mesh, Sphere


def bent_pipe(sections=200, sides=24):
    """Return vertices and faces of a closed pipe along a torus knot, of 12 m with a radius of 0.5 m."""
    turn = np.linspace(0.0, 2.0 * np.pi, sections, endpoint=False)

    def middle(t):
        around = 4.0 + 1.5 * np.cos(3.0 * t)
        return np.column_stack([around * np.cos(2.0 * t), around * np.sin(2.0 * t), 1.5 * np.sin(3.0 * t)])

    centre, along = middle(turn), middle(turn + 1e-4) - middle(turn - 1e-4)
    along /= np.linalg.norm(along, axis=1)[:, None]
    first = np.cross(along, (0.0, 0.0, 1.0))
    first /= np.linalg.norm(first, axis=1)[:, None]
    second = np.cross(along, first)
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[None, :, None]
    vertices = centre[:, None] + 0.5 * (np.cos(angle) * first[:, None] + np.sin(angle) * second[:, None])
    i, j = (k.ravel() for k in np.meshgrid(np.arange(sections), np.arange(sides), indexing="ij"))
    a, b = i * sides + j, (i + 1) % sections * sides + j
    c, d = (i + 1) % sections * sides + (j + 1) % sides, i * sides + (j + 1) % sides
    faces = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])]).astype(np.int32)
    mesh = trimesh.Trimesh(vertices.reshape(-1, 3), faces, process=False)
    return mesh.vertices, (faces if mesh.volume > 0.0 else faces[:, ::-1])


def loaded(make, compiled, tmp_path, mesh, *bodies, steps=0):
    """Return a world with a static mesh and moving bodies after some milliseconds."""
    trimesh.Trimesh(*mesh, process=False).export(tmp_path / "mesh.stl")
    shape = Mesh(tmp_path / "mesh.stl", "mesh.stl")
    c = compiled(make.model("mesh", make.link("mesh::link", shape), static=True), *bodies)
    mujoco.mj_step(c.model, c.data, steps)
    mujoco.mj_forward(c.model, c.data)
    return c


@pytest.mark.slow
def test_a_bent_pipe_is_covered_by_few_tiles_within_their_error(make, compiled, tmp_path):
    vertices, faces = bent_pipe()
    pieces, tiles, error, _ = large_surface_pieces(vertices, faces)
    size = float(np.ptp(vertices, axis=0).max())
    assert len(faces) == 9600
    assert len(tiles) + len(pieces) < len(faces) / 10
    assert error <= 1e-3 * size
    c = loaded(make, compiled, tmp_path, (vertices, faces))
    pipe = trimesh.Trimesh(vertices, faces, process=False)
    points, at = trimesh.sample.sample_surface(pipe, 1000, seed=0)
    contacts = np.array([0, 0, 0, 0, 0, 1], np.uint8)
    for point, normal in zip(points, pipe.face_normals[at], strict=True):
        start = point + 0.1 * normal
        distance = mujoco.mj_ray(c.model, c.data, start, -normal, contacts, 1, -1, np.zeros(1, np.int32), None)
        assert distance == pytest.approx(0.1, abs=1.5 * error)  # along the normal; the error is across the tile


def test_the_solid_of_tiles_lies_in_the_closed_mesh():
    vertices, faces = bent_pipe()
    _, tiles, error, _ = large_surface_pieces(vertices, faces)
    points = []
    for tile in tiles:
        rows, columns = tile.heights.shape
        ends = tile.cell * (columns - 1, rows - 1)
        points += [tile.origin + tile.axes @ (x * ends[0], y * ends[1], -tile.base) for x in (0, 1) for y in (0, 1)]
    pipe = trimesh.Trimesh(vertices, faces, process=False)
    outside = np.array(points)[~pipe.contains(points)]
    if len(outside):
        _, distances, _ = trimesh.proximity.closest_point(pipe, outside)
        assert distances.max() <= error


@pytest.mark.slow
@pytest.mark.parametrize("inside", [True, False])
def test_a_ball_rests_in_a_bowl_at_its_true_height(make, compiled, tmp_path, inside):
    bowl = trimesh.creation.icosphere(subdivisions=5, radius=2.0)
    shell = bowl.slice_plane((0, 0, -0.5), (0, 0, -1))
    if inside:
        shell.invert()
    assert len(shell.faces) > 4000
    pose = Pose((0.0, 0.0, -1.2)) if inside else Pose((0.0, 0.0, -1.0))
    c = loaded(
        make, compiled, tmp_path, (shell.vertices, shell.faces), make.solid("ball", Sphere(0.2), pose), steps=4000
    )
    # a bowl whose triangles face outwards is solid for the thickness of its layer above them
    height = float(c.data.body("ball::link").xpos[2])
    assert -1.8 - 0.004 < height < -1.8 + (0.004 if inside else 0.17)


@pytest.mark.slow
def test_a_ball_falls_through_a_hole_in_a_curved_surface(make, compiled, tmp_path):
    x, y = np.meshgrid(np.linspace(-3, 3, 61), np.linspace(-3, 3, 61), indexing="ij")
    moved = np.random.default_rng(0).uniform(-0.02, 0.02, (2, *x.shape))  # no regular grid
    x, y = x + moved[0], y + moved[1]
    vertices = np.stack([x, y, 0.05 * (x * x + y * y)], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(60), np.arange(60), indexing="ij"))
    a = i * 61 + j
    faces = np.vstack([np.column_stack([a, a + 61, a + 62]), np.column_stack([a, a + 62, a + 1])]).astype(np.int32)
    faces = faces[np.linalg.norm(vertices[faces].mean(axis=1)[:, :2] - (1.5, 0.0), axis=1) > 0.35]
    _, tiles, _, _ = large_surface_pieces(vertices, faces)
    assert len(tiles) > 50
    over = make.solid("over", Sphere(0.2), Pose((1.5, 0.0, 0.6)))
    beside = make.solid("beside", Sphere(0.2), Pose((0.0, 0.0, 0.4)))
    c = loaded(make, compiled, tmp_path, (vertices, faces), over, beside, steps=1200)
    assert c.data.body("over::link").xpos[2] < -3.0
    assert c.data.body("beside::link").xpos[2] == pytest.approx(0.2, abs=0.006)


@pytest.mark.slow
def test_a_ball_rolls_down_an_irregular_channel_as_in_theory(tmp_path):
    x, y = np.meshgrid(np.linspace(0, 12, 71), np.linspace(-3, 3, 71), indexing="ij")
    moved = np.random.default_rng(0).uniform(-0.03, 0.03, (2, *x.shape))
    x, y = x + moved[0], y + moved[1]
    vertices = np.stack([x, y, 0.03 * y * y - 0.2 * x], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(70), np.arange(70), indexing="ij"))
    a = i * 71 + j
    faces = np.vstack([np.column_stack([a, a + 71, a + 72]), np.column_stack([a, a + 72, a + 1])]).astype(np.int32)
    trimesh.Trimesh(vertices, faces, process=False).export(tmp_path / "channel.stl")
    (tmp_path / "world.sdf").write_text(
        '<sdf version="1.9"><world name="w"><model name="channel"><static>true</static><link name="l">'
        '<collision name="c"><geometry><mesh><uri>channel.stl</uri></mesh></geometry></collision></link></model>'
        '<model name="ball"><pose>1 0 0.004 0 0 0</pose><link name="l"><inertial auto="true"/><collision name="c">'
        "<geometry><sphere><radius>0.2</radius></sphere></geometry></collision></link></model></world></sdf>"
    )
    slope = float(np.arctan(0.2))
    with simkit.load(tmp_path / "world.sdf") as sim:
        assert sim.mj_model.nhfield > 300
        sim.run(2.5)
        x, y, z = sim.model("ball").pose.position
    travel = 0.5 * 5.0 / 7.0 * 9.8 * np.sin(slope) * np.cos(slope) * 2.5**2
    assert x - 1.0 == pytest.approx(travel, rel=0.002)
    assert (z + 0.2 * x - 0.03 * y * y) * np.cos(slope) == pytest.approx(0.2, abs=1e-3)


def test_overlapping_boxes_are_those_that_a_comparison_of_all_pairs_finds():
    rng = np.random.default_rng(0)
    low, other = rng.uniform(0.0, 1.0, (40, 3)), rng.uniform(0.0, 1.0, (300, 3))
    high, other_high = low + rng.uniform(0.0, 0.2, (40, 3)), other + rng.uniform(0.0, 0.05, (300, 3))
    other[:3], other_high[:3] = 0.0, 1.0  # as wide as everything
    found = overlaps(low, high, other, other_high)
    expected = np.nonzero((low[:, None] <= other_high).all(axis=2) & (high[:, None] >= other).all(axis=2))
    assert sorted(zip(*map(list, found), strict=True)) == sorted(zip(*map(list, expected), strict=True))
    assert (np.diff(found[0]) >= 0).all()
