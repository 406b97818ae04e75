"""Culling of geoms that the rays of a fan cannot hit because they stay above or below all rays.

Joints connect a sensor to its own robot. A body without a joint between it and the sensor has a constant pose in the
fan's frame. A body behind hinges and ball joints stays within a sphere around the first of them, whose radius grows
along the chain.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul, norm
from simkit.pose import Pose, Vector
from simkit.sensors.rays.geom_types import Ids
from simkit.sensors.rays.numpy_rays import FanDirections, pairs_towards

MANY_PAIRS = 1 << 15
"""Number of rays towards one sphere from which they are no longer computed together with those towards others."""


@dataclass(slots=True)  # not frozen, which would cost a microsecond per cast
class RayBundle:
    """Rays from one point.

    Attributes:
        origin: origin in the world [m], shape (3,).
        columns: unit vectors in the world, shape (3, n).
        start: distance from the origin at which the rays start [m].
        reach: distance beyond which hits are ignored [m].
        limit: bits of the reach (see `finite_limit_bits`).
        axis: unit vector in the world, shape (3,).
        lowest, highest: elevations above the plane perpendicular to `axis` that contain all rays [rad].
        search: directions in the sensor's frame, which know the rays towards a sphere; None tests every ray.
        rotation: rotation matrix of the sensor's frame, shape (3, 3).
    """

    origin: Vector
    columns: Vector
    start: float
    reach: float
    limit: npt.NDArray[np.uint64]
    axis: Vector
    lowest: float
    highest: float
    search: FanDirections | None = None
    rotation: Vector | None = None

    @property
    def directions(self) -> Vector:
        """Unit vectors in the world, shape (n, 3)."""
        return self.columns.T

    def pairs(self, centres: Vector, radii: Vector) -> Iterator[tuple[Ids, Ids]]:
        """Yield spheres and the rays that may hit them, some at a time; no such ray is missing.

        Args:
            centres: centres of the spheres from the origin, in the world [m], shape (m, 3).
            radii: radii [m], shape (m,).

        Yields:
            Indices of spheres, ascending, and of rays, either as pairs, or one sphere and all rays towards it.
        """
        if self.search is not None and self.rotation is not None:
            yield from self.search.pairs(matmul(centres, self.rotation), radii, large=MANY_PAIRS)
        else:
            yield from pairs_towards(self.directions, centres, radii)


RayHits = tuple[Vector, npt.NDArray[np.int32], npt.NDArray[np.bool_]]
"""Distances [m], infinite for misses; geom ids, -1 for misses; and a mask of the infinite distances."""


def reaches_plane(rays: RayBundle, point: Sequence[float], normal: Sequence[float]) -> bool:
    """Check whether a ray may hit the front of a plane within the reach; False is always correct, True may be wrong."""
    (x, y, z), (ax, ay, az), (nx, ny, nz) = rays.origin.tolist(), rays.axis.tolist(), normal
    height = nx * (x - point[0]) + ny * (y - point[1]) + nz * (z - point[2])
    steepest = max(abs(rays.lowest), abs(rays.highest))
    tilt = math.acos(min(1.0, abs(nx * ax + ny * ay + nz * az))) + steepest
    fall = rays.reach * math.sin(tilt) if tilt < math.pi / 2 else rays.reach
    return bool(0.0 <= height <= fall * (1 + 1e-9) + 1e-9)


def finite_limit_bits(reach: float) -> npt.NDArray[np.uint64]:
    """Return the bits of the longest finite distance within the reach, for fast comparison of many distances."""
    return np.array(min(reach, float(np.finfo(np.float64).max))).view(np.uint64)


_ROTARY_JOINTS = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_BALL))
_MARGIN = 1e-9  # [m]
ENDLESS = 1e9
"""Half size that replaces the infinite size of a plane [m]."""


@dataclass(frozen=True, slots=True)
class BodyTie:
    """Constraint on a body's position in the fan's frame.

    The body's pose is constant, or one of its points stays within a sphere.

    Attributes:
        pose: pose of the body in the fan's frame; None if joints move the body.
        centre: centre of the sphere in the fan's frame [m], shape (3,).
        point: point of the body that stays within the sphere [m], in the body's frame, shape (3,).
        slack: radius of the sphere [m].
    """

    pose: Pose | None
    centre: Vector
    point: Vector
    slack: float


def reaches_between_cones(
    height: Vector, side: Vector, radius: Vector, lowest: float, highest: float
) -> npt.NDArray[np.bool_]:
    """Check which spheres extend between the cones that bound a fan's elevations.

    Args:
        height: distances of the centres along the fan's axis [m].
        side: distances of the centres from the fan's axis [m].
        radius: radii of the spheres [m].
        lowest: elevation of the lower cone above the plane perpendicular to the axis [rad].
        highest: elevation of the upper cone above that plane [rad].
    """
    above = height * math.cos(highest) - side * math.sin(highest)
    below = side * math.sin(lowest) - height * math.cos(lowest)
    is_reached: npt.NDArray[np.bool_] = (above <= radius + _MARGIN) & (below <= radius + _MARGIN)
    return is_reached


def geom_half_sizes(model: mujoco.MjModel, geoms: npt.NDArray[np.intp]) -> Vector:
    """Return half the sizes of the boxes around geoms, along their own axes [m], shape (m, 3)."""
    is_plane = model.geom_type[geoms] == int(mujoco.mjtGeom.mjGEOM_PLANE)
    halves: Vector = np.where(is_plane[:, None], ENDLESS, model.geom_aabb[geoms, 3:])
    return halves


class NearbyGeoms:
    """Planes and shapes, with a search for those that a fan can hit at their current poses.

    Args:
        model: compiled model.
        which: numbers of the geoms, shape (m,).
        geoms: geom ids, shape (m,).
    """

    def __init__(self, model: mujoco.MjModel, which: npt.NDArray[np.intp], geoms: npt.NDArray[np.intp]) -> None:
        self._which, self._geoms = which, geoms
        bounds = model.geom_rbound[geoms]
        # MuJoCo gives planes a radius of 0, but a plane is infinite
        self._radii, self._halves = np.where(bounds > 0, bounds, ENDLESS), geom_half_sizes(model, geoms)

    def reached(self, data: mujoco.MjData, rays: RayBundle) -> npt.NDArray[np.intp]:
        """Return the numbers of the geoms within reach and between the fan's elevations; no such geom is missing."""
        if not self._which.size:
            return self._which
        centres = data.geom_xpos.take(self._geoms, 0)
        centres -= rays.origin
        square = np.einsum("ij,ij->i", centres, centres)
        reach = (self._radii + rays.reach) * (1 + 1e-9) + _MARGIN
        near = np.flatnonzero(square <= reach * reach)
        if not near.size:
            return near
        height, radii = matmul(centres.take(near, 0), rays.axis), self._radii.take(near)
        if rays.lowest == rays.highest == 0.0:
            close = np.abs(height) <= radii + _MARGIN
            near, height = near[close], height[close]
            turns = data.geom_xmat.take(self._geoms.take(near), 0).reshape(-1, 3, 3)
            extent = np.abs(matmul(rays.axis, turns))
            extent *= self._halves.take(near, 0)
            near = near[np.abs(height) <= extent.sum(axis=1) + _MARGIN]
        else:
            side = np.sqrt(np.maximum(square.take(near) - height * height, 0.0))
            near = near[reaches_between_cones(height, side, radii, rays.lowest, rays.highest)]
        geoms: npt.NDArray[np.intp] = self._which.take(near)
        return geoms


