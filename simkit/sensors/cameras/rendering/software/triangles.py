"""Triangles of an image: those of all visible shapes together, with light at the corners, clipped at the view."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np

from simkit.sensors.cameras.rendering.software import shape_meshes
from simkit.sensors.cameras.rendering.software.clipping import are_in_view, clip
from simkit.sensors.cameras.rendering.software.flat_shapes import line_points, plane_points
from simkit.sensors.cameras.rendering.software.frame import Frame
from simkit.sensors.cameras.rendering.software.lamps import CornerLight, Lamp
from simkit.sensors.cameras.rendering.software.shape_store import ShapeStore
from simkit.sensors.cameras.rendering.software.shape_table import ShapeTable
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, Integers

_LARGEST: Final = 1500.0
"""Radius of a shape in the image [px] above which its triangles are clipped."""
_MATT_SQUARES: Final = 24  # divisions of a plane without gloss
_GLOSSY_SQUARES: Final = 48
_LARGE, _GLOSSY_SIDES = 32, 96  # number of sides from which a glossy round shape has more sides
_MOST_LAMPS: Final = 3  # number of lamps below which planes are divided finely
_CASTER_SIDES: Final = 48  # number of sides of round shapes that cast shadows


@dataclass(slots=True)
class Corners:
    """Corners of the triangles of some shapes.

    Attributes:
        points: positions relative to the origin of the frame [m], shape (n, 3).
        normals: unit normals, shape (n, 3).
        faces: triangles, shape (m, 3).
        owners: rows of the shapes in the table, shape (n,).
        parts: parts of the shapes (`shape_meshes`), shape (n,).
        coordinates: texture coordinates of the shapes that have some, else 0, shape (n, 2).
    """

    points: Floats
    normals: Floats
    faces: Integers
    owners: Integers
    parts: Integers
    coordinates: Floats


@dataclass(slots=True)
class Triangles:
    """Triangles ready for the rasteriser.

    Attributes:
        points, faces, owners, parts: as in `Corners`.
        values: layers of values at the corners, each of shape (n, 3).
    """

    points: Floats
    faces: Integers
    owners: Integers
    parts: Integers
    values: list[Floats]

    def of_shapes(self, is_chosen: Array) -> Integers:
        """Return the faces of some shapes.

        Args:
            is_chosen: True for each row of the table to keep.
        """
        chosen: Integers = self.faces[is_chosen[self.owners[self.faces[:, 0]]]]
        return chosen


class VisibleShapes:
    """Visible shapes of one image.

    Args:
        scene: composed scene.
        table: its shapes.
        store: triangles of the shapes.
        frame: pose and frustum of the image.
        hidden: rows of shapes that are not drawn.

    Attributes:
        frame: pose and frustum of the image.
        is_visible: True for each shape that may be in the image, shape (n,).
        needs_clipping: True for each shape that may reach behind the camera or far around the image, shape (n,).
        distances: distances of the middle of each shape [m], shape (n,).
    """

    def __init__(
        self, scene: mujoco.MjvScene, table: ShapeTable, store: ShapeStore, frame: Frame, hidden: Sequence[int]
    ) -> None:
        self._scene, self._table, self._store, self.frame = scene, table, store, frame
        self._hidden = hidden
        store.use_origin(frame.origin)
        centres, radii = store.spheres(table)
        right, up, ahead = frame.in_camera(centres - frame.origin)
        view = frame.view
        outside = (ahead + radii < view.near) | (ahead - radii > view.far)
        for tangent, across, sign in (
            (view.left, right, -1.0), (view.right, right, 1.0), (view.bottom, up, -1.0), (view.top, up, 1.0),
        ):  # fmt: skip
            outside |= sign * (across - tangent * ahead) > radii * float(np.sqrt(1.0 + tangent * tangent))
        self.is_visible = ~outside
        self.is_visible[list(hidden)] = False
        self.is_visible[table.kinds == int(mujoco.mjtGeom.mjGEOM_NONE)] = False
        pixels = frame.pixels_per_tangent / np.maximum(ahead - radii, view.near)
        self.needs_clipping = (ahead - radii < 1.01 * view.near) | (2.0 * radii * pixels > _LARGEST)
        self.distances = np.sqrt(right * right + up * up + ahead * ahead)
        self._sides = store.sides(table, frame.pixels_per_tangent / np.maximum(self.distances, view.near))

    def seen_from(self, frame: Frame) -> VisibleShapes:
        """Return the same shapes as seen in another frame."""
        return VisibleShapes(self._scene, self._table, self._store, frame, self._hidden)

    def casters(self, rows: Array) -> Corners:
        """Return the corners of shapes that cast shadows; they do not depend on the camera.

        Args:
            rows: rows of the shapes in the table.
        """
        is_round = self._sides > 0
        return self._collect(rows, np.where(is_round, _CASTER_SIDES, 0), np.zeros(len(self._table), bool), 1, 1)

    def corners(self, rows: Array, lamps: Sequence[Lamp], quads: int) -> Corners:
        """Return the corners of shapes.

        Args:
            rows: rows of the shapes in the table.
            lamps: lights of the scene; they decide how finely flat sides are divided.
            quads: divisions of an edge of a box with uneven light.
        """
        table = self._table
        places = [lamp.place for lamp in lamps if not lamp.is_parallel and not lamp.is_ambient]
        shines = bool(places) | ((table.specular > 0.0) & any(lamp.specular.any() for lamp in lamps))
        # a highlight between corners is interpolated, so round shapes need more of them
        sides = np.where(shines & (self._sides >= _LARGE), _GLOSSY_SIDES, self._sides)
        return self._collect(rows, sides, shines, quads, _MATT_SQUARES, places[:_MOST_LAMPS])

    def _collect(
        self, rows: Array, sides: Array, shines: Array, quads: int, squares: int, places: Sequence[Array] = ()
    ) -> Corners:
        """Return the corners of shapes.

        Args:
            rows: rows of the shapes in the table.
            sides: number of sides of each round shape, for all rows of the table.
            shines: True for each shape with uneven light on flat sides, for all rows of the table.
            quads: divisions of an edge of a box with uneven light.
            squares: divisions of an edge of a plane with even light.
            places: positions of lamps, below which planes are divided finely.
        """
        table, frame = self._table, self.frame
        drawn_rows, points, normals, faces, parts, coordinates, counts = [], [], [], [], [], [], []
        start = 0
        for row in rows.tolist():
            kind = int(table.kinds[row])
            texture: Array | None = None
            if kind == shape_meshes.PLANE:
                at, up, of = plane_points(table, row, frame, _GLOSSY_SQUARES if shines[row] else squares, places)
                part = np.zeros(len(at), np.int32)
            elif kind in (shape_meshes.LINE, shape_meshes.LINEBOX):
                at, up, of = line_points(table, row, frame)
                part = np.zeros(len(at), np.int32)
            else:
                placed = self._store.place(self._scene, table, row, int(sides[row]), quads if shines[row] else 1, frame)
                if placed is None:
                    continue
                at, up, of, part = placed.points, placed.normals, placed.mesh.faces, placed.mesh.parts
                texture = placed.mesh.coordinates
            drawn_rows.append(row)
            counts.append(len(at))
            points.append(at)
            normals.append(up)
            faces.append(of + np.int32(start))
            parts.append(part)
            coordinates.append(np.zeros((len(at), 2), np.float32) if texture is None else texture)
            start += len(at)
        if not drawn_rows:
            none = np.zeros((0, 3), np.float32)
            empty = np.zeros(0, np.int32)
            return Corners(none, none, np.zeros((0, 3), np.int32), empty, empty, np.zeros((0, 2), np.float32))
        return Corners(
            np.concatenate(points),
            np.concatenate(normals),
            np.concatenate(faces),
            np.repeat(np.array(drawn_rows, np.int32), counts),
            np.concatenate(parts),
            np.concatenate(coordinates),
        )

    def in_view(self, corners: Corners) -> Corners:
        """Return the corners without the faces that `triangles` would drop, so that no light is computed for them.

        In a small image of a large world, these are more than half of all faces.
        """
        faces = corners.faces
        doubtful = self.needs_clipping[corners.owners[faces[:, 0]]] if len(faces) else np.zeros(0, bool)
        if not doubtful.any():
            return corners
        is_kept = ~doubtful
        is_kept[doubtful] = are_in_view(self.frame, corners.points, faces[doubtful])
        faces = faces[is_kept]
        used = np.zeros(len(corners.points), bool)
        used[faces.ravel()] = True
        numbers = np.cumsum(used, dtype=np.int32) - np.int32(1)
        return Corners(
            corners.points[used],
            corners.normals[used],
            numbers.take(faces),
            corners.owners[used],
            corners.parts[used],
            corners.coordinates[used],
        )

    def lit(self, corners: Corners, light: CornerLight) -> list[Floats]:
        """Return the layers of light at corners; lines have their own colour without light."""
        layers = light.colours(corners.points, corners.normals, corners.owners)
        is_line = np.isin(self._table.kinds, (shape_meshes.LINE, shape_meshes.LINEBOX))
        if is_line.any():
            chosen = is_line[corners.owners]
            layers[0][chosen] = self._table.colours[corners.owners[chosen], :3]
            for layer in layers[1:]:
                layer[chosen] = 0.0
        return layers

    def triangles(self, corners: Corners, values: list[Floats]) -> Triangles:
        """Clip triangles where necessary.

        Args:
            corners: corners of the shapes.
            values: layers of values at the corners, each of shape (n, 3).
        """
        owners = corners.owners[corners.faces[:, 0]] if len(corners.faces) else np.zeros(0, np.int32)
        chosen = self.needs_clipping[owners]
        if not chosen.any():
            return Triangles(corners.points, corners.faces, corners.owners, corners.parts, values)
        doubtful = corners.faces[chosen]
        joined = np.concatenate(values, axis=1) if values else np.zeros((len(corners.points), 0), np.float32)
        uncut_faces, points, new_values, sources = clip(self.frame, corners.points, joined, doubtful)
        first = np.repeat(doubtful[sources, 0], 3)
        new_faces = (len(corners.points) + np.arange(len(points), dtype=np.int32)).reshape(-1, 3)
        layers = [
            np.concatenate((layer, new_values[:, 3 * number : 3 * number + 3])) for number, layer in enumerate(values)
        ]
        return Triangles(
            np.concatenate((corners.points, points)),
            np.concatenate((corners.faces[~chosen], uncut_faces, new_faces)),
            np.concatenate((corners.owners, corners.owners[first])),
            np.concatenate((corners.parts, corners.parts[first])),
            layers,
        )
