"""Blind zone of a lidar: surfaces that are too near, and sectors that the robot's own housing blocks."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from simkit import Params
from simkit.extend import Artefact, LidarMeasurement, LidarReading, Sensor
from simkit_realism.lidar_returns import Mask, change_returns, lose_returns

_TURN = 2.0 * math.pi


@dataclass(frozen=True, slots=True)
class Sector:
    """Sector of azimuths.

    Attributes:
        low, high: first and last azimuth in the sensor's frame [rad].
        range: range that its rays read [m]; infinite if they have no return.
    """

    low: float
    high: float
    range: float

    def contains(self, azimuths: np.ndarray) -> Mask:
        """Check which azimuths [rad] are in the sector; whole turns do not count."""
        inside: Mask = np.mod(azimuths - self.low, _TURN) <= self.high - self.low + 1e-9
        return inside


class LidarBlindZone(Artefact):
    """`<simkit:blind_zone>` of a lidar: lost or false ranges of near surfaces, and blocked sectors.

    Args:
        params: the element, with `range` [m], below which a surface is too near; `probability` that its return is lost;
            `false_range` [m], which all other near returns read instead of their range; and any number of `sector`
            with `min_angle` and `max_angle` [rad] and the `range` [m] of a housing that all rays of the sector read;
            without it, they have no return.
        sensor: the lidar.
    """

    elements = ("lidar/blind_zone",)
    order = 40.0
    sensor: LidarMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._range = params.number("range", 0.0, minimum=0.0)
        self._probability = params.number("probability", 1.0, minimum=0.0, maximum=1.0)
        self._false_range = params.number("false_range", math.nan, minimum=0.0)
        self._sectors = [sector for block in params.all("sector") if (sector := _read_sector(block)) is not None]
        if not self._range and not self._sectors:
            hint = "write <range> in m, or a <sector> with <min_angle> and <max_angle>"
            params.warning("SK-SENSOR-211", "<blind_zone> has no effect: it has no <range> and no <sector>", hint)

    def prepare(self) -> None:
        options = self.sensor.options
        azimuths = np.tile(options.horizontal.angles, options.vertical.samples)
        self._blocked = [(sector, sector.contains(azimuths)) for sector in self._sectors]
        self._streams = [self.stream(name, self.sensor.fan.count) for name in ("rays", "second rays")]

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        if self._range > 0.0:
            reading = lose_returns(reading, lambda part, number: self._is_near_and_lost(part, number, index))
            if not math.isnan(self._false_range):
                reading = change_returns(reading, self._with_false_ranges)
        for sector, rays in self._blocked:
            reading = lose_returns(reading, _always(rays))
            if math.isfinite(sector.range):
                ranges = np.where(rays, sector.range, reading.ranges)
                reading = replace(reading, ranges=ranges, infinite=reading.infinite & ~rays)
        return reading

    def _is_near_and_lost(self, reading: LidarReading, number: int, index: int) -> Mask:
        is_near: Mask = reading.ranges < self._range
        if self._probability >= 1.0:
            return is_near
        return is_near & (self._streams[number].uniform(index) < 2.0 * self._probability - 1.0)

    def _with_false_ranges(self, reading: LidarReading, number: int) -> LidarReading:
        is_near = (reading.ranges < self._range) & ~reading.infinite
        return replace(reading, ranges=np.where(is_near, self._false_range, reading.ranges))


def _always(rays: Mask) -> Callable[[LidarReading, int], Mask]:
    return lambda _part, _number: rays


def _read_sector(block: Params) -> Sector | None:
    low, high = block.number("min_angle", required=True), block.number("max_angle", required=True)
    far = block.number("range", math.inf, minimum=0.0)
    if low <= high <= low + _TURN + 1e-6:
        return Sector(low, high, far)
    message = f"<sector> from {low:g} to {high:g} rad; expected a <max_angle> above <min_angle>, by at most a turn"
    block.error("SK-SENSOR-212", message, "across the rear, write for example 2.8 and 3.5")
    return None
