"""Normals of the surfaces that rays hit: from the shape of a geom, or from the triangle of a mesh or heightmap.

The casters of rays give no normals, because few sensors need them. They are computed afterwards, for the hits only.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import mujoco
import numpy as np

from simkit.pose import Vector
from simkit.sensors.rays.geom_types import BOX, CAPSULE, CYLINDER, ELLIPSOID, HFIELD, MESH, PLANE, SPHERE, Ids
from simkit.sensors.rays.ray_fan import RayFan

_TINY = 1e-300  # replacement for a zero divisor


class BodyFrames(Protocol):
    """Poses of bodies while rays are measured."""

    def frames(self, bodies: Ids, rays: Ids) -> tuple[Vector, Vector]:
        """Return positions [m], shape (m, 3), and rotation matrices, shape (m, 3, 3), of one body for each ray."""


class InstantFrames:
    """Poses of bodies at one instant.

    Args:
        data: data with up-to-date poses.
    """

    def __init__(self, data: mujoco.MjData) -> None:
        self._data = data

    def frames(self, bodies: Ids, rays: Ids) -> tuple[Vector, Vector]:
        return self._data.xpos.take(bodies, 0), self._data.xmat.take(bodies, 0).reshape(-1, 3, 3)


def hit_normals(
    fan: RayFan,
    frames: BodyFrames,
    origins: Vector,
    directions: Vector,
    start: float = 0.0,
) -> Vector:
    """Return the unit normals in the world of the surfaces that the rays of a fan hit last, shape (n, 3).

    A normal points to the side from which its ray comes. The normal of a ray without a hit is 0.

    Args:
        fan: fan with the distances and hits of its last cast.
        frames: poses of the bodies during the cast.
        origins: origins of the rays in the world [m], shape (3,) or (n, 3).
        directions: unit vectors in the world, shape (n, 3).
        start: distance from the origin at which the rays start [m].
    """
    normals, geoms = np.zeros((fan.count, 3)), fan.geoms
    rays = np.flatnonzero((geoms >= 0) & np.isfinite(fan.distances))
    if not rays.size:
        return normals
    model = fan.targets.model
    hit_geoms = geoms.take(rays).astype(np.intp)
    bodies = model.geom_bodyid.take(hit_geoms).astype(np.intp)
    positions, turns = frames.frames(bodies, rays)
    origin = origins if origins.ndim == 1 else origins.take(rays, 0)
    forward, distances = directions.take(rays, 0), fan.distances.take(rays)
    local_origins, local_directions = _into(turns, origin - positions), _into(turns, forward)
    kinds = model.geom_type.take(hit_geoms)
    local = np.zeros((len(rays), 3))
    points = local_origins + local_directions * distances[:, None]
    for kind, normals_of in _NORMALS.items():
        which = np.flatnonzero(kinds == kind)
        if which.size:
            local[which] = _shape_normals(model, hit_geoms.take(which), points.take(which, 0), normals_of)
    which = np.flatnonzero((kinds == MESH) | (kinds == HFIELD))
    if which.size:
        ways = local_origins.take(which, 0), local_directions.take(which, 0), distances.take(which)
        local[which] = _triangle_normals(fan, hit_geoms.take(which), ways, start)
    normals[rays] = _towards(_out_of(turns, local), forward)
    return normals


def _into(turns: Vector, vectors: Vector) -> Vector:
    """Return vectors in the frames of rotation matrices, shape (m, 3), with the same bits for any m."""
    x, y, z = vectors.T
    return np.stack([turns[:, 0, i] * x + turns[:, 1, i] * y + turns[:, 2, i] * z for i in range(3)], axis=1)


def _out_of(turns: Vector, vectors: Vector) -> Vector:
    """Return vectors given in the frames of rotation matrices, shape (m, 3)."""
    x, y, z = vectors.T
    return np.stack([turns[:, i, 0] * x + turns[:, i, 1] * y + turns[:, i, 2] * z for i in range(3)], axis=1)


def _towards(normals: Vector, directions: Vector) -> Vector:
    """Return the normals, turned against the rays, with length 1."""
    along = dots(normals, directions)
    length = np.sqrt(np.maximum(dots(normals, normals), _TINY))
    turned: Vector = normals * (np.where(along > 0.0, -1.0, 1.0) / length)[:, None]
    return turned


def dots(first: Vector, second: Vector) -> Vector:
    """Return the scalar products of rows, shapes (n, 3), with the same bits for any n."""
    products: Vector = first[:, 0] * second[:, 0]
    products += first[:, 1] * second[:, 1]
    products += first[:, 2] * second[:, 2]
    return products


# ---------------------------------------------------------------------- shapes

ShapeNormals = Callable[[Vector, Vector], Vector]


def _shape_normals(model: mujoco.MjModel, geoms: Ids, points: Vector, normals_of: ShapeNormals) -> Vector:
    """Return normals in the body's frame for points of shapes in the body's frame."""
    used = sorted(set(geoms.tolist()))
    turns = np.zeros((model.ngeom, 3, 3))
    matrix = np.empty(9)
    for geom in used:
        mujoco.mju_quat2Mat(matrix, model.geom_quat[geom])
        turns[geom] = matrix.reshape(3, 3)
    own = turns.take(geoms, 0)
    local = _into(own, points - model.geom_pos.take(geoms, 0))
    return _out_of(own, normals_of(local, model.geom_size.take(geoms, 0)))


def _plane(points: Vector, _sizes: Vector) -> Vector:
    normals = np.zeros_like(points)
    normals[:, 2] = 1.0
    return normals


def _sphere(points: Vector, _sizes: Vector) -> Vector:
    return points


def _ellipsoid(points: Vector, sizes: Vector) -> Vector:
    normals: Vector = points / (sizes * sizes)
    return normals


def _box(points: Vector, sizes: Vector) -> Vector:
    normals, rows = np.zeros_like(points), np.arange(len(points))
    # the face is that whose plane is nearest
    axes = (np.abs(points) - sizes).argmax(axis=1)
    normals[rows, axes] = np.copysign(1.0, points[rows, axes])
    return normals


def _cylinder(points: Vector, sizes: Vector) -> Vector:
    x, y, z = points.T
    is_cap = np.abs(np.abs(z) - sizes[:, 1]) < np.abs(np.sqrt(x * x + y * y) - sizes[:, 0])
    return np.stack((np.where(is_cap, 0.0, x), np.where(is_cap, 0.0, y), np.where(is_cap, z, 0.0)), axis=1)


def _capsule(points: Vector, sizes: Vector) -> Vector:
    normals = points.copy()
    normals[:, 2] -= np.clip(points[:, 2], -sizes[:, 1], sizes[:, 1])
    return normals


_NORMALS: dict[int, ShapeNormals] = {
    PLANE: _plane,
    SPHERE: _sphere,
    ELLIPSOID: _ellipsoid,
    BOX: _box,
    CYLINDER: _cylinder,
    CAPSULE: _capsule,
}

# ---------------------------------------------------------------------- triangles


Ways = tuple[Vector, Vector, Vector]
"""Origins [m], directions and distances [m] of rays in the frame of the body that each of them hits."""


def _triangle_normals(fan: RayFan, geoms: Ids, ways: Ways, start: float) -> Vector:
    """Return normals in the body's frame of the triangles that rays hit."""
    targets = fan.targets
    if not targets.has_embree:
        return _engine_normals(targets.model, geoms, ways[0] + start * ways[1], ways[1])
    normals = np.zeros((len(geoms), 3))
    for body in targets.triangles_for_engine if fan.by_engine else targets.triangles_and_boxes:
        which = np.flatnonzero(np.isin(geoms, body.geoms))
        if which.size:
            origins, directions, distances = (column.take(which, 0) for column in ways)
            # the same rays find the same triangles again, since nothing nearer belongs to the body
            limit = (distances * (1.0 + 1e-6) + 1e-5).astype(np.float32)
            hits, found = body.hit_normals(origins, directions, start, limit)
            # a ray that rounding moves past an edge keeps a surface that faces it
            normals[which] = -directions
            normals[which[hits]] = found
    return normals


def _engine_normals(model: mujoco.MjModel, geoms: Ids, origins: Vector, directions: Vector) -> Vector:
    """Return normals of meshes and heightmaps from MuJoCo, one ray at a time, for machines without Embree."""
    data, normals = mujoco.MjData(model), np.zeros((len(geoms), 3))
    turn, normal = np.empty(9), np.zeros(3)
    for row, geom in enumerate(geoms.tolist()):
        # a data whose bodies are at the origin: the geoms have their poses in the body's frame
        data.geom_xpos[geom] = model.geom_pos[geom]
        mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
        data.geom_xmat[geom] = turn
        ray = mujoco.mj_rayMesh if int(model.geom_type[geom]) == MESH else mujoco.mj_rayHfield
        distance = ray(model, data, geom, origins[row], directions[row], normal)
        normals[row] = normal if distance >= 0 else -directions[row]
    return normals
