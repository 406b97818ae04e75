"""Beam of a lidar with a divergence: mixed pixels at edges, and several returns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from simkit import Params
from simkit.extend import Artefact, LidarMeasurement, LidarReading, Sensor, Vector
from simkit.sensors.rays.ray_probes import RayCast
from simkit_realism.artefacts.lidar_glass import LidarGlass
from simkit_realism.beam_echoes import EchoList, beam_directions
from simkit_realism.lidar_returns import reading_of
from simkit_realism.optical_rays import OpticalRays, Returns, trace

_RETURNS = ("strongest", "first", "last", "dual")


class LidarBeam(Artefact):
    """`<simkit:beam>` of a lidar: each ray is a cone, whose parts may hit different surfaces.

    Surfaces that are nearer together than `resolution` give one echo, at the mean of their ranges weighted by the
    strengths ρ·cos(θ)/r² (a mixed pixel), or at the nearest one. Others give an echo each. `returns` selects which echo
    is the reading. `dual` has the strongest one and a second return: the last one, or the second strongest if the
    strongest is the last (VLP-16 User Manual, "Dual Return Mode").

    Args:
        params: the element, with the full angle `divergence` [rad] of the cone, the number of `rings` of parts around
            the axis, `resolution` [m], `mixing` (`mean` or `nearest`) and `returns`.
        sensor: the lidar.
    """

    elements = ("lidar/beam",)
    order = -20.0
    sensor: LidarMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._divergence = params.number("divergence", required=True, minimum=0.0, maximum=0.5)
        self._rings = params.integer("rings", 1, minimum=1, maximum=4)
        self._resolution = params.number("resolution", 0.5, minimum=0.0)
        self._is_nearest = params.choice("mixing", ("mean", "nearest"), "mean") == "nearest"
        self._mode = params.choice("returns", _RETURNS, "strongest")
        if self._mode == "dual":
            self.sensor.has_second_returns = True

    def prepare(self) -> None:
        sensor, probes = self.sensor, self.sensor.probes
        if self._mode == "dual":
            sensor.add_second_returns()
        self._fan = probes.add_fan(self._spread)
        glass = next((artefact for artefact in sensor.artefacts if isinstance(artefact, LidarGlass)), None)
        self._optics: tuple[OpticalRays, ...] = ()
        if glass is not None:
            self._optics = glass.rays_of(sensor.fan), glass.rays_of(self._fan, self._spread)
        probes.wants_surfaces = True
        probes.add("beam", self._echoes)

    def _spread(self, axes: Vector) -> Vector:
        return beam_directions(axes, self._divergence, self._rings)

    def _echoes(self, cast: RayCast) -> tuple[Returns, Returns | None]:
        """Return the selected echo of each ray, and its second return."""
        sensor, around = self.sensor, cast.cast(self._fan)
        if self._optics:
            axis, rest = self._optics[0].trace(cast), self._optics[1].trace(around)
        else:
            axis, rest = trace(sensor.probes, sensor.fan, cast), trace(sensor.probes, self._fan, around)
        columns = (np.concatenate((getattr(axis, name), getattr(rest, name))) for name in Returns.__slots__)
        echoes = EchoList(Returns(*columns), sensor.fan.count, self._resolution, self._is_nearest)
        if self._mode != "dual":
            return echoes.returns(getattr(echoes, self._mode)), None
        first, last = echoes.returns(echoes.strongest), echoes.returns(echoes.last)
        second, is_last = echoes.returns(echoes.second), echoes.strongest.part == echoes.last.part
        last.put(np.flatnonzero(is_last), second.take(np.flatnonzero(is_last)))
        return first, last

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        first, second = (reading.probed or {})["beam"]
        changed = reading_of(reading, first, self.sensor)
        if second is None:
            return changed
        other = replace(reading_of(reading, second, self.sensor), scatter=None, second=None, probed=None)
        return replace(changed, second=other)
