"""Number that a lidar writes for a ray without a return."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from simkit import Params
from simkit.extend import Artefact, LidarMeasurement, LidarReading, Sensor


class LidarNoReturn(Artefact):
    """`<simkit:no_return>` of a lidar: what rays without a return read in scans; clouds leave such rays out.

    Drivers differ: `rplidar_ros` writes +inf, the driver of TurtleBot3's LDS-01 writes 0.

    Args:
        params: the element, with `value`: `inf`, `nan`, `zero` or `maximum` (the maximum range).
        sensor: the lidar.
    """

    elements = ("lidar/no_return",)
    order = 90.0
    sensor: LidarMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        name = params.choice("value", ("inf", "nan", "zero", "maximum"), required=True)
        self._value = {"inf": np.inf, "nan": np.nan, "zero": 0.0}.get(name, self.sensor.options.range_max)

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        is_missing = reading.infinite & (reading.ranges == np.inf)
        return replace(reading, ranges=np.where(is_missing, self._value, reading.ranges))
