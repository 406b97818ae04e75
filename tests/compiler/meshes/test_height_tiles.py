"""Large regular grids collide as height fields: exact, and fast to load."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
import trimesh

from simkit.compiler.meshes.surface_patches import large_surface_pieces
from simkit.pose import Pose
from simkit.scene import Box, Mesh, Sphere

COUNT, STEP = 53, 0.2


def ground(is_turned=False):
    """Return 5408 triangles of bumps; the cells are divided along one diagonal or the other."""
    x, y = np.meshgrid(np.arange(COUNT) * STEP, np.arange(COUNT) * STEP, indexing="ij")
    z = 0.2 * np.sin(1.3 * x) * np.sin(1.7 * y) + 0.05 * np.random.default_rng(0).random(x.shape)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(COUNT - 1), np.arange(COUNT - 1), indexing="ij"))
    a, b, c, d = i * COUNT + j, (i + 1) * COUNT + j, (i + 1) * COUNT + j + 1, i * COUNT + j + 1
    halves = ((a, b, d), (b, c, d)) if is_turned else ((a, b, c), (a, c, d))
    faces = np.vstack([np.column_stack(half) for half in halves]).astype(np.int32)
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), faces


def turned(vertices, axis):
    """Return vertices whose heights are along another axis, with the same sense of rotation."""
    return np.roll(vertices, axis - 2, axis=1)


def settle(make, compiled, tmp_path, vertices, faces, *bodies, steps=1500):
    """Return a world with a static mesh and moving bodies after some milliseconds."""
    trimesh.Trimesh(vertices, faces, process=False).export(tmp_path / "mesh.stl")
    shape = Mesh(tmp_path / "mesh.stl", "mesh.stl")
    c = compiled(make.model("mesh", make.link("mesh::link", shape), static=True), *bodies)
    mujoco.mj_step(c.model, c.data, steps)
    return c


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("is_turned", [False, True])
def test_tiles_are_the_surface_itself(compiled, make, tmp_path, axis, is_turned):
    vertices, faces = ground(is_turned)
    pieces, tiles, error, _ = large_surface_pieces(turned(vertices, axis), faces)
    assert (len(pieces), len(tiles)) == (0, 11 * 11)
    assert error < 1e-3
    c = settle(make, compiled, tmp_path, turned(vertices, axis), faces, steps=1)
    rng = np.random.default_rng(1)
    places = np.column_stack([rng.uniform(0.1, 10.2, (200, 2)), np.full(200, 3.0)])
    true, _, _ = trimesh.Trimesh(vertices, faces).ray.intersects_location(
        places, np.tile((0.0, 0.0, -1.0), (200, 1)), multiple_hits=False
    )
    down = turned(np.array([(0.0, 0.0, -1.0)]), axis)[0]
    fields = np.flatnonzero(c.model.geom_type == mujoco.mjtGeom.mjGEOM_HFIELD)
    for start, hit in zip(turned(places, axis), true, strict=True):
        distances = [mujoco.mj_rayHfield(c.model, c.data, int(g), start, down, None) for g in fields]
        assert min(d for d in distances if d >= 0.0) == pytest.approx(3.0 - hit[2], abs=1e-5)


def test_the_tiles_of_a_downward_surface_lie_behind_it():
    vertices, faces = ground()
    _, tiles, _, _ = large_surface_pieces(vertices, faces[:, ::-1])
    assert {tuple(tile.axes[:, 2]) for tile in tiles} == {(0.0, 0.0, -1.0)}
    top = max(float(tile.origin[2]) + tile.base for tile in tiles)
    assert top <= vertices[:, 2].max() + 0.05 + 1e-9  # the layer lies behind the surface, here above it


@pytest.mark.slow
def test_a_ball_between_two_layers_of_a_grid_stays_there(make, compiled, tmp_path):
    vertices, faces = ground()
    upper = vertices + np.array((0.0, 0.0, 0.7))
    mesh = np.vstack([vertices, upper]), np.vstack([faces, faces + len(vertices)])
    ball = make.solid("ball", Sphere(0.05), Pose((5.0, 5.0, 0.45)))
    c = settle(make, compiled, tmp_path, *mesh, ball)
    assert -0.3 < c.data.body("ball::link").xpos[2] < 0.4


def test_a_box_as_wide_as_many_cells_rests_on_a_fine_grid(make, compiled, tmp_path):
    vertices, faces = ground()
    vertices = vertices * (0.2, 0.2, 0.02)  # cells of 4 cm
    c = settle(make, compiled, tmp_path, vertices, faces, make.solid("box", Box((1.2, 1.2, 0.2)), Pose((1, 1, 0.15))))
    assert c.data.body("box::link").xpos[2] == pytest.approx(0.1 + vertices[:, 2].max(), abs=2e-3)
    assert abs(c.data.body("box::link").xmat[8]) > 0.9999


def test_a_hole_and_a_plane_in_a_grid_stay_as_they_are():
    vertices, faces = ground()
    middle = np.linalg.norm(vertices[faces].mean(axis=1)[:, :2] - 5.0, axis=1)
    _, tiles, _, _ = large_surface_pieces(vertices, faces[middle > 0.8])
    covered = sum((t.heights.shape[0] - 1) * (t.heights.shape[1] - 1) for t in tiles)
    assert covered < (middle > 0.8).sum() / 2
    vertices[:, 2] = np.where(vertices[:, 0] < 8.0, 0.0, vertices[:, 2])
    pieces, tiles, _, _ = large_surface_pieces(vertices, faces)
    assert 0 < len(tiles) <= 4 * 11  # the plane is a few large patches
    assert len(pieces) < 60
