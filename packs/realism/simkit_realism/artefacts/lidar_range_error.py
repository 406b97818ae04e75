"""Errors of the ranges of a lidar that depend on the range."""

from __future__ import annotations

import numpy as np

from simkit import Params
from simkit.extend import Artefact, LidarMeasurement, LidarReading, Sensor, Vector, quantise
from simkit_realism.laws import Law, read_law
from simkit_realism.lidar_returns import change_ranges, change_returns


class LidarRangeError(Artefact):
    """`<simkit:range_error>` of a lidar: bias, scale error, noise that grows with the range, and quantisation.

    r' = r·(1 + scale) + bias(r) + stddev(r)·n, with a standard normal number n for each ray; then r' is rounded. A
    triangulation lidar measures a position on its image sensor, which is proportional to 1/r; rounding 1/r' to
    multiples of q gives steps of about q·r².

    Args:
        params: the element, with `bias` [m] and `stddev` [m] as laws of the range [m]; `scale`, the relative error;
            `resolution` [m], the step of the ranges; and `inverse_resolution` [1/m], the step q of 1/r.
        sensor: the lidar.
    """

    elements = ("lidar/range_error",)
    order = 10.0
    sensor: LidarMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._bias = read_law(params, "bias", minimum=-1000.0) or Law()
        self._scale = params.number("scale", 0.0, minimum=-0.9, maximum=10.0)
        self._stddev = read_law(params, "stddev") or Law()
        self._step = np.array(params.number("resolution", 0.0, minimum=0.0))
        self._inverse_step = np.array(params.number("inverse_resolution", 0.0, minimum=0.0))

    def prepare(self) -> None:
        self._streams = [self.stream(name, self.sensor.fan.count) for name in ("rays", "second rays")]

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        return change_returns(reading, lambda part, number: change_ranges(part, self._with_error(part, number, index)))

    def _with_error(self, reading: LidarReading, number: int, index: int) -> Vector:
        ranges = np.where(reading.infinite, 1.0, reading.ranges)
        changed: Vector = ranges * (1.0 + self._scale)
        if not self._bias.is_zero:
            changed = changed + self._bias(ranges)
        if not self._stddev.is_zero:
            changed = changed + self._stddev(ranges) * self._streams[number].normal(index)
        if self._inverse_step > 0.0:
            inverse = quantise(1.0 / np.maximum(changed, 1e-9), self._inverse_step)
            changed = 1.0 / np.maximum(inverse, self._inverse_step)
        if self._step > 0.0:
            changed = quantise(changed, self._step)
        options = self.sensor.options
        return np.clip(changed, options.range_min, options.range_max)
