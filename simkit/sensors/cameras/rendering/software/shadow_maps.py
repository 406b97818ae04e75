"""Shadow maps: the nearest surface in each direction from a light, drawn by OpenCV's rasteriser.

A directional light needs parallel rays, and OpenCV draws only in perspective. A point at depth t along the rays is
therefore given to OpenCV at the distance 1 / (2 - t/range) with coordinates that are multiplied by the same number. Its
projection and its key are then exactly linear in the point, as for parallel rays.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Final, Protocol

import mujoco
import numpy as np

from simkit.sensors.cameras.rendering.lights_and_shadows import Sphere, place_directional_lights
from simkit.sensors.cameras.rendering.software.frame import FAR, Frame
from simkit.sensors.cameras.rendering.software.lamps import Lamp
from simkit.sensors.cameras.rendering.software.rasteriser import draw_keys
from simkit.sensors.cameras.rendering.software.shape_meshes import BOX, CAPSULE, CYLINDER, ELLIPSOID, SPHERE
from simkit.sensors.cameras.rendering.software.shape_table import ShapeTable
from simkit.sensors.cameras.rendering.software.triangles import Corners, VisibleShapes
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, cross, dot, rotate, unit
from simkit.sensors.cameras.rendering.view import View

_WIDEST: Final = 160.0  # [degrees] of the cone of a spot light, as in MuJoCo
_OFFSET: Final = 1.5
"""Distance along the normal [px of the map] at which a surface is compared, so that it does not shadow itself."""
_SLACK: Final = 0.75  # further tolerance [px of the map] along the rays
_EDGE: Final = 4  # number of directions at the edge of a disc that must agree
_NEAR: Final = 0.01  # [m] beginning of the map of a spot light
_CLOSED: Final = (BOX, SPHERE, ELLIPSOID, CYLINDER, CAPSULE)


class Shadow(Protocol):
    """Shadow in the light of one lamp."""

    def coordinates(self, points: Floats, normals: Floats) -> Floats:
        """Return the coordinates of surface points for `shares`, linear in the points, shape (n, 3)."""

    def shares(self, at: Floats) -> Floats:
        """Return the share of the light that reaches points at coordinates (n, 3), from 0 to 1, shape (n,)."""


@dataclass(frozen=True, slots=True)
class ShadowMap:
    """Shadow map of one light.

    Attributes:
        keys: keys of the nearest surfaces, shape (size, size).
        position: position of the light relative to the origin of the frame [m], shape (3,).
        axes: unit vectors to the right, up and along the rays, shape (3, 3).
        reach: half width of the map [m] for a directional light, or the tangent of half its angle.
        depth: depth of the map of a directional light [m]; 0 for a spot light.
        far_key: key of a pixel without a surface.
        frame: frame of the map of a spot light; None for a directional light.
    """

    keys: Floats
    position: Array
    axes: Array
    reach: float
    depth: float
    far_key: float
    frame: Frame | None

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


class SoftShadow:
    """Shadow of a directional light that is a disc: the mean of the shadows from several directions.

    Where four directions at the edge of the disc agree, all do; only the other points are compared with all maps.

    Args:
        middle: map from the middle of the disc, for the coordinates.
        draw: function that returns the map from one of the directions; it may overwrite the one before.
        count: number of directions, the last ones at the edge of the disc.
    """

    def __init__(self, middle: ShadowMap, draw: Callable[[int], ShadowMap], count: int) -> None:
        self._middle, self._draw, self._count = middle, draw, count

    def coordinates(self, points: Floats, normals: Floats) -> Floats:
        """Return the coordinates of surface points for `shares`, linear in the points, shape (n, 3)."""
        return self._middle.coordinates(points, normals)

    def shares(self, at: Floats) -> Floats:
        """Return the share of the light that reaches points at coordinates (n, 3), from 0 to 1, shape (n,)."""
        points = rotate(at, self._middle.axes.T)
        points += self._middle.position.astype(np.float32)
        first = min(_EDGE, self._count)
        edge = [self._from(self._count - 1 - number, points) for number in range(first)]
        total = edge[0].copy()
        for share in edge[1:]:
            total += share
        uneven = np.flatnonzero(np.max(edge, axis=0) > np.min(edge, axis=0))
        mean: Floats = total * np.float32(1.0 / first)
        some = points[uneven]
        for number in range(self._count - first):
            total[uneven] += self._from(number, some)
        mean[uneven] = total[uneven] * np.float32(1.0 / self._count)
        return mean

    def _from(self, number: int, points: Floats) -> Floats:
        shadow_map = self._draw(number)
        return shadow_map.shares(rotate(points - shadow_map.position.astype(np.float32), shadow_map.axes))


def _parallel_keys(along: Floats, depth: float) -> Floats:
    """Return the keys of depths along parallel rays [m]."""
    keys = along * np.float32(-1.0 / depth)
    keys += np.float32(2.0)
    keys *= np.float32(-FAR)
    return keys


def _axes(direction: Array) -> Array:
    """Return unit vectors to the right, up and along a direction, shape (3, 3)."""
    side = cross(direction, np.array((0.0, 0.0, 1.0) if abs(direction[2]) < 0.9 else (1.0, 0.0, 0.0)))
    right = unit(side)
    return np.stack((right, cross(right, direction), direction))


class ShadowMaps:
    """Shadow maps of the lights of an image. The shapes that do not move are drawn once for each place of a light.

    Args:
        size: width of a map [px].
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._buffers: list[Floats] = []
        self._static: list[tuple[bytes, Floats]] = []

    def clear(self) -> None:
        """Free the maps."""
        self._buffers.clear()
        self._static.clear()

    def place_lights(
        self, scene: mujoco.MjvScene, model: mujoco.MjModel, position: Array, frame: Frame, lit: Sphere | None
    ) -> float:
        """Move the directional lights of a scene and return the half width of their maps [m]."""
        context = SimpleNamespace(shadowSize=self._size, shadowClip=1.0)
        place_directional_lights(scene, context, model, position, frame.ahead, frame.view.far, lit)
        return float(context.shadowClip)

    def draw(
        self,
        lamps: list[Lamp],
        model: mujoco.MjModel,
        table: ShapeTable,
        shapes: VisibleShapes,
        casters: Array,
        reach: float,
        far: float,
    ) -> list[ShadowMap]:
        """Draw the shadow maps of lamps.

        Args:
            lamps: lamps with shadows.
            model: compiled model.
            table: shapes of the scene.
            shapes: triangles of the shapes.
            casters: rows of the shapes that cast shadows.
            reach: half width of the maps of directional lights [m].
            far: depth of the maps [m].
        """
        geoms = table.geoms[casters]
        is_static = (geoms >= 0) & (model.body_weldid[model.geom_bodyid[np.maximum(geoms, 0)]] == 0)
        fixed, moving = casters[is_static], casters[~is_static]
        rows = (table.kinds, table.sizes, table.positions, table.rotations, table.geoms)
        state = b"".join(values[fixed].tobytes() for values in rows)
        while len(self._buffers) < len(lamps):
            self._buffers.append(np.empty((self._size, self._size), np.float32))
        while len(self._static) < len(lamps):
            self._static.append((b"", np.empty((self._size, self._size), np.float32)))
        maps = []
        for number, lamp in enumerate(lamps):
            shadow_map = self._map(lamp, reach, far, shapes, self._buffers[number])
            ground = self._is_ground(shadow_map, shapes, table)
            key = b"".join(
                (
                    state,
                    ground.tobytes(),
                    shadow_map.position.tobytes(),
                    shadow_map.axes.tobytes(),
                    np.array((reach, far)).tobytes(),
                )
            )
            known, keys = self._static[number]
            if key != known:
                keys.fill(shadow_map.far_key)
                self._add(shadow_map, shapes, table, fixed, keys)
                self._static[number] = key, keys
            np.copyto(shadow_map.keys, keys)
            self._add(shadow_map, shapes, table, moving, shadow_map.keys)
            maps.append(shadow_map)
        return maps

    def draw_once(
        self, lamp: Lamp, table: ShapeTable, shapes: VisibleShapes, casters: Array, reach: float, far: float
    ) -> ShadowMap:
        """Draw the shadow map of one lamp, and overwrite the map before; see `draw`."""
        if not self._buffers:
            self._buffers.append(np.empty((self._size, self._size), np.float32))
        shadow_map = self._map(lamp, reach, far, shapes, self._buffers[0])
        shadow_map.keys.fill(shadow_map.far_key)
        self._add(shadow_map, shapes, table, casters, shadow_map.keys)
        return shadow_map

    def _map(self, lamp: Lamp, reach: float, far: float, shapes: VisibleShapes, keys: Floats) -> ShadowMap:
        """Return an empty map of a lamp."""
        axes = _axes(lamp.direction)
        if lamp.is_parallel:
            return ShadowMap(keys, lamp.place, axes, reach, far, 2.0, None)
        wide = math.tan(math.radians(0.5 * min(2.0 * lamp.cutoff, _WIDEST)))
        rotation = np.stack((axes[2], -axes[0], axes[1]), axis=1)
        view = View(self._size, self._size, -wide, wide, -wide, wide, _NEAR, far)
        origin = shapes.frame.origin
        frame = Frame(view, lamp.place + origin, rotation, origin, shift=0.0)
        return ShadowMap(keys, lamp.place, axes, wide, 0.0, float(frame.far_key), frame)

    def _add(self, shadow_map: ShadowMap, shapes: VisibleShapes, table: ShapeTable, rows: Array, keys: Floats) -> None:
        """Draw shapes into a map; of a closed shape only the sides that face the light."""
        if shadow_map.frame is not None:
            from_light = shapes.seen_from(shadow_map.frame)
            rows = rows[from_light.is_visible[rows]]
            triangles = from_light.triangles(from_light.casters(rows), [])
            points, faces, owners, matrix = triangles.points, triangles.faces, triangles.owners, shadow_map.frame.matrix
        else:
            rows = rows[~self._is_ground(shadow_map, shapes, table)[rows]]
            corners = shapes.casters(rows)
            points, faces, owners, matrix = _parallel(shadow_map, corners), corners.faces, corners.owners, np.eye(4)
            # beyond twice the range, points would be behind OpenCV's camera
            faces = faces[(points[:, 2] < -0.1)[faces].all(axis=1)]
        is_closed = np.isin(table.kinds, _CLOSED)[owners[faces[:, 0]]]
        draw_keys(matrix, points, faces[is_closed], keys)
        draw_keys(matrix, points, faces[~is_closed], keys, both_sides=True)

    def _is_ground(self, shadow_map: ShadowMap, shapes: VisibleShapes, table: ShapeTable) -> Array:
        """Return True for each plane below everything that is lit: light and camera are above, and the map is inside.

        Such a plane shadows nothing that is visible, but it would fill the map.
        """
        is_ground = np.zeros(len(table), bool)
        for row in table.planes().tolist():
            normal = table.rotations[row, :, 2].astype(np.float64)
            eye = shapes.frame.eye - (table.positions[row].astype(np.float64) - shapes.frame.origin)
            is_wide = bool((table.sizes[row, :2] >= shadow_map.reach).all())
            is_ground[row] = is_wide and float(dot(normal, shadow_map.axes[2])) < 0.0 < float(dot(normal, eye))
        return is_ground


def _parallel(shadow_map: ShadowMap, corners: Corners) -> Floats:
    """Return corners as OpenCV must get them for parallel rays, shape (n, 3)."""
    away = corners.points - shadow_map.position.astype(np.float32)
    right, up, along = (dot(away, axis.astype(np.float32)) for axis in shadow_map.axes)
    share = np.float32(1.0) / np.maximum(np.float32(2.0) - along * np.float32(1.0 / shadow_map.depth), np.float32(1e-3))
    scale = np.float32(1.0 / shadow_map.reach)
    is_near = along < np.float32(1.9 * shadow_map.depth)
    return np.stack((right * scale * share, up * scale * share, np.where(is_near, -share, np.float32(0.0))), axis=-1)
