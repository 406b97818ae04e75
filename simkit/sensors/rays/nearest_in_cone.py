"""Nearest surface in a cone: rays that sample the cone, then ever denser rays around the nearest hits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.name_map import NameMap
from simkit.linear_algebra import matmul, norm
from simkit.pose import Vector
from simkit.sensors.rays.ray_fan import RayFan

MIN_RAY_ANGLE = math.radians(0.5)
"""Largest angle between the rings of a cone [rad]; larger if the cone would need more than `MAX_RINGS` rings."""
MAX_RINGS = 24
SPHERE_RAYS = 2000
_GOLDEN = math.pi * (3.0 - math.sqrt(5.0))  # [rad]

_NEIGHBOURS: Final = 8
_STARTS: Final = 4
"""Largest number of hits around which the rays become denser: of several objects, any may have the nearest point."""
_ROUNDS, _RINGS = 3, 4
"""Rounds of denser rays, and rings of rays around a hit in each round; the spacing shrinks by the number of rings."""
_SPHERE_SPACING: Final = math.sqrt(4.0 * math.pi / SPHERE_RAYS)  # [rad]


class Nearest(NamedTuple):
    """Distance of the nearest surface [m], infinite for none, and its geom."""

    distance: float
    geom: int


class NearestInCone:
    """Search for the nearest surface in a cone, to be made repeatedly.

    Args:
        half_angle: angle between axis and edge [rad]; pi for all directions.
        axis: axis of the cone, a unit vector in the sensor's frame.
        groups: visible geom groups.
        reach: longest distance [m].
    """

    def __init__(
        self, half_angle: float, axis: tuple[float, float, float], groups: Sequence[int], reach: float
    ) -> None:
        self._axis, self._half_angle = np.array(axis), half_angle
        self._inside, self._outside = math.cos(min(half_angle, math.pi)), math.sin(min(half_angle, math.pi))
        directions = cone_directions(half_angle, axis)
        self._fan = RayFan(directions, groups, reach)
        self._refined = RayFan(np.zeros((_STARTS * len(_PATTERN), 3)), groups, reach)
        is_sphere = half_angle >= math.pi
        self._spacing = _SPHERE_SPACING if is_sphere else half_angle / max(_ring_count(half_angle), 1)
        self._across = _perpendicular(directions)

    def bind(self, model: mujoco.MjModel, names: NameMap, body: int, own_geoms: Sequence[int]) -> None:
        """Set the model; see `RayFan.bind`."""
        self._fan.bind(model, names, body, own_geoms)
        self._refined.bind(model, names, body, own_geoms)

    def find(self, model: mujoco.MjModel, data: mujoco.MjData, origin: Vector, rotation: Vector) -> Nearest:
        """Return the nearest surface.

        Args:
            model: model that the search is bound to.
            data: data of that model with up-to-date poses.
            origin: tip of the cone in the world [m], shape (3,).
            rotation: rotation matrix of the sensor's frame, shape (3, 3).
        """
        fan = self._fan
        fan.cast(model, data, origin, rotation)
        distances = fan.distances
        best = int(distances.argmin())
        nearest = Nearest(float(distances[best]), int(fan.geoms[best]))
        if math.isinf(nearest.distance) or self._spacing == 0.0:
            return nearest
        starts = np.flatnonzero(distances <= np.minimum.reduce(distances.take(_neighbours(self._half_angle))))
        starts = starts[distances.take(starts).argsort(kind="stable")[:_STARTS]]
        return self._refine(model, data, (origin, rotation), starts, nearest)

    def _refine(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        frame: tuple[Vector, Vector],
        starts: npt.NDArray[np.intp],
        nearest: Nearest,
    ) -> Nearest:
        """Return the nearest surface of rays around some rays of the fan, which get denser in each round."""
        refined, spacing, count = self._refined, self._spacing, len(starts)
        middle, (first, second) = self._fan.directions[starts, None], self._across[:, starts, None]
        rows, used = np.arange(count) * len(_PATTERN), count * len(_PATTERN)
        refined.directions[used:] = middle[0]
        u = v = np.zeros((count, 1))  # coordinates of the nearest hits so far along `first` and `second`
        for _ in range(_ROUNDS):
            u, v = u + spacing * _PATTERN[:, 0], v + spacing * _PATTERN[:, 1]
            directions = middle + u[..., None] * first + v[..., None] * second
            refined.directions[:used] = self._within_cone(directions.reshape(used, 3))
            refined.cast(model, data, *frame)
            chosen = rows + refined.distances[:used].reshape(count, -1).argmin(axis=1)
            reached = refined.distances.take(chosen)
            best = int(reached.argmin())
            if reached[best] < nearest.distance:
                nearest = Nearest(float(reached[best]), int(refined.geoms[chosen[best]]))
            u, v = u.take(chosen)[:, None], v.take(chosen)[:, None]
            spacing /= _RINGS
        return nearest

    def _within_cone(self, directions: Vector) -> Vector:
        """Return unit vectors, shape (n, 3); those outside of the cone become the nearest ones on its edge."""
        directions /= np.sqrt(np.einsum("ij,ij->i", directions, directions))[:, None]
        along = matmul(directions, self._axis)
        outside = np.flatnonzero(along < self._inside)
        if len(outside) and self._half_angle < math.pi:
            across = directions[outside] - along[outside, None] * self._axis
            across *= (self._outside / np.sqrt(np.einsum("ij,ij->i", across, across)))[:, None]
            directions[outside] = self._inside * self._axis + across
        return directions


def cone_directions(half_angle: float, axis: tuple[float, float, float]) -> Vector:
    """Return unit vectors that sample a cone, shape (n, 3); the first is the axis.

    Ring k around the axis, k = 1, 2, ..., has 6k rays; the last ring is on the edge. Neighbouring rays of a ring are
    as far apart as neighbouring rings. Each direction in the cone is closer to a ray than 0.75 of this distance. With a
    half angle of pi (all directions), the rays are both directions of three perpendicular axes and a Fibonacci spiral.

    Args:
        half_angle: angle between axis and edge [rad].
        axis: unit vector.
    """
    if half_angle >= math.pi:
        upright = np.vstack((np.eye(3)[[2, 0, 1]], -np.eye(3)[[2, 0, 1]], _spiral_directions(SPHERE_RAYS)))
    else:
        rings = _ring_count(half_angle)
        number = np.concatenate([np.full(max(6 * k, 1), k) for k in range(rings + 1)])
        index = np.concatenate([np.arange(max(6 * k, 1)) for k in range(rings + 1)])
        away = half_angle * number / max(rings, 1)
        # every second ring is rotated by half a gap, so that the gaps do not form straight lines
        around = 2 * np.pi * (index + 0.5 * (number % 2)) / np.maximum(6 * number, 1)
        upright = np.stack((np.sin(away) * np.cos(around), np.sin(away) * np.sin(around), np.cos(away)), axis=-1)
    return np.asarray(matmul(upright, _frame_along(axis)), dtype=np.float64)


def _spiral_directions(count: int) -> Vector:
    step = np.arange(count)
    height = 1.0 - (2.0 * step + 1.0) / count
    across = np.sqrt(1.0 - height**2)
    spiral: Vector = np.stack((across * np.cos(_GOLDEN * step), across * np.sin(_GOLDEN * step), height), axis=-1)
    return spiral


def _frame_along(axis: tuple[float, float, float]) -> Vector:
    """Return a matrix whose rows are three perpendicular unit vectors, the last along the axis."""
    along = np.array(axis)
    other = np.eye(3)[int(np.argmin(np.abs(along)))]
    first = np.cross(other, along)
    first /= norm(first)
    frame: Vector = np.stack((first, np.cross(along, first), along))
    return frame


def _ring_count(half_angle: float) -> int:
    return min(max(math.ceil(half_angle / MIN_RAY_ANGLE), 1), MAX_RINGS) if half_angle > 0 else 0


def _ring_points(rings: int) -> Vector:
    """Return points on rings around the origin of a plane; ring k has the radius k / rings and 6k points."""
    points = []
    for k in range(1, rings + 1):
        angle = 2.0 * np.pi * (np.arange(6 * k) + 0.5 * (k % 2)) / (6 * k)
        points.append(k / rings * np.stack((np.cos(angle), np.sin(angle)), axis=-1))
    return np.concatenate(points)


_PATTERN: Final = np.vstack((np.zeros((1, 2)), _ring_points(_RINGS)))


def _perpendicular(directions: Vector) -> Vector:
    """Return two unit vectors perpendicular to each direction and to each other, shape (2, n, 3)."""
    first = np.zeros_like(directions)
    first[np.arange(len(directions)), np.abs(directions).argmin(axis=1)] = 1.0
    first -= np.einsum("ij,ij->i", first, directions)[:, None] * directions
    first /= np.sqrt(np.einsum("ij,ij->i", first, first))[:, None]
    return np.stack((first, np.cross(directions, first)))


@lru_cache(maxsize=16)
def _neighbours(half_angle: float) -> npt.NDArray[np.intp]:
    """Return the nearest rays of each ray of a cone, shape (8, n)."""
    directions = cone_directions(half_angle, (0.0, 0.0, 1.0))
    most = min(_NEIGHBOURS, len(directions) - 1)
    neighbours = np.empty((len(directions), most), dtype=np.intp)
    for i, direction in enumerate(directions):
        distance = ((directions - direction) ** 2).sum(axis=1)
        distance[i] = np.inf
        neighbours[i] = np.argsort(distance, kind="stable")[:most]
    return np.ascontiguousarray(neighbours.T)
