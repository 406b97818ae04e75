"""Store of the triangles of shapes, at the pose and with the number of sides that an image needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np

from simkit.sensors.cameras.rendering.software import model_meshes, shape_meshes
from simkit.sensors.cameras.rendering.software.frame import Frame
from simkit.sensors.cameras.rendering.software.shape_meshes import ROUND, UNIT, ShapeMesh
from simkit.sensors.cameras.rendering.software.shape_table import ShapeTable
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, Integers, rotate, unit

_SIDES: Final = (12, 16, 24, 32, 48, 64, 96, 128)
_SIDES_PER_ROOT: Final = 5.0
"""Sides per square root of the radius [px]: the middle of a side is then at most 0.2 px inside the circle."""
_MOST_PLACED: Final = 4096  # number of placed shapes that are kept
_GLOSSY_STACKS, _MATT_STACKS = 4, 1
_SURROUNDING: Final = 1e9  # radius [m] of shapes that may be anywhere
_DRAWN: Final = frozenset(
    {
        shape_meshes.HEIGHTS, shape_meshes.MESH, shape_meshes.SDF, shape_meshes.CAPSULE, shape_meshes.ARROW,
        shape_meshes.ARROW1, shape_meshes.ARROW2, shape_meshes.TRIANGLE, shape_meshes.FLEX, shape_meshes.SKIN, *UNIT,
    }
)  # fmt: skip
"""Types of shapes that the store knows; planes and lines depend on the camera."""


@dataclass(frozen=True, slots=True)
class Placed:
    """Triangles of one shape at its pose.

    Attributes:
        mesh: triangles in the shape's own frame.
        points: corners relative to the origin of the frame [m], shape (n, 3).
        normals: unit normals in the world, shape (n, 3).
    """

    mesh: ShapeMesh
    points: Floats
    normals: Floats


class ShapeStore:
    """Triangles of the shapes of a model. Shapes that do not move are placed once."""

    def __init__(self) -> None:
        self._model: mujoco.MjModel | None = None
        self._meshes: dict[tuple[int, int], ShapeMesh] = {}
        self._placed: dict[tuple[int, int, int], tuple[bytes, Placed]] = {}
        self._origin = b""

    def use_origin(self, origin: Array) -> None:
        """Forget the places of shapes relative to another origin."""
        key = origin.tobytes()
        if key != self._origin:
            self._origin = key
            self._placed.clear()

    def use_model(self, model: mujoco.MjModel) -> bool:
        """Forget the triangles of another model; return True if the model differs from the last one."""
        if model is self._model:
            return False
        self.clear()
        self._model = model
        return True

    def clear(self) -> None:
        """Forget all triangles."""
        self._model = None
        self._meshes.clear()
        self._placed.clear()

    def spheres(self, table: ShapeTable) -> tuple[Array, Array]:
        """Return the bounding spheres of shapes in the world: centres (n, 3) and radii (n,) [m]."""
        size = table.sizes.astype(np.float64)
        x, y, z = size[:, 0], size[:, 1], size[:, 2]
        centres, radii = table.positions.astype(np.float64), np.sqrt(x * x + y * y + z * z)
        kinds = table.kinds
        radii[kinds == shape_meshes.CAPSULE] += x[kinds == shape_meshes.CAPSULE]
        radii[np.isin(kinds, (shape_meshes.ARROW, shape_meshes.ARROW1, shape_meshes.ARROW2))] *= 2.0
        radii[np.isin(kinds, (shape_meshes.PLANE, shape_meshes.FLEX, shape_meshes.SKIN))] = _SURROUNDING
        is_stored = np.isin(kinds, (shape_meshes.MESH, shape_meshes.SDF, shape_meshes.HEIGHTS))
        for row in np.flatnonzero(is_stored & (table.numbers >= 0)):
            mesh = self._model_mesh(int(kinds[row]), int(table.numbers[row]))
            centres[row] += rotate(mesh.centre[None], table.rotations[row].astype(np.float64))[0]
            radii[row] = mesh.radius
        return centres, radii * 1.001

    def sides(self, table: ShapeTable, pixels: Array) -> Integers:
        """Return the number of sides of each round shape, 0 for other shapes.

        Args:
            table: shapes of the scene.
            pixels: pixels per metre at the nearest point of each shape, shape (n,).
        """
        wanted = _SIDES_PER_ROOT * np.sqrt(table.sizes[:, :2].max(axis=1) * pixels)
        steps = np.minimum(np.searchsorted(_SIDES, wanted), len(_SIDES) - 1)
        is_round = np.isin(table.kinds, tuple(ROUND))
        side_counts: Integers = np.where(is_round, np.array(_SIDES, np.int32)[steps], 0).astype(np.int32)
        return side_counts

    def place(
        self, scene: mujoco.MjvScene, table: ShapeTable, row: int, sides: int, squares: int, frame: Frame
    ) -> Placed | None:
        """Return the triangles of a shape; None for a type that the store does not know, or a mesh without data.

        Args:
            scene: composed scene, for flexes and skins.
            table: shapes of the scene.
            row: row of the shape in the table.
            sides: number of sides of a round shape.
            squares: divisions of the edges of a box.
            frame: frame of the image.
        """
        kind = int(table.kinds[row])
        if kind not in _DRAWN:
            return None
        if kind in (shape_meshes.FLEX, shape_meshes.SKIN):
            return self._deformed(scene, kind, int(table.objects[row]), float(table.sizes[row, 0]), frame)
        key = table.poses[row].tobytes()
        place = row, int(table.numbers[row]), (kind * 1000 + sides) * 1000 + squares
        known = self._placed.get(place)
        if known is not None and known[0] == key:
            return known[1]
        if kind in (shape_meshes.HEIGHTS, shape_meshes.MESH, shape_meshes.SDF) and table.numbers[row] < 0:
            return None
        mesh = self._mesh(kind, int(table.numbers[row]), table.sizes[row], sides, squares)
        rotation = table.rotations[row].astype(np.float64)
        corners, normals = mesh.corners, mesh.normals
        if kind in UNIT:
            scale = np.maximum(table.sizes[row], np.float32(1e-9))
            corners = corners * scale
            if kind in (shape_meshes.ELLIPSOID, shape_meshes.CYLINDER):
                normals = unit(normals / scale)
        points = rotate(corners, rotation)
        points += (table.positions[row].astype(np.float64) - frame.origin).astype(np.float32)
        placed = Placed(mesh, points, rotate(normals, rotation))
        if len(self._placed) > _MOST_PLACED:
            self._placed.clear()
        self._placed[place] = key, placed
        return placed

    def _mesh(self, kind: int, number: int, size: Floats, sides: int, squares: int) -> ShapeMesh:
        if kind in (shape_meshes.MESH, shape_meshes.SDF, shape_meshes.HEIGHTS):
            return self._model_mesh(kind, number)
        if kind == shape_meshes.BOX:
            return shape_meshes.box(squares)
        if kind in (shape_meshes.SPHERE, shape_meshes.ELLIPSOID):
            return shape_meshes.sphere(sides)
        if kind == shape_meshes.CYLINDER:
            return shape_meshes.cylinder(sides, _GLOSSY_STACKS if squares > 1 else _MATT_STACKS)
        x, y, z = (float(part) for part in size)
        if kind == shape_meshes.CAPSULE:
            return shape_meshes.capsule(x, z, sides)
        if kind == shape_meshes.TRIANGLE:
            return shape_meshes.triangle(x, y)
        return shape_meshes.arrow(kind, (x, y, z), sides)

    def _model_mesh(self, kind: int, number: int) -> ShapeMesh:
        assert self._model is not None
        key = (kind, number)
        if key not in self._meshes:
            make = model_meshes.heights_of if kind == shape_meshes.HEIGHTS else model_meshes.mesh_of
            self._meshes[key] = make(self._model, number)
        return self._meshes[key]

    def _deformed(self, scene: mujoco.MjvScene, kind: int, number: int, radius: float, frame: Frame) -> Placed:
        assert self._model is not None
        if kind == shape_meshes.FLEX:
            mesh = model_meshes.flex_of(scene, number, radius)
        else:
            mesh = model_meshes.skin_of(self._model, scene, number)
        return Placed(mesh, mesh.corners - frame.origin.astype(np.float32), mesh.normals)
