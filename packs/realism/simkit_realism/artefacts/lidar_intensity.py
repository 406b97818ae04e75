"""Intensities of a lidar, from the reflectivity of the surfaces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from simkit import Params
from simkit.extend import Artefact, LidarMeasurement, LidarReading, Sensor, quantise
from simkit_realism.lidar_returns import change_returns, surfaces_of


class LidarIntensity(Artefact):
    """`<simkit:intensity>` of a lidar: intensity = scale·ρ·cos(θ), or scale·ρ·cos(θ)·(r₀/r)² if the range counts.

    ρ is the reflectivity, θ the angle of incidence, r the range and r₀ the reference range. Devices with calibrated
    reflectivity compensate the range: a Velodyne reports 0 to 100 for surfaces that scatter 0 to 100 %, and 101 to 255
    for retro-reflectors (VLP-16 User Manual, "Calibrated Reflectivity"). Others report the power that they receive.

    Args:
        params: the element, with `scale`, the intensity of ρ = 1 at θ = 0; `reference_range` r₀ [m], without which the
            range is compensated; `maximum`; `resolution`, the step; and `stddev`, the noise as a share.
        sensor: the lidar.
    """

    elements = ("lidar/intensity",)
    order = 50.0
    sensor: LidarMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._scale = params.number("scale", 100.0, minimum=0.0)
        self._reference = params.number("reference_range", 0.0, minimum=0.0)
        self._maximum = params.number("maximum", 255.0, minimum=0.0)
        self._step = np.array(params.number("resolution", 0.0, minimum=0.0))
        self._stddev = params.number("stddev", 0.0, minimum=0.0)

    def prepare(self) -> None:
        self.sensor.probes.wants_surfaces = True
        self._streams = [self.stream(name, self.sensor.fan.count) for name in ("rays", "second rays")]

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        return change_returns(reading, lambda part, number: self._with_intensities(part, number, index))

    def _with_intensities(self, reading: LidarReading, number: int, index: int) -> LidarReading:
        surfaces = surfaces_of(reading)
        values = self._scale * (surfaces.reflectivities * surfaces.cosines)
        if self._reference > 0.0:
            ratio = self._reference / np.maximum(np.where(reading.infinite, np.inf, reading.ranges), 1e-6)
            values = values * (ratio * ratio)
        if self._stddev > 0.0:
            values = values * (1.0 + self._stddev * self._streams[number].normal(index))
        values = quantise(np.clip(values, 0.0, self._maximum), self._step)
        return replace(reading, intensities=np.where(reading.infinite, 0.0, values))
