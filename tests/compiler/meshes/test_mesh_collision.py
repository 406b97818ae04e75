"""What collides in place of a mesh that is not convex and moves, and what a user hears about it."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh

from simkit.compiler.meshes import convex_decomposition as mesh_collision
from simkit.compiler.meshes.convex_decomposition import convex_bodies
from simkit.compiler.meshes.convex_pieces import filled_ratio, mesh_volume
from simkit.compiler.shape_geometry import polyline_triangles
from simkit.pose import Pose
from simkit.scene import Mesh, Polyline, Sphere
from tests.loaders.meshes.mesh_makers import L_SHAPE, TETRAHEDRON, TETRAHEDRON_FACES

THICK = 0.4
NEEDS_COACD = pytest.mark.skipif(
    importlib.util.find_spec("coacd") is None, reason="the extra `decompose` is not installed"
)


@pytest.fixture
def corner(tmp_path):
    """An L of 1 m × 1 m with a notch of 0.7 m, 0.4 m thick."""
    file = tmp_path / "corner.obj"
    trimesh.Trimesh(*polyline_triangles(Polyline((L_SHAPE,), THICK)), process=False).export(file)
    return file


def resting_height(make, compiled, shape):
    """Where a ball comes to rest that falls (along -y) onto the notch of a heavy L that floats."""
    heavy = make.solid("corner", shape, mass=1e6, inertia=1e6, gravity=False)
    ball = make.solid("ball", Sphere(0.1), Pose((0.6, 1.2, THICK / 2)))
    c = compiled(heavy, ball, gravity=(0.0, -9.8, 0.0))
    ball_y = (
        c.model.jnt_qposadr[c.model.body_jntadr[mujoco.mj_name2id(c.model, mujoco.mjtObj.mjOBJ_BODY, "ball::link")]] + 1
    )
    mujoco.mj_step(c.model, c.data, 1000)
    return float(c.data.qpos[ball_y]), list(c.builder.diagnostics)


@NEEDS_COACD
def test_a_ball_falls_into_the_notch_of_a_decomposed_mesh(make, compiled, corner):
    height, said = resting_height(make, compiled, Mesh(corner, "corner.obj", optimization="convex_decomposition"))
    assert height == pytest.approx(0.3 + 0.1, abs=5e-3)
    assert [(d.severity, d.code) for d in said if "MESH" in d.code] == [("note", "SK-MESH-004")]
    assert "2 convex pieces (together 1.00 times its volume)" in said[0].message


def test_a_ball_does_not_fall_into_the_notch_of_a_hull_and_the_user_hears_of_it(make, compiled, corner):
    height, said = resting_height(make, compiled, Mesh(corner, "corner.obj"))
    assert height > 0.8 or height < 0.0  # on the slope of the hull, or rolled off it
    (found,) = [d for d in said if "MESH" in d.code]
    assert (found.severity, found.code) == ("warning", "SK-MESH-004")
    # hull: the square without the triangle over the notch
    assert f"{(1.0 - 0.7 * 0.7 / 2) / (1.0 - 0.7 * 0.7):.2f} times the mesh's volume" in found.message
    assert "convex_decomposition" in found.hint


def test_of_a_mesh_that_is_not_closed_the_user_hears_how_much_the_hull_fills(make, compiled, tmp_path):
    trough = trimesh.creation.box((1, 1, 0.2))
    for x in (-0.4, 0.4):
        wall = trimesh.creation.box((0.2, 1, 1))
        wall.apply_translation((x, 0, 0.4))
        trough = trimesh.util.concatenate([trough, wall])
    trough.merge_vertices()
    trough.export(tmp_path / "trough.stl")
    c = compiled(make.solid("m", Mesh(tmp_path / "trough.stl", "trough.stl")))
    (found,) = [d for d in c.builder.diagnostics if "MESH" in d.code]
    assert (found.severity, found.code) == ("warning", "SK-MESH-004")
    # 1.1 m³ beside 0.2 m³ for the floor and 0.18 m³ for each wall
    assert "about 1.9 times the volume that the mesh encloses" in found.message or "about 2.0 times" in found.message


def test_the_estimate_for_an_open_mesh_is_near_the_true_share():
    ring = trimesh.creation.torus(0.4, 0.12)
    true = ring.convex_hull.volume / ring.volume
    assert filled_ratio(ring.vertices, ring.faces, [ring.vertices]) == pytest.approx(true, rel=0.2)
    ball = trimesh.creation.icosphere()
    holed = ball.faces[np.arange(len(ball.faces)) % 10 != 0]
    assert filled_ratio(ball.vertices, holed, [ball.vertices]) == pytest.approx(1.0, abs=0.05)


def test_a_hull_that_was_asked_for_is_no_surprise(make, compiled, corner):
    _, said = resting_height(make, compiled, Mesh(corner, "corner.obj", optimization="convex_hull"))
    assert not [d for d in said if "MESH" in d.code]


def test_an_extruded_outline_collides_exactly(make, compiled):
    height, said = resting_height(make, compiled, Polyline((L_SHAPE,), THICK))
    assert height == pytest.approx(0.3 + 0.1, abs=5e-3)
    assert not [d for d in said if "MESH" in d.code]


@pytest.mark.slow
@NEEDS_COACD
def test_a_decomposition_has_the_same_bits_every_time(monkeypatch):
    monkeypatch.setenv("SIMKIT_CACHE_DIR", "/dev/null")
    whole = trimesh.creation.annulus(0.5, 1.0, 0.4, sections=24)
    vertices, faces = np.asarray(whole.vertices, float), np.asarray(whole.faces, np.int32)
    runs = []
    for _ in range(2):
        mesh_collision._memory.clear()
        runs.append(convex_bodies(vertices, faces, fixed=False, optimization="convex_decomposition", most=12))
    assert 2 < len(runs[0].shapes) <= 12
    for (v, f), (w, g) in zip(runs[0].shapes, runs[1].shapes, strict=True):
        np.testing.assert_array_equal(v, w)
        np.testing.assert_array_equal(f, g)
    total = sum(trimesh.Trimesh(v, f, process=False).volume for v, f in runs[0].shapes)
    assert total == pytest.approx(mesh_volume(vertices, faces), rel=0.15)


@NEEDS_COACD
def test_pieces_are_not_more_than_asked_for():
    vertices, faces = polyline_triangles(Polyline((L_SHAPE,), THICK))
    assert len(convex_bodies(vertices, faces, fixed=False, optimization="convex_decomposition", most=1).shapes) == 1


def test_without_the_extra_the_hull_collides_and_the_extra_is_named(make, compiled, corner, monkeypatch):
    monkeypatch.setattr(mesh_collision, "is_available", lambda: False)
    monkeypatch.setattr(mesh_collision, "is_available", lambda: False)
    _, said = resting_height(make, compiled, Mesh(corner, "corner.obj", optimization="convex_decomposition"))
    assert [d.code for d in said if "MESH" in d.code] == ["SK-MESH-014", "SK-MESH-004"]
    assert "simkit-robotics[decompose]" in said[0].hint


def test_a_decomposition_that_breaks_down_is_a_warning(make, compiled, corner, monkeypatch, tmp_path):
    script = tmp_path / "broken.py"
    script.write_text("import os; os.abort()")
    monkeypatch.setattr(mesh_collision, "_SCRIPT", Path(script))
    mesh_collision._memory.clear()
    monkeypatch.setattr(mesh_collision, "is_available", lambda: True)
    _, said = resting_height(make, compiled, Mesh(corner, "corner.obj", optimization="convex_decomposition"))
    assert "SK-MESH-014" in [d.code for d in said]


@NEEDS_COACD
def test_a_static_mesh_is_decomposed_when_asked_and_rays_see_it_as_it_is(make, compiled, corner):
    shape = Mesh(corner, "corner.obj", optimization="convex_decomposition")
    c = compiled(make.model("arena", make.link("arena::link", shape), static=True))
    assert len(c.names.link("arena::link").geoms) == 2
    assert len(c.names.link("arena::link").ray_geoms) == 1


def test_a_mesh_used_by_many_is_spoken_of_once(make, compiled, corner):
    models = [make.solid(f"m{i}", Mesh(corner, "corner.obj"), Pose((2 * i, 0, 0))) for i in range(4)]
    c = compiled(*models)
    assert [d.code for d in c.builder.diagnostics if "MESH" in d.code] == ["SK-MESH-004"]
    assert c.model.nmesh == 2  # the hull for contacts and the triangles for rays


def test_pieces_that_are_convex_already_are_not_joined_by_one_hull(make, compiled, tmp_path):
    two = trimesh.util.concatenate(
        [trimesh.creation.box((1, 1, 1), trimesh.transformations.translation_matrix((x, 0, 0))) for x in (0, 4)]
    )
    two.export(tmp_path / "two.stl")
    c = compiled(make.solid("pair", Mesh(tmp_path / "two.stl", "two.stl")))
    assert len(c.names.link("pair::link").geoms) == 2
    assert not [d for d in c.builder.diagnostics if "MESH" in d.code]


# ---------------------------------------------------------------------- what has no volume


def solid_of(make, compiled, tmp_path, text):
    file = tmp_path / "thin.obj"
    file.write_text(text)
    c = compiled(make.solid("thin", Mesh(file, "thin.obj")))
    return c, [(d.severity, d.code) for d in c.builder.diagnostics if "MESH" in d.code]


def test_a_single_triangle_collides_as_a_plate(make, compiled, tmp_path):
    c, said = solid_of(make, compiled, tmp_path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert said == [("note", "SK-MESH-007")]
    assert len(c.names.link("thin::link").geoms) == 1


def test_triangles_without_area_are_left_out_with_a_word(make, compiled, tmp_path):
    c, said = solid_of(make, compiled, tmp_path, "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n")
    assert said == [("warning", "SK-MESH-003")]
    assert not c.names.link("thin::link").geoms


def test_a_sliver_among_good_triangles_changes_nothing(make, compiled, tmp_path):
    lines = ["v {:g} {:g} {:g}".format(*p) for p in TETRAHEDRON] + [
        f"f {a + 1} {b + 1} {c + 1}" for a, b, c in TETRAHEDRON_FACES
    ]
    c, said = solid_of(make, compiled, tmp_path, "\n".join([*lines, "f 1 1 2", "f 1 2 2"]))
    assert not said
    assert len(c.names.link("thin::link").geoms) == 1


@pytest.mark.parametrize("scale", [(-1.0, 1.0, 1.0), (-1.0, -2.0, 1.0), (-1.0, -1.0, -1.0), (0.5, 3.0, -2.0)])
def test_a_mirrored_mesh_keeps_its_outside_and_its_volume(tmp_path, scale):
    from simkit.diagnostics import NOWHERE, Diagnostics
    from simkit.loaders.meshes.mesh_part import join_parts
    from simkit.loaders.meshes.mesh_reader import load_mesh

    trimesh.Trimesh(TETRAHEDRON, TETRAHEDRON_FACES, process=False).export(tmp_path / "t.stl")
    vertices, faces = join_parts(load_mesh(Mesh(tmp_path / "t.stl", "t.stl", scale), Diagnostics(), NOWHERE))
    assert trimesh.Trimesh(vertices, faces, process=False).volume == pytest.approx(abs(np.prod(scale)))
    assert np.sign(vertices.sum(axis=0)).tolist() == np.sign(scale).tolist()
