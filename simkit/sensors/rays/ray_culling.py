"""Rays from one point, and geoms that they can meet: one that stays above or below all of them is left out.

A sensor's own robot is tied to it by joints. What no joint moves against the sensor keeps its place in the fan's frame;
what hinges and ball joints move stays within a sphere around the first of them, whose radius grows along the chain.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Pose, Vector


@dataclass(slots=True)  # not frozen: that would cost a microsecond for each cast
class RayBundle:
    """Rays from one point.

    Attributes:
        origin: in the world, shape (3,) [m].
        directions: in the world, unit vectors, shape (n, 3).
        start: how far from the origin they begin [m].
        reach: what is farther does not count [m].
        limit: its bits (see `finite_limit_bits`).
        axis: unit vector in the world, shape (3,).
        lowest, highest: angles between which the rays leave the plane across the axis [rad].
    """

    origin: Vector
    directions: Vector
    start: float
    reach: float
    limit: npt.NDArray[np.uint64]
    axis: Vector
    lowest: float
    highest: float


RayHits = tuple[Vector, npt.NDArray[np.int32], npt.NDArray[np.bool_]]
"""Distances [m], infinite where nothing is hit; geoms, -1 for nothing; and where the distances are infinite."""


def reaches_plane(rays: RayBundle, point: Sequence[float], normal: Sequence[float]) -> bool:
    """Whether a ray may come down on a plane through a point within the reach; never wrongly False."""
    (x, y, z), (ax, ay, az), (nx, ny, nz) = rays.origin.tolist(), rays.axis.tolist(), normal
    height = nx * (x - point[0]) + ny * (y - point[1]) + nz * (z - point[2])
    steepest = max(abs(rays.lowest), abs(rays.highest))
    tilt = math.acos(min(1.0, abs(nx * ax + ny * ay + nz * az))) + steepest
    fall = rays.reach * math.sin(tilt) if tilt < math.pi / 2 else rays.reach
    return bool(0.0 <= height <= fall * (1 + 1e-9) + 1e-9)


def finite_limit_bits(reach: float) -> npt.NDArray[np.uint64]:
    """The bits of the longest finite distance that counts, for comparing many at once."""
    return np.array(min(reach, float(np.finfo(np.float64).max))).view(np.uint64)


_ROTARY_JOINTS = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_BALL))
_MARGIN = 1e-9  # [m]
ENDLESS = 1e9
"""Half size of a plane [m]."""


@dataclass(frozen=True, slots=True)
class BodyTie:
    """How a body is tied to the fan.

    Attributes:
        pose: of the body in the fan's frame; None where joints move it.
        centre: a point of the fan's frame (shape (3,)) ...
        point: ... from which this point of the body ...
        slack: ... is never farther than this [m].
    """

    pose: Pose | None
    centre: Vector
    point: Vector
    slack: float


def reaches_between_cones(
    height: Vector, side: Vector, radius: Vector, lowest: float, highest: float
) -> npt.NDArray[np.bool_]:
    """Whether spheres reach between the cones at the ends of a fan.

    Args:
        height, side: of the centres, along the fan's axis and from it [m].
        lowest, highest: angles of the cones with the plane across the axis [rad].
    """
    above = height * math.cos(highest) - side * math.sin(highest)
    below = side * math.sin(lowest) - height * math.cos(lowest)
    found: npt.NDArray[np.bool_] = (above <= radius + _MARGIN) & (below <= radius + _MARGIN)
    return found


def geom_half_sizes(model: mujoco.MjModel, geoms: npt.NDArray[np.intp]) -> Vector:
    """Of the boxes around geoms, along their own axes [m], shape (m, 3)."""
    is_plane = model.geom_type[geoms] == int(mujoco.mjtGeom.mjGEOM_PLANE)
    halves: Vector = np.where(is_plane[:, None], ENDLESS, model.geom_aabb[geoms, 3:])
    return halves


class NearbyGeoms:
    """Planes and shapes, and which of them a fan may meet where they are now.

    Args:
        model: compiled.
        which: numbers of the geoms, shape (m,).
        geoms: theirs, shape (m,).
    """

    def __init__(self, model: mujoco.MjModel, which: npt.NDArray[np.intp], geoms: npt.NDArray[np.intp]) -> None:
        self._which, self._geoms = which, geoms
        bounds = model.geom_rbound[geoms]
        # a plane has no radius: it has no end
        self._radii, self._halves = np.where(bounds > 0, bounds, ENDLESS), geom_half_sizes(model, geoms)

    def met(self, data: mujoco.MjData, rays: RayBundle) -> npt.NDArray[np.intp]:
        """Numbers of those within reach and between the ends of the fan; never one too few."""
        places = data.geom_xpos.take(self._geoms, 0)
        places -= rays.origin
        square = np.einsum("ij,ij->i", places, places)
        reach = (self._radii + rays.reach) * (1 + 1e-9) + _MARGIN
        near = np.flatnonzero(square <= reach * reach)
        if not near.size:
            return near
        height, radii = places.take(near, 0) @ rays.axis, self._radii.take(near)
        if rays.lowest == rays.highest == 0.0:
            close = np.abs(height) <= radii + _MARGIN
            near, height = near[close], height[close]
            turns = data.geom_xmat.take(self._geoms.take(near), 0).reshape(-1, 3, 3)
            extent = np.abs(rays.axis @ turns)
            extent *= self._halves.take(near, 0)
            near = near[np.abs(height) <= extent.sum(axis=1) + _MARGIN]
        else:
            side = np.sqrt(np.maximum(square.take(near) - height * height, 0.0))
            near = near[reaches_between_cones(height, side, radii, rays.lowest, rays.highest)]
        found: npt.NDArray[np.intp] = self._which.take(near)
        return found


def can_meet(
    model: mujoco.MjModel, body: int, offset: Pose, geoms: npt.NDArray[np.intp], lowest: float, highest: float
) -> npt.NDArray[np.bool_]:
    """Which geoms rays may ever meet, shape (m,); never wrongly False.

    Args:
        body: that carries the fan.
        offset: the fan's frame in it.
        geoms: shape (m,).
        lowest, highest: angles between which the rays leave the plane across the frame's z [rad].
    """
    ties = _tied_bodies(model, body, offset)
    halves = geom_half_sizes(model, geoms)
    places, extents = np.zeros((len(geoms), 3)), np.full(len(geoms), np.inf)
    for i, geom in enumerate(geoms.tolist()):
        tie = ties.get(int(model.geom_bodyid[geom]))
        if tie is None:
            continue
        at = Pose(model.geom_pos[geom], model.geom_quat[geom]) @ Pose(model.geom_aabb[geom, :3])
        size = float(np.linalg.norm(halves[i]))
        if tie.pose is None:
            places[i] = tie.centre
            extents[i] = tie.slack + float(np.linalg.norm(at.position - tie.point)) + size
        else:
            pose = tie.pose @ at
            places[i] = pose.position
            extents[i] = np.abs(pose.matrix[2]) @ halves[i] if lowest == highest == 0.0 else size
    side = np.hypot(places[:, 0], places[:, 1])
    return reaches_between_cones(places[:, 2], side, extents, lowest, highest)


def _tied_bodies(model: mujoco.MjModel, body: int, offset: Pose) -> dict[int, BodyTie]:
    """Of all bodies that turning joints alone tie to a body, the world left out."""
    if body <= 0:
        return {}
    children: dict[int, list[int]] = {}
    for child, parent in enumerate(model.body_parentid.tolist()):
        children.setdefault(parent, []).append(child)
    start = offset.inverse()
    ties = {body: BodyTie(start, start.position, np.zeros(3), 0.0)}
    waiting = [body]
    while waiting:
        here = waiting.pop()
        parent = int(model.body_parentid[here])
        for there in (*children.get(here, []), parent):
            if there == 0 or there in ties:
                continue
            tie = _tie_of_neighbour(model, ties[here], here, there)
            if tie is not None:
                ties[there] = tie
                waiting.append(there)
    return ties


def _tie_of_neighbour(model: mujoco.MjModel, tie: BodyTie, here: int, there: int) -> BodyTie | None:
    """The tie of a neighbour in the tree; None where something else than a turning joint is between them."""
    child = there if int(model.body_parentid[there]) == here else here
    step = Pose(model.body_pos[child], model.body_quat[child])  # of the child in its parent
    to_there = step.inverse() if child == there else step
    first, count = int(model.body_jntadr[child]), int(model.body_jntnum[child])
    if count == 0:
        pose = None if tie.pose is None else tie.pose @ to_there.inverse()
        return BodyTie(pose, tie.centre, to_there.transform(tie.point), tie.slack)
    joints = range(first, first + count)
    anchor = model.jnt_pos[first]
    turning = all(int(model.jnt_type[j]) in _ROTARY_JOINTS and np.array_equal(model.jnt_pos[j], anchor) for j in joints)
    if not turning:
        return None
    # the joint's own point is the same in both bodies, wherever the joint stands
    in_child, in_parent = np.array(anchor), step.transform(anchor)
    mine, other = (in_parent, in_child) if child == there else (in_child, in_parent)
    if tie.pose is not None:
        return BodyTie(None, tie.pose.transform(mine), other, 0.0)
    return BodyTie(None, tie.centre, other, tie.slack + float(np.linalg.norm(mine - tie.point)))
