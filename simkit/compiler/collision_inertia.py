"""Inertia of the collisions of links, for files whose links have a mass and no moments of inertia."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from simkit.diagnostics import Diagnostics
from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul
from simkit.loaders.meshes.mesh_part import Floats, MeshPart, join_parts
from simkit.loaders.sdf.solid_moments import Solid, solid_of, solid_of_triangles
from simkit.scene import Mesh, SceneCollision, SceneLink

Matrix = npt.NDArray[np.float64]


def collision_inertia(links: Sequence[SceneLink], mass: float, diagnostics: Diagnostics) -> Matrix | None:
    """Return the inertia of a mass that fills the collisions of links evenly.

    A mesh counts as its convex hull, because files with such links often have meshes that are not closed.

    Args:
        links: links that are rigidly connected.
        mass: mass of all links together [kg].
        diagnostics: collection for the problems of mesh files.

    Returns:
        The tensor about the centroid of the collisions [kg·m²], in world axes, shape (3, 3). None if the collisions
        have no volume.
    """
    solids: list[tuple[float, Floats, Matrix]] = []
    for link in links:
        for collision in link.collisions:
            solid = _solid(collision, diagnostics)
            if solid is None or not (solid[0] > 0.0 and np.isfinite(solid[2]).all()):
                continue
            pose = link.pose_world @ collision.pose_link
            solids.append((solid[0], pose.transform(solid[1]), matmul(pose.matrix, solid[2], pose.matrix.T)))
    volume = float_sum(part for part, _, _ in solids)
    if not solids or not np.isfinite(volume):
        return None
    middle = sum((part * centre for part, centre, _ in solids), np.zeros(3)) / volume
    total = np.zeros((3, 3))
    for part, centre, moments in solids:
        d = centre - middle
        total += moments + part * (float(matmul(d, d)) * np.eye(3) - np.outer(d, d))
    inertia: Matrix = total * (mass / volume)
    return inertia


def _solid(collision: SceneCollision, diagnostics: Diagnostics) -> Solid | None:
    """Return volume, centroid and moments of a collision in its own frame; None for a shape without volume."""
    shape = collision.geometry
    if not isinstance(shape, Mesh):
        return solid_of(shape)
    from scipy.spatial import ConvexHull, QhullError

    from simkit.loaders.meshes.mesh_reader import load_mesh

    vertices, _ = join_parts([] if shape.missing else load_mesh(shape, diagnostics, collision.where))
    try:
        faces = ConvexHull(vertices).simplices
    except (QhullError, ValueError):
        return None
    middle = vertices[faces].mean(axis=(0, 1))
    a, b, c = (vertices[faces[:, i]] - middle for i in range(3))
    is_inwards = np.einsum("ij,ij->i", a, np.cross(b, c)) < 0.0
    faces[is_inwards] = faces[is_inwards, ::-1]
    return solid_of_triangles([MeshPart("", vertices, faces)])
