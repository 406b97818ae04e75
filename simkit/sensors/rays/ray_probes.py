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
from simkit.sensors.rays.hit_normals import BodyFrames, dots, hit_normals
from simkit.sensors.rays.ray_fan import RayFan
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
        model, data: compiled model and its data with up-to-date poses.
        origins: origins of the rays in the world [m], shape (3,), or (n, 3) if each ray has its own.
        directions: unit vectors of the rays in the world, shape (n, 3).
        frames: poses of the bodies at the times of the rays.
        cast: function that casts the rays of another fan that `RayProbes.add_fan` has returned.
    """

    model: mujoco.MjModel
    data: mujoco.MjData
    origins: Vector
    directions: Vector
    frames: BodyFrames
    cast: Callable[[RayFan], RayCast]


Probe = Callable[[RayCast], object]


class RayProbes:
    """Measurements beside the ranges of a lidar; each is made for every sample.

    Args:
        fan: fan of the lidar.
        sees_visuals: True if the rays detect visuals, False if they detect collisions.
        start: distance from the origin at which the rays start [m].
    """

    def __init__(self, fan: RayFan, sees_visuals: bool, start: float) -> None:
        self.fan, self._sees_visuals, self._start = fan, sees_visuals, start
        self.wants_surfaces = False
        self._fans: list[tuple[RayFan, Callable[[SurfaceOptics], npt.NDArray[np.bool_]] | None]] = []
        self._probes: dict[str, Probe] = {}
        self._own: HitSurfaces | None = None  # surfaces of the lidar's own rays, while its probes measure

    def add(self, name: str, probe: Probe) -> None:
        """Add a measurement; its result is in `probed` of each reading, under the name."""
        self._probes[name] = probe

    def add_fan(
        self, directions: Vector, hides: Callable[[SurfaceOptics], npt.NDArray[np.bool_]] | None = None
    ) -> RayFan:
        """Return a fan of further rays from the same origin.

        Args:
            directions: unit vectors in the sensor's frame, shape (m, 3); m is a multiple of the number of rays.
            hides: function that returns which geoms the rays pass through, shape (ngeom + 1,).
        """
        groups = np.flatnonzero(self.fan.groups).tolist()
        fan = RayFan(directions, groups, self.fan.reach)
        self._fans.append((fan, hides))
        return fan

    def bind(self, compiled: Compiled, bind_fan: Callable[[RayFan, Sequence[int]], None]) -> None:
        """Set the compiled model.

        Args:
            compiled: compiled model.
            bind_fan: function that binds a further fan, with the geoms that it passes through.
        """
        self.optics = surface_optics(compiled, of_visuals=self._sees_visuals)
        for fan, hides in self._fans:
            hidden = np.empty(0, dtype=np.intp) if hides is None else np.flatnonzero(hides(self.optics)[:-1])
            bind_fan(fan, hidden.tolist())

    def surfaces(self, fan: RayFan, cast: RayCast) -> HitSurfaces:
        """Return the surfaces that the rays of a fan hit."""
        if self._own is not None and fan is self.fan:
            return self._own
        normals = hit_normals(fan, cast.frames, cast.origins, cast.directions, self._start)
        return HitSurfaces(normals, -dots(normals, cast.directions), self.optics.reflectivity.take(fan.geoms))

    def measure(self, cast: RayCast) -> tuple[HitSurfaces | None, dict[str, Any]]:
        """Return the surfaces that the lidar's rays hit, if an artefact wants them, and the results of all probes."""
        self._own = surfaces = self.surfaces(self.fan, cast) if self.wants_surfaces else None
        probed = {name: probe(cast) for name, probe in self._probes.items()}
        self._own = None
        return surfaces, probed
