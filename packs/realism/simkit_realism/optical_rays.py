"""Rays of a lidar that pass through glass and are reflected by mirrors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np

from simkit.extend import Vector
from simkit.sensors.rays.geom_types import Ids
from simkit.sensors.rays.hit_normals import dots
from simkit.sensors.rays.ray_fan import RayFan
from simkit.sensors.rays.ray_probes import RayCast, RayProbes, Spread
from simkit.sensors.surface_optics import SurfaceOptics

_GROUPS = np.array((1, 0, 0, 0, 0, 0), dtype=np.uint8)
_LIFT = 1e-6  # [m], so that a reflected ray does not hit the mirror again


@dataclass(slots=True)
class Returns:
    """Returns of rays, one for each; arrays of shape (n,), normals of shape (n, 3).

    Attributes:
        ranges: lengths of the ways of the light [m]; infinite for no return.
        geoms: geoms of the compiled model that return the light; -1 for none.
        normals: unit normals in the world.
        cosines: cosines of the angles of incidence.
        reflectivities: shares of the light that return, without the factor of the incidence: glass and mirrors count.
    """

    ranges: Vector
    geoms: Ids
    normals: Vector
    cosines: Vector
    reflectivities: Vector

    @property
    def strengths(self) -> Vector:
        """Strength of each return: ρ·cos(θ)/r² [1/m²]."""
        ranges = np.maximum(self.ranges, 1e-6)
        strengths: Vector = self.reflectivities * self.cosines / (ranges * ranges)
        return strengths

    def take(self, rays: Ids) -> Returns:
        """Return those of some rays."""
        return Returns(*(getattr(self, name).take(rays, 0) for name in self.__slots__))

    def put(self, rays: Ids, others: Returns) -> None:
        """Replace those of some rays."""
        for name in self.__slots__:
            getattr(self, name)[rays] = getattr(others, name)


Follow = Callable[[Returns, RayCast], None]


def trace(probes: RayProbes, fan: RayFan, cast: RayCast) -> Returns:
    """Return what the rays of a fan meet first, without glass and mirrors."""
    surfaces = probes.surfaces(fan, cast)
    geoms = np.where(np.isfinite(fan.distances), fan.geoms, -1)
    return Returns(fan.distances.copy(), geoms, *surfaces)


class OpticalRays:
    """Rays of one fan with what lies behind glass and in mirrors.

    Args:
        probes: probes of the lidar.
        fan: fan whose rays meet the glass and mirrors.
        spread: function that returns the directions of this fan for those of the lidar.
        normal_cosine: cosine of the angle of incidence below which glass and mirrors themselves return light.
        least_share: smallest share of the light that returns.
    """

    def __init__(
        self, probes: RayProbes, fan: RayFan, spread: Spread, normal_cosine: float, least_share: float
    ) -> None:
        self._probes, self._fan = probes, fan
        self._normal_cosine, self._least_share = normal_cosine, least_share
        self._behind = probes.add_fan(spread, _is_transparent)

    def trace(self, cast: RayCast) -> Returns:
        """Return the strongest return of each ray of the fan, which is cast already."""
        optics, found = self._probes.optics, trace(self._probes, self._fan, cast)
        transmitted, reflected = optics.transmittance.take(found.geoms), optics.specularity.take(found.geoms)
        is_normal = found.cosines >= self._normal_cosine
        is_glass, is_mirror = (transmitted > 0.0) & ~is_normal, (reflected > 0.0) & ~is_normal
        if not (is_glass.any() or is_mirror.any()):
            return found
        candidates = []
        rays = np.flatnonzero(is_glass)
        if rays.size:
            behind = trace(self._probes, self._behind, cast.cast(self._behind)).take(rays)
            behind.reflectivities = behind.reflectivities * transmitted[rays] * transmitted[rays]
            candidates.append((rays, behind))
        rays = np.flatnonzero(is_mirror)
        if rays.size:
            ghosts = self._reflect(found.take(rays), rays, cast)
            ghosts.reflectivities = ghosts.reflectivities * reflected[rays] * reflected[rays]
            candidates.append((rays, ghosts))
        strengths = found.strengths
        for rays, others in candidates:
            is_stronger = others.strengths > strengths[rays]
            found.put(rays[is_stronger], others.take(np.flatnonzero(is_stronger)))
            strengths[rays] = np.maximum(strengths[rays], others.strengths)
        is_weak = (is_glass | is_mirror) & (found.reflectivities * found.cosines < self._least_share)
        found.ranges[is_weak], found.geoms[is_weak] = np.inf, -1
        return found

    def _reflect(self, mirrors: Returns, rays: Ids, cast: RayCast) -> Returns:
        """Return what some rays meet after a mirror, at the whole length of the way; the sensor's own robot too."""
        origins = cast.origins if cast.origins.ndim == 1 else cast.origins.take(rays, 0)
        directions = cast.directions.take(rays, 0)
        turned = directions - (2.0 * dots(directions, mirrors.normals))[:, None] * mirrors.normals
        starts = origins + directions * mirrors.ranges[:, None] + _LIFT * mirrors.normals
        seen, count = self._fan.targets.whole.model, len(rays)
        ghosts = Returns(
            np.full(count, np.inf), np.full(count, -1), np.zeros((count, 3)), np.zeros(count), np.zeros(count)
        )
        geom, normal = np.empty(1, np.int32), np.empty(3)
        for i in range(count):
            distance = mujoco.mj_ray(seen, cast.data, starts[i], turned[i], _GROUPS, 1, -1, geom, normal)
            if distance >= 0.0 and mirrors.ranges[i] + distance <= self._fan.reach:
                ghosts.ranges[i], ghosts.geoms[i], ghosts.normals[i] = mirrors.ranges[i] + distance, geom[0], normal
        ghosts.cosines = np.abs(dots(ghosts.normals, turned))
        ghosts.reflectivities = self._probes.optics.reflectivity.take(ghosts.geoms)
        return ghosts


def _is_transparent(optics: SurfaceOptics) -> np.ndarray:
    return optics.transmittance > 0.0
