"""Triangles of MuJoCo's built-in shapes, in the shape's own frame."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, replace
from typing import Final

import mujoco
import numpy as np

from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, Integers, cross, dot, unit

_KINDS = mujoco.mjtGeom
PLANE, HEIGHTS, SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX, MESH, SDF = (
    int(kind)
    for kind in (
        _KINDS.mjGEOM_PLANE, _KINDS.mjGEOM_HFIELD, _KINDS.mjGEOM_SPHERE, _KINDS.mjGEOM_CAPSULE,
        _KINDS.mjGEOM_ELLIPSOID, _KINDS.mjGEOM_CYLINDER, _KINDS.mjGEOM_BOX, _KINDS.mjGEOM_MESH, _KINDS.mjGEOM_SDF,
    )
)  # fmt: skip
ARROW, ARROW1, ARROW2, LINE, LINEBOX, TRIANGLE, FLEX, SKIN = (
    int(kind)
    for kind in (
        _KINDS.mjGEOM_ARROW, _KINDS.mjGEOM_ARROW1, _KINDS.mjGEOM_ARROW2, _KINDS.mjGEOM_LINE, _KINDS.mjGEOM_LINEBOX,
        _KINDS.mjGEOM_TRIANGLE, _KINDS.mjGEOM_FLEX, _KINDS.mjGEOM_SKIN,
    )
)  # fmt: skip
ROUND: Final = frozenset({SPHERE, CAPSULE, ELLIPSOID, CYLINDER, ARROW, ARROW1, ARROW2})
"""Types of shapes whose number of sides follows from their size in the image."""
UNIT: Final = frozenset({SPHERE, ELLIPSOID, CYLINDER, BOX})
"""Types of shapes whose triangles are those of the unit shape, scaled by the size."""

FLAT, SIDE, TOP, BOTTOM = range(4)
"""Parts of a shape: flat triangles, and the curved parts that `exact_surfaces` knows."""


@dataclass(frozen=True, slots=True)
class ShapeMesh:
    """Triangles of one shape in its own frame.

    Attributes:
        corners: positions [m], or for a unit shape without unit, shape (n, 3).
        normals: unit normals at the corners, shape (n, 3).
        faces: indices of three corners each, counter-clockwise from outside, shape (m, 3).
        parts: part of the shape to which each corner belongs, shape (n,).
        coordinates: texture coordinates at the corners, shape (n, 2); None without.
        centre: middle of the bounding box, shape (3,).
        radius: distance of the farthest corner from `centre`.
    """

    corners: Floats
    normals: Floats
    faces: Integers
    parts: Integers
    coordinates: Floats | None
    centre: Array
    radius: float

    @classmethod
    def of(
        cls, corners: Array, normals: Array, faces: Array, parts: Array | int = FLAT, coordinates: Array | None = None
    ) -> ShapeMesh:
        """Return a mesh from arrays of any precision."""
        low, high = (corners.min(axis=0), corners.max(axis=0)) if len(corners) else (np.zeros(3), np.zeros(3))
        centre = (low + high) / 2.0
        away = corners - centre
        radius = math.sqrt(float(dot(away, away).max())) if len(corners) else 0.0
        return cls(
            np.ascontiguousarray(corners, np.float32),
            np.ascontiguousarray(normals, np.float32),
            np.ascontiguousarray(faces, np.int32),
            np.full(len(corners), parts, np.int32) if isinstance(parts, int) else parts.astype(np.int32),
            None if coordinates is None else np.ascontiguousarray(coordinates, np.float32),
            np.asarray(centre, np.float64),
            radius,
        )


def merge(meshes: list[ShapeMesh]) -> ShapeMesh:
    """Return one mesh of several."""
    starts = np.cumsum([0] + [len(mesh.corners) for mesh in meshes[:-1]])
    return ShapeMesh.of(
        np.concatenate([mesh.corners for mesh in meshes]),
        np.concatenate([mesh.normals for mesh in meshes]),
        np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=True)]),
        np.concatenate([mesh.parts for mesh in meshes]),
        np.concatenate([np.zeros((len(m.corners), 2)) if m.coordinates is None else m.coordinates for m in meshes]),
    )


def face_normals(corners: Array, faces: Array) -> Array:
    """Return the unit normal of each face, shape (m, 3)."""
    a, b, c = (corners[faces[:, k]] for k in range(3))
    return unit(cross(b - a, c - a))


def _grid_faces(rows: int, columns: int) -> Array:
    """Return the faces of a grid of corners, counter-clockwise for columns to the right and rows upwards."""
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    right = first + 1
    return np.concatenate(
        (np.column_stack((first, right, right + columns)), np.column_stack((first, right + columns, first + columns)))
    )


@functools.lru_cache(maxsize=16)
def box(squares: int) -> ShapeMesh:
    """Return the unit box; each side is divided into squares, so that light at corners shows a gloss."""
    steps = np.linspace(-1.0, 1.0, squares + 1)
    rows, columns = (values.ravel() for values in np.meshgrid(steps, steps, indexing="ij"))
    sides = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            corners, normal = np.empty((len(rows), 3)), np.zeros(3)
            corners[:, axis], corners[:, (axis + 1) % 3], corners[:, (axis + 2) % 3] = sign, columns, rows
            normal[axis] = sign
            faces = _grid_faces(squares + 1, squares + 1)
            right, up = corners[:, 1 if axis == 0 else 0], corners[:, 1 if axis == 2 else 2]
            sides.append(
                ShapeMesh.of(
                    corners,
                    np.tile(normal, (len(rows), 1)),
                    faces if sign > 0 else faces[:, ::-1],
                    coordinates=0.5 + 0.5 * np.stack((right, -up), axis=-1),
                )
            )
    return merge(sides)


def _revolve(profile: list[tuple[float, float, float, float]], sides: int, part: int) -> ShapeMesh:
    """Return a surface of revolution. Its texture goes once around, from the last row down to the first one.

    Args:
        profile: rows from bottom to top: radius, height, and the radial and the upward part of the normal.
        sides: number of sides.
        part: part of the shape to which the surface belongs.
    """
    rows = np.array(profile, np.float64)
    # the engine's own sine, because NumPy's has other bits on other processors
    angles = [2.0 * math.pi * (side % sides) / sides for side in range(sides + 1)]
    around = np.array([(math.cos(angle), math.sin(angle)) for angle in angles])
    corners = np.empty((len(rows), sides + 1, 3))
    normals = np.empty_like(corners)
    for target, radial, upward in ((corners, 0, 1), (normals, 2, 3)):
        target[:, :, :2] = rows[:, radial, None, None] * around
        target[:, :, 2] = rows[:, upward, None]
    faces = _grid_faces(len(rows), sides + 1)
    down = 1.0 - np.arange(len(rows)) / (len(rows) - 1)
    coordinates = np.stack(np.broadcast_arrays(np.arange(sides + 1) / sides, down[:, None]), axis=-1)
    points = corners.reshape(-1, 3)
    a, b, c = (points[faces[:, k]] for k in range(3))
    area = cross(b - a, c - a)
    faces = faces[dot(area, area) > 1e-24]
    return ShapeMesh.of(points, normals.reshape(-1, 3), faces, part, coordinates.reshape(-1, 2))


def _arc(first: float, last: float, steps: int) -> list[tuple[float, float]]:
    """Return cosine and sine of equal steps between two angles [rad]."""
    angles = [first + (last - first) * step / steps for step in range(steps + 1)]
    return [(math.cos(angle), math.sin(angle)) for angle in angles]


@functools.lru_cache(maxsize=64)
def sphere(sides: int) -> ShapeMesh:
    """Return the unit sphere."""
    arc = [(max(across, 0.0), up) for across, up in _arc(-math.pi / 2, math.pi / 2, max(4, sides // 2))]
    arc[0], arc[-1] = (0.0, -1.0), (0.0, 1.0)
    return _revolve([(across, up, across, up) for across, up in arc], sides, SIDE)


@functools.lru_cache(maxsize=64)
def cylinder(sides: int, stacks: int, is_open: bool = False) -> ShapeMesh:
    """Return the unit cylinder from -1 to +1 in z; an open one has no lids."""
    heights = [2.0 * stack / stacks - 1.0 for stack in range(stacks + 1)]
    side = _revolve([(1.0, height, 1.0, 0.0) for height in heights], sides, SIDE)
    if is_open:
        return side
    rings = [step / stacks for step in range(stacks + 1)]
    low = _revolve([(ring, -1.0, 0.0, -1.0) for ring in rings], sides, FLAT)
    high = _revolve([(ring, 1.0, 0.0, 1.0) for ring in rings[::-1]], sides, FLAT)
    return merge([side, *(replace(lid, coordinates=0.5 + 0.5 * lid.corners[:, :2]) for lid in (low, high))])


@functools.lru_cache(maxsize=256)
def capsule(radius: float, half_length: float, sides: int) -> ShapeMesh:
    """Return a capsule along z."""
    steps = max(3, sides // 4)
    low = [(max(c, 0.0), s) for c, s in _arc(-math.pi / 2, 0.0, steps)]
    high = [(max(c, 0.0), s) for c, s in _arc(0.0, math.pi / 2, steps)]
    low[0], high[-1] = (0.0, -1.0), (0.0, 1.0)
    bottom = _revolve([(radius * c, radius * s - half_length, c, s) for c, s in low], sides, BOTTOM)
    top = _revolve([(radius * c, radius * s + half_length, c, s) for c, s in high], sides, TOP)
    middle = [(radius, height, 1.0, 0.0) for height in (-half_length, half_length)]
    return merge([bottom, _revolve(middle, sides, SIDE), top])


@functools.lru_cache(maxsize=256)
def arrow(kind: int, size: tuple[float, float, float], sides: int) -> ShapeMesh:
    """Return one of MuJoCo's three arrows along z (`renderGeom` in render_gl3.c)."""
    step = size[2] / (3.0 if kind == ARROW2 else 6.0)
    wide = 1.0 if kind == ARROW1 else 1.75
    if kind == ARROW2:
        shaft = _scaled(cylinder(sides, 1, is_open=True), (size[0], size[1], step), 0.0)
        heads = [_cone(size, wide, 0.5 * step, sign * step, sign, sides) for sign in (-1.0, 1.0)]
        return merge([shaft, *heads])
    shaft = _scaled(cylinder(sides, 1), (size[0], size[1], step), step)
    return merge([shaft, _cone(size, wide, step, 2.0 * step, 1.0, sides)])


