"""Light that a point of the world receives from one lamp: direction, share, and what casts a shadow on it."""

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
from simkit.pose import Pose, Vector
from simkit.runtime.handles.light import Light, LightState
from simkit.scene import SceneLight
from simkit.sensors.temporary_values import temporary_values

LEAST_OPACITY: Final = 0.5
"""What is less opaque than this throws no shadow."""

_MIN_DISTANCE: Final = 1e-3  # [m]; nobody is nearer to a lamp
_OPEN_GROUP: Final = 0
"""Nothing of ours is in this group, so for a moment it can hold exactly what a ray is to see."""


@dataclass(frozen=True, slots=True)
class Beam:
    """Light at a point.

    Attributes:
        direction: unit vector from the point to the light, world frame, shape (3,).
        distance: to the light [m]; infinite where its rays are parallel.
        share: of the light that goes there, from 0 to 1: 0 where it is off, or the point lies outside its cone.
    """

    direction: Vector
    distance: float
    share: float


class Lamp:
    """A light as the points of the world see it.

    Args:
        light: its handle.
        by_position: a directional light too is where its pose is, as for the course's sensor; else its rays are
            parallel and come from where it does not shine to.
    """

    def __init__(self, light: Light, by_position: bool = False) -> None:
        self.light = light
        self.is_parallel = light.scene.type == "directional" and not by_position

    @property
    def scene(self) -> SceneLight:
        """What the light is like now."""
        return self.light.scene

    def bind(self, names: NameMap) -> None:
        """Finds what carries it in a compiled model's name map."""
        carrier = names.link(self.scene.link) if self.scene.link else None
        self._body = int(carrier.body) if carrier else 0
        self._offset: Pose | None = carrier.offset if carrier else None

    def pose(self, state: LightState, data: mujoco.MjData) -> Pose:
        """In the world, of a state of the light and one of the physics."""
        if self._offset is None:
            return state.pose
        return Pose(data.xpos[self._body], data.xquat[self._body]) @ self._offset @ state.pose

    def at(self, state: LightState, data: mujoco.MjData, point: Vector) -> Beam:
        """The light at a point of the world [m], shape (3,), of a state of the light and one of the physics."""
        pose = self.pose(state, data)
        share = 1.0 if state.on else 0.0
        if self.is_parallel:
            return Beam(-pose.rotate(self.scene.direction), math.inf, share)
        towards = pose.position - point
        distance = math.sqrt(towards @ towards)
        if distance <= 0.0:
            return Beam(np.zeros(3), 0.0, 0.0)
        direction = towards / distance
        if self.scene.type == "spot":
            cosine = float(-direction @ pose.rotate(self.scene.direction))
            share *= spot_share(self.scene, math.acos(max(-1.0, min(1.0, cosine))))
        return Beam(direction, distance, share)


def falloff_share(scene: SceneLight, distance: float, rule: str) -> float:
    """The factor by which a lamp fades over a distance [m].

    Args:
        rule: `none` (1), `inverse_square` (1 at 1 m), or `attenuation`, the light's own in the file: 0 beyond its
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
    """Finds what stands between a link and a light: what is drawn and throws shadows.

    Of a link without visuals the collisions count. A visual with `<cast_shadows>` false throws none, nor does one that
    lets more than half of the light through. The link itself is the housing and is passed over, as is the lamp's.
    """

    def __init__(self) -> None:
        self._groups = np.zeros(6, dtype=np.uint8)
        self._groups[_OPEN_GROUP] = 1
        self._geom = np.empty(1, dtype=np.int32)

    def bind(self, compiled: Compiled, link: str, lamp: str = "") -> None:
        """Finds what throws shadows on a link in a compiled model; `lamp` is the link of the light, if any (scoped)."""
        names = self._names = compiled.names
        casters = names.shared("what throws shadows", lambda: _shadow_casters(compiled.model, names))
        ends = [names.link(name) for name in (link, lamp) if name]
        own = {geom for end in ends for geom in (*end.visuals, *end.ray_geoms)}
        self._casters = np.array([g for g in casters if g not in own], dtype=np.intp)

    def find(self, model: mujoco.MjModel, data: mujoco.MjData, origin: Vector, beam: Beam) -> str:
        """Scoped name of the visual or collision nearest to `origin` that is in the way, or an empty text.

        The ray ends at the lamp; a parallel one passes through the whole scene.
        """
        if not len(self._casters):
            return ""
        with temporary_values(model.geom_group, self._casters, _OPEN_GROUP):
            hit = mujoco.mj_ray(model, data, origin, beam.direction, self._groups, 1, -1, self._geom, None)
        if not 0.0 <= hit < beam.distance:
            return ""
        return str(self._names.geom_owner(int(self._geom[0]))[1])


def _shadow_casters(model: mujoco.MjModel, names: NameMap) -> list[int]:
    """Ids of the geoms that throw shadows."""
    opaque: npt.NDArray[np.bool_] = model.geom_rgba[:, 3] >= LEAST_OPACITY
    drawn = opaque & np.asarray(model.geom_castshadow, dtype=bool)
    found: set[int] = set()
    for link in names.links.values():
        if link.visuals:
            found.update(g for g in link.visuals if drawn[g] and model.geom_group[g] in (VISUAL, DRAWN_COLLISION))
        else:
            found.update(g for g in link.ray_geoms if model.geom_group[g] in SEEN_AS_COLLISIONS)
    return sorted(found)
