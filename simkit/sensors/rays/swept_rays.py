"""Casting of the rays of a sweep: each ray has its own origin, direction and time.

Static geoms are hit in the world's frame. For moving bodies, the rays are turned into the body's frame at the time of
each ray. The methods are those of `RayFan`: the engine or NumPy for shapes, Embree for triangles. Each ray is computed
alone, so that a scan in several parts has the same bits as a scan at once.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Vector
from simkit.sensors.rays.embree_rays import TriangleBody
from simkit.sensors.rays.geom_types import PLANE, TRIANGLES, Ids
from simkit.sensors.rays.mujoco_rays import SOLIDS, SOLIDS_AND_PLANES
from simkit.sensors.rays.numpy_rays import INTERVALS
from simkit.sensors.rays.ray_culling import can_reach
from simkit.sensors.rays.ray_fan import RayFan
from simkit.sensors.rays.sweep import RayPattern
from simkit.sensors.rays.sweep_poses import Poses, SweepPoses, rotate, rotate_back

_GROUPS = np.array((1, 0, 0, 0, 0, 0), dtype=np.uint8)


@dataclass(slots=True)
class WorldRays:
    """Rays in the world's frame, as columns.

    Attributes:
        origins: origins [m], shape (3, n).
        directions: unit vectors, shape (3, n).
        times: time of each ray after the scan's stamp [s], shape (n,).
        poses: poses of all bodies during the scan.
        numbers: number of each ray in the fan, shape (n,).
    """

    origins: Vector
    directions: Vector
    times: Vector
    poses: SweepPoses
    numbers: Ids


@dataclass(slots=True)
class SweptHits:
    """First hits of the rays of a fan so far.

    Attributes:
        distances: distances [m], shape (n,); infinite for no hit.
        geoms: geoms of the compiled model, shape (n,); -1 for no hit.
    """

    distances: Vector
    geoms: npt.NDArray[np.int32]

    @classmethod
    def of(cls, count: int) -> SweptHits:
        """Return hits of rays that are not cast yet."""
        return cls(np.full(count, np.inf), np.full(count, -1, dtype=np.int32))

    def shorten(self, rays: Ids, distances: Vector, geoms: npt.NDArray[np.int32] | int) -> None:
        """Replace hits by nearer ones; a ray may be there several times, if its geoms are given one by one."""
        nearer = np.flatnonzero(distances < self.distances.take(rays))
        rays, distances = rays[nearer], distances[nearer]
        if isinstance(geoms, int):
            self.distances[rays], self.geoms[rays] = distances, geoms
            return
        geoms = geoms[nearer]
        np.minimum.at(self.distances, rays, distances)
        first = self.distances[rays] == distances
        self.geoms[rays[first]] = geoms[first]


class SweptCaster:
    """Caster of the rays of one fan at their own times.

    Args:
        fan: fan that is bound to a model.
        offset: position [m], shape (3,), and rotation matrix, shape (3, 3), of the fan in the frame of its body.
    """

    def __init__(self, fan: RayFan, offset: tuple[Vector, Vector]) -> None:
        self._fan, self._targets, self._model = fan, fan.targets, fan.targets.model
        self._offset = offset
        self._turned: tuple[RayPattern, Vector] | None = None
        self._batch: Any = None
        targets, carriers = fan.targets, fan.targets.carriers
        others = np.flatnonzero((carriers != 0) & (carriers != fan.carrier))
        if fan.offset is not None and len(others):
            reachable = can_reach(self._model, fan.body, fan.offset, targets.geoms[others], *fan.bounds)
            others = others[reachable]
        self._movers = others
        self._mover_carriers = sorted(set(carriers[others].tolist()))
        self._bodies = np.array([targets.bodies[c] for c in self._mover_carriers], dtype=np.intp)
        self._radii = self._carrier_radii()
        static = targets.triangles_for_engine if fan.by_engine else targets.triangles_and_boxes
        needs_triangles = not targets.needs_engine
        self._static = [body for body in static if not body.carrier] if needs_triangles else []
        self._moving_triangles = self._find_moving_triangles() if needs_triangles else {}

    @property
    def needs_poses(self) -> bool:
        """True if the scan needs the poses of bodies at several ticks: the sensor or a target can move."""
        return bool(self._fan.body > 0 or (self._bodies > 0).any())

    def _carrier_radii(self) -> Vector:
        """Return the radius of the sphere around each carrier's origin with all its geoms [m]; infinite for planes."""
        model, radii = self._model, []
        for carrier in self._mover_carriers:
            which = self._movers[self._targets.carriers[self._movers] == carrier]
            geoms = self._targets.geoms[which]
            positions, bounds = model.geom_pos[geoms], model.geom_rbound[geoms]
            bounds = np.where(self._targets.types[which] == PLANE, np.inf, bounds)
            square = positions[:, 0] ** 2 + positions[:, 1] ** 2 + positions[:, 2] ** 2
            radii.append(float((np.sqrt(square) + bounds).max()) * (1 + 1e-9) + 1e-6)
        return np.array(radii)

    def _find_moving_triangles(self) -> dict[int, TriangleBody]:
        bodies = self._targets.triangles_and_boxes
        return {body.carrier: body for body in bodies if body.carrier in set(self._mover_carriers)}

    # ------------------------------------------------------------------ casting

    def world_rays(self, pattern: RayPattern, poses: SweepPoses, columns: Ids) -> WorldRays:
        """Return the rays of some columns of a pattern."""
        if self._turned is None or self._turned[0] is not pattern:
            x, y, z = pattern.directions.T
            turn = self._offset[1]
            turned = np.stack([turn[i, 0] * x + turn[i, 1] * y + turn[i, 2] * z for i in range(3)])
            self._turned = pattern, turned.reshape(3, -1, len(pattern.times))
        directions = self._turned[1]
        layers, count = directions.shape[1:]
        is_part = len(columns) != count
        numbers = (np.arange(layers)[:, None] * count + columns).ravel() if is_part else np.arange(layers * count)
        if is_part:
            directions = directions[:, :, columns]
        times = pattern.times.take(columns) if is_part else pattern.times
        position, size = self._offset[0][:, None], layers * len(columns)
        if self._fan.body > 0:
            frame = poses.at(self._fan.body, times)
            origins = frame.positions
            if position.any():
                origins = origins + rotate(frame.quaternions, position)
            world = rotate(frame.quaternions[:, None], directions)
        else:
            origins, world = np.broadcast_to(position, (3, len(times))), directions
        origins = np.broadcast_to(origins[:, None], (3, layers, len(times))).reshape(3, size)
        times = np.broadcast_to(times, (layers, len(times))).reshape(size)
        return WorldRays(origins, np.ascontiguousarray(world.reshape(3, size)), times, poses, numbers)

    def cast(self, data: mujoco.MjData, rays: WorldRays, start: float, hits: SweptHits) -> None:
        """Cast rays, and enter their first hits in `hits`.

        Args:
            data: data of the fan's model, in which everything static has its pose.
            rays: rays to cast.
            start: distance from the origin at which the rays start [m].
            hits: hits of all rays of the fan.
        """
        if self._targets.needs_engine:
            self._cast_in_whole_model(data, rays, start, hits)
            return
        if self._fan.by_engine:
            self._cast_on_static_shapes(rays, start, hits)
        else:
            self._cast_on_static_geoms(data, rays, start, hits)
        for body in self._static:
            self._cast_on_triangles(body, rays.numbers, rays.origins, rays.directions, start, hits)
        if len(self._mover_carriers):
            self._cast_on_movers(data, rays, start, hits)

    def _cast_on_triangles(
        self, body: TriangleBody, numbers: Ids, origins: Vector, directions: Vector, start: float, hits: SweptHits
    ) -> None:
        limit = np.minimum(hits.distances.take(numbers), self._fan.reach, dtype=np.float32)
        which, distances, geoms = body.cast_local(
            np.ascontiguousarray(origins.T), np.ascontiguousarray(directions.T), start, limit
        )
        nearer = distances < hits.distances.take(numbers[which])
        chosen = numbers[which][nearer]
        hits.distances[chosen], hits.geoms[chosen] = distances[nearer], geoms[nearer]

    def _cast_on_static_shapes(self, rays: WorldRays, start: float, hits: SweptHits) -> None:
        """Cast on static planes and shapes with the engine, as `mj_ray` does."""
        shapes = self._targets.shapes_by_engine
        if shapes is None:
            return
        if self._batch is None:
            from mujoco.batch import Batch

            self._batch = Batch(shapes.static_model, 1, 1)
        origins, directions = np.ascontiguousarray(rays.origins.T), np.ascontiguousarray(rays.directions.T)
        groups = SOLIDS_AND_PLANES if shapes.has_planes else SOLIDS
        found, geoms = (part[0] for part in self._batch.ray(origins[None], directions[None], geomgroup=groups))
        missed = found < 0
        distances = np.where(missed, np.inf, found)
        if start > 0:
            near = np.flatnonzero(distances < start)
            if len(near):
                # the engine has no start distance, so rays with a hit before the start are cast again
                again = origins[near] + start * directions[near]
                found, beyond = (
                    part[0] for part in self._batch.ray(again[None], directions[near][None], geomgroup=groups)
                )
                distances[near] = np.where(found < 0, np.inf, start + found)
                geoms = np.array(geoms)
                geoms[near] = beyond
        geoms = shapes.ids.take(geoms)
        nearer = distances < hits.distances.take(rays.numbers)
        chosen = rays.numbers[nearer]
        hits.distances[chosen], hits.geoms[chosen] = distances[nearer], geoms[nearer]

    def _cast_on_static_geoms(self, data: mujoco.MjData, rays: WorldRays, start: float, hits: SweptHits) -> None:
        """Cast on static planes and shapes in NumPy."""
        targets = self._targets
        for which in targets.planes[targets.carriers[targets.planes] == 0].tolist():
            geom = int(targets.geoms[which])
            self._cast_on_geoms(data, np.array([geom]), rays.origins, rays.directions, rays.numbers, start, hits)
        shapes = targets.shapes[targets.carriers[targets.shapes] == 0]
        geoms = targets.geoms[shapes]
        for geom in geoms.tolist():
            centre, radius = data.geom_xpos[geom], float(self._model.geom_rbound[geom])
            near = _rays_near(rays.origins, rays.directions, centre[:, None], radius, self._fan.reach)
            if len(near):
                parts = rays.origins.take(near, 1), rays.directions.take(near, 1), rays.numbers.take(near)
                self._cast_on_geoms(data, np.array([geom]), *parts, start, hits)

    def _cast_on_geoms(
        self,
        data: mujoco.MjData | None,
        geoms: Ids,
        origins: Vector,
        directions: Vector,
        numbers: Ids,
        start: float,
        hits: SweptHits,
    ) -> None:
        """Cast rays on geoms of one type: each ray on its own geom, or all rays on one.

        Args:
            data: data with the poses of the geoms in the world; None for rays in the frames of the geoms' bodies.
            geoms: geom ids, shape (n,) or (1,).
            origins: origins [m], shape (3, n).
            directions: unit vectors, shape (3, n).
            numbers: numbers of the rays in the fan, shape (n,).
            start: distance at which the rays start [m].
            hits: hits of all rays.
        """
        model = self._model
        if data is None:
            quaternions = model.geom_quat[geoms].T
            local, turned = origins - model.geom_pos[geoms].T, directions
            if (quaternions[0] != 1.0).any():
                local, turned = rotate_back(quaternions, local), rotate_back(quaternions, turned)
        else:
            matrices = data.geom_xmat[geoms].reshape(-1, 3, 3)
            local = _into(matrices, origins - data.geom_xpos[geoms].T)
            turned = _into(matrices, directions)
        kind, sizes = int(model.geom_type[geoms[0]]), model.geom_size[geoms].T
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            if kind == PLANE:
                distances = _distances_to_plane(local, turned, sizes, start)
            else:
                enter, leave = INTERVALS[kind](local, turned, sizes)
                distances = np.where(enter >= start, enter, leave)
                distances = np.where((enter <= leave) & (distances >= start), distances, np.inf)
        if len(geoms) == 1:
            hits.shorten(numbers, distances, int(geoms[0]))
        else:
            hits.shorten(numbers, distances, geoms.astype(np.int32))

    def _cast_on_movers(self, data: mujoco.MjData, rays: WorldRays, start: float, hits: SweptHits) -> None:
        """Cast on all other carriers, with the rays that may hit them, in the frames of their bodies."""
        carriers, which = self._pairs_of_movers(rays)
        if not len(which):
            return
        bodies, numbers = self._bodies.take(carriers), rays.numbers.take(which)
        poses = rays.poses.at(bodies, rays.times.take(which))
        origins, directions = rays.origins.take(which, 1), rays.directions.take(which, 1)
        origins = rotate_back(poses.quaternions, origins - poses.positions)
        directions = rotate_back(poses.quaternions, directions)
        targets = self._targets
        types, owner = targets.types[self._movers], targets.carriers[self._movers]
        for kind in sorted(set(types.tolist()) - set(TRIANGLES)):
            geoms_of = [self._movers[(types == kind) & (owner == c)] for c in self._mover_carriers]
            counts = np.array([len(geoms) for geoms in geoms_of], dtype=np.intp)
            first = np.cumsum(counts) - counts
            geoms = targets.geoms[np.concatenate(geoms_of)]
            repeats = counts.take(carriers)
            if not repeats.any():
                continue
            pairs = np.repeat(np.arange(len(carriers)), repeats)
            within = np.arange(len(pairs)) - np.repeat(np.cumsum(repeats) - repeats, repeats)
            own = geoms.take(first.take(carriers.take(pairs)) + within)
            parts = origins.take(pairs, 1), directions.take(pairs, 1), numbers.take(pairs)
            self._cast_on_geoms(None, own, *parts, start, hits)
        for index, carrier in enumerate(self._mover_carriers):
            body = self._moving_triangles.get(carrier)
            if body is not None:
                own = np.flatnonzero(carriers == index)
                if len(own):
                    parts = numbers[own], origins[:, own], directions[:, own]
                    self._cast_on_triangles(body, *parts, start, hits)

    def _pairs_of_movers(self, rays: WorldRays) -> tuple[Ids, Ids]:
        """Return pairs of a carrier's index and a ray that may hit its geoms; no such pair is missing."""
        count = rays.times.size
        near = []
        for index, body in enumerate(self._bodies.tolist()):
            if not np.isfinite(self._radii[index]):
                near.append(np.arange(count))
                continue
            centres = rays.poses.positions_at(body, rays.times)
            near.append(_rays_near(rays.origins, rays.directions, centres, self._radii[index], self._fan.reach))
        carriers = np.repeat(np.arange(len(near)), [len(part) for part in near])
        return carriers, np.concatenate(near)

    # ------------------------------------------------------------------ without Embree

    def _cast_in_whole_model(self, data: mujoco.MjData, rays: WorldRays, start: float, hits: SweptHits) -> None:
        """Cast ray by ray with the engine through all geoms, whose bodies move to their poses at each ray's time."""
        whole = self._targets.whole
        model, moved = whole.model, copy.copy(data)
        bodies = np.array([b for b in self._targets.bodies if b > 0 and b != self._fan.body], dtype=np.intp)
        mover = _BodyMover(model, moved, bodies) if len(bodies) else None
        geom, exclude = np.empty(1, np.int32), self._fan.body if self._fan.body > 0 else -1
        with whole.without(self._fan.own_geoms):
            for i in np.argsort(rays.times, kind="stable").tolist():
                if mover is not None:
                    mover.move(rays.poses, float(rays.times[i]))
                origin, direction = rays.origins[:, i].copy(), rays.directions[:, i].copy()
                distance = mujoco.mj_ray(model, moved, origin, direction, _GROUPS, 1, exclude, geom, None)
                if 0 <= distance < start:
                    origin += start * direction
                    distance = mujoco.mj_ray(model, moved, origin, direction, _GROUPS, 1, exclude, geom, None)
                    distance = distance + start if distance >= 0 else distance
                if distance >= 0:
                    hits.distances[rays.numbers[i]], hits.geoms[rays.numbers[i]] = distance, geom[0]


