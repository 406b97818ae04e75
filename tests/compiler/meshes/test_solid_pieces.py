"""Closed parts of a large mesh collide as few solid convex pieces, which keep holes and hollows."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
import trimesh

from simkit.compiler.meshes import convex_decomposition
from simkit.compiler.meshes.solid_pieces import is_closed, solid_parts, solid_pieces
from simkit.pose import Pose
from simkit.scene import Mesh, Sphere


def ring(sections=15):
    """Return a ring with a radius of 0.5 m around z and a thickness of 0.3 m."""
    return trimesh.creation.torus(0.5, 0.15, major_sections=sections, minor_sections=10)


def rings(count, turned=(), distance=2.0):
    """Return rings at different places of one mesh."""
    found = []
    for k in range(count):
        one = ring()
        if k in turned:
            one.apply_transform(trimesh.transformations.rotation_matrix(0.3, (1, 0, 0)))
        found.append(one.apply_translation((distance * (k % 6), distance * (k // 6), 0.3 * (k % 3))))
    return trimesh.util.concatenate(found)


def corners_of(mesh):
    return np.asarray(mesh.vertices)[np.asarray(mesh.faces)]


def inside(pieces, point):
    """Return whether a point lies in one of some convex bodies."""
    return any(trimesh.convex.convex_hull(piece).contains([point])[0] for piece in pieces)


@pytest.mark.parametrize(("tolerance", "most"), [(0.03, 10), (0.01, 24)])
def test_a_ring_becomes_few_solid_pieces_within_their_error(tolerance, most):
    mesh = ring(60)
    pieces, error = solid_pieces(corners_of(mesh), tolerance)
    assert len(pieces) <= most
    assert 0.2 * tolerance < error <= tolerance
    points, of = trimesh.sample.sample_surface(mesh, 1000, seed=0)
    normals = mesh.face_normals[of]
    hulls = trimesh.util.concatenate([trimesh.convex.convex_hull(piece) for piece in pieces])
    hits, rays, _ = hulls.ray.intersects_location(points + 0.1 * normals, -normals, multiple_hits=False)
    above = np.einsum("ij,ij->i", hits - points[rays], normals[rays])
    assert len(rays) == 1000
    assert above.min() > -1e-4 and above.max() < 1.5 * error  # along the normal, not along the shortest way


@pytest.mark.parametrize("height", [0.01, 1.0])
def test_the_hole_of_a_plate_or_a_pipe_stays(height):
    pipe = trimesh.creation.annulus(0.3, 0.5, height, sections=64)
    pieces, error = solid_pieces(corners_of(pipe), 0.03)  # the plate is thinner than the error
    assert len(pieces) <= 16
    assert error <= 0.03
    for radius, is_solid in ((0.0, False), (0.26, False), (0.4, True), (0.52, False)):
        for angle in 0.1 + np.arange(8) * 0.8:
            assert inside(pieces, (radius * np.cos(angle), radius * np.sin(angle), 0.1 * height)) == is_solid, (
                radius,
                angle,
            )


def test_a_rock_is_left_to_height_fields():
    ball = trimesh.creation.icosphere(subdivisions=3)
    waves = np.sin(3.0 * ball.vertices @ np.array([(1.0, 2.0, 0.5), (2.0, -1.0, 1.5), (0.3, 1.0, -2.0)]))
    rock = trimesh.Trimesh(ball.vertices * (1.0 + 0.08 * waves.sum(axis=1))[:, None], ball.faces)
    assert solid_pieces(corners_of(rock), 2e-3) is None


def test_equal_rings_are_divided_once_and_share_their_pieces():
    mesh = rings(9, turned=(4,))
    faces = np.asarray(mesh.faces)
    parts = list(np.arange(len(faces)).reshape(9, -1))
    rounded = np.asarray(mesh.vertices, np.float32).astype(float)  # as in an STL file
    found = solid_parts(rounded, faces, parts, 0.03)
    straight, turned = (len(solid_pieces(corners_of(rings(2, turned=(1,)))[of], 0.03).pieces) for of in parts[:2])
    assert len(found.faces) == 9
    assert len(found.pieces) == straight + turned
    assert len(found.copies) == 7 * straight
    for number, offset in found.copies:
        place = found.pieces[number].mean(axis=0) + offset
        assert 0.3 < np.linalg.norm(place[:2] - 2.0 * np.round(place[:2] / 2.0)) < 0.65


def test_an_open_surface_is_not_closed():
    mesh = ring()
    assert is_closed(np.asarray(mesh.faces))
    assert not is_closed(np.asarray(mesh.faces)[1:])
    assert not is_closed(np.vstack([mesh.faces[1:], mesh.faces[:1, ::-1]]))


@pytest.mark.slow
def test_balls_rest_on_every_ring_and_fall_through_its_hole(make, compiled, tmp_path):
    mesh = rings(30, distance=8.0)  # 9000 triangles
    mesh.export(tmp_path / "rings.stl")
    centres = [(8.0 * (k % 6), 8.0 * (k // 6), 0.3 * (k % 3)) for k in range(30)]
    chosen = {f"{kind}{k}": (centres[k], kind) for k in (0, 7, 29) for kind in ("on", "in")}
    balls = [
        make.solid(name, Sphere(0.1), Pose((x + (0.5 if kind == "on" else 0.0), y, z + 0.26)))
        for name, ((x, y, z), kind) in chosen.items()
    ]
    static = make.model("rings", make.link("rings::link", Mesh(tmp_path / "rings.stl", "rings.stl")), static=True)
    for _ in range(2):  # the second time from the cache
        c = compiled(static, *balls)
        assert c.model.nmesh <= 15  # pieces of one ring, and the mesh that rays hit
        mujoco.mj_step(c.model, c.data, 200)
        for name, ((_, _, z), kind) in chosen.items():
            height = float(c.data.body(f"{name}::link").xpos[2]) - z
            if kind == "on":
                assert height == pytest.approx(0.25, abs=0.02), name
            else:
                assert height < 0.08, name
        convex_decomposition._memory.clear()