def _scaled(mesh: ShapeMesh, scale: tuple[float, float, float], height: float) -> ShapeMesh:
    corners = mesh.corners * np.array(scale, np.float64) + (0.0, 0.0, height)
    normals = unit(mesh.normals / np.maximum(np.array(scale, np.float64), 1e-12))
    return ShapeMesh.of(corners, normals, mesh.faces)


def _cone(
    size: tuple[float, float, float], wide: float, length: float, height: float, sign: float, sides: int
) -> ShapeMesh:
    """Return the head of an arrow: an open cone from `height` upwards (sign 1) or downwards (sign -1)."""
    slope = math.sqrt(0.5)
    cone = _revolve([(1.0, 0.0, slope, slope), (0.0, 1.0, slope, slope)], sides, FLAT)
    scale = np.array((wide * size[0], wide * size[1], length))
    flip = np.array((1.0, sign, sign))  # a half turn about x
    normals = unit(cone.normals / np.maximum(scale, 1e-12)) * flip
    return ShapeMesh.of(cone.corners * scale * flip + (0.0, 0.0, height), normals, cone.faces)


@functools.lru_cache(maxsize=64)
def triangle(width: float, height: float) -> ShapeMesh:
    """Return MuJoCo's triangle, which has two sides."""
    corners = np.array(((0.0, 0.0, 0.0), (width, 0.0, 0.0), (0.0, height, 0.0)))
    return ShapeMesh.of(corners, np.tile((0.0, 0.0, 1.0), (3, 1)), np.array(((0, 1, 2), (0, 2, 1))))
