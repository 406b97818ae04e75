"""Volumes with which links displace air or water, computed from the collisions of the links."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from simkit.extend import Diagnostics, SceneCollision, SceneLink, SharedByCopies, Vector
from simkit.linear_algebra import matmul
from simkit.loaders.meshes.mesh_part import join_parts
from simkit.scene import Cylinder, Geometry, Mesh, Polyline
from simkit_water_and_air.plugins.fluids.submerged_volume import Polyhedron, Solid, Triangles, solid_of


@dataclass(frozen=True, eq=False)
class Hull:
    """Volume of one collision that displaces a fluid.

    Attributes:
        volume: Volume [m³].
        centre: Centre of the volume in the link's frame [m], shape (3,).
        reach: Upper bound of the distance from the centre to any point of the volume [m].
        solid: Shape of the volume; None if only volume, centre and reach are known.
        axes, origin: Rotation matrix and position [m] of the solid's frame in the link's frame.
    """

    volume: float
    centre: Vector
    reach: float = 0.0
    solid: Solid | None = None
    axes: Vector = field(default_factory=lambda: np.eye(3))
    origin: Vector = field(default_factory=lambda: np.zeros(3))


class HullFactory(SharedByCopies):
    """Factory of hulls; it converts equal shapes only once. A deep copy returns the same object.

    Args:
        on_open_mesh: Function called with the scoped name of a collision whose mesh is open. The convex hull of the
            mesh is used in this case.
    """

    def __init__(self, on_open_mesh: Callable[[str], None]) -> None:
        self._on_open_mesh = on_open_mesh
        self._solids: dict[Geometry, Solid | None] = {}

    def hulls(self, link: SceneLink) -> list[Hull]:
        """Return one hull for each collision of a link; collisions without a volume have none."""
        return [hull for collision in link.collisions if (hull := self.hull(collision)) is not None]

    def hull(self, collision: SceneCollision) -> Hull | None:
        """Return the hull of a collision; None if it has no volume."""
        shape = collision.geometry
        if shape not in self._solids:
            self._solids[shape] = solid_of(shape, lambda other: self._triangles(other, collision))
        solid = self._solids[shape]
        if solid is None:
            return None
        axes, origin = collision.pose_link.matrix, np.asarray(collision.pose_link.position, float)
        return Hull(solid.volume, origin + matmul(axes, solid.centre), solid.reach, solid, axes, origin)

    def _triangles(self, shape: Geometry, collision: SceneCollision) -> Triangles | None:
        from simkit.compiler.meshes.convex_decomposition import convex_hull
        from simkit.compiler.meshes.convex_pieces import mesh_volume

        vertices, faces = _surface(shape, collision)
        if not len(faces):
            return None
        if mesh_volume(vertices, faces) <= 0:
            self._on_open_mesh(collision.scoped)
            convex = convex_hull(vertices)
            if convex is None or not len(convex[1]):
                return None
            vertices, faces = convex
        corners: Triangles = np.asarray(vertices, float)[np.asarray(faces)]
        return corners


def _surface(shape: Geometry, collision: SceneCollision) -> tuple[Vector, npt.NDArray[np.int32]]:
    """Return the vertices and faces of a mesh or an extruded outline.

    Faults of a mesh file are not reported here, because the compiler has already reported them.
    """
    from simkit.compiler.shape_geometry import polyline_triangles
    from simkit.loaders.meshes.mesh_reader import load_mesh

    if isinstance(shape, Polyline):
        try:
            return polyline_triangles(shape)
        except ValueError:
            return np.zeros((0, 3)), np.zeros((0, 3), int)
    if not isinstance(shape, Mesh) or shape.missing:
        return np.zeros((0, 3)), np.zeros((0, 3), int)
    return join_parts(load_mesh(shape, Diagnostics(), collision.where))


def link_size(link: SceneLink) -> Vector:
    """Return the size of the box around a link's collisions, along the axes of the link [m], shape (3,).

    A round shape counts as the ball around it, except a cylinder.
    """
    factory, bounds = HullFactory(lambda _: None), []
    for collision in link.collisions:
        hull = factory.hull(collision)
        if hull is not None:
            bounds.append(_bounds(hull, collision.geometry))
    if not bounds:
        return np.zeros(3)
    corners = np.array(bounds)
    size: Vector = corners[:, 1].max(axis=0) - corners[:, 0].min(axis=0)
    return size


def _bounds(hull: Hull, shape: Geometry) -> tuple[Vector, Vector]:
    """Return the corners of the box around a hull, in the axes of the link [m]."""
    if isinstance(hull.solid, Polyhedron):
        points = hull.origin + matmul(hull.solid.corners.reshape(-1, 3), hull.axes.T)
        return points.min(axis=0), points.max(axis=0)
    half = np.full(3, hull.reach)
    if isinstance(shape, Cylinder):
        along = np.abs(hull.axes[:, 2])
        half = shape.length / 2 * along + shape.radius * np.sqrt(np.maximum(0.0, 1.0 - along * along))
    return hull.centre - half, hull.centre + half


def link_triangles(link: SceneLink) -> Vector:
    """Return the surfaces of a link's collisions as triangles in the link's frame [m], shape (n, 3, 3).

    A cylinder becomes a prism with 24 sides; other round shapes are left out.
    """
    factory, parts = HullFactory(lambda _: None), [np.zeros((0, 3, 3))]
    for collision in link.collisions:
        hull = factory.hull(collision)
        if hull is None:
            continue
        if isinstance(hull.solid, Polyhedron):
            corners = hull.solid.corners
        elif isinstance(collision.geometry, Cylinder):
            corners = _prism(collision.geometry.radius, collision.geometry.length)
        else:
            continue
        parts.append((hull.origin + matmul(corners.reshape(-1, 3), hull.axes.T)).reshape(-1, 3, 3))
    return np.concatenate(parts)


def _prism(radius: float, length: float, sides: int = 24) -> Vector:
    """Return the triangles of a prism about z, counter-clockwise from outside."""
    angles = [2 * math.pi * side / sides for side in range(sides + 1)]
    ring = [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]
    half, triangles = length / 2, []
    for (x, y), (u, v) in itertools.pairwise(ring):
        low, high, next_low, next_high = (x, y, -half), (x, y, half), (u, v, -half), (u, v, half)
        triangles += [(low, next_low, next_high), (low, next_high, high)]
        triangles += [((0.0, 0.0, half), high, next_high), ((0.0, 0.0, -half), next_low, low)]
    return np.array(triangles)