def can_reach(
    model: mujoco.MjModel, body: int, offset: Pose, geoms: npt.NDArray[np.intp], lowest: float, highest: float
) -> npt.NDArray[np.bool_]:
    """Check which geoms rays can ever hit, shape (m,); False is always correct, True may be wrong.

    Args:
        model: compiled model.
        body: body that carries the fan.
        offset: the fan's frame in that body.
        geoms: geom ids, shape (m,).
        lowest: lowest elevation of the rays above the plane perpendicular to the frame's z axis [rad].
        highest: highest elevation of the rays above that plane [rad].
    """
    ties = _tied_bodies(model, body, offset)
    halves = geom_half_sizes(model, geoms)
    centres, extents = np.zeros((len(geoms), 3)), np.full(len(geoms), np.inf)
    for i, geom in enumerate(geoms.tolist()):
        tie = ties.get(int(model.geom_bodyid[geom]))
        if tie is None:
            continue
        box = Pose(model.geom_pos[geom], model.geom_quat[geom]) @ Pose(model.geom_aabb[geom, :3])
        size = norm(halves[i])
        if tie.pose is None:
            centres[i] = tie.centre
            extents[i] = tie.slack + norm(box.position - tie.point) + size
        else:
            pose = tie.pose @ box
            centres[i] = pose.position
            extents[i] = matmul(np.abs(pose.matrix[2]), halves[i]) if lowest == highest == 0.0 else size
    side = np.hypot(centres[:, 0], centres[:, 1])
    return reaches_between_cones(centres[:, 2], side, extents, lowest, highest)


def _tied_bodies(model: mujoco.MjModel, body: int, offset: Pose) -> dict[int, BodyTie]:
    """Return the ties of all bodies that only hinges and ball joints connect to `body`, except the world body."""
    if body <= 0:
        return {}
    children: dict[int, list[int]] = {}
    for child, parent in enumerate(model.body_parentid.tolist()):
        children.setdefault(parent, []).append(child)
    start = offset.inverse()
    ties = {body: BodyTie(start, start.position, np.zeros(3), 0.0)}
    pending = [body]
    while pending:
        current = pending.pop()
        parent = int(model.body_parentid[current])
        for neighbour in (*children.get(current, []), parent):
            if neighbour == 0 or neighbour in ties:
                continue
            tie = _tie_of_neighbour(model, ties[current], current, neighbour)
            if tie is not None:
                ties[neighbour] = tie
                pending.append(neighbour)
    return ties


def _tie_of_neighbour(model: mujoco.MjModel, tie: BodyTie, current: int, neighbour: int) -> BodyTie | None:
    """Return the tie of a neighbouring body; None if a joint other than a hinge or ball joint connects the two."""
    child = neighbour if int(model.body_parentid[neighbour]) == current else current
    step = Pose(model.body_pos[child], model.body_quat[child])  # pose of the child in its parent
    to_neighbour = step.inverse() if child == neighbour else step
    first, count = int(model.body_jntadr[child]), int(model.body_jntnum[child])
    if count == 0:
        pose = None if tie.pose is None else tie.pose @ to_neighbour.inverse()
        return BodyTie(pose, tie.centre, to_neighbour.transform(tie.point), tie.slack)
    joints = range(first, first + count)
    anchor = model.jnt_pos[first]
    turning = all(int(model.jnt_type[j]) in _ROTARY_JOINTS and np.array_equal(model.jnt_pos[j], anchor) for j in joints)
    if not turning:
        return None
    # the joint's anchor is the same point in both bodies at any joint position
    in_child, in_parent = np.array(anchor), step.transform(anchor)
    in_current, in_neighbour = (in_parent, in_child) if child == neighbour else (in_child, in_parent)
    if tie.pose is not None:
        return BodyTie(None, tie.pose.transform(in_current), in_neighbour, 0.0)
    return BodyTie(None, tie.centre, in_neighbour, tie.slack + norm(in_current - tie.point))
