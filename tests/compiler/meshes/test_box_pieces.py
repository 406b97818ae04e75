"""Walls and floors of a large mesh collide as boxes."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
import trimesh

from simkit.compiler.meshes import convex_decomposition
from simkit.compiler.meshes.box_pieces import box_pieces
from simkit.compiler.meshes.convex_decomposition import convex_bodies
from simkit.pose import Pose
from simkit.scene import Mesh, Sphere

SIGNS = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)


@pytest.mark.parametrize("half", [(1.0, 1.0, 1.0), (3.0, 3.0, 0.05), (0.02, 5.0, 2.0), (0.3, 0.2, 0.1)])
def test_turned_boxes_are_found_whatever_the_order_of_their_corners(half):
    rng = np.random.default_rng(0)
    for seed in range(20):
        turn = trimesh.transformations.random_rotation_matrix(rng.random(3))[:3, :3]
        centre = rng.uniform(-20.0, 20.0, 3)
        corners = (rng.permutation(SIGNS) * half) @ turn.T + centre
        (box,) = box_pieces([np.asarray(corners, np.float32).astype(float)])  # as in an STL file
        assert box is not None, seed
        assert np.linalg.det(box.axes) == pytest.approx(1.0, abs=1e-3)
        assert box.centre == pytest.approx(centre, abs=1e-5)
        assert np.sort(box.half) == pytest.approx(np.sort(half), abs=1e-5)
        again = (SIGNS * box.half) @ box.axes.T + box.centre
        distances = np.linalg.norm(again[:, None] - corners, axis=2).min(axis=1)
        assert distances.max() < 1e-5  # the corners are rounded to 2e-6 m


def test_wedges_skewed_boxes_and_other_pieces_are_no_boxes():
    box = SIGNS * (1.0, 0.5, 0.2)
    wedge, skewed, dented = box.copy(), box.copy(), box.copy()
    wedge[box[:, 2] > 0, 0] *= 0.9
    skewed[:, 0] += 0.01 * box[:, 1]
    dented[3] += 1e-3
    flat = box * (1.0, 1.0, 1e-7)
    assert box_pieces([wedge, skewed, dented, flat, box[:7]]) == [None] * 5
    assert [found is None for found in box_pieces([box, wedge, box + 1.0])] == [False, True, False]


def test_balls_rest_on_the_boxes_of_a_city(make, compiled, tmp_path):
    houses = [
        trimesh.creation.box((1, 1, 1 + k % 5)).apply_translation((2.0 * (k % 20), 2.0 * (k // 20), 0.5 * (k % 5)))
        for k in range(400)
    ]
    city = trimesh.util.concatenate(houses)
    city.export(tmp_path / "city.stl")
    bodies = convex_bodies(np.asarray(city.vertices), np.asarray(city.faces, np.int32), fixed=True)
    assert (len(bodies.boxes), len(bodies.shapes), len(bodies.tiles)) == (400, 0, 0)
    assert [code for _, code, _, _ in bodies.findings] == ["SK-MESH-006"]
    chosen = (0, 44, 399)
    balls = [make.solid(f"b{k}", Sphere(0.1), Pose((2.0 * (k % 20), 2.0 * (k // 20), 0.7 + k % 5))) for k in chosen]
    static = make.model("city", make.link("city::link", Mesh(tmp_path / "city.stl", "city.stl")), static=True)
    for _ in range(2):  # the second time from the cache
        c = compiled(static, *balls)
        assert c.model.nmesh == 1  # the mesh that rays hit
        mujoco.mj_step(c.model, c.data, 800)
        for k in chosen:
            assert c.data.body(f"b{k}::link").xpos[2] == pytest.approx(0.6 + k % 5, abs=2e-3)
        convex_decomposition._memory.clear()
