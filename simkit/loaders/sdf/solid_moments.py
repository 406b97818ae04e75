"""Volume, centroid and moments of solids of density 1, for automatic inertia."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from simkit.loaders.resources.loader import Triangles
from simkit.scene import Box, Capsule, Cone, Cylinder, Ellipsoid, Geometry, Polyline, Sphere

Floats = npt.NDArray[np.float64]
Solid = tuple[float, Floats, Floats]
Outline = Sequence[tuple[float, float]]


def solid_of(shape: Geometry) -> Solid | None:
    """Return volume [m³], centroid [m] and moments [m⁵] about the centroid, in the shape's frame.

    The result is None for a shape without volume.
    """
    centre = np.zeros(3)
    match shape:
        case Box(size=(x, y, z)):
            v = x * y * z
            return v, centre, np.diag((y * y + z * z, x * x + z * z, x * x + y * y)) * (v / 12)
        case Sphere(radius=r):
            v = 4 / 3 * math.pi * r * r * r
            return v, centre, np.eye(3) * (0.4 * v * r * r)
        case Ellipsoid(radii=(a, b, c)):
            v = 4 / 3 * math.pi * a * b * c
            return v, centre, np.diag((b * b + c * c, a * a + c * c, a * a + b * b)) * (v / 5)
        case Cylinder(radius=r, length=h):
            v = math.pi * r * r * h
            side = v * (3 * r * r + h * h) / 12
            return v, centre, np.diag((side, side, v * r * r / 2))
        case Capsule(radius=r, length=h):
            return _capsule(r, h)
        case Cone(radius=r, length=h):
            v = math.pi * r * r * h / 3
            side = v * (3 / 20 * r * r + 3 / 80 * h * h)
            return v, np.array((0.0, 0.0, -h / 4)), np.diag((side, side, 0.3 * v * r * r))
        case Polyline(outlines=outlines, height=h):
            return _extruded(outlines, h)
    return None


def _capsule(r: float, h: float) -> Solid:
    body, caps = math.pi * r * r * h, 4 / 3 * math.pi * r * r * r
    side = body * (h * h / 12 + r * r / 4) + caps * (0.4 * r * r + h * h / 4 + 3 * h * r / 8)
    return body + caps, np.zeros(3), np.diag((side, side, body * r * r / 2 + caps * 0.4 * r * r))


def solid_of_triangles(parts: Iterable[Triangles]) -> Solid | None:
    """Return the solid inside closed surfaces, as a signed sum over tetrahedra; None if they enclose no volume.

    All tetrahedra have one corner at the origin. The sign of the sum depends on the orientation of the faces and is
    ignored. Source: Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor", 2004.
    """
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for part in parts:
        corners = np.asarray(part.vertices, float)[np.asarray(part.faces)]
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        sixth = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
        middle = a + b + c
        volume += float(sixth.sum())
        first += (sixth[:, None] * middle).sum(axis=0) / 4
        products = sum((np.einsum("i,ij,ik->jk", sixth, p, p) for p in (a, b, c, middle)), np.zeros((3, 3)))
        second += products / 20
    if abs(volume) < 1e-15 or not math.isfinite(volume):
        return None
    return _about_centroid(volume, first / volume, second)


def _about_centroid(volume: float, centre: Floats, second: Floats) -> Solid:
    """Return a solid from its signed volume, its centroid, and the signed integral of position times position."""
    sign = math.copysign(1.0, volume)
    inner = sign * (second - volume * np.outer(centre, centre))
    return abs(volume), centre, np.trace(inner) * np.eye(3) - inner


def _extruded(outlines: Sequence[Outline], height: float) -> Solid | None:
    """Return the solid of outlines in x and y from z = 0 to `height`; an outline inside another is a hole."""
    area, first, second = 0.0, np.zeros(2), np.zeros((2, 2))
    for i, outline in enumerate(outlines):
        nesting = sum(_is_inside(outline[0], other) for j, other in enumerate(outlines) if j != i)
        a, f, s = _polygon(outline)
        sign = math.copysign(1.0, a) * (-1.0) ** nesting
        area, first, second = area + sign * a, first + sign * f, second + sign * s
    if not 1e-15 <= area < math.inf:
        return None
    centre = np.array((*(first / area), height / 2))
    moments = np.zeros((3, 3))
    moments[:2, :2] = second * height
    moments[:2, 2] = moments[2, :2] = first * height * height / 2
    moments[2, 2] = area * height * height * height / 3
    return _about_centroid(area * height, centre, moments)


def _polygon(outline: Outline) -> tuple[float, Floats, Floats]:
    """Return the signed area, and the integrals of position and of position times position (Green's theorem)."""
    p = np.asarray(outline, float)
    q = np.roll(p, -1, axis=0)
    cross = p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]
    middle = p + q
    products = sum((np.einsum("i,ij,ik->jk", cross, v, v) for v in (p, q, middle)), np.zeros((2, 2)))
    return float(cross.sum()) / 2, (cross[:, None] * middle).sum(axis=0) / 6, products / 24


def _is_inside(point: tuple[float, float], outline: Outline) -> bool:
    x, y = point
    crossings = 0
    for (ax, ay), (bx, by) in zip(outline, (*outline[1:], outline[0]), strict=True):
        if (ay > y) != (by > y) and x < (bx - ax) * (y - ay) / (by - ay) + ax:
            crossings += 1
    return crossings % 2 == 1
