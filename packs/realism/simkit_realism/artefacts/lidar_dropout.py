"""Drop-out of a lidar: rays without a return."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from simkit import Params
from simkit.sensors.artefacts import Artefact
from simkit.sensors.base import Sensor
from simkit.sensors.rays.lidar_measurement import LidarMeasurement, LidarReading


class LidarDropout(Artefact):
    """`<simkit:dropout>` of a lidar: rays that have no return, which read +inf.

    Args:
        params: the element, with `probability`, the share of rays without a return.
        sensor: the lidar.
    """

    elements = ("lidar/dropout",)
    sensor: LidarMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.probability = params.number("probability", 0.0, minimum=0.0, maximum=1.0)

    def prepare(self) -> None:
        self._stream = self.stream("rays", self.sensor.fan.count)

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        # the numbers are uniform from -1 to 1
        is_lost = self._stream.uniform(index) < 2.0 * self.probability - 1.0
        return replace(
            reading,
            ranges=np.where(is_lost, np.inf, reading.ranges),
            intensities=np.where(is_lost, 0.0, reading.intensities),
            infinite=reading.infinite | is_lost,
        )
