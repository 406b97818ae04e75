"""Light that a point of the world receives from one lamp: direction, received fraction, and shadow caster."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler import Compiled
from simkit.compiler.geom_groups import DRAWN_COLLISION, SEEN_AS_COLLISIONS, VISUAL
from simkit.compiler.lights import spot_share
from simkit.compiler.name_map import NameMap
from simkit.linear_algebra import matmul
from simkit.pose import Pose, Vector
from simkit.runtime.handles.light import Light, LightState
from simkit.scene import SceneLight
from simkit.sensors.values_with_expiry import temporary_values

LEAST_OPACITY: Final = 0.5
"""Lowest opacity of a visual that casts a shadow."""

_MIN_DISTANCE: Final = 1e-3  # [m]; a smaller distance to a lamp counts as this one
_OPEN_GROUP: Final = 0
"""Geom group that simkit leaves empty; geoms that a ray can hit are in this group while the ray is cast."""


@dataclass(frozen=True, slots=True)
class Beam:
    """Light at a point.

    Attributes:
        direction: unit vector from the point to the light, world frame, shape (3,).
        distance: distance to the light [m]; infinite for parallel rays.
        fraction: fraction of the light that reaches the point, from 0 to 1. It is 0 if the light is off or the point is
            outside the light's cone.
    """

    direction: Vector
    distance: float
    fraction: float


class Lamp:
    """Light as a point of the world receives it.

    Args:
        light: handle of the light.
        by_position: True treats a directional light as a point at its pose, as the plugin `libsolar_sensor.so` does.
            False uses parallel rays against the light's direction.
    """

    def __init__(self, light: Light, by_position: bool = False) -> None:
        self.light = light
        self.is_parallel = light.scene.type == "directional" and not by_position

    @property
    def scene(self) -> SceneLight:
        """Current properties of the light."""
        return self.light.scene

    def bind(self, names: NameMap) -> None:
        """Find the link that carries the light in a compiled model's name map."""
        carrier = names.link(self.scene.link) if self.scene.link else None
        self._body = int(carrier.body) if carrier else 0
        self._offset: Pose | None = carrier.offset if carrier else None

    def pose(self, state: LightState, data: mujoco.MjData) -> Pose:
        """Return the light's pose in the world, from a state of the light and the physics data."""
        if self._offset is None:
            return state.pose
        return Pose(data.xpos[self._body], data.xquat[self._body]) @ self._offset @ state.pose

    def at(self, state: LightState, data: mujoco.MjData, point: Vector) -> Beam:
        """Return the light at a world point [m], shape (3,), from a state of the light and the physics data."""
        pose = self.pose(state, data)
        fraction = 1.0 if state.on else 0.0
        if self.is_parallel:
            return Beam(-pose.rotate(self.scene.direction), math.inf, fraction)
        towards = pose.position - point
        distance = math.sqrt(matmul(towards, towards))
        if distance <= 0.0:
            return Beam(np.zeros(3), 0.0, 0.0)
        direction = towards / distance
        if self.scene.type == "spot":
            cosine = float(matmul(-direction, pose.rotate(self.scene.direction)))
            fraction *= spot_share(self.scene, math.acos(max(-1.0, min(1.0, cosine))))
        return Beam(direction, distance, fraction)


def falloff_factor(scene: SceneLight, distance: float, rule: str) -> float:
    """Return the factor by which a lamp fades over a distance.

    Args:
        scene: light of the scene.
        distance: distance to the light [m].
        rule: `none` (1), `inverse_square` (1 at 1 m), or `attenuation`, the rule of the file: 0 beyond the light's
            range, else 1 / (constant + linear·r + quadratic·r²), at most 1.
    """
    if rule == "inverse_square":
        return 1.0 / max(distance, _MIN_DISTANCE) ** 2
    if rule == "attenuation":
        reach, constant, linear, quadratic = scene.attenuation
        divisor = constant + distance * (linear + distance * quadratic)
        return 0.0 if distance > reach else 1.0 / max(1.0, divisor)
    return 1.0


class ShadowRay:
    """Search for shadow casters between a link and a light.

    The visuals of a link cast shadows, or its collisions if it has no visuals. A visual casts none if its
    `<cast_shadows>` is false or if its opacity is below one half. The links of the sensor and the lamp are ignored.
    """

    def __init__(self) -> None:
        self._groups = np.zeros(6, dtype=np.uint8)
        self._groups[_OPEN_GROUP] = 1
        self._geom = np.empty(1, dtype=np.int32)

    def bind(self, compiled: Compiled, link: str, lamp: str = "") -> None:
        """Find the geoms of a compiled model that can cast a shadow on a link.

        Args:
            compiled: compiled model.
            link: scoped name of the link.
            lamp: scoped name of the light's link; empty if it has none.
        """
        names = self._names = compiled.names
        casters = names.shared("shadow casters", lambda: _shadow_casters(compiled.model, names))
        housings = [names.link(name) for name in (link, lamp) if name]
        housing_geoms = {geom for housing in housings for geom in (*housing.visuals, *housing.ray_geoms)}
        self._casters = np.array([g for g in casters if g not in housing_geoms], dtype=np.intp)

    def find(self, model: mujoco.MjModel, data: mujoco.MjData, origin: Vector, beam: Beam) -> str:
        """Return the scoped name of the first visual or collision between `origin` and the light, or "".

        The ray ends at the lamp; a parallel ray passes through the whole scene.
        """
        if not len(self._casters):
            return ""
        with temporary_values(model.geom_group, self._casters, _OPEN_GROUP):
            hit = mujoco.mj_ray(model, data, origin, beam.direction, self._groups, 1, -1, self._geom, None)
        if not 0.0 <= hit < beam.distance:
            return ""
        return str(self._names.geom_owner(int(self._geom[0]))[1])


def _shadow_casters(model: mujoco.MjModel, names: NameMap) -> list[int]:
    """Return the ids of the geoms that cast shadows."""
    opaque: npt.NDArray[np.bool_] = model.geom_rgba[:, 3] >= LEAST_OPACITY
    drawn = opaque & np.asarray(model.geom_castshadow, dtype=bool)
    casters: set[int] = set()
    for link in names.links.values():
        if link.visuals:
            casters.update(g for g in link.visuals if drawn[g] and model.geom_group[g] in (VISUAL, DRAWN_COLLISION))
        else:
            casters.update(g for g in link.ray_geoms if model.geom_group[g] in SEEN_AS_COLLISIONS)
    return sorted(casters)