class _BodyMover:
    """Moves bodies of MuJoCo's data to the poses of a time, as far as rays need it."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, bodies: Ids) -> None:
        self._model, self._data, self._bodies = model, data, bodies
        self._geoms = np.flatnonzero(np.isin(model.geom_bodyid, bodies))
        place = {body: i for i, body in enumerate(bodies.tolist())}
        self._owners = np.array([place[int(model.geom_bodyid[g])] for g in self._geoms], dtype=np.intp)
        self._time = -1.0

    def move(self, poses: SweepPoses, time: float) -> None:
        if time == self._time:
            return
        self._time = time
        model, data, bodies = self._model, self._data, self._bodies
        frame = poses.at(bodies, np.full(len(bodies), time))
        self._place(data.xpos, data.xmat, bodies, frame, np.zeros((len(bodies), 3)), None)
        self._place(data.xipos, data.ximat, bodies, frame, model.body_ipos[bodies], model.body_iquat[bodies])
        owners = Poses(frame.positions[:, self._owners], frame.quaternions[:, self._owners])
        geoms = self._geoms
        self._place(data.geom_xpos, data.geom_xmat, geoms, owners, model.geom_pos[geoms], model.geom_quat[geoms])

    @staticmethod
    def _place(
        positions: Vector, matrices: Vector, which: Ids, frame: Poses, offset: Vector, turn: Vector | None
    ) -> None:
        positions[which] = (frame.positions + rotate(frame.quaternions, offset.T)).T
        axes = np.eye(3)[:, :, None]
        columns = [axes[i] if turn is None else rotate(turn.T, axes[i]) for i in range(3)]
        turned = [rotate(frame.quaternions, column) for column in columns]
        matrices[which] = np.stack(turned, axis=1).transpose(2, 0, 1).reshape(len(which), 9)


def _rays_near(origins: Vector, directions: Vector, centres: Vector, radius: float, reach: float) -> Ids:
    """Return the rays that pass through spheres with their centres in the columns of `centres`, within the reach."""
    x, y, z = centres - origins
    a, b, c = directions
    along = x * a
    along += y * b
    along += z * c
    square = x * x
    square += y * y
    square += z * z
    beside = square - along * along
    margin = radius * radius * (1 + 1e-9) + 1e-9 + 1e-12 * square
    is_near = (beside <= margin) & ((along >= 0) | (square <= margin))
    if np.isfinite(reach):
        is_near &= along <= (reach + radius) * (1 + 1e-9) + 1e-9
    return np.flatnonzero(is_near)


def _into(matrices: Vector, columns: Vector) -> Vector:
    """Return columns, shape (3, n), in the frames of rotation matrices, shape (n, 3, 3) or (1, 3, 3)."""
    x, y, z = columns
    return np.stack([matrices[:, 0, i] * x + matrices[:, 1, i] * y + matrices[:, 2, i] * z for i in range(3)])


def _distances_to_plane(origins: Vector, directions: Vector, sizes: Vector, start: float) -> Vector:
    """Return distances to the front of planes or rectangles in their own frames [m]; infinite for misses."""
    height, descent = origins[2], directions[2]
    distances = np.where((height > 0) & (descent < -1e-15), -height / descent, np.inf)
    distances[distances < start] = np.inf
    for axis in (0, 1):
        side = np.abs(origins[axis] + distances * directions[axis])
        distances = np.where((sizes[axis] > 0) & ~(side <= sizes[axis]), np.inf, distances)
    return distances
