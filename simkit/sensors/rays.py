"""Casting a fan of rays from one point, by MuJoCo's own ray casting."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Vector

_UNUSED_GROUP = 0
"""Nothing of ours is in this group, so what is put there for a moment is not hit."""
_ENDLESS = 1e9  # [m]


class RayFan:
    """Fixed directions in a frame, cast again and again.

    Args:
        directions: unit vectors in the sensor's frame, shape (n, 3).
        groups: geom groups that are seen.
        reach: longest distance of interest [m].
    """

    def __init__(self, directions: Vector, groups: Sequence[int], reach: float) -> None:
        self.directions = np.ascontiguousarray(directions, dtype=np.float64)
        self.count = len(directions)
        self.reach = float(reach)
        self._rotated = np.empty((self.count, 3))
        self._flat = self._rotated.reshape(-1)
        self.distances = np.empty(self.count)
        self.geoms = np.empty(self.count, dtype=np.int32)
        self._groups = np.zeros(6, dtype=np.uint8)
        self._groups[list(groups)] = 1

    def bind(self, model: Any, names: Any, body: int, own_geoms: Sequence[int]) -> None:
        """Says what is not hit: the geoms of a moving body, or some geoms of the world; `names` are the model's."""
        self._exclude = body if body > 0 else -1
        self._hidden = list(own_geoms) if body <= 0 else []
        bounds = partial(_bounds_to_widen, model, self._groups)
        self._roots, self._wide = names.shared(f"bounds of groups {self._groups.tolist()}", bounds)
        self._narrow = model.bvh_aabb[self._roots]

    def cast(self, model: Any, data: Any, origin: Vector, rotation: Vector) -> None:
        """Fills `distances` [m] (negative: nothing hit) and `geoms`, shape (n,).

        Args:
            origin: where the rays start, in the world, shape (3,).
            rotation: of the sensor's frame, shape (3, 3).
        """
        np.matmul(self.directions, rotation.T, out=self._rotated)
        kept = self._open_eyes(model)
        try:
            mujoco.mj_multiRay(
                model, data, origin, self._flat, self._groups, 1, self._exclude,
                self.geoms, self.distances, None, self.count, self.reach,
            )  # fmt: skip
        finally:
            self._shut_eyes(model, kept)

    def recast(self, model: Any, data: Any, origin: Vector, start: float, which: npt.NDArray[np.intp]) -> None:
        """Casts some rays of the last `cast` again, from `start` [m] along each; distances count from the origin."""
        geom = np.empty(1, dtype=np.int32)
        kept = self._open_eyes(model)
        try:
            for i in which.tolist():
                direction = self._rotated[i]
                found = mujoco.mj_ray(
                    model, data, origin + start * direction, direction, self._groups, 1, self._exclude, geom, None
                )
                self.distances[i] = start + found if found >= 0 else -1.0
                self.geoms[i] = geom[0]
        finally:
            self._shut_eyes(model, kept)

    def _open_eyes(self, model: Any) -> Any:
        """Changes the model for one cast; gives what `_shut_eyes` needs.

        One body can be excluded, but for a static link that would be the whole world, so its geoms are put into a
        group that is not seen. And a body is passed over where a ray misses what collides of it, even if another of
        its geoms is in the way: its bounds are made to hold all that is seen.
        """
        kept = None
        if self._hidden:
            groups = model.geom_group
            kept = groups[self._hidden]
            groups[self._hidden] = _UNUSED_GROUP
        if len(self._roots):
            model.bvh_aabb[self._roots] = self._wide
        return kept

    def _shut_eyes(self, model: Any, kept: Any) -> None:
        if len(self._roots):
            model.bvh_aabb[self._roots] = self._narrow
        if kept is not None:
            model.geom_group[self._hidden] = kept


def _bounds_to_widen(model: Any, groups: npt.NDArray[np.uint8]) -> tuple[npt.NDArray[np.intp], Vector]:
    """Bounds of bodies (rows of `bvh_aabb`: centre and half size, in the inertial frame) that seen geoms stick out of.

    Returns:
        The rows, shape (k,), and what they should be, shape (k, 6).
    """
    seen = np.flatnonzero(groups[model.geom_group] > 0)
    bodies = model.geom_bodyid[seen]
    seen = seen[model.body_bvhnum[bodies] > 0]
    bodies = model.geom_bodyid[seen]
    turn = np.empty((model.nbody, 9))
    for body in np.unique(bodies):
        mujoco.mju_quat2Mat(turn[body], model.body_iquat[body])
    centre = model.geom_pos[seen] - model.body_ipos[bodies]
    centre = np.einsum("gji,gj->gi", turn.reshape(-1, 3, 3)[bodies], centre)
    # a plane has no radius: it has no end
    radius = np.where(model.geom_rbound[seen] > 0, model.geom_rbound[seen], _ENDLESS)[:, None]
    roots = model.body_bvhadr
    low, high = np.full((model.nbody, 3), np.inf), np.full((model.nbody, 3), -np.inf)
    np.minimum.at(low, bodies, centre - radius)
    np.maximum.at(high, bodies, centre + radius)
    found = np.unique(bodies)
    rows = roots[found].astype(np.intp)
    box = model.bvh_aabb[rows]
    low, high = np.minimum(low[found], box[:, :3] - box[:, 3:]), np.maximum(high[found], box[:, :3] + box[:, 3:])
    wide = np.hstack(((low + high) / 2, (high - low) / 2))
    changed = (wide[:, 3:] > box[:, 3:] + 1e-12).any(axis=1)
    return rows[changed], wide[changed]


def fan_directions(azimuths: Vector, elevations: Vector) -> Vector:
    """Unit vectors, x forward, y left, z up, layer by layer from the first elevation on, shape (m·n, 3)."""
    elevation, azimuth = np.meshgrid(elevations, azimuths, indexing="ij")
    directions = np.stack(
        (np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)), axis=-1
    )
    return directions.reshape(-1, 3)
