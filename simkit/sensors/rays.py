"""Casting a fan of rays from one point, by MuJoCo's own ray casting."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Vector

_UNUSED_GROUP = 0
"""Nothing of ours is in this group, so what is put there for a moment is not hit."""


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

    def bind(self, body: int, own_geoms: Sequence[int]) -> None:
        """Says what is not hit: the geoms of a moving body, or some geoms of the world."""
        self._exclude = body if body > 0 else -1
        self._hidden = list(own_geoms) if body <= 0 else []

    def cast(self, model: Any, data: Any, origin: Vector, rotation: Vector) -> None:
        """Fills `distances` [m] (negative: nothing hit) and `geoms`, shape (n,).

        Args:
            origin: where the rays start, in the world, shape (3,).
            rotation: of the sensor's frame, shape (3, 3).
        """
        np.matmul(self.directions, rotation.T, out=self._rotated)
        with self._without_own(model):
            mujoco.mj_multiRay(
                model, data, origin, self._flat, self._groups, 1, self._exclude,
                self.geoms, self.distances, None, self.count, self.reach,
            )  # fmt: skip

    def recast(self, model: Any, data: Any, origin: Vector, start: float, which: npt.NDArray[np.intp]) -> None:
        """Casts some rays of the last `cast` again, from `start` [m] along each; distances count from the origin."""
        geom = np.empty(1, dtype=np.int32)
        with self._without_own(model):
            for i in which.tolist():
                direction = self._rotated[i]
                found = mujoco.mj_ray(
                    model, data, origin + start * direction, direction, self._groups, 1, self._exclude, geom, None
                )
                self.distances[i] = start + found if found >= 0 else -1.0
                self.geoms[i] = geom[0]

    @contextmanager
    def _without_own(self, model: Any) -> Iterator[None]:
        # one body can be excluded, but for a static link that would be the whole world
        if not self._hidden:
            yield
            return
        groups = model.geom_group
        before = groups[self._hidden]
        groups[self._hidden] = _UNUSED_GROUP
        try:
            yield
        finally:
            groups[self._hidden] = before


def fan_directions(azimuths: Vector, elevations: Vector) -> Vector:
    """Unit vectors, x forward, y left, z up, layer by layer from the first elevation on, shape (m·n, 3)."""
    elevation, azimuth = np.meshgrid(elevations, azimuths, indexing="ij")
    directions = np.stack(
        (np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)), axis=-1
    )
    return directions.reshape(-1, 3)
