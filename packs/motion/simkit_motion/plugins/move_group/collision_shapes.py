"""Shapes of the package `coal` for MuJoCo's geoms and for the objects of a planning scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.extend import Vector

if TYPE_CHECKING:
    from coal import CollisionGeometry

    from simkit.msgs import Message

Triangles = npt.NDArray[np.int64]


def shape_of_geom(model: mujoco.MjModel, geom: int) -> CollisionGeometry | None:
    """Return the shape of a geom in the geom's frame; None for a kind of geom that has no such shape.

    A mesh is its convex hull, as in MuJoCo's collisions. A plane is the half space below it.
    """
    import coal

    kinds, size = mujoco.mjtGeom, [float(v) for v in model.geom_size[geom]]
    kind = int(model.geom_type[geom])
    if kind == kinds.mjGEOM_PLANE:
        return coal.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0)
    if kind == kinds.mjGEOM_SPHERE:
        return coal.Sphere(size[0])
    if kind == kinds.mjGEOM_CAPSULE:
        return coal.Capsule(size[0], 2 * size[1])
    if kind == kinds.mjGEOM_CYLINDER:
        return coal.Cylinder(size[0], 2 * size[1])
    if kind == kinds.mjGEOM_ELLIPSOID:
        return coal.Ellipsoid(*size)
    if kind == kinds.mjGEOM_BOX:
        return coal.Box(*(2 * v for v in size))
    if kind == kinds.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        start, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        return convex_hull(np.array(model.mesh_vert[start : start + count], dtype=float))
    if kind == kinds.mjGEOM_HFIELD:
        return _height_field(model, int(model.geom_dataid[geom]))
    return None


def shape_of_primitive(primitive: Message) -> CollisionGeometry:
    """Return the shape of a `shape_msgs/msg/SolidPrimitive`; its origin and axes are those of the primitive.

    Raises:
        ValueError: The kind is not a box, sphere, cylinder or cone, or a dimension is missing or not positive.
    """
    import coal

    kind, sizes = int(primitive.type), [float(v) for v in primitive.dimensions]
    needed = {primitive.BOX: 3, primitive.SPHERE: 1, primitive.CYLINDER: 2, primitive.CONE: 2}.get(kind)
    if needed is None:
        raise ValueError(
            f"primitive type {kind} is not supported; expected 1 (box), 2 (sphere), 3 (cylinder) or 4 (cone)"
        )
    if len(sizes) < needed or not all(np.isfinite(sizes[:needed])) or min(sizes[:needed]) <= 0:
        raise ValueError(f"dimensions {sizes} are invalid; expected {needed} positive lengths")
    if kind == primitive.BOX:
        return coal.Box(*sizes[:3])
    if kind == primitive.SPHERE:
        return coal.Sphere(sizes[0])
    height, radius = sizes[:2]
    return coal.Cylinder(radius, height) if kind == primitive.CYLINDER else coal.Cone(radius, height)


def convex_hull(points: Vector) -> CollisionGeometry:
    """Return the convex hull of points, shape (n, 3)."""
    import coal
    from scipy.spatial import ConvexHull

    hull = ConvexHull(points)
    used = np.unique(hull.simplices)
    index = np.searchsorted(used, hull.simplices)
    # the faces of a coal.Convex face outwards
    corners = points[used]
    normals = np.cross(corners[index[:, 1]] - corners[index[:, 0]], corners[index[:, 2]] - corners[index[:, 0]])
    inwards = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0
    index[inwards] = index[inwards][:, ::-1]
    vertices, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    vertices.extend(list(corners))
    faces.extend([coal.Triangle(*(int(i) for i in face)) for face in index])
    return coal.Convex(vertices, faces)


def triangle_mesh(points: Vector, triangles: Triangles) -> CollisionGeometry:
    """Return a surface of triangles; its inside is not solid.

    Args:
        points: Vertices [m], shape (n, 3).
        triangles: Indices of the three vertices of each triangle, shape (m, 3).
    """
    import coal

    surface = coal.BVHModelOBBRSS()
    surface.beginModel(len(triangles), len(points))
    surface.addVertices(np.asarray(points, dtype=float))
    surface.addTriangles(np.asarray(triangles, dtype=np.int32))
    surface.endModel()
    return surface


def voxels(centres: Vector, side: float) -> tuple[CollisionGeometry, Vector] | None:
    """Return one shape for many equal cubes, and its position; None if the cubes do not lie in one grid.

    The shape is an octree: a check against 1100 cubes takes 0.03 ms, against as many boxes 2 ms.

    Args:
        centres: Centre of each cube [m], shape (n, 3); the edges are parallel to the axes.
        side: Length of an edge [m].
    """
    import coal

    corner = centres[0] - side / 2
    steps = (centres - centres[0]) / side
    if np.abs(steps - np.round(steps)).max() > 1e-3:
        return None
    return coal.makeOctree(np.ascontiguousarray((np.round(steps) + 0.5) * side), side), corner


def _height_field(model: mujoco.MjModel, field: int) -> CollisionGeometry:
    """Return the surface of a height field."""
    rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    x_half, y_half, top, _ = model.hfield_size[field]
    start = int(model.hfield_adr[field])
    heights = np.array(model.hfield_data[start : start + rows * columns], dtype=float) * top
    y, x = np.meshgrid(np.linspace(-y_half, y_half, rows), np.linspace(-x_half, x_half, columns), indexing="ij")
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    lower = np.stack([corner, corner + 1, corner + columns], axis=1)
    upper = np.stack([corner + 1, corner + columns + 1, corner + columns], axis=1)
    return triangle_mesh(np.stack([x.ravel(), y.ravel(), heights], axis=1), np.vstack([lower, upper]))
