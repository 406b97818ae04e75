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
from simkit.sensors.rays.sweep_poses import Poses, SweepPoses, matrices_of, rotate, rotate_back

_PAIRS = 1 << 16  # pairs of column and sphere that are tested together
_MANY = 256  # rays towards one shape from which the shape is processed alone
_GROUPS = np.array((1, 0, 0, 0, 0, 0), dtype=np.uint8)


@dataclass(slots=True)
class _Columns:
    """Columns of a pattern in the frame of the sensor's body.

    Attributes:
        pattern: the pattern, with l layers and c columns.
        directions: unit vectors, shape (3, l, c).
        numbers: number of each ray in the fan, shape (l, c).
        normals: unit vector of each column to which all its rays are almost perpendicular, shape (3, c).
        axes: mean direction of each column, shape (3, c).
        spread: largest product of a normal with a ray of its column.
        is_ahead: True if no ray deviates from the axis of its column by more than 90°.
    """

    pattern: RayPattern
    directions: Vector
    numbers: Ids
    normals: Vector
    axes: Vector
    spread: float
    is_ahead: bool

    @classmethod
    def of(cls, pattern: RayPattern, turn: Vector) -> _Columns:
        x, y, z = pattern.directions.T
        turned = np.stack([turn[i, 0] * x + turn[i, 1] * y + turn[i, 2] * z for i in range(3)])
        directions = np.ascontiguousarray(turned.reshape(3, -1, len(pattern.times)))
        numbers = np.arange(len(pattern.directions)).reshape(directions.shape[1:])
        first, last = directions[:, 0], directions[:, -1]
        normals = _unit(np.cross(first, last, axis=0))
        axes = _unit(first + last)
        spread = np.abs(_dot(normals[:, None], directions)).max()
        is_ahead = bool((_dot(axes[:, None], directions) >= 0.0).all())
        return cls(pattern, directions, numbers, normals, axes, float(spread), is_ahead)


