"""Batches of equal lidars, whose rays are cast together; the results have the same bits as separate casts."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from functools import partial
from itertools import pairwise

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Vector
from simkit.runtime.particle_clouds import has_sources
from simkit.sensors.rays.embree_rays import MovingBodies
from simkit.sensors.rays.geom_types import Ids
from simkit.sensors.rays.lidar_measurement import LidarMeasurement, LidarReading
from simkit.sensors.rays.numpy_rays import cast_on_shapes
from simkit.sensors.rays.ray_culling import geom_half_sizes, reaches_between_cones
from simkit.sensors.rays.ray_fan import RAYS_PER_THREAD, RayFan
from simkit.sensors.rays.ray_threads import ray_threads
from simkit.sensors.sensor_batch import MIN_MEMBERS, SensorBatch

_CHUNK = 1 << 16  # pairs of fan and shape that are tested together
_MARGIN = 1e-9


def lidar_batch_key(lidar: LidarMeasurement) -> Hashable | None:
    """Return the properties that lidars of one batch share; None for a lidar whose rays are not cast in NumPy."""
    fan = lidar.fan
    if fan.by_engine or fan.targets.needs_engine or fan.grid is None:
        return None
    if lidar.artefacts:
        return None
    if lidar.sees_visuals and has_sources(lidar.sim):
        return None
    common = fan.directions.tobytes(), fan.reach, id(fan.targets), fan.bounds
    return (*common, lidar._start, lidar.sees_visuals)


class LidarBatch(SensorBatch[LidarMeasurement]):
    """Batch of equal lidars, each on its own robot; the lidars that have a reader cast together."""

    def __init__(self, members: Sequence[LidarMeasurement]) -> None:
        super().__init__(members)
        self._start, self._targets = members[0]._start, members[0].fan.targets
        self._which = self._targets.shapes
        self._geoms, self._carriers = self._targets.geoms[self._which], self._targets.carriers[self._which]
        self._radii = self.model.geom_rbound[self._geoms]
        self._halves = geom_half_sizes(self.model, self._geoms)
        self._movers = MovingBodies([body for body in self._targets.triangles_and_boxes if body.carrier])
        self._reachable: dict[int, Ids] = {}  # bodies of `_movers` by the id of a fan
        self._readings: dict[int, LidarReading] = {}

    def capture_all(self, data: mujoco.MjData) -> None:
        read = [index for index, lidar in enumerate(self.members) if lidar.is_read_now]
        self._readings.clear()
        if len(read) < MIN_MEMBERS:
            for index in read:
                self._readings[index] = self.members[index].measure(self.model, data)
            return
        frames = [self.members[index].ray_frame(data) for index in read]
        origins, rotations = (np.array(part) for part in zip(*frames, strict=True))
        self._cast([self.members[index].fan for index in read], data, origins, rotations)
        for index in read:
            self._readings[index] = self.members[index].reading_of_cast()

    def captured(self, member_index: int) -> LidarReading:
        reading = self._readings.pop(member_index, None)
        # a lidar whose first reader subscribed within this step has no reading yet
        return self.members[member_index].measure_now() if reading is None else reading

    def _cast(self, fans: Sequence[RayFan], data: mujoco.MjData, origins: Vector, rotations: Vector) -> None:
        """Set `distances`, `hits` and `infinite` of some fans, with the same bits as separate casts.

        Args:
            fans: k fans.
            data: physics data with up-to-date poses.
            origins: points from which distances are measured [m], shape (k, 3).
            rotations: rotation matrices of the fans' frames, shape (k, 3, 3).
        """
        first, start = fans[0], self._start
        count, directions = first.count, first.numpy_directions
        assert directions is not None
        best, hits = np.full(len(fans) * count, np.inf), np.full(len(fans) * count, -1, dtype=np.int32)
        self._find_movers(fans)
        columns, bundles = np.empty((3, len(best))), []
        for i, fan in enumerate(fans):
            own_rays = slice(i * count, (i + 1) * count)
            fan.distances, fan.hits = best[own_rays], hits[own_rays]
            bundles.append(fan.rays_from(origins[i], rotations[i], start, out=columns[:, own_rays]))

        def cast_on_triangles(some: range) -> None:
            rays = slice(some.start * count, some.stop * count)
            own_origins = np.repeat(origins[some.start : some.stop].T, count, axis=1)
            first.cast_on_static_triangles(own_origins, columns[:, rays], start, best[rays], hits[rays])
            if len(self._movers):
                pairs = [(bundles[i], self._reachable[id(fans[i])]) for i in some]
                self._movers.cast_fans(data, pairs, columns[:, rays], best[rays], hits[rays])
            for i in some:
                fans[i].cast_on_planes(data, bundles[i], fans[i].distances, fans[i].hits)

        threads = min(ray_threads.count, max(1, len(best) // RAYS_PER_THREAD), len(fans))
        ends = [i * len(fans) // threads for i in range(threads + 1)]
        ray_threads.run([partial(cast_on_triangles, range(*ends_of_part)) for ends_of_part in pairwise(ends)])
        for fan_indices, shapes in self._near(fans, data, origins, rotations):
            shapes_in_fans = self._targets.shapes_in_frame(
                data, self._which.take(shapes), origins.take(fan_indices, 0), rotations.take(fan_indices, 0)
            )
            cast_on_shapes(directions, shapes_in_fans, first.reach, start, best, hits, fan_indices * count)
        for fan in fans:
            # copies, because a view would keep the arrays of all scans alive
            fan.distances, fan.hits = fan.distances.copy(), fan.hits.copy()
            fan.finish()

    def _find_movers(self, fans: Sequence[RayFan]) -> None:
        """Find the moving bodies with triangles, and those that each fan can hit, once for each fan."""
        for fan in fans:
            if id(fan) not in self._reachable:
                fan.find_triangles()
                self._reachable[id(fan)] = self._movers.numbers_of(fan.movers)

    def _near(
        self, fans: Sequence[RayFan], data: mujoco.MjData, origins: Vector, rotations: Vector
    ) -> Iterator[tuple[Ids, Ids]]:
        """Yield pairs of a fan and a shape that its rays may hit, for some fans at a time; no such pair is missing."""
        carriers = np.array([fan.carrier for fan in fans], dtype=np.intp)
        centres = data.geom_xpos.take(self._geoms, 0)
        reach = (self._radii + fans[0].reach) * (1 + 1e-9) + _MARGIN
        fans_per_chunk = max(1, _CHUNK // max(1, len(self._geoms)))
        for first in range(0, len(fans), fans_per_chunk):
            part = slice(first, first + fans_per_chunk)
            offsets = centres - origins[part, None]
            square = offsets[..., 0] ** 2 + offsets[..., 1] ** 2 + offsets[..., 2] ** 2
            fan_carriers = carriers[part, None]
            of, shapes = np.nonzero(
                (square <= reach * reach) & ((fan_carriers != self._carriers) | (fan_carriers == 0))
            )
            axes = rotations[part, :, 2].take(of, 0)
            height = (offsets[of, shapes] * axes).sum(axis=1)
            within = self._within(fans[0], data, shapes, axes, height, square[of, shapes])
            yield of[within] + first, shapes[within]

    def _within(
        self, fan: RayFan, data: mujoco.MjData, shapes: Ids, axes: Vector, height: Vector, square: Vector
    ) -> npt.NDArray[np.bool_]:
        """Check which shapes reach into the fan's range of elevations, by their height above it."""
        lowest, highest = fan.bounds
        radii = self._radii.take(shapes)
        if lowest == highest == 0.0:
            turns = data.geom_xmat.take(self._geoms.take(shapes), 0).reshape(-1, 3, 3)
            extent = np.abs(np.einsum("ni,nij->nj", axes, turns)) * self._halves.take(shapes, 0)
            flat: npt.NDArray[np.bool_] = np.abs(height) <= extent.sum(axis=1) + _MARGIN
            return flat
        side = np.sqrt(np.maximum(square - height * height, 0.0))
        return reaches_between_cones(height, side, radii, lowest, highest)
