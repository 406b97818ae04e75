"""Cast the rays of many lidars of one make at once, to the same bits as one by one."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Vector
from simkit.sensors.rays.geom_types import Ids
from simkit.sensors.rays.lidar_measurement import LidarMeasurement, LidarReading
from simkit.sensors.rays.numpy_rays import cast_on_shapes
from simkit.sensors.rays.ray_culling import geom_half_sizes, reaches_between_cones
from simkit.sensors.rays.ray_fan import RayFan
from simkit.sensors.sensor_batch import MIN_MEMBERS, SensorBatch

_CHUNK = 1 << 16  # pairs of fan and shape that are looked at together
_MARGIN = 1e-9


def lidar_batch_key(lidar: LidarMeasurement) -> Hashable | None:
    """What lidars have in common that may be measured together; None for one whose rays are not cast in NumPy."""
    fan = lidar._fan
    if fan._by_engine or fan._targets.needs_engine or fan._grid is None:
        return None
    common = fan.directions.tobytes(), fan.reach, id(fan._targets), fan._bounds
    return (*common, lidar._start, lidar.sees_visuals)


class LidarBatch(SensorBatch[LidarMeasurement]):
    """Lidars of one make, each on a robot of its own; those that somebody reads cast together."""

    def __init__(self, members: Sequence[LidarMeasurement]) -> None:
        super().__init__(members)
        self._start, self._targets = members[0]._start, members[0]._fan._targets
        self._which = self._targets.shapes
        self._geoms, self._carriers = self._targets.geoms[self._which], self._targets.carriers[self._which]
        self._radii = self.model.geom_rbound[self._geoms]
        self._halves = geom_half_sizes(self.model, self._geoms)
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
        self._cast([self.members[place]._fan for place in read], data, origins, rotations)
        for place in read:
            self._readings[place] = self.members[place].reading_of_cast()

    def captured(self, place: int) -> LidarReading:
        reading = self._readings.pop(place, None)
        # somebody has begun to read within this step
        return self.members[place].measure_now() if reading is None else reading

    def _cast(self, fans: Sequence[RayFan], data: mujoco.MjData, origins: Vector, rotations: Vector) -> None:
        """Makes `distances`, `hits` and `infinite` of some fans anew, to the same bits as one by one.

        Args:
            fans: k of them.
            data: with up-to-date places.
            origins: where distances are counted from, shape (k, 3) [m].
            rotations: of the fans' frames, shape (k, 3, 3).
        """
        first, start = fans[0], self._start
        count, directions = first.count, first._fan
        assert directions is not None
        best, hits = np.full(len(fans) * count, np.inf), np.full(len(fans) * count, -1, dtype=np.int32)
        for i, fan in enumerate(fans):
            mine = slice(i * count, (i + 1) * count)
            fan.distances, fan.hits = best[mine], hits[mine]
            fan._cast_on_planes_and_triangles(data, fan._rays(origins[i], rotations[i], start))
        for of, shapes in self._near(fans, data, origins, rotations):
            found = self._targets.shapes_in_frame(
                data, self._which.take(shapes), origins.take(of, 0), rotations.take(of, 0)
            )
            cast_on_shapes(directions, found, first.reach, start, best, hits, of * count)
        for fan in fans:
            # who keeps one scan does not keep those of all
            fan.distances, fan.hits = fan.distances.copy(), fan.hits.copy()
            fan._end()

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
