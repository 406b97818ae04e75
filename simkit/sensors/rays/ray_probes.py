"""Further measurements of a lidar's rays that artefacts request: properties of the surfaces, and further rays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler import Compiled
from simkit.pose import Vector
from simkit.sensors.rays.hit_normals import BodyFrames, InstantFrames, dots, hit_normals
from simkit.sensors.rays.numpy_rays import rotate_vectors
from simkit.sensors.rays.ray_fan import RayFan
from simkit.sensors.rays.sweep import RayPattern
from simkit.sensors.rays.sweep_poses import matrices_of, rotate
from simkit.sensors.rays.swept_rays import SweptCaster, SweptHits
from simkit.sensors.rays.swept_scan import SweptRays
from simkit.sensors.surface_optics import SurfaceOptics, surface_optics


class HitSurfaces(NamedTuple):
    """Surfaces that rays hit; 0 for a ray without a hit.

    Attributes:
        normals: unit normals in the world, on the side of the sensor, shape (n, 3).
        cosines: cosines of the angles of incidence between ray and normal, shape (n,).
        reflectivities: shares of the light that the surfaces scatter, shape (n,).
    """

    normals: Vector
    cosines: Vector
    reflectivities: Vector


@dataclass(slots=True)
class RayCast:
    """Rays of a lidar at the time of a sample.

    Attributes:
        data: data of the compiled model with up-to-date poses, at the last ray of a sweep.
        origins: origins of the rays in the world [m], shape (3,), or (n, 3) if each ray has its own.
        directions: unit vectors of the rays in the world, shape (n, 3).
        frames: poses of the bodies at the times of the rays.
        cast: function that casts the rays of another fan that `RayProbes.add_fan` has returned.
    """

    data: mujoco.MjData
    origins: Vector
    directions: Vector
    frames: BodyFrames
    cast: Callable[[RayFan], RayCast]


Probe = Callable[[RayCast], object]
Spread = Callable[[Vector], Vector]
Hides = Callable[[SurfaceOptics], npt.NDArray[np.bool_]]


class SweptFrames:
    """Poses of bodies at the times of the rays of a sweep; rays beyond the first turn of a fan repeat its times.

    Args:
        sweep: times of the rays, and poses.
    """

    def __init__(self, sweep: SweptRays) -> None:
        self._poses, self._times = sweep.poses, sweep.ray_times

    def frames(self, bodies: npt.NDArray[np.intp], rays: npt.NDArray[np.intp]) -> tuple[Vector, Vector]:
        poses = self._poses.at(bodies, self._times.take(rays % len(self._times)))
        rows = [np.stack(row, axis=1) for row in matrices_of(poses.quaternions)]
        return np.ascontiguousarray(poses.positions.T), np.stack(rows, axis=1)


@dataclass(slots=True)
class _FurtherFan:
    """Fan of further rays: its directions by those of the lidar, the geoms it passes through, and its caster."""

    fan: RayFan
    spread: Spread
    hides: Hides | None
    caster: SweptCaster | None = None
    pattern: tuple[RayPattern, RayPattern] | None = None

    def pattern_of(self, pattern: RayPattern) -> RayPattern:
        """Return the pattern of the further rays for that of the lidar."""
        if self.pattern is None or self.pattern[0] is not pattern:
            self.pattern = pattern, RayPattern(self.spread(pattern.directions), pattern.times)
        return self.pattern[1]


class RayProbes:
    """Measurements beside the ranges of a lidar; each is made for every sample.

    Args:
        fan: fan of the lidar.
        sees_visuals: True if the rays detect visuals, False if they detect collisions.
        start: distance from the origin at which the rays start [m].

    Attributes:
        optics: optical properties of the surfaces that the rays can hit.
        wants_surfaces: True if readings have the surfaces that were hit.
    """

    optics: SurfaceOptics

    def __init__(self, fan: RayFan, sees_visuals: bool, start: float) -> None:
        self.fan, self._sees_visuals, self._start = fan, sees_visuals, start
        self.wants_surfaces = False
        self._fans: list[_FurtherFan] = []
        self._probes: dict[str, Probe] = {}
        self._own: HitSurfaces | None = None  # surfaces of the lidar's own rays, while its probes measure

    def add(self, name: str, probe: Probe) -> None:
        """Add a measurement; its result is in `probed` of each reading, under the name."""
        self._probes[name] = probe

    def add_fan(self, spread: Spread, hides: Hides | None = None) -> RayFan:
        """Return a fan of further rays from the same origin.

        Args:
            spread: function of the lidar's directions, shape (n, 3), that returns the further ones, shape (k · n, 3):
                k rays for each ray, at its time; both are unit vectors in the sensor's frame.
            hides: function that returns which geoms the rays pass through, shape (ngeom + 1,).
        """
        groups = np.flatnonzero(self.fan.groups).tolist()
        fan = RayFan(spread(self.fan.directions), groups, self.fan.reach)
        self._fans.append(_FurtherFan(fan, spread, hides))
        return fan

    def bind(
        self,
        compiled: Compiled,
        bind_fan: Callable[[RayFan, Sequence[int]], None],
        offset: tuple[Vector, Vector] | None,
    ) -> None:
        """Set the compiled model.

        Args:
            compiled: compiled model.
            bind_fan: function that binds a further fan, with the geoms that it passes through.
            offset: position [m] and rotation matrix of the sensor in the frame of its body, for a lidar that sweeps.
        """
        self.optics = surface_optics(compiled, of_visuals=self._sees_visuals)
        for further in self._fans:
            hidden: list[int] = []
            if further.hides is not None:
                hidden = np.flatnonzero(further.hides(self.optics)[:-1]).tolist()
            bind_fan(further.fan, hidden)
            further.caster = None if offset is None else SweptCaster(further.fan, offset)

    def surfaces(self, fan: RayFan, cast: RayCast) -> HitSurfaces:
        """Return the surfaces that the rays of a fan hit."""
        if self._own is not None and fan is self.fan:
            return self._own
        normals = hit_normals(fan, cast.frames, cast.origins, cast.directions, self._start)
        return HitSurfaces(normals, -dots(normals, cast.directions), self.optics.reflectivity.take(fan.geoms))

    def measure(
        self, data: mujoco.MjData, origin: Vector, rotation: Vector, sweep: SweptRays | None
    ) -> tuple[HitSurfaces | None, dict[str, Any]]:
        """Return the surfaces that the lidar's rays hit, if an artefact wants them, and the results of all probes.

        Args:
            data: data with up-to-date poses.
            origin: position of the sensor in the world [m].
            rotation: rotation matrix of the sensor in the world.
            sweep: times and poses of the rays; None for a scan at one instant.
        """
        cast = self._instant_cast(data, origin, rotation, self.fan) if sweep is None else self._swept_cast(data, sweep)
        self._own = surfaces = self.surfaces(self.fan, cast) if self.wants_surfaces else None
        probed = {name: probe(cast) for name, probe in self._probes.items()}
        self._own = None
        return surfaces, probed

    def _instant_cast(self, data: mujoco.MjData, origin: Vector, rotation: Vector, fan: RayFan) -> RayCast:
        """Return the rays of a fan at one instant."""

        def cast(further: RayFan) -> RayCast:
            further.cast(further.targets.model, data, origin, rotation, self._start)
            return self._instant_cast(data, origin, rotation, further)

        return RayCast(data, origin, rotate_vectors(fan.directions, rotation.T), InstantFrames(data), cast)

    def _swept_cast(self, data: mujoco.MjData, sweep: SweptRays) -> RayCast:
        """Return the rays of the lidar at their own times."""
        frames, poses = SweptFrames(sweep), sweep.sensor_poses()
        directions = rotate(poses.quaternions, sweep.directions.T).T

        def cast(fan: RayFan) -> RayCast:
            further = next(further for further in self._fans if further.fan is fan)
            pattern, caster = further.pattern_of(sweep.pattern), further.caster
            assert caster is not None
            rays = caster.world_rays(pattern, sweep.poses, np.arange(len(pattern.times)))
            hits = SweptHits.of(fan.count)
            caster.cast(data, rays, self._start, hits)
            fan.use(hits.distances, hits.geoms)
            return RayCast(data, rays.all_origins(), rays.all_directions(), frames, cast)

        return RayCast(data, np.ascontiguousarray(poses.positions.T), np.ascontiguousarray(directions), frames, cast)
