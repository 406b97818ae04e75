"""Casting of a fan of rays from one point.

The number of rays and the content of the compiled model select the method; earlier casts have no influence:

- Without triangles (meshes, heightmaps), the engine casts fewer than `MANY_RAYS` rays through planes and shapes only.
  NumPy casts more rays than that.
- Embree traces triangles if `embreex` is installed. All static triangles form one scene that all fans share. Each
  moving body is traced with the rays that may hit it. With many rays, static boxes are traced as triangles too.
- Without `embreex`, the engine casts through the whole model if it has triangles.

All methods agree: shapes and planes are exact, and rays hit a triangle in its own plane, computed in float64. Only
Embree's float32 decides on which side of a mesh edge a ray passes.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.name_map import NameMap
from simkit.linear_algebra import matmul
from simkit.pose import Pose, Vector
from simkit.sensors.rays.embree_rays import MovingBodies, TriangleBody
from simkit.sensors.rays.mujoco_rays import ReducedModelCaster
from simkit.sensors.rays.numpy_rays import (
    FanDirections,
    cast_on_plane,
    cast_on_shapes,
    rotate_columns,
    rotate_vectors,
)
from simkit.sensors.rays.ray_culling import ENDLESS, NearbyGeoms, RayBundle, can_reach, finite_limit_bits, reaches_plane
from simkit.sensors.rays.ray_targets import MAX_MOVING_BODIES, RayTargets
from simkit.sensors.rays.ray_threads import ray_threads

if TYPE_CHECKING:
    from simkit.runtime.state_arrays import StateArrays

MANY_RAYS: Final = 2048
"""Number of rays from which NumPy is faster on shapes than the engine."""

_RAYS_PER_CHUNK = 1 << 18  # rays traced at a time, which limits the memory besides the result
RAYS_PER_THREAD: Final = 1 << 14
"""Fewest rays for which a thread saves time."""
_LARGEST = float(np.finfo(np.float64).max)
_LARGEST_SINGLE = 3e38  # of float32, with a margin


class FanPart(NamedTuple):
    """Rays of a fan that one thread casts.

    Attributes:
        rays: their numbers.
        directions: their directions in the sensor's frame.
        bounds: their lowest and highest elevation [rad].
    """

    rays: slice
    directions: FanDirections
    bounds: tuple[float, float]


class RayFan:
    """Fan of fixed directions in a frame, to be cast repeatedly.

    Attributes:
        distances: distances of the last cast [m], shape (n,); infinite for no hit within the reach.
        infinite: True where the distance is infinite, shape (n,).
        hits: indices in `ids` of the geoms that were hit, shape (n,); -1 for no hit. Each cast makes new arrays.
        ids: geom ids of the compiled model; the last is -1.
        groups: visible geom groups, shape (6,), 1 for visible.
        body: body that is not hit; 0 for none.
        targets: geoms that the rays can hit.
        carrier: carrier that is not hit; see `RayTargets`.
        bounds: lowest and highest elevation of the rays [rad].
        by_engine: True if the engine casts on shapes, False if NumPy does.
        numpy_directions: directions for casts in NumPy; None if the engine casts.
        offset: pose of the fan in the body's frame; None if it may change.
        own_geoms: geoms of a static carrier that are not hit.
        movers: moving bodies with triangles that the rays can hit, after `find_triangles`.

    Args:
        directions: unit vectors in the sensor's frame, shape (n, 3).
        groups: visible geom groups.
        reach: longest distance [m].
        grid: ascending elevations and azimuths [rad], if the directions are all their pairs, layer by layer; else None.
        use_embree: False leaves triangles to the engine even if `embreex` is installed.
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
        self._static: list[TriangleBody] | None = None
        self.movers = MovingBodies([])
        self._parts: list[FanPart] = []
        self._pieces = 0
        self.groups = np.zeros(6, dtype=np.uint8)
        self.groups[list(groups)] = 1
        self.grid, self.numpy_directions = (
            grid,
            None if self.count < MANY_RAYS else FanDirections(self.directions, grid),
        )
        self._use_embree = use_embree
        self.bounds = _bounds(grid)

    @property
    def geoms(self) -> npt.NDArray[np.int32]:
        """Geoms that were hit, shape (n,): geom ids of the compiled model, -1 for no hit."""
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
        """Set the model that the rays are cast in.

        Args:
            model: compiled model.
            names: name map of the compiled model.
            body: body that carries the rays; a moving one is not hit.
            own_geoms: geoms of a static carrier that are not hit.
            hidden: other geoms that are not visible.
            offset: pose of the fan in the body's frame, None if it may change. A constant pose excludes geoms that no
                ray can ever hit.
        """
        self.body = body if body > 0 else 0
        self.own_geoms = [] if body > 0 else list(own_geoms)
        self.targets = self._find_targets(model, names, hidden)
        self.carrier = self.targets.carrier_of(self.body, self.own_geoms)
        if self.carrier < 0 and not self.targets.needs_engine:
            self.targets = self._find_targets(model, names, (*hidden, *self.own_geoms))
            self.carrier = 0
        self.offset, self._static, self._nearby = offset, None, None
        targets = self.targets
        # ids of the compiled model; `cast` replaces them with the ids of the reduced model if it casts all rays
        self.ids = np.append(np.arange(model.ngeom), -1).astype(np.int32)
        self.by_engine = self.count < MANY_RAYS and targets.moving_shapes <= MAX_MOVING_BODIES
        if not self.by_engine and self.numpy_directions is None:
            self.numpy_directions = FanDirections(self.directions, self.grid)

    @property
    def casts_in_rows(self) -> bool:
        """True if `RayFanRows` can cast the rays: they are few, and hit no moving triangles."""
        return self.by_engine and not self.targets.needs_engine and not len(self.movers)

    def _find_targets(self, model: mujoco.MjModel, names: NameMap, hidden: Sequence[int]) -> RayTargets:
        def find() -> RayTargets:
            seen = self.groups[model.geom_group] > 0
            seen[list(hidden)] = False
            return RayTargets(model, names, seen, self._use_embree)

        key = f"seen by rays: groups {self.groups.tolist()}, {self._use_embree}, without {sorted(hidden)}"
        targets: RayTargets = names.shared(key, find)
        return targets

    def cast(
        self, model: mujoco.MjModel, data: mujoco.MjData, origin: Vector, rotation: Vector, start: float = 0.0
    ) -> None:
        """Cast the rays, and set new arrays `distances`, `hits` and `infinite`.

        Args:
            model: model that the fan is bound to.
            data: data of that model with up-to-date poses.
            origin: point from which distances are measured, in the world [m], shape (3,).
            rotation: rotation matrix of the sensor's frame, shape (3, 3).
            start: distance from the origin at which the rays start [m].
        """
        targets = self.targets
        if targets.needs_engine:
            rays = self._rays_for_engine(origin, rotation, start)
            self.distances, self.hits, self.infinite = targets.whole.cast(data, rays, self.body, self.own_geoms)
            return
        if not self.by_engine:
            self._clear()
            self._cast_parts(data, origin, rotation, start)
            self.finish()
            return
        rays, shapes = self._rays_for_engine(origin, rotation, start), targets.shapes_by_engine
        if shapes is not None:
            self.distances, self.hits, self.infinite = shapes.cast(data, rays, self._nearby_movers(shapes))
            if not targets.triangles_for_engine:
                self.ids = shapes.ids
                return
            self.hits = shapes.ids[self.hits]
        else:
            self._clear()
        self.find_triangles()
        self.cast_on_static_triangles(origin, rays.columns, start, self.distances, self.hits)
        self.movers.cast(data, rays, self.distances, self.hits)
        self.finish()

    def use(self, distances: Vector, geoms: npt.NDArray[np.int32]) -> None:
        """Set the results of a cast by other code: distances [m], infinite for no hit, and geoms of the model."""
        if len(self.ids) != self.targets.model.ngeom + 1:
            self.ids = np.append(np.arange(self.targets.model.ngeom), -1).astype(np.int32)
        self.distances, self.hits = distances, geoms
        self.finish()

    def _rays_for_engine(self, origin: Vector, rotation: Vector, start: float) -> RayBundle:
        directions = rotate_vectors(self.directions, rotation.T)
        return RayBundle(origin, directions.T, start, self.reach, self._limit, rotation[:, 2], *self.bounds)

    def rays_from(
        self, origin: Vector, rotation: Vector, start: float, part: FanPart | None = None, out: Vector | None = None
    ) -> RayBundle:
        """Return the rays, or those of a part, in the world, in the array `out` if it is given; see `cast`."""
        search, bounds = (self.numpy_directions, self.bounds) if part is None else part[1:]
        assert search is not None
        columns, axis = rotate_columns(rotation, search.columns, out), rotation[:, 2]
        return RayBundle(origin, columns, start, self.reach, self._limit, axis, *bounds, search, rotation)

    def _nearby_movers(self, shapes: ReducedModelCaster) -> NearbyGeoms:
        if self._nearby is None:
            movers = shapes.reachable_movers(self.carrier, self.body, self.offset, *self.bounds)
            self._nearby = NearbyGeoms(self.targets.model, movers, shapes.movers[movers])
        return self._nearby

    def _cast_parts(self, data: mujoco.MjData, origin: Vector, rotation: Vector, start: float) -> None:
        """Cast the rays in NumPy and with Embree: one part in each thread. Each ray is computed alone."""
        self.find_triangles()
        self._find_shapes()
        count = min(ray_threads.count, max(1, self.count // RAYS_PER_THREAD))
        # a low and a high part for each thread, because rays to the sky take less time than rays to the ground
        pieces = 1 if count == 1 else 2 * count
        if self._pieces != pieces:
            assert self.numpy_directions is not None
            self._parts, self._pieces = _parts_of(self.numpy_directions, self.grid, pieces), pieces

        def cast_part(part: FanPart) -> None:
            rays = self.rays_from(origin, rotation, start, part)
            best, hits = self.distances[part.rays], self.hits[part.rays]
            self.cast_on_static_triangles(origin, rays.columns, start, best, hits)
            self.movers.cast(data, rays, best, hits)
            self.cast_on_planes(data, rays, best, hits)
            self._cast_on_shapes(data, rays, best, hits)

        def cast_parts(number: int) -> None:
            for i in sorted({number, pieces - 1 - number}):
                if i < len(self._parts):
                    cast_part(self._parts[i])

        ray_threads.run([partial(cast_parts, number) for number in range(count)])

    def finish(self) -> None:
        self.infinite = self.distances > min(self.reach, _LARGEST)
        np.copyto(self.distances, np.inf, where=self.infinite)

    def _clear(self) -> None:
        self.hits = np.full(self.count, -1, dtype=np.int32)
        self.distances = np.full(self.count, np.inf)

    def cast_on_planes(self, data: mujoco.MjData, rays: RayBundle, best: Vector, hits: npt.NDArray[np.int32]) -> None:
        """Cast on planes in NumPy; shorten `best` and set `hits`, shapes (n,)."""
        targets = self.targets
        for i in targets.planes.tolist():
            if self.carrier and targets.carriers[i] == self.carrier:
                continue
            geom = int(targets.geoms[i])
            turn, size = data.geom_xmat[geom].reshape(3, 3), targets.model.geom_size[geom]
            if not reaches_plane(rays, data.geom_xpos[geom].tolist(), turn[:, 2].tolist()):
                continue
            plane_distances = cast_on_plane(rays.origin, rays.columns, data.geom_xpos[geom], turn, size, rays.start)
            if plane_distances is not None:
                nearer = plane_distances < best
                np.copyto(best, plane_distances, where=nearer)
                hits[nearer] = geom

    def _find_shapes(self) -> None:
        if self._nearby is None:
            targets, which = self.targets, self.targets.shapes
            if self.carrier:
                which = which[targets.carriers[which] != self.carrier]
            self._nearby = NearbyGeoms(targets.model, which, targets.geoms[which])

    def _cast_on_shapes(self, data: mujoco.MjData, rays: RayBundle, best: Vector, hits: npt.NDArray[np.int32]) -> None:
        assert self._nearby is not None and rays.search is not None and rays.rotation is not None
        which = self._nearby.reached(data, rays)
        if len(which):
            shapes = self.targets.shapes_in_frame(data, which, rays.origin, rays.rotation)
            cast_on_shapes(rays.search, shapes, rays.reach, rays.start, best, hits)

    def find_triangles(self) -> None:
        """Find the triangles that the rays can hit, once for each model."""
        if self._static is None:
            bodies = self.targets.triangles_for_engine if self.by_engine else self.targets.triangles_and_boxes
            self._static = [body for body in bodies if not body.carrier]
            self.movers = MovingBodies([body for body in bodies if body.carrier and self._can_reach(body)])

    def cast_on_static_triangles(
        self, origin: Vector, columns: Vector, start: float, best: Vector, hits: npt.NDArray[np.int32]
    ) -> None:
        """Cast rays of this fan, or of fans with the same targets, on static triangles.

        Args:
            origin: common origin of the rays in the world [m], shape (3,), or the origin of each, shape (3, n).
            columns: unit vectors in the world, shape (3, n).
            start: distance from the origin at which the rays start [m].
            best: shortest distances so far [m], shape (n,), which are shortened.
            hits: geoms at those distances, shape (n,).
        """
        assert self._static is not None
        for body in self._static:
            for first in range(0, len(best), _RAYS_PER_CHUNK):
                part = slice(first, first + _RAYS_PER_CHUNK)
                limit: Any = min(self.reach, _LARGEST_SINGLE)
                if body is not self._static[0] or self.by_engine:  # other geoms may be nearer
                    limit = np.minimum(best[part], self.reach, dtype=np.float32)
                own_origin = origin if origin.ndim == 1 else origin[:, part]
                distances, geoms = body.cast(own_origin, columns[:, part], start, limit)
                nearer = distances < best[part]
                np.copyto(best[part], distances, where=nearer)
                np.copyto(hits[part], geoms, where=nearer)

    def _can_reach(self, body: TriangleBody) -> bool:
        if body.carrier == self.carrier:
            return False
        if self.offset is None:
            return True
        return bool(can_reach(self.targets.model, self.body, self.offset, body.geoms, *self.bounds).any())


def _bounds(grid: tuple[Vector, Vector] | None) -> tuple[float, float]:
    """Return the lowest and highest elevation of rays [rad]."""
    if grid is not None and np.abs(grid[0]).max() <= np.pi / 2:
        return float(grid[0].min()), float(grid[0].max())
    return -np.pi / 2, np.pi / 2


def _parts_of(whole: FanDirections, grid: tuple[Vector, Vector] | None, count: int) -> list[FanPart]:
    """Divide the rays of a fan into parts, which are complete layers of a grid."""
    if count == 1:
        return [FanPart(slice(0, len(whole.directions)), whole, _bounds(grid))]
    layers = len(whole.directions) if grid is None else len(grid[0])
    length, ends = len(whole.directions) // layers, [i * layers // count for i in range(count + 1)]
    parts = []
    for first, last in pairwise(ends):
        if last > first:
            rays = slice(first * length, last * length)
            own_grid = None if grid is None else (grid[0][first:last], grid[1])
            parts.append(FanPart(rays, FanDirections(whole.directions[rays], own_grid), _bounds(own_grid)))
    return parts


class RayFanRows:
    """Casts of one fan in n simulations, whose static surroundings may differ.

    The engine casts through planes and shapes, and Embree through static triangles, as `RayFan` does.

    Args:
        fan: fan of the simulation that resets all others.
        states: states of all simulations.
    """

    def __init__(self, fan: RayFan, states: StateArrays) -> None:
        self._fan, self._states = fan, states
        self._casters: list[ReducedModelCaster | None] = [None] * states.count
        self._triangles: list[list[TriangleBody]] = [[]] * states.count
        self._batch: Any = None
        self._movers: Any = None

    def take(self, row: int) -> None:
        """Copy the surroundings of the fan to one row."""
        shapes = self._fan.targets.shapes_by_engine
        if shapes is not self._casters[row]:
            self._casters[row], self._batch = shapes, None
        self._triangles[row] = self._fan._static or []

    def _make_batch(self) -> None:
        """Make the batch of the reduced models, which contain planes and shapes only."""
        from mujoco.batch import Batch

        fan, states = self._fan, self._states
        shapes = next((caster for caster in self._casters if caster is not None), None)
        if shapes is None:
            return
        has_movers = len(shapes.reachable_movers(fan.carrier, fan.body, fan.offset, *fan.bounds)) > 0
        models = [(caster or shapes).model_for_rows(has_movers) for caster in self._casters]
        self._batch = Batch(models[0], states.count, states.threads)
        if any(model is not models[0] for model in models):
            self._batch.set_models(models)
        self._movers = None
        if has_movers:
            places = self._batch.bind("mocap_pos"), self._batch.bind("mocap_quat")
            self._movers = (*places, *shapes.mover_bodies(fan.carrier))

    def cast(self, origins: Vector, rotations: Vector, start: float) -> Vector:
        """Return the distances in all simulations [m], shape (n, rays); infinite for no hit within the reach.

        Args:
            origins: points from which distances are measured, in the world [m], shape (n, 3).
            rotations: rotation matrices of the sensor's frame, shape (n, 3, 3).
            start: distance from the origin at which the rays start [m].
        """
        fan, states = self._fan, self._states
        if self._batch is None:
            self._make_batch()
        origins = np.nan_to_num(origins)
        directions = np.nan_to_num(matmul(fan.directions, rotations.transpose(0, 2, 1)))
        distances = np.full(directions.shape[:2], np.inf)
        if self._batch is not None:
            if self._movers is not None:
                places, quaternions, bodies, is_kept = self._movers
                places[:], quaternions[:] = states.field("xpos")[:, bodies], states.field("xquat")[:, bodies]
                places[:, ~is_kept] = ENDLESS
            distances = self._cast_on_shapes(origins, directions, start)
        self._cast_on_triangles(origins, directions, distances, start)
        distances[~(distances <= fan.reach)] = np.inf
        return distances

    def _cast_on_shapes(self, origins: Vector, directions: Vector, start: float) -> Vector:
        points = np.broadcast_to(origins[:, None], directions.shape)
        distances: Vector = self._batch.ray(points, directions)[0]
        distances[distances < 0] = np.inf
        near = distances < start
        if near.any():
            # the engine has no start distance, so rays with a hit before the start are cast again
            rows = near.any(axis=1)
            beyond = self._batch.ray(points[rows] + start * directions[rows], directions[rows], ids=rows)[0]
            again = np.where(beyond < 0, np.inf, start + beyond)
            distances[rows] = np.where(near[rows], again, distances[rows])
        return distances

    def _cast_on_triangles(self, origins: Vector, directions: Vector, distances: Vector, start: float) -> None:
        """Shorten the distances of rays that hit static triangles, for all simulations with the same ones at once."""
        fan = self._fan
        kinds = np.array([id(bodies) for bodies in self._triangles])
        for kind in set(kinds.tolist()):
            rows = np.flatnonzero(kinds == kind)
            points = np.repeat(origins[rows].T, fan.count, axis=1)
            rays, shortest = directions[rows].reshape(-1, 3).T, distances[rows].reshape(-1)
            for body in self._triangles[rows[0]]:
                limit = np.minimum(shortest, fan.reach, dtype=np.float32)
                lengths, _ = body.cast(points, rays, start, limit)
                np.fmin(shortest, lengths, out=shortest)
            distances[rows] = shortest.reshape(len(rows), -1)


def fan_directions(azimuths: Vector, elevations: Vector) -> Vector:
    """Return unit vectors (x forward, y left, z up), layer by layer from the first elevation, shape (m·n, 3).

    Args:
        azimuths: angles about z [rad], shape (n,).
        elevations: angles above the x-y plane [rad], shape (m,).
    """
    elevation, azimuth = np.meshgrid(elevations, azimuths, indexing="ij")
    directions = np.stack(
        (np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)), axis=-1
    )
    return directions.reshape(-1, 3)
