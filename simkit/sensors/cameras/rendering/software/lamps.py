"""Light at the corners of triangles, as OpenGL's fixed functions compute it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np

from simkit.sensors.cameras.rendering.software.shape_table import ShapeTable
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, Integers, dot, power, unit

_DIRECTIONAL: Final = int(mujoco.mjtLightType.mjLIGHT_DIRECTIONAL)
_SPOT: Final = int(mujoco.mjtLightType.mjLIGHT_SPOT)
_EVERYWHERE: Final = 180.0  # [degrees] cutoff of a spot light that shines in all directions
_UNLIT: Final = 0.3  # ambient light of a scene without any light (`initLights` in render_gl3.c)
_GLOSSIEST: Final = 128.0
_BLOCK: Final = 16384  # number of corners lit at once: so few stay in the processor's cache


@dataclass(frozen=True, slots=True)
class Lamp:
    """One light of a scene.

    Attributes:
        ambient, diffuse, specular: colours, shape (3,).
        direction: unit vector of the rays, shape (3,).
        place: position relative to the origin of the frame [m], shape (3,).
        is_parallel: True for a directional light, whose position only frames its shadows.
        attenuation: constant, linear and quadratic attenuation.
        cutoff: half angle of the cone [degrees].
        exponent: exponent of the cone's falloff.
        has_shadow: True if shapes cast shadows in its light.
    """

    ambient: Floats
    diffuse: Floats
    specular: Floats
    direction: Array
    place: Array
    is_parallel: bool
    attenuation: tuple[float, float, float]
    cutoff: float
    exponent: float
    has_shadow: bool

    @property
    def is_ambient(self) -> bool:
        """True if the lamp has neither diffuse nor specular light."""
        return not (self.diffuse.any() or self.specular.any())


def lamps_of(scene: mujoco.MjvScene, origin: Array, shadows: bool) -> list[Lamp]:
    """Return the lights of a composed scene.

    Args:
        scene: scene whose lights are read; MuJoCo's rasteriser draws directional and spot lights only.
        origin: origin of the frame in the world [m], shape (3,).
        shadows: True if shapes cast shadows.
    """
    lamps = []
    for light in scene.lights[: scene.nlight]:
        kind = int(light.type)
        if kind not in (_DIRECTIONAL, _SPOT):
            continue
        direction = unit(np.array(light.dir, np.float64))
        is_parallel = kind == _DIRECTIONAL
        constant, linear, quadratic = (float(part) for part in light.attenuation)
        lamps.append(
            Lamp(
                ambient=np.array(light.ambient, np.float32),
                diffuse=np.array(light.diffuse, np.float32),
                specular=np.array(light.specular, np.float32),
                direction=direction,
                place=np.array(light.pos, np.float64) - origin,
                is_parallel=is_parallel,
                attenuation=(constant, linear, quadratic),
                cutoff=_EVERYWHERE if is_parallel else float(light.cutoff),
                exponent=0.0 if is_parallel else float(light.exponent),
                has_shadow=shadows and bool(light.castshadow) and not light.headlight,
            )
        )
    return lamps


class CornerLight:
    """Light at corners of triangles.

    Args:
        table: shapes of the scene.
        lamps: lights of the scene.
        eye: position of the camera relative to the origin of the frame [m], shape (3,).
    """

    def __init__(self, table: ShapeTable, lamps: list[Lamp], eye: Array) -> None:
        self._table, self._lamps, self._eye = table, lamps, eye.astype(np.float32)
        self.shadowed = [lamp for lamp in lamps if lamp.has_shadow and not lamp.is_ambient]

    def colours(self, points: Floats, normals: Floats, owners: Integers) -> list[Floats]:
        """Return colours of corners: first without the lamps of `shadowed`, then one array for each of these.

        Args:
            points: corners relative to the origin of the frame [m], shape (n, 3).
            normals: unit normals, shape (n, 3).
            owners: rows of the shapes in the table, shape (n,).
        """
        layers = [np.empty(points.shape, np.float32) for _ in range(1 + len(self.shadowed))]
        for first in range(0, len(points), _BLOCK):
            rows = slice(first, first + _BLOCK)
            for layer, part in zip(layers, self._block(points[rows], normals[rows], owners[rows]), strict=True):
                layer[rows] = part
        return layers

    def _block(self, points: Floats, normals: Floats, owners: Integers) -> list[Floats]:
        """Return the layers of light of a few corners."""
        table = self._table
        surface = table.colours[:, :3].take(owners, axis=0)
        basic = table.emission.take(owners)[:, None] * surface
        if not self._lamps:
            basic += np.float32(_UNLIT) * surface
        layers = [basic]
        specular = table.specular.take(owners)
        is_shiny = specular > 0.0
        shiny: slice | Array = slice(None) if is_shiny.all() else np.flatnonzero(is_shiny)
        has_gloss = bool(is_shiny.any())
        for lamp in self._lamps:
            part = self._light(lamp, surface, points, normals)
            if has_gloss and lamp.specular.any():
                gloss = self._gloss(lamp, points[shiny], normals[shiny], owners[shiny])
                part[shiny] += (specular[shiny] * gloss)[:, None] * lamp.specular
            if lamp.has_shadow and not lamp.is_ambient:
                layers.append(part)
            else:
                basic += part
        return [np.clip(layer, 0.0, 1.0, out=layer) for layer in layers]

    def _light(self, lamp: Lamp, surface: Floats, points: Floats, normals: Floats) -> Floats:
        """Return the ambient and diffuse light of a lamp, shape (n, 3)."""
        if lamp.is_ambient and lamp.is_parallel:
            return lamp.ambient * surface
        towards, share = _rays(lamp, points)
        facing = np.maximum(dot(normals, towards), np.float32(0.0))
        light = facing[:, None] * lamp.diffuse
        light += lamp.ambient
        if share is not None:
            light *= share[:, None]
        light *= surface
        return light

    def _gloss(self, lamp: Lamp, points: Floats, normals: Floats, owners: Integers) -> Floats:
        """Return the strength of the highlight of a lamp, shape (n,)."""
        towards, share = _rays(lamp, points)
        half = unit(self._eye - points)
        half += towards
        shine = np.maximum(dot(normals, unit(half)), np.float32(0.0))
        exponents = np.minimum(self._table.shininess * np.float32(_GLOSSIEST), np.float32(_GLOSSIEST))
        gloss = power(shine, exponents.take(owners))
        gloss[dot(normals, towards) <= 0.0] = 0.0
        return gloss if share is None else gloss * share


def _rays(lamp: Lamp, points: Floats) -> tuple[Floats, Floats | None]:
    """Return unit vectors towards a lamp, shape (3,) or (n, 3), and the share of its light at each point."""
    if lamp.is_parallel:
        return (-lamp.direction).astype(np.float32), None
    towards = lamp.place.astype(np.float32) - points
    distances = np.sqrt(dot(towards, towards))
    towards /= np.maximum(distances, np.float32(1e-9))[:, None]
    constant, linear, quadratic = (np.float32(part) for part in lamp.attenuation)
    share = np.float32(1.0) / np.maximum(constant + distances * (linear + distances * quadratic), np.float32(1e-9))
    if lamp.cutoff < _EVERYWHERE:
        along = -dot(towards, lamp.direction.astype(np.float32))
        is_inside = along >= np.float32(math.cos(math.radians(lamp.cutoff)))
        falloff = power(np.maximum(along, np.float32(0.0)), np.full(len(along), lamp.exponent, np.float32))
        share = np.where(is_inside, share * falloff, np.float32(0.0))
    return towards, share
