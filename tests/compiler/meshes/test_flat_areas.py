"""Walls and floors of large static meshes collide as few exact pieces."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from simkit.compiler.meshes.surface_patches import large_surface_pieces


@pytest.fixture(scope="module")
def rooms():
    """One-sided walls of 3 × 3 rooms with doors in 4608 triangles, and a few more for a small dome."""
    parts = []
    for i in range(4):
        for j in range(3):
            for low, width, bottom in ((0.0, 1.5, 0.0), (1.5, 1.0, 2.0), (2.5, 1.5, 0.0)):
                v = np.array(
                    [(4 * i, 4 * j + low + dy * width, bottom + dz * (2.6 - bottom)) for dy in (0, 1) for dz in (0, 1)]
                )
                faces = np.array([(0, 2, 3), (0, 3, 1)])
                parts += [trimesh.Trimesh(v, faces), trimesh.Trimesh(v[:, (1, 0, 2)], faces[:, ::-1])]
    walls = trimesh.util.concatenate(parts)
    for _ in range(2):
        walls = walls.subdivide()
    dome = trimesh.creation.icosphere(subdivisions=4, radius=0.5).slice_plane((0, 0, 0), (0, 0, 1))
    walls = trimesh.util.concatenate([walls, dome.apply_translation((2, 2, 0))])
    walls.merge_vertices()
    return np.asarray(walls.vertices), np.asarray(walls.faces, np.int32)


def test_walls_with_doors_are_divided_along_their_doors(rooms):
    vertices, faces = rooms
    pieces, _, error, _ = large_surface_pieces(vertices, faces)
    walls = [p.points for p in pieces if np.ptp(p.points, axis=0).min() < 0.06 and p.points[:, 2].max() > 2.0]
    assert len(walls) <= 24 * 3 + 24  # three convex areas of each wall, and some that crossing walls divide
    assert error < 0.02
    for x, y in ((4.0, 2.0), (8.0, 6.0), (2.0, 4.0)):  # doors
        for points in walls:
            low, high = points.min(axis=0), points.max(axis=0)
            assert not ((low < (x, y, 1.0)) & ((x, y, 1.0) < high)).all()
