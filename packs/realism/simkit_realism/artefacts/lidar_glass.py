"""Glass and mirrors in front of a lidar."""

from __future__ import annotations

import math

from simkit import Params
from simkit.extend import Artefact, LidarMeasurement, LidarReading, Sensor
from simkit.sensors.rays.ray_fan import RayFan
from simkit.sensors.rays.ray_probes import Spread
from simkit_realism.lidar_returns import reading_of
from simkit_realism.optical_rays import OpticalRays, Returns


class LidarGlass(Artefact):
    """`<simkit:glass_and_mirrors>` of a lidar: rays pass through glass, and mirrors show ghosts.

    A ray that meets a surface with a `<simkit:transmittance>` T or a `<simkit:specularity>` S returns from it alone
    within the normal angle, where the reflex hits the receiver. Outside of it, the strongest of these returns counts:
    the light that the surface itself scatters, the surface behind the glass with T² of its light, or what the mirror
    shows, at the length of the whole way, with S². A return of less than the least share is lost. Glass is passed any
    number of times, with the factor of the first pane; a mirror reflects once.

    Zhao et al. 2020, "Mapping with Reflection" (arXiv:1909.12483), show panes, surfaces behind them and ghosts in real
    scans. The default values are estimates.

    Args:
        params: the element, with `normal_angle` [rad] and `least_share` of the light.
        sensor: the lidar.
    """

    elements = ("lidar/glass_and_mirrors",)
    order = -30.0
    sensor: LidarMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._cosine = math.cos(params.number("normal_angle", 0.09, minimum=0.0, maximum=math.pi / 2))
        self._least_share = params.number("least_share", 0.05, minimum=0.0, maximum=1.0)

    def rays_of(self, fan: RayFan, spread: Spread = lambda directions: directions) -> OpticalRays:
        """Return the rays of a fan with glass and mirrors; `spread` makes its directions from those of the lidar."""
        return OpticalRays(self.sensor.probes, fan, spread, self._cosine, self._least_share)

    def prepare(self) -> None:
        if any("lidar/beam" in artefact.elements for artefact in self.sensor.artefacts):
            return  # the beam traces all its rays through glass and mirrors
        self.sensor.probes.wants_surfaces = True
        self.sensor.probes.add("glass", self.rays_of(self.sensor.fan).trace)

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        returns: Returns | None = (reading.probed or {}).get("glass")
        return reading if returns is None else reading_of(reading, returns, self.sensor)
