"""Exact depth of round shapes: the surface of spheres, ellipsoids, cylinders and capsules instead of their triangles.

A point at depth z of the pixel (x, y) is eye + z·(ahead + x·right + y·up). On a quadric, z solves a·z² + 2·b·z + c = 0
with a quadratic and b linear in (x, y). The nearer solution has the reciprocal -b/c + √((b/c)² - a/c) for c > 0, that
is, for an eye outside of the quadric.
"""

from __future__ import annotations

import numpy as np

from simkit.sensors.cameras.rendering.software import shape_meshes
from simkit.sensors.cameras.rendering.software.frame import Frame, reciprocals_of
from simkit.sensors.cameras.rendering.software.rasteriser import draw_numbers, nearer
from simkit.sensors.cameras.rendering.software.shape_table import ShapeTable
from simkit.sensors.cameras.rendering.software.triangles import Triangles
from simkit.sensors.cameras.rendering.software.vectors import Array, Floats, rotate

_PARTS = 4
_NEAREST = 0.15
"""Largest relative difference between the surface and its triangles; a larger one is at the edge of the surface."""
_EXACT = (shape_meshes.SPHERE, shape_meshes.ELLIPSOID, shape_meshes.CYLINDER, shape_meshes.CAPSULE)


def exact_depths(frame: Frame, table: ShapeTable, triangles: Triangles, keys: Floats) -> tuple[Array, Array]:
    """Return the pixels that show a round surface, as flat indices, and their reciprocal depths [1/m].

    Args:
        frame: pose and frustum of the image.
        table: shapes of the scene.
        triangles: triangles of the image.
        keys: keys after all triangles were drawn, shape (height, width).
    """
    is_round = np.isin(table.kinds, _EXACT)
    first = triangles.faces[:, 0]
    faces = triangles.faces[is_round[triangles.owners[first]] & (triangles.parts[first] != shape_meshes.FLAT)]
    if not len(faces):
        return np.zeros(0, np.intp), np.zeros(0)
    image = np.zeros((*keys.shape, 3), np.float32)
    numbers = triangles.owners * _PARTS + triangles.parts
    draw_numbers(frame, triangles.points, faces, numbers, image, nearer(keys))
    number = image[..., 0].ravel()
    pixels = np.flatnonzero(number)
    part_numbers = number[pixels].astype(np.intp)
    if not len(part_numbers):
        return pixels, np.zeros(0)
    counts = np.bincount(part_numbers)
    used = np.flatnonzero(counts)
    row_of = np.zeros(len(counts), np.intp)
    row_of[used] = np.arange(len(used))
    rows = row_of[part_numbers]
    terms = np.array([_terms(frame, table, int(use) // _PARTS, int(use) % _PARTS) for use in used])
    width = keys.shape[1]
    x, y = frame.columns()[pixels % width], frame.rows()[pixels // width]
    straight, xs, ys, square, cx, cy, xx, yy, xy = (terms[:, k].take(rows) for k in range(9))
    linear = straight + xs * x + ys * y
    inside = square + (cx + xx * x + xy * y) * x + (cy + yy * y) * y
    with np.errstate(invalid="ignore"):
        exact = linear + np.sqrt(inside)
    rough = reciprocals_of(keys.ravel()[pixels])
    good = np.abs(exact - rough) <= _NEAREST * rough  # False for NaN
    return pixels[good], exact[good]


def _terms(frame: Frame, table: ShapeTable, row: int, part: int) -> list[float]:
    """Return the coefficients of -b/c and of (b/c)² - a/c in 1, x, y and in 1, x, y, x², y², xy."""
    rotation = table.rotations[row].astype(np.float64)
    size = table.sizes[row].astype(np.float64)
    offset = frame.eye - (table.positions[row].astype(np.float64) - frame.origin)
    kind = int(table.kinds[row])
    # the four vectors in the frame of the shape
    local = rotate(np.stack((offset, frame.ahead, frame.right, frame.up)), rotation.T)
    if kind == shape_meshes.CAPSULE:
        local[0, 2] += {shape_meshes.TOP: -size[2], shape_meshes.BOTTOM: size[2]}.get(part, 0.0)
        size = np.full(3, size[0])
    local = local / np.maximum(size, 1e-12)
    is_tube = kind == shape_meshes.CYLINDER or (kind == shape_meshes.CAPSULE and part == shape_meshes.SIDE)
    o, d, u, v = ([float(x) for x in (vector[:2] if is_tube else vector)] for vector in local)
    c = _product(o, o) - 1.0
    if c <= 0.0:
        return [float("nan")] * 9
    b = [-_product(o, vector) / c for vector in (d, u, v)]
    a = [
        _product(d, d), 2.0 * _product(d, u), 2.0 * _product(d, v), _product(u, u), _product(v, v), 2.0 * _product(u, v)
    ]  # fmt: skip
    squares = [b[0] * b[0], 2.0 * b[0] * b[1], 2.0 * b[0] * b[2], b[1] * b[1], b[2] * b[2], 2.0 * b[1] * b[2]]
    return [*b, *(square - part / c for square, part in zip(squares, a, strict=True))]


def _product(a: list[float], b: list[float]) -> float:
    total = 0.0
    for x, y in zip(a, b, strict=True):
        total += x * y
    return total
