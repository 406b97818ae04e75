"""Shadow maps: the nearest surface in each direction from a light, drawn by OpenCV's rasteriser.

A directional light needs parallel rays, and OpenCV draws only in perspective. A point at depth t along the rays is
therefore given to OpenCV at the distance 1 / (1 + t/range) with coordinates that are divided by the same number. Its
projection and its key are then exactly linear in the point, as for parallel rays.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Final

import mujoco
import numpy as np

from simkit.sensors.cameras.rendering.lights_and_shadows import Sphere, place_directional_lights
from simkit.sensors.cameras.rendering.software.frame import FAR, Frame
from simkit.sensors.cameras.rendering.software.lamps import Lamp
from simkit.sensors.cameras.rendering.software.rasteriser import draw_keys
from simkit.sensors.cameras.rendering.software.triangles import Corners, Triangles, View3D
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, cross, dot, unit
from simkit.sensors.cameras.rendering.view import View

_WIDEST: Final = 160.0  # [degrees] of the cone of a spot light, as in MuJoCo
_OFFSET: Final = 1.5
"""Distance along the normal [px of the map] at which a surface is compared, so that it does not shadow itself."""
_SLACK: Final = 0.75  # further tolerance [px of the map] along the rays


@dataclass(frozen=True, slots=True)
class ShadowMap:
    """Shadow map of one light.

    Attributes:
        keys: keys of the nearest surfaces, shape (size, size).
        position: position of the light relative to the origin of the frame [m], shape (3,).
        axes: unit vectors to the right, up and along the rays, shape (3, 3).
        reach: half width of the map [m] for a directional light, or the tangent of half its angle.
        depth: depth of the map of a directional light [m]; 0 for a spot light.
    """

    keys: Floats
    position: Array
    axes: Array
    reach: float
    depth: float

    def coordinates(self, points: Floats, normals: Floats) -> Floats:
        """Return the coordinates of surface points for `shares`, linear in the points, shape (n, 3)."""
        away = points - self.position.astype(np.float32)
        axes = self.axes.astype(np.float32)
        size = np.float32(_OFFSET * 2.0 * self.reach / len(self.keys))
        along = dot(away, axes[2])
        pixel = np.full(len(points), size, np.float32) if self.depth else np.abs(along) * size
        # a surface that faces the light needs no offset, a steep one needs all of it
        facing = dot(normals, axes[2])
        offset = pixel * np.sqrt(np.maximum(np.float32(1.0) - facing * facing, np.float32(0.0)))
        away = away + offset[:, None] * normals
        return np.stack([dot(away, axis) for axis in axes], axis=-1)

    def shares(self, at: Floats) -> Floats:
        """Return the share of the light that reaches points at coordinates (n, 3), from 0 to 1, shape (n,)."""
        size = len(self.keys)
        along = at[:, 2]
        scale = np.float32(0.5 * size / self.reach)
        slack = np.float32(_SLACK * 2.0 * self.reach / size)
        if self.depth:
            x, y = at[:, 0] * scale, at[:, 1] * scale
            keys = _parallel_keys(along - slack, self.depth)
        else:
            distance = np.maximum(along, np.float32(1e-6))
            x, y = at[:, 0] * scale / distance, at[:, 1] * scale / distance
            keys = np.float32(2.0) - np.float32(FAR) / (distance - slack * distance)
        # half a pixel: the map's values are at the centres of its pixels
        x += np.float32(0.5 * size - 0.5)
        y = np.float32(0.5 * size - 0.5) - y
        x0, y0 = np.floor(x), np.floor(y)
        right, down = x - x0, y - y0
        column, row = x0.astype(np.int32), y0.astype(np.int32)
        is_outside = (column < 0) | (row < 0) | (column > size - 2) | (row > size - 2)
        if not self.depth:
            is_outside |= along <= 0.0
        corner = np.where(is_outside, 0, row * size + column)
        flat = self.keys.ravel()
        lit = [(keys <= flat.take(corner + step)).astype(np.float32) for step in (0, 1, size, size + 1)]
        upper = lit[0] + right * (lit[1] - lit[0])
        lower = lit[2] + right * (lit[3] - lit[2])
        share: Floats = upper + down * (lower - upper)
        share[is_outside] = 1.0
        return share


def _parallel_keys(along: Floats, depth: float) -> Floats:
    """Return the keys of depths along parallel rays [m]."""
    keys = along * np.float32(1.0 / depth)
    keys += np.float32(1.0)
    keys *= np.float32(-FAR)
    return keys


def _axes(direction: Array) -> Array:
    """Return unit vectors to the right, up and along a direction, shape (3, 3)."""
    side = cross(direction, np.array((0.0, 0.0, 1.0) if abs(direction[2]) < 0.9 else (1.0, 0.0, 0.0)))
    right = unit(side)
    return np.stack((right, cross(right, direction), direction))


class ShadowMaps:
    """Shadow maps of the lights of an image.

    Args:
        size: width of a map [px].
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._buffers: list[Floats] = []

    def place_lights(
        self, scene: mujoco.MjvScene, model: mujoco.MjModel, position: Array, frame: Frame, lit: Sphere | None
    ) -> float:
        """Move the directional lights of a scene and return the half width of their maps [m]."""
        context = SimpleNamespace(shadowSize=self._size, shadowClip=1.0)
        place_directional_lights(scene, context, model, position, frame.ahead, frame.view.far, lit)
        return float(context.shadowClip)

    def draw(self, lamps: list[Lamp], shapes: View3D, casters: Array, reach: float, far: float) -> list[ShadowMap]:
        """Draw the shadow maps of lamps.

        Args:
            lamps: lamps with shadows.
            shapes: shapes of the scene.
            casters: rows of the shapes that cast shadows.
            reach: half width of the maps of directional lights [m].
            far: depth of the maps of directional lights [m].
        """
        corners = shapes.corners(casters, (), 1)
        while len(self._buffers) < len(lamps):
            self._buffers.append(np.empty((self._size, self._size), np.float32))
        return [
            self._directional(lamp, corners, reach, far, buffer)
            if lamp.is_parallel
            else self._spot(lamp, shapes, casters, far, buffer)
            for lamp, buffer in zip(lamps, self._buffers, strict=False)
        ]

    def _directional(self, lamp: Lamp, corners: Corners, reach: float, far: float, keys: Floats) -> ShadowMap:
        axes = _axes(lamp.direction)
        away = corners.points - lamp.place.astype(np.float32)
        right, up, along = (dot(away, axis.astype(np.float32)) for axis in axes)
        share = np.float32(1.0) / (np.float32(1.0) + along * np.float32(1.0 / far))
        scale = np.float32(1.0 / reach)
        points = np.stack((right * scale * share, up * scale * share, -share), axis=-1)
        # what lies before the map's beginning would change sides
        faces = corners.faces[(along > -0.9 * far)[corners.faces].all(axis=1)]
        keys.fill(2.0)
        draw_keys(np.eye(4), points, faces, keys, both_sides=True)
        return ShadowMap(keys, lamp.place, axes, reach, far)

    def _spot(self, lamp: Lamp, shapes: View3D, casters: Array, far: float, keys: Floats) -> ShadowMap:
        axes = _axes(lamp.direction)
        half = 0.5 * min(2.0 * lamp.cutoff, _WIDEST)
        reach = math.tan(math.radians(half))
        rotation = np.stack((axes[2], -axes[0], axes[1]), axis=1)
        view = View(self._size, self._size, -reach, reach, -reach, reach, 0.01, far)
        frame = Frame(view, lamp.place + shapes.frame.origin, rotation, shapes.frame.origin, shift=0.0)
        from_light = shapes.seen_from(frame)
        triangles: Triangles = from_light.triangles(
            from_light.corners(casters[from_light.is_visible[casters]], (), 1), []
        )
        keys.fill(float(frame.far_key))
        draw_keys(frame.matrix, triangles.points, triangles.faces, keys, both_sides=True)
        return ShadowMap(keys, lamp.place, axes, reach, 0.0)
