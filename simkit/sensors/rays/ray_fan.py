"""Casting a fan of rays from one point.

How is decided by the number of rays and by what the compiled model holds, never by what happened before:

- Without triangles (meshes, heightmaps), fewer than `MANY_RAYS` rays are cast by the engine through planes and shapes
  alone, more of them in NumPy.
- Triangles are traced by Embree where `embreex` is installed, what stands still as one scene that all fans share, each
  moving body by the rays that may meet it. Of many rays, boxes that stand still are traced as triangles too.
- Without `embreex` a model with triangles is left to the engine whole.

All ways agree: shapes and planes are exact everywhere, triangles are met in their own plane, worked out in float64.
It is only Embree's float32 that says on which side of the edge of a mesh a ray passes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.name_map import NameMap
from simkit.pose import Pose, Vector
from simkit.sensors.rays.embree_rays import MovingBodies, TriangleBody
from simkit.sensors.rays.geom_types import Ids
from simkit.sensors.rays.numpy_rays import (
    FanDirections,
    cast_on_plane,
    cast_on_shapes,
    rotate_vectors,
)
from simkit.sensors.rays.ray_culling import NearbyGeoms, RayBundle, can_meet, finite_limit_bits, reaches_plane
from simkit.sensors.rays.ray_targets import MAX_MOVING_BODIES, RayTargets

MANY_RAYS: Final = 2048
"""From so many rays on NumPy is faster on shapes than the engine."""

_RAYS_PER_CHUNK = 1 << 18  # rays traced at a time: bounds what is needed besides the result
_LARGEST = float(np.finfo(np.float64).max)


class RayFan:
    """Fixed directions in a frame, cast again and again.

    Attributes:
        distances: of the last cast [m], shape (n,); infinite where nothing is hit within the reach.
        infinite: where they are, shape (n,).
        hits: what was hit, shape (n,), as positions in `ids`; -1 for nothing. Each cast makes these arrays anew.
        ids: geoms of the compiled model; the last is -1.
        groups: geom groups that are seen, shape (6,), 1 for each.
        body: that is not hit; 0 for none.

    Args:
        directions: unit vectors in the sensor's frame, shape (n, 3).
        groups: geom groups that are seen.
        reach: longest distance [m].
        grid: elevations and azimuths [rad], ascending, where the directions are all their pairs, layer by layer.
        use_embree: False leaves triangles to the engine even where `embreex` is installed.
    """

    def __init__(
        self,
        directions: Vector,
        groups: Sequence[int],
        reach: float,
        *,
        grid: tuple[Vector, Vector] | None = None,
        use_embree: bool = True,
    ) -> None:
        self.directions = np.ascontiguousarray(directions, dtype=np.float64)
        self.count = len(directions)
        self.reach, self._limit = float(reach), finite_limit_bits(reach)
        self._clear()
        self.infinite = np.full(self.count, True)
        self.ids = np.array((-1,), dtype=np.int32)
        self._nearby: NearbyGeoms | None = None
        self._standing: list[TriangleBody] | None = None
        self._movers = MovingBodies([])
        self._rotated = np.empty((self.count, 3))
        self.groups = np.zeros(6, dtype=np.uint8)
        self.groups[list(groups)] = 1
        self._grid, self._fan = grid, None if self.count < MANY_RAYS else FanDirections(self.directions, grid)
        self._use_embree = use_embree
        self._bounds = -np.pi / 2, np.pi / 2
        if grid is not None and np.abs(grid[0]).max() <= np.pi / 2:
            self._bounds = float(grid[0].min()), float(grid[0].max())

    @property
    def geoms(self) -> npt.NDArray[np.int32]:
        """What was hit, shape (n,): geoms of the compiled model, -1 for nothing."""
        return self.ids[self.hits]

    def bind(
        self,
        model: mujoco.MjModel,
        names: NameMap,
        body: int,
        own_geoms: Sequence[int],
        *,
        hidden: Sequence[int] = (),
        offset: Pose | None = None,
    ) -> None:
        """Says in what the rays are cast.

        Args:
            model: compiled.
            names: the compiler's name map of it.
            body: that carries the rays: it is not hit, where it moves.
            own_geoms: what is not hit of a body that does not.
            hidden: other geoms that are not seen.
            offset: the directions' frame in the body's, where that stays: less has to be looked at then.
        """
        self.body = body if body > 0 else 0
        self._own = [] if body > 0 else list(own_geoms)
        self._targets = self._find_targets(model, names, hidden)
        self._carrier = self._targets.carrier_of(self.body, self._own)
        if self._carrier < 0 and not self._targets.needs_engine:
            self._targets = self._find_targets(model, names, (*hidden, *self._own))
            self._carrier = 0
        self._offset, self._standing, self._nearby = offset, None, None
        targets = self._targets
        # only the reduced model has numbers of its own
        self.ids = np.append(np.arange(model.ngeom), -1).astype(np.int32)
        self._by_engine = self.count < MANY_RAYS and targets.moving_shapes <= MAX_MOVING_BODIES
        if not self._by_engine and self._fan is None:
            self._fan = FanDirections(self.directions, self._grid)

    def _find_targets(self, model: mujoco.MjModel, names: NameMap, hidden: Sequence[int]) -> RayTargets:
        def find() -> RayTargets:
            seen = self.groups[model.geom_group] > 0
            seen[list(hidden)] = False
            return RayTargets(model, names, seen, self._use_embree)

        what = f"seen by rays: groups {self.groups.tolist()}, {self._use_embree}, without {sorted(hidden)}"
        found: RayTargets = names.shared(what, find)
        return found

    def cast(
        self, model: mujoco.MjModel, data: mujoco.MjData, origin: Vector, rotation: Vector, start: float = 0.0
    ) -> None:
        """Makes `distances`, `hits` and `infinite` anew.

        Args:
            model: the one that the fan is bound to.
            data: of that model, with up-to-date places.
            origin: where distances are counted from, in the world, shape (3,) [m].
            rotation: of the sensor's frame, shape (3, 3).
            start: how far from there the rays begin [m].
        """
        rays, targets = self._rays(origin, rotation, start), self._targets
        if targets.needs_engine:
            self.distances, self.hits, self.infinite = targets.whole.cast(data, rays, self.body, self._own)
            return
        if self._by_engine:
            shapes = targets.shapes_by_engine
            if shapes is not None:
                if self._nearby is None:
                    sight = shapes.sight(self._carrier, self.body, self._offset, *self._bounds)
                    self._nearby = NearbyGeoms(targets.model, sight, shapes.movers[sight])
                self.distances, self.hits, self.infinite = shapes.cast(data, rays, self._nearby)
                if not targets.triangles_for_engine:
                    self.ids = shapes.ids
                    return
                self.hits = shapes.ids[self.hits]
            else:
                self._clear()
            self._cast_on_triangles(targets.triangles_for_engine, data, rays)
        else:
            self._clear()
            self._cast_on_planes_and_triangles(data, rays)
            self._cast_on_shapes(data, rays, rotation)
        self._end()

    def _rays(self, origin: Vector, rotation: Vector, start: float) -> RayBundle:
        rotate_vectors(self.directions, rotation.T, out=self._rotated)
        return RayBundle(origin, self._rotated, start, self.reach, self._limit, rotation[:, 2], *self._bounds)

    def _end(self) -> None:
        self.infinite = self.distances > min(self.reach, _LARGEST)
        np.copyto(self.distances, np.inf, where=self.infinite)

    def _clear(self) -> None:
        self.hits = np.full(self.count, -1, dtype=np.int32)
        self.distances = np.full(self.count, np.inf)

    def _cast_on_planes_and_triangles(self, data: mujoco.MjData, rays: RayBundle) -> None:
        """On all but shapes, in NumPy and by Embree."""
        best, targets = self.distances, self._targets
        self._cast_on_triangles(targets.triangles_and_boxes, data, rays)
        for i in targets.planes.tolist():
            if self._carrier and targets.carriers[i] == self._carrier:
                continue
            geom = int(targets.geoms[i])
            turn, size = data.geom_xmat[geom].reshape(3, 3), targets.model.geom_size[geom]
            if not reaches_plane(rays, data.geom_xpos[geom].tolist(), turn[:, 2].tolist()):
                continue
            found = cast_on_plane(rays.origin, rays.directions, data.geom_xpos[geom], turn, size, rays.start)
            if found is not None:
                nearer = found < best
                np.copyto(best, found, where=nearer)
                self.hits[nearer] = geom

    def _cast_on_shapes(self, data: mujoco.MjData, rays: RayBundle, rotation: Vector) -> None:
        targets = self._targets
        if self._nearby is None:
            which = targets.shapes
            if self._carrier:
                which = which[targets.carriers[which] != self._carrier]
            self._nearby = NearbyGeoms(targets.model, which, targets.geoms[which])
        which = self._nearby.met(data, rays)
        if not len(which):
            return
        assert self._fan is not None
        shapes = targets.shapes_in_frame(data, which, rays.origin, rotation)
        cast_on_shapes(self._fan, shapes, rays.reach, rays.start, self.distances, self.hits)

    def _cast_on_triangles(self, bodies: list[TriangleBody], data: mujoco.MjData, rays: RayBundle) -> None:
        """First what stands still, then each body by the rays that may meet it."""
        if self._standing is None:
            self._standing = [body for body in bodies if not body.carrier]
            self._movers = MovingBodies([body for body in bodies if body.carrier and self._can_meet(body)])
        for body in self._standing:
            for first in range(0, self.count, _RAYS_PER_CHUNK):
                part = slice(first, first + _RAYS_PER_CHUNK)
                limit = np.minimum(self.distances[part], rays.reach, dtype=np.float32)
                found = body.cast(data, rays.origin, rays.directions[part], rays.start, limit)
                self._shorten(found[0] + first, *found[1:])
        for body, some in self._movers.met(data, rays):
            limit = np.minimum(self.distances.take(some), rays.reach, dtype=np.float32)
            found = body.cast(data, rays.origin, rays.directions.take(some, 0), rays.start, limit)
            self._shorten(some[found[0]], *found[1:])

    def _shorten(self, which: Ids, found: Vector, geoms: npt.NDArray[np.int32]) -> None:
        """Takes distances of some rays where they are shorter than those so far."""
        nearer = found < self.distances.take(which)
        which = which[nearer]
        self.distances[which], self.hits[which] = found[nearer], geoms[nearer]

    def _can_meet(self, body: TriangleBody) -> bool:
        if body.carrier == self._carrier:
            return False
        if self._offset is None:
            return True
        return bool(can_meet(self._targets.model, self.body, self._offset, body.geoms, *self._bounds).any())


def fan_directions(azimuths: Vector, elevations: Vector) -> Vector:
    """Unit vectors, x forward, y left, z up, layer by layer from the first elevation on, shape (m·n, 3)."""
    elevation, azimuth = np.meshgrid(elevations, azimuths, indexing="ij")
    directions = np.stack(
        (np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)), axis=-1
    )
    return directions.reshape(-1, 3)
