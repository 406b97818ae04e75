"""Many lidars of one make at once, to the same bits as one by one."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.sensors.crews import LEAST, Crew, form
from simkit.sensors.rays.together import Fans, can_join

if TYPE_CHECKING:
    from simkit.sensors.lidar import Lidar, LidarReading


def form_crews(lidars: Sequence[Lidar]) -> None:
    """Has lidars that are alike work together."""
    form(lidars, LidarCrew, _alike)


def _alike(lidar: Lidar) -> Hashable | None:
    common = can_join(lidar._fan)
    return None if common is None else (*common, lidar._start, lidar.sees_visuals)


class LidarCrew(Crew["Lidar"]):
    """Lidars that differ in place alone; those that somebody reads cast together."""

    def __init__(self, members: Sequence[Lidar]) -> None:
        super().__init__(members)
        self._fans, self._start = Fans([lidar._fan for lidar in members]), members[0]._start
        self._readings: dict[int, LidarReading] = {}

    def look(self, data: Any) -> None:
        read = [place for place, lidar in enumerate(self.members) if lidar.is_read_now]
        self._readings.clear()
        if len(read) < LEAST:
            for place in read:
                self._readings[place] = self.members[place].measure(self.model, data)
            return
        places = [self.members[place]._place(data) for place in read]
        origins, rotations = (np.array(part) for part in zip(*places, strict=True))
        self._fans.cast(read, data, origins, rotations, self._start)
        for place in read:
            self._readings[place] = self.members[place].reading_of_cast()

    def raw_of(self, place: int) -> LidarReading:
        reading = self._readings.pop(place, None)
        # somebody has begun to read within this step
        return self.members[place].measure_now() if reading is None else reading
