"""Strength of the returns of a lidar: returns below a threshold are lost."""

from __future__ import annotations

import numpy as np

from simkit import Params
from simkit.elementary_functions import power
from simkit.extend import Artefact, LidarMeasurement, LidarReading, Sensor
from simkit_realism.lidar_returns import Mask, lose_returns, surfaces_of


class LidarSignal(Artefact):
    """`<simkit:signal>` of a lidar: returns that are too weak to be detected are lost.

    The strength of a return is ρ·cos(θ)/r², for a surface with Lambert's law that is larger than the beam: ρ is the
    reflectivity, θ the angle of incidence and r the range. The threshold is the strength at the range and reflectivity
    of the data sheet, at θ = 0 (lidar equation, Wagner et al. 2006, doi:10.1016/j.isprsjprs.2005.12.001).

    Args:
        params: the element, with `range` [m] and `reflectivity` of the farthest return, as in "12 m at 10 %";
            `exponent` of the range; and `spread`, the standard deviation of the strength as a share of it.
        sensor: the lidar.
    """

    elements = ("lidar/signal",)
    order = 20.0
    sensor: LidarMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.range = params.number("range", required=True, minimum=0.0)
        self.reflectivity = params.number("reflectivity", 0.1, minimum=0.0, maximum=1000.0)
        self._exponent = params.number("exponent", 2.0, minimum=0.0, maximum=10.0)
        self._spread = params.number("spread", 0.0, minimum=0.0, maximum=1.0)

    def prepare(self) -> None:
        self.sensor.probes.wants_surfaces = True
        self._streams = [self.stream(name, self.sensor.fan.count) for name in ("rays", "second rays")]

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        def is_lost(part: LidarReading, number: int) -> Mask:
            surfaces, ranges = surfaces_of(part), np.where(part.infinite, 0.0, part.ranges)
            strengths = surfaces.reflectivities * surfaces.cosines
            if self._spread > 0.0:
                strengths = strengths * (1.0 + self._spread * self._streams[number].normal(index))
            # both sides times the powers of the ranges, so that a range of 0 divides nothing
            if self._exponent == 2.0:
                lost: Mask = strengths * (self.range * self.range) < self.reflectivity * (ranges * ranges)
            else:
                limit = power(self.range, self._exponent)
                lost = strengths * limit < self.reflectivity * power(ranges, self._exponent)
            return lost

        return lose_returns(reading, is_lost)
