"""Cast the rays of many lidars of one make at once, to the same bits as one by one."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Vector
from simkit.sensors.rays.geom_types import Ids
from simkit.sensors.rays.lidar_measurement import LidarMeasurement, LidarReading
from simkit.sensors.rays.numpy_rays import Shapes, cast_on_shapes, in_frame
from simkit.sensors.rays.ray_culling import geom_half_sizes, reaches_between_cones
from simkit.sensors.rays.ray_fan import RayFan
from simkit.sensors.sensor_batch import MIN_MEMBERS, SensorBatch

_CHUNK = 1 << 16  # pairs of fan and shape that are looked at together
_MARGIN = 1e-9


class FanBatch:
    """Fans of the same directions, reach and targets, each on a robot of its own; to the same bits as one by one.

    Args:
        fans: bound, each one `fan_batch_key`.
    """

    def __init__(self, fans: Sequence[RayFan]) -> None:
        first = fans[0]
        self._fans, self._targets, self._count = list(fans), first._targets, first.count
        model, which = self._targets.model, self._targets.shapes
        self._which, self._geoms = which, self._targets.geoms[which]
        self._carriers = self._targets.carriers[which]
        self._radii, self._halves = model.geom_rbound[self._geoms], geom_half_sizes(model, self._geoms)

    def cast(
        self, chosen: Sequence[int], data: mujoco.MjData, origins: Vector, rotations: Vector, start: float
    ) -> None:
        """Makes `distances`, `hits` and `infinite` of these fans anew.

        Args:
            chosen: numbers of the fans, k of them.
            data: with up-to-date places.
            origins: where distances are counted from, shape (k, 3) [m].
            rotations: of the fans' frames, shape (k, 3, 3).
            start: how far from there the rays begin [m].
        """
        fans, count = [self._fans[i] for i in chosen], self._count
        best, hits = np.full(len(fans) * count, np.inf), np.full(len(fans) * count, -1, dtype=np.int32)
        for i, fan in enumerate(fans):
            mine = slice(i * count, (i + 1) * count)
            fan.distances, fan.hits = best[mine], hits[mine]
            fan._cast_on_planes_and_triangles(self._targets, data, fan._rays(origins[i], rotations[i], start))
        for of, shapes in self._near(fans, data, origins, rotations):
            self._cast(fans[0], data, origins, rotations, start, of, shapes, best, hits)
        for fan in fans:
            # who keeps one scan does not keep those of all
            fan.distances, fan.hits = fan.distances.copy(), fan.hits.copy()
            fan._end()

    def _cast(
        self,
        fan: RayFan,
        data: mujoco.MjData,
        origins: Vector,
        rotations: Vector,
        start: float,
        of: Ids,
        shapes: Ids,
        best: Vector,
        hits: npt.NDArray[np.int32],
    ) -> None:
        """Casts on pairs of fan (`of`) and shape."""
        model, geoms = self._targets.model, self._geoms.take(shapes)
        turns = data.geom_xmat.take(geoms, 0).reshape(-1, 3, 3)
        placed = in_frame(data.geom_xpos.take(geoms, 0), turns, origins.take(of, 0), rotations.take(of, 0))
        kinds = self._targets.types.take(self._which.take(shapes))
        sizes, radii = model.geom_size.take(geoms, 0), self._radii.take(shapes)
        found = Shapes(kinds, sizes, *placed, radii, geoms.astype(np.int32))
        assert fan._fan is not None
        cast_on_shapes(fan._fan, found, fan.reach, start, best, hits, of * self._count)

    def _near(
        self, fans: Sequence[RayFan], data: mujoco.MjData, origins: Vector, rotations: Vector
    ) -> Iterator[tuple[Ids, Ids]]:
        """Pairs of fan and shape where rays may meet it, some fans at a time; never one too few."""
        carriers = np.array([fan._carrier for fan in fans], dtype=np.intp)
        places = data.geom_xpos.take(self._geoms, 0)
        reach = (self._radii + fans[0].reach) * (1 + 1e-9) + _MARGIN
        some = max(1, _CHUNK // max(1, len(self._geoms)))
        for first in range(0, len(fans), some):
            part = slice(first, first + some)
            to = places - origins[part, None]
            square = to[..., 0] ** 2 + to[..., 1] ** 2 + to[..., 2] ** 2
            mine = carriers[part, None]
            of, shapes = np.nonzero((square <= reach * reach) & ((mine != self._carriers) | (mine == 0)))
            axes = rotations[part, :, 2].take(of, 0)
            height = (to[of, shapes] * axes).sum(axis=1)
            within = self._within(fans[0], data, shapes, axes, height, square[of, shapes])
            yield of[within] + first, shapes[within]

    def _within(
        self, fan: RayFan, data: mujoco.MjData, shapes: Ids, axes: Vector, height: Vector, square: Vector
    ) -> npt.NDArray[np.bool_]:
        """Whether shapes reach between the ends of a fan, by their height over it."""
        lowest, highest = fan._bounds
        radii = self._radii.take(shapes)
        if lowest == highest == 0.0:
            turns = data.geom_xmat.take(self._geoms.take(shapes), 0).reshape(-1, 3, 3)
            extent = np.abs(np.einsum("ni,nij->nj", axes, turns)) * self._halves.take(shapes, 0)
            flat: npt.NDArray[np.bool_] = np.abs(height) <= extent.sum(axis=1) + _MARGIN
            return flat
        side = np.sqrt(np.maximum(square - height * height, 0.0))
        return reaches_between_cones(height, side, radii, lowest, highest)


def fan_batch_key(fan: RayFan) -> tuple[object, ...] | None:
    """What fans have in common that may be cast together; None for one that is not cast in NumPy."""
    if fan._by_engine or fan._targets.needs_engine or fan._grid is None:
        return None
    return fan.directions.tobytes(), fan.reach, id(fan._targets), fan._bounds


def lidar_batch_key(lidar: LidarMeasurement) -> Hashable | None:
    """What lidars have in common that may be measured together; None for one that is measured alone."""
    common = fan_batch_key(lidar._fan)
    return None if common is None else (*common, lidar._start, lidar.sees_visuals)


class LidarBatch(SensorBatch[LidarMeasurement]):
    """Lidars that differ in place alone; those that somebody reads cast together."""

    def __init__(self, members: Sequence[LidarMeasurement]) -> None:
        super().__init__(members)
        self._fans, self._start = FanBatch([lidar._fan for lidar in members]), members[0]._start
        self._readings: dict[int, LidarReading] = {}

    def capture_all(self, data: mujoco.MjData) -> None:
        read = [place for place, lidar in enumerate(self.members) if lidar.is_read_now]
        self._readings.clear()
        if len(read) < MIN_MEMBERS:
            for place in read:
                self._readings[place] = self.members[place].measure(self.model, data)
            return
        places = [self.members[place]._place(data) for place in read]
        origins, rotations = (np.array(part) for part in zip(*places, strict=True))
        self._fans.cast(read, data, origins, rotations, self._start)
        for place in read:
            self._readings[place] = self.members[place].reading_of_cast()

    def captured(self, place: int) -> LidarReading:
        reading = self._readings.pop(place, None)
        # somebody has begun to read within this step
        return self.members[place].measure_now() if reading is None else reading