@dataclass(slots=True)
class WorldRays:
    """Rays of c columns and l layers in the world's frame, as columns.

    Attributes:
        origins: origin of each column [m], shape (3, c).
        directions: unit vectors, shape (3, l, c).
        times: time of each column after the scan's stamp [s], shape (c,).
        poses: poses of all bodies during the scan.
        numbers: number of each ray in the fan, shape (l, c).
        normals, axes, spread, is_ahead: bounds of the columns, as in `_Columns`, in the world's frame.
    """

    origins: Vector
    directions: Vector
    times: Vector
    poses: SweepPoses
    numbers: Ids
    normals: Vector
    axes: Vector
    spread: float
    is_ahead: bool

    def columns(self) -> tuple[Vector, Vector]:
        """Return the origin [m] and the direction of each ray, shapes (3, l · c)."""
        layers = len(self.numbers)
        origins = self.origins if layers == 1 else np.tile(self.origins, layers)
        return origins, self.directions.reshape(3, -1)

    def all_origins(self) -> Vector:
        """Return the origin of each ray [m], shape (l · c, 3)."""
        return np.ascontiguousarray(self.columns()[0].T)

    def all_directions(self) -> Vector:
        """Return the direction of each ray, shape (l · c, 3)."""
        return np.ascontiguousarray(self.directions.reshape(3, -1).T)

    def near(self, centres: Vector, radii: Vector, reach: float) -> tuple[Ids, Ids]:
        """Return pairs of a sphere and a ray that may pass through it within the reach; no such pair is missing.

        Args:
            centres: centres in the world at the time of each column [m], shape (3, m, c) or (3, m, 1).
            radii: radii [m], shape (m,).
            reach: longest distance [m].

        Returns:
            Indices of spheres, ascending, and of rays, which count layer by layer as `numbers`.
        """
        layers, columns = self.numbers.shape
        reaches, radius = centres - self.origins[:, None], radii[:, None]
        square = _dot(reaches, reaches)
        if layers == 1:
            spheres, rays = np.nonzero(_passes(reaches, square, self.directions, radius, reach))
            return spheres, rays
        beside = np.abs(_dot(reaches, self.normals[:, None]))
        far = radius + self.spread * (np.sqrt(square) + radius)
        is_near = beside <= far * (1 + 1e-9) + 1e-9
        if self.is_ahead:
            is_near &= _dot(reaches, self.axes[:, None]) >= -radius * (1 + 1e-9) - 1e-9
        spheres, chosen = np.nonzero(is_near)
        towards, square = reaches[:, spheres, chosen], square[spheres, chosen]
        directions = self.directions[:, :, chosen]
        passes = _passes(towards[:, None], square, directions, radii.take(spheres), reach)
        pairs, layer = np.nonzero(passes.T)
        return spheres.take(pairs), layer * columns + chosen.take(pairs)


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
        self._columns: _Columns | None = None
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
        self._mover_shapes = self._sort_mover_shapes()
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

    def _sort_mover_shapes(self) -> list[tuple[Ids, Ids, Ids]]:
        """Return the planes and shapes of the movers, sorted by type and carrier.

        Returns:
            For each type: geoms, number of geoms of each carrier, and index of each carrier's first geom.
        """
        targets, sorted_shapes = self._targets, []
        types, owner = targets.types[self._movers], targets.carriers[self._movers]
        for kind in sorted(set(types.tolist()) - set(TRIANGLES)):
            geoms_of = [self._movers[(types == kind) & (owner == carrier)] for carrier in self._mover_carriers]
            counts = np.array([len(geoms) for geoms in geoms_of], dtype=np.intp)
            sorted_shapes.append((targets.geoms[np.concatenate(geoms_of)], counts, np.cumsum(counts) - counts))
        return sorted_shapes

    def _find_moving_triangles(self) -> dict[int, TriangleBody]:
        bodies = self._targets.triangles_and_boxes
        return {body.carrier: body for body in bodies if body.carrier in set(self._mover_carriers)}

    # ------------------------------------------------------------------ casting

    def world_rays(self, pattern: RayPattern, poses: SweepPoses, columns: Ids) -> WorldRays:
        """Return the rays of some columns of a pattern."""
        if self._columns is None or self._columns.pattern is not pattern:
            self._columns = _Columns.of(pattern, self._offset[1])
        whole = self._columns
        layers, count = whole.directions.shape[1:]
        is_part = len(columns) != count
        numbers = np.arange(layers)[:, None] * count + columns if is_part else whole.numbers
        parts = whole.directions, whole.normals, whole.axes
        directions, normals, axes = (part[..., columns] for part in parts) if is_part else parts
        times = pattern.times.take(columns) if is_part else pattern.times
        position = self._offset[0][:, None]
        if self._fan.body > 0:
            frame = poses.at(self._fan.body, times)
            turn = matrices_of(frame.quaternions)
            origins = frame.positions
            if position.any():
                origins = origins + _turn(turn, position)
            directions = _turn(turn, directions)
            if layers > 1:
                normals, axes = _turn(turn, normals), _turn(turn, axes)
        else:
            origins = np.repeat(position, len(times), axis=1)
        return WorldRays(origins, directions, times, poses, numbers, normals, axes, whole.spread, whole.is_ahead)

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
        if self._static:
            (origins, directions), numbers = rays.columns(), rays.numbers.ravel()
            for body in self._static:
                self._cast_on_triangles(body, numbers, origins, directions, start, hits)
        if len(self._mover_carriers):
            self._cast_on_movers(rays, start, hits)

    def _cast_on_triangles(
        self, body: TriangleBody, numbers: Ids, origins: Vector, directions: Vector, start: float, hits: SweptHits
    ) -> None:
        limit = np.minimum(hits.distances.take(numbers), self._fan.reach, dtype=np.float32)
        distances, geoms = body.cast(origins, directions, start, limit)
        nearer = np.flatnonzero(distances < hits.distances.take(numbers))
        chosen = numbers.take(nearer)
        hits.distances[chosen], hits.geoms[chosen] = distances.take(nearer), geoms.take(nearer)

    def _cast_on_static_shapes(self, rays: WorldRays, start: float, hits: SweptHits) -> None:
        """Cast on static planes and shapes with the engine, as `mj_ray` does."""
        shapes = self._targets.shapes_by_engine
        if shapes is None:
            return
        if self._batch is None:
            from mujoco.batch import Batch

            self._batch = Batch(shapes.static_model, 1, 1)
        origins, directions = rays.all_origins(), rays.all_directions()
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
        geoms, numbers = shapes.ids.take(geoms), rays.numbers.ravel()
        nearer = distances < hits.distances.take(numbers)
        chosen = numbers[nearer]
        hits.distances[chosen], hits.geoms[chosen] = distances[nearer], geoms[nearer]

    def _cast_on_static_geoms(self, data: mujoco.MjData, rays: WorldRays, start: float, hits: SweptHits) -> None:
        """Cast on static planes and shapes in NumPy."""
        targets, model = self._targets, self._model
        for which in targets.planes[targets.carriers[targets.planes] == 0].tolist():
            self._cast_on_static_plane(data, int(targets.geoms[which]), rays, start, hits)
        shapes = targets.shapes[targets.carriers[targets.shapes] == 0]
        geoms, types = targets.geoms[shapes], targets.types[shapes]
        columns = max(1, len(rays.times))
        for first in range(0, len(geoms), max(1, _PAIRS // columns)):
            some = geoms[first : first + max(1, _PAIRS // columns)]
            centres = data.geom_xpos[some].T[:, :, None]
            owners, which = rays.near(centres, model.geom_rbound[some], self._fan.reach)
            counts = np.bincount(owners, minlength=len(some))
            ends = np.cumsum(counts).tolist()
            for index in np.flatnonzero(counts >= _MANY).tolist():  # one pose for all these rays saves time
                own = which[ends[index] - counts[index] : ends[index]]
                self._cast_on_geoms(data, some[index : index + 1], *_of_rays(rays, own), start, hits)
            is_few = (counts < _MANY).take(owners)
            kinds = np.where(is_few, types[first : first + len(some)].take(owners), -1)
            for kind in np.flatnonzero(np.bincount(kinds + 1)).tolist():
                if kind:
                    pairs = np.flatnonzero(kinds == kind - 1)
                    parts = _of_rays(rays, which.take(pairs))
                    self._cast_on_geoms(data, some.take(owners.take(pairs)), *parts, start, hits)

    def _cast_on_static_plane(
        self, data: mujoco.MjData, geom: int, rays: WorldRays, start: float, hits: SweptHits
    ) -> None:
        """Cast all rays on a static plane or rectangle."""
        turn, size = data.geom_xmat[geom].reshape(3, 3), self._model.geom_size[geom]
        origins = rays.origins - data.geom_xpos[geom][:, None]
        height = _dot(origins, turn[:, 2])
        if not (height > 0).any():
            return
        descent = _dot(rays.directions, turn[:, 2])
        with np.errstate(divide="ignore", invalid="ignore"):
            distances = -height / descent
            hit = (height > 0) & (descent < -1e-15) & (distances >= start)
            hit &= distances < hits.distances.take(rays.numbers)
            for axis in (0, 1):
                if size[axis] > 0:
                    side = _dot(origins, turn[:, axis]) + distances * _dot(rays.directions, turn[:, axis])
                    hit &= np.abs(side) <= size[axis]
        numbers = rays.numbers[hit]
        hits.distances[numbers], hits.geoms[numbers] = distances[hit], geom

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

    def _cast_on_movers(self, rays: WorldRays, start: float, hits: SweptHits) -> None:
        """Cast on all other carriers, with the rays that may hit them, in the frames of their bodies."""
        carriers, which = self._pairs_of_movers(rays)
        if not len(which):
            return
        columns = which % len(rays.times)
        poses = rays.poses.at(self._bodies.take(carriers), rays.times, columns)
        origins, directions, numbers = _of_rays(rays, which)
        turn = matrices_of(poses.quaternions)
        origins, directions = _turn_back(turn, origins - poses.positions), _turn_back(turn, directions)
        for geoms, counts, first in self._mover_shapes:
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
                    local, turned = origins.take(own, 1), directions.take(own, 1)
                    self._cast_on_triangles(body, numbers[own], local, turned, start, hits)

    def _pairs_of_movers(self, rays: WorldRays) -> tuple[Ids, Ids]:
        """Return pairs of a carrier's index and a ray that may hit its geoms; no such pair is missing."""
        carriers, which = [], []
        endless = np.flatnonzero(~np.isfinite(self._radii))
        carriers.append(np.repeat(endless, rays.numbers.size))
        which.append(np.tile(np.arange(rays.numbers.size), len(endless)))
        bounded = np.flatnonzero(np.isfinite(self._radii))
        step = max(1, _PAIRS // max(1, len(rays.times)))
        for first in range(0, len(bounded), step):
            some = bounded[first : first + step]
            centres = rays.poses.positions_at(self._bodies[some], rays.times)
            owners, near = rays.near(centres, self._radii[some], self._fan.reach)
            carriers.append(some.take(owners))
            which.append(near)
        return np.concatenate(carriers), np.concatenate(which)

    # ------------------------------------------------------------------ without Embree

    def _cast_in_whole_model(self, data: mujoco.MjData, rays: WorldRays, start: float, hits: SweptHits) -> None:
        """Cast ray by ray with the engine through all geoms, whose bodies move to their poses at each ray's time."""
        whole = self._targets.whole
        model, moved = whole.model, copy.copy(data)
        bodies = np.array([b for b in self._targets.bodies if b > 0 and b != self._fan.body], dtype=np.intp)
        mover = _BodyMover(model, moved, bodies) if len(bodies) else None
        geom, exclude = np.empty(1, np.int32), self._fan.body if self._fan.body > 0 else -1
        with whole.without(self._fan.own_geoms):
            for layer, i in ((k, i) for i in range(len(rays.times)) for k in range(len(rays.numbers))):
                if mover is not None:
                    mover.move(rays.poses, float(rays.times[i]))
                origin, direction = rays.origins[:, i].copy(), rays.directions[:, layer, i].copy()
                distance = mujoco.mj_ray(model, moved, origin, direction, _GROUPS, 1, exclude, geom, None)
                if 0 <= distance < start:
                    origin += start * direction
                    distance = mujoco.mj_ray(model, moved, origin, direction, _GROUPS, 1, exclude, geom, None)
                    distance = distance + start if distance >= 0 else distance
                if distance >= 0:
                    number = rays.numbers[layer, i]
                    hits.distances[number], hits.geoms[number] = distance, geom[0]


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


def _dot(first: Any, second: Any) -> Vector:
    """Return the products of vectors, whose components are the first axis."""
    product: Vector = first[0] * second[0]
    product += first[1] * second[1]
    product += first[2] * second[2]
    return product


def _unit(vectors: Vector) -> Vector:
    """Return unit vectors; those without a length stay zero."""
    unit: Vector = vectors / np.maximum(np.sqrt(_dot(vectors, vectors)), 1e-300)
    return unit


def _turn(matrix: Any, vectors: Vector) -> Vector:
    """Return vectors turned by rotation matrices; components are the first axis."""
    turned: Vector = np.empty((3, *np.broadcast_shapes(matrix[0][0].shape, vectors.shape[1:])))
    for row, out in zip(matrix, turned, strict=True):
        np.multiply(row[0], vectors[0], out=out)
        out += row[1] * vectors[1]
        out += row[2] * vectors[2]
    return turned


def _turn_back(matrix: Any, vectors: Vector) -> Vector:
    """Return vectors turned by the inverses of rotation matrices; components are the first axis."""
    return _turn(tuple(zip(*matrix, strict=True)), vectors)


def _of_rays(rays: WorldRays, which: Ids) -> tuple[Vector, Vector, Ids]:
    """Return origins, directions and numbers of some rays, which count layer by layer."""
    origins = rays.origins.take(which % len(rays.times), 1)
    return origins, rays.directions.reshape(3, -1).take(which, 1), rays.numbers.ravel().take(which)


def _passes(reaches: Vector, square: Vector, directions: Vector, radius: Vector, reach: float) -> npt.NDArray[np.bool_]:
    """Check which rays pass through spheres within the reach.

    Args:
        reaches: vectors from the origins of the rays to the centres [m].
        square: their squares [m²].
        directions: directions of the rays.
        radius: radii of the spheres [m].
        reach: longest distance [m].
    """
    along = _dot(reaches, directions)
    margin = radius * radius * (1 + 1e-9) + 1e-9 + 1e-12 * square
    is_near: npt.NDArray[np.bool_] = square - along * along <= margin
    is_near &= (along >= 0) | (square <= margin)
    if np.isfinite(reach):
        is_near &= along <= (reach + radius) * (1 + 1e-9) + 1e-9
    return is_near


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
