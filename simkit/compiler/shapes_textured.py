"""Primitives that wear a picture, as triangles with texture coordinates. The picture stands upright on their sides."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from simkit.compiler.meshes.part import Floats, Ints, MeshPart
from simkit.scene import Box, Capsule, Cylinder, Ellipsoid, Geometry, Sphere

_AROUND: Final = 96
"""Sides of what is round: a cylinder's surface is 0.05 % of its radius inside the true one."""

_UP: Final = 48


def textured(shape: Geometry) -> MeshPart | None:
    """The shape as triangles with texture coordinates; None for shapes that are drawn as they are."""
    match shape:
        case Box(size=size):
            return MeshPart("box", *_box(np.asarray(size, float) / 2))
        case Sphere(radius=r):
            return MeshPart("sphere", *_round(np.array((r, r, r)), 0.0))
        case Ellipsoid(radii=radii):
            return MeshPart("ellipsoid", *_round(np.asarray(radii, float), 0.0))
        case Capsule(radius=r, length=h):
            return MeshPart("capsule", *_round(np.array((r, r, r)), h))
        case Cylinder(radius=r, length=h):
            return MeshPart("cylinder", *_cylinder(r, h / 2))
        case _:
            return None


def _box(half: Floats) -> tuple[Floats, Ints, Floats]:
    """Six sides, the whole picture on each; seen from outside, with z up (on top and below: y up)."""
    sides = [
        # outward normal, the picture's right, its up
        ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        ((-1, 0, 0), (0, -1, 0), (0, 0, 1)),
        ((0, 1, 0), (-1, 0, 0), (0, 0, 1)),
        ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
        ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
        ((0, 0, -1), (-1, 0, 0), (0, 1, 0)),
    ]
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    vertices = [
        [(np.array(n) + u * np.array(right) + v * np.array(up)) * half for u, v in corners] for n, right, up in sides
    ]
    faces = [(4 * i + a, 4 * i + b, 4 * i + c) for i in range(6) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    uv = np.tile(np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float), (6, 1))
    return np.array(vertices, float).reshape(-1, 3), np.array(faces, np.int32), uv


def _circle() -> tuple[Floats, Floats]:
    """Angles once around, and the points there; the last point is the first."""
    turn = np.linspace(0.0, 2.0 * np.pi, _AROUND + 1)
    points = np.column_stack([np.cos(turn), np.sin(turn)])
    points[-1] = points[0]
    return turn, points


def _grid(rows: Any, columns: int) -> Ints:
    """Triangles between rows of `columns` + 1 points, each row above the one before, counter-clockwise outside."""
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns), indexing="ij")
    a = (i * (columns + 1) + j).reshape(-1)
    b, c, d = a + 1, a + columns + 2, a + columns + 1
    return np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])]).astype(np.int32)


def _round(radii: Floats, length: float) -> tuple[Floats, Ints, Floats]:
    """A ball, stretched, its halves `length` apart; the picture goes once around and from pole to pole."""
    turn, circle = _circle()
    rise = np.linspace(-np.pi / 2, np.pi / 2, _UP + 1)
    height = radii[2] * np.sin(rise) + np.sign(rise) * length / 2
    ring = np.cos(rise)
    ring[[0, -1]] = 0.0
    if length > 0.0:  # the equator twice
        middle = _UP // 2
        ring = np.insert(ring, middle, ring[middle])
        height = np.insert(height, middle, -length / 2)
        height[middle + 1] = length / 2
    x, y = radii[0] * np.outer(ring, circle[:, 0]), radii[1] * np.outer(ring, circle[:, 1])
    z = np.repeat(height[:, None], len(turn), axis=1)
    u, v = np.meshgrid(turn / (2.0 * np.pi), (height - height[0]) / (height[-1] - height[0]))
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    faces = _grid(len(ring), _AROUND)
    lowest, highest = faces < _AROUND + 1, faces >= len(vertices) - (_AROUND + 1)
    faces = faces[(lowest.sum(axis=1) < 2) & (highest.sum(axis=1) < 2)]  # without those that end at a pole as a line
    return vertices, faces, np.stack([u, v], axis=-1).reshape(-1, 2)


def _cylinder(radius: float, half: float) -> tuple[Floats, Ints, Floats]:
    """The picture once around the side, and once on each end."""
    turn, ring = _circle()
    sides = [np.column_stack([radius * ring, np.full(len(turn), z)]) for z in (-half, half)]
    side_uv = [np.column_stack([turn / (2.0 * np.pi), np.full(len(turn), v)]) for v in (0.0, 1.0)]
    vertices, uv, faces = [*sides], [*side_uv], [_grid(2, _AROUND)]
    count = 2 * len(turn)
    for z, mirror in ((half, 1.0), (-half, -1.0)):
        vertices.append(np.vstack([np.column_stack([radius * ring, np.full(len(turn), z)]), (0.0, 0.0, z)]))
        uv.append(np.vstack([0.5 + 0.5 * ring * (mirror, 1.0), (0.5, 0.5)]))
        i = count + np.arange(_AROUND)
        middle = np.full(_AROUND, count + len(turn))
        faces.append(np.column_stack([i, i + 1, middle] if mirror > 0.0 else [i + 1, i, middle]).astype(np.int32))
        count += len(turn) + 1
    return np.vstack(vertices), np.vstack(faces).astype(np.int32), np.vstack(uv)
