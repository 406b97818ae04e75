"""Drop-out of a lidar: rays without a return."""

from __future__ import annotations

import numpy as np

from simkit import Params
from simkit.elementary_functions import arccos
from simkit.extend import Artefact, LidarMeasurement, LidarReading, Sensor, Vector
from simkit_realism.laws import read_law
from simkit_realism.lidar_returns import Mask, lose_returns, surfaces_of

_NAMES = ("second rays", "second runs")  # streams of second returns


class LidarDropout(Artefact):
    """`<simkit:dropout>` of a lidar: rays that have no return, which read +inf.

    The laws are independent reasons for a loss: a ray is kept with the product of the probabilities to be kept. With a
    burst length L, a ray begins a new run with the probability 1/L, and all rays of a run have the same random number.
    The share of lost rays stays the same.

    Args:
        params: the element, with `probability`, the share of rays without a return; `by_range`, `by_incidence` and
            `by_reflectivity`, laws of the probability by range [m], angle of incidence [rad] and reflectivity; and
            `burst_length`, the mean number of neighbouring rays that are lost or kept together.
        sensor: the lidar.
    """

    elements = ("lidar/dropout",)
    order = 30.0
    sensor: LidarMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.probability = params.number("probability", 0.0, minimum=0.0, maximum=1.0)
        self._by_range = read_law(params, "by_range", maximum=1.0)
        self._by_incidence = read_law(params, "by_incidence", maximum=1.0)
        self._by_reflectivity = read_law(params, "by_reflectivity", maximum=1.0)
        self._burst = params.number("burst_length", 1.0, minimum=1.0, maximum=1e6)
        laws = (self._by_range, self._by_incidence, self._by_reflectivity)
        if self.probability == 0.0 and all(law is None or law.is_zero for law in laws):
            params.warning("SK-SENSOR-211", "<dropout> loses no ray: all its probabilities are 0", _HINT)

    def prepare(self) -> None:
        count = self.sensor.fan.count
        names = ("rays", "runs"), _NAMES
        self._streams = [(self.stream(rays, count), self.stream(runs, count)) for rays, runs in names]
        if self._by_incidence is not None or self._by_reflectivity is not None:
            self.sensor.probes.wants_surfaces = True

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        def is_lost(part: LidarReading, number: int) -> Mask:
            lost: Mask = self._chances(number, index) < self._probabilities(part)
            return lost

        return lose_returns(reading, is_lost)

    def _probabilities(self, reading: LidarReading) -> Vector | float:
        """Return the probability that each return is lost."""
        kept: Vector | float = 1.0 - self.probability
        if self._by_range is not None:
            kept = kept * (1.0 - np.clip(self._by_range(reading.ranges), 0.0, 1.0))
        if self._by_incidence is not None:
            angles = arccos(np.clip(surfaces_of(reading).cosines, 0.0, 1.0))
            kept = kept * (1.0 - np.clip(self._by_incidence(angles), 0.0, 1.0))
        if self._by_reflectivity is not None:
            kept = kept * (1.0 - np.clip(self._by_reflectivity(surfaces_of(reading).reflectivities), 0.0, 1.0))
        return 1.0 - kept

    def _chances(self, number: int, index: int) -> Vector:
        """Return a random number from 0 to 1 for each return, the same for all rays of a run."""
        rays, runs = self._streams[number]
        chances: Vector = 0.5 + 0.5 * rays.uniform(index)
        if self._burst > 1.0:
            begins = (0.5 + 0.5 * runs.uniform(index)) < 1.0 / self._burst
            begins[:: self.sensor.options.horizontal.samples] = True  # each layer begins a run
            firsts = np.maximum.accumulate(np.where(begins, np.arange(len(begins)), 0))
            chances = chances.take(firsts)
        return chances


_HINT = "write <probability>, <by_range>, <by_incidence> or <by_reflectivity>"
