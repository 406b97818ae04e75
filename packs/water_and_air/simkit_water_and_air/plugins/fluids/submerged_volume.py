"""Volume and centre of the part of a solid below a plane; the result is exact for any slope of the plane."""

from __future__ import annotations

import itertools
import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeVar

import numpy as np

from simkit.elementary_functions import arccos
from simkit.extend import Box, Cylinder, Sphere, Vector
from simkit.linear_algebra import matmul
from simkit.scene import Capsule, Cone, Ellipsoid, Geometry, Mesh, Polyline

Height = TypeVar("Height", float, Vector)

Triangles = Vector
"""Corners of triangles, counter-clockwise if seen from outside, shape (n, 3, 3)."""


Part = tuple[float, float, float, float]
"""Volume [m³], and the x, y, z components of volume times centre [m⁴]."""


class Solid(ABC):
    """Solid shape; all coordinates are in the frame of the shape.

    Attributes:
        volume: Volume [m³].
        centre: Centre of the volume [m], shape (3,).
        reach: Upper bound of the distance from the centre to any point of the volume [m].
    """

    volume: float
    centre: Vector
    reach: float

    @abstractmethod
    def cut(self, x: float, y: float, z: float, height: float) -> Part:
        """Compute the part of the solid below a plane.

        The arguments are Python floats, because arrays are many times slower for a few hulls.

        Args:
            x: X component of the plane's unit normal.
            y: Y component of the normal.
            z: Z component of the normal.
            height: Distance of the plane from the origin along the normal [m].

        Returns:
            The volume of the part [m³], and its volume times its centre [m⁴].
        """


class EllipsoidSolid(Solid):
    """Ellipsoid with its centre at the origin and its axes along x, y, z."""

    def __init__(self, radii: tuple[float, float, float]) -> None:
        self._radii = x, y, z = radii
        self.volume = 4 / 3 * math.pi * x * y * z
        self.centre, self.reach = np.zeros(3), max(radii)

    def cut(self, x: float, y: float, z: float, height: float) -> Part:
        """Compute the part below a plane: transform the ellipsoid to a unit ball, and cut a cap from the ball."""
        rx, ry, rz = self._radii
        sx, sy, sz = rx * x, ry * y, rz * z
        length = math.sqrt(sx * sx + sy * sy + sz * sz)
        depth = min(max(height / length + 1.0, 0.0), 2.0)  # height of the cap of the unit ball, 0 to 2
        volume = depth * depth * (3.0 - depth) / 4.0 * self.volume
        out = -0.75 * (2.0 - depth) ** 2 / (3.0 - depth) * volume / length
        return volume, out * rx * sx, out * ry * sy, out * rz * sz


class Polyhedron(Solid):
    """Solid with a surface of triangles.

    Attributes:
        corners: Corners of the triangles, shape (n, 3, 3).
    """

    def __init__(self, triangles: Triangles) -> None:
        self.corners = np.ascontiguousarray(triangles, float)
        volume, moment = _enclosed(self.corners)
        if volume < 0:  # the normals of the triangles point inwards
            self.corners = np.ascontiguousarray(self.corners[:, ::-1])
        self.volume = abs(volume)
        self.centre = moment / volume if self.volume > 0 else np.zeros(3)
        away = self.corners.reshape(-1, 3) - self.centre
        self.reach = float(np.sqrt((away * away).sum(axis=1).max())) if len(away) else 0.0
        first, second, third = self.corners.transpose(1, 0, 2)
        self._areas = np.cross(second - first, third - first) / 2  # outward normal times area, shape (n, 3)
        self._is_small = len(self.corners) <= _FEW
        self._by_corner = np.ascontiguousarray(self.corners.transpose(1, 0, 2)), self.corners.sum(axis=1)
        if self._is_small:
            points, places = np.unique(self.corners.reshape(-1, 3), axis=0, return_inverse=True)
            self._points = [tuple(point) for point in points.tolist()]
            rows = zip(places.reshape(-1, 3).tolist(), self._areas.tolist(), strict=True)
            self._faces = [(*corners, *area) for corners, area in rows]

    def cut(self, x: float, y: float, z: float, height: float) -> Part:
        return (self._cut_few if self._is_small else self._cut_many)(x, y, z, height)

    def _cut_few(self, x: float, y: float, z: float, height: float) -> Part:
        points = self._points
        over = [x * px + y * py + z * pz - height for px, py, pz in points]
        # d, e, f: heights of the three corners above the plane; lean: twice the integral of the height over the part
        volume = mx = my = mz = lean = 0.0
        for i, j, k, ax, ay, az in self._faces:
            d, e, f = over[i], over[j], over[k]
            flux = x * ax + y * ay + z * az
            dry = (d > 0) + (e > 0) + (f > 0)
            if dry == 3 or flux == 0.0:
                continue
            (px, py, pz), (qx, qy, qz), (rx, ry, rz) = points[i], points[j], points[k]
            if dry <= 1:
                total = d + e + f
                volume += flux * total / 3
                twelfth = flux / 12
                mx += twelfth * ((px + qx + rx) * total + px * d + qx * e + rx * f)
                my += twelfth * ((py + qy + ry) * total + py * d + qy * e + ry * f)
                mz += twelfth * ((pz + qz + rz) * total + pz * d + qz * e + rz * f)
                lean += twelfth * (total * total + d * d + e * e + f * f)
            if dry == 0:
                continue
            # the plane cuts off a tip with one corner: a tip below the plane is added, a tip above it is subtracted
            is_alone_dry = dry == 1
            if (d > 0) != is_alone_dry:
                if (e > 0) == is_alone_dry:
                    d, e, f, px, py, pz, qx, qy, qz, rx, ry, rz = e, f, d, qx, qy, qz, rx, ry, rz, px, py, pz
                else:
                    d, e, f, px, py, pz, qx, qy, qz, rx, ry, rz = f, d, e, rx, ry, rz, px, py, pz, qx, qy, qz
            u, v = d / (d - e), d / (d - f)  # fractions of the tip's two edges at which the plane cuts them
            flux *= -u * v if is_alone_dry else u * v
            volume += flux * d / 3
            twelfth = flux * d / 12
            mx += twelfth * (4 * px + u * (qx - px) + v * (rx - px))
            my += twelfth * (4 * py + u * (qy - py) + v * (ry - py))
            mz += twelfth * (4 * pz + u * (qz - pz) + v * (rz - pz))
            lean += twelfth * 2 * d
        lean /= 2
        return volume, mx - x * lean, my - y * lean, mz - z * lean

    def _cut_many(self, x: float, y: float, z: float, height: float) -> Part:
        normal = np.array((x, y, z))
        by_corner, sums = self._by_corner
        over, flux = (
            matmul(by_corner, normal) - height,
            matmul(self._areas, normal),
        )  # for n triangles: shapes (3, n) and (n,)
        is_above = over > 0
        dry, total = is_above.sum(axis=0), over.sum(axis=0)
        shares = np.where(dry <= 1, flux / 12, 0.0)
        volume = 4 * float(matmul(shares, total))
        moment = matmul(shares * total, sums) + matmul((shares * over).ravel(), by_corner.reshape(-1, 3))
        lean = float(matmul(shares, total * total + (over * over).sum(axis=0)))
        split = np.flatnonzero((dry == 1) | (dry == 2))
        if len(split):
            is_one_dry = dry[split] == 1
            alone = (is_above[:, split] == is_one_dry).argmax(axis=0)
            order = (alone[:, None] + _TURN) % 3
            corners, levels = by_corner[order, split[:, None]], over[order, split[:, None]]
            first = levels[:, 0]
            parts = first[:, None] / (first[:, None] - levels[:, 1:])
            shares = flux[split] * parts[:, 0] * parts[:, 1] * np.where(is_one_dry, -1.0, 1.0) * first / 12
            volume += 4 * float(shares.sum())
            edges = parts[:, :, None] * (corners[:, 1:] - corners[:, :1])
            moment += matmul(shares, 4 * corners[:, 0] + edges.sum(axis=1))
            lean += 2 * float(matmul(shares, first))
        mx, my, mz = (moment - normal * (lean / 2)).tolist()
        return volume, mx, my, mz


def _enclosed(corners: Triangles) -> tuple[float, Vector]:
    """Return the volume [m³] and volume times centre [m⁴] inside triangles.

    Both are sums over tetrahedra, each with a triangle as base and the origin as tip.
    """
    a, b, c = corners.transpose(1, 2, 0)
    sixth = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    sixth /= 6.0
    return float(sixth.sum()), matmul(corners.sum(axis=1).T, sixth / 4)


@dataclass(frozen=True, slots=True)
class RevolvedSegment:
    """Segment of a solid of revolution about the z axis, with radius² = a + b·z + c·z² from z = `low` to `high`."""

    low: float
    high: float
    a: float
    b: float
    c: float

    def square(self, z: Height) -> Height:
        """Return radius² [m²] at height z."""
        return self.a + z * (self.b + z * self.c)

    def between(self, middle: float, half: float) -> tuple[float, float]:
        """Return the volume [m³] from z = middle − half to middle + half, and the volume integral of z [m⁴]."""
        slope, third = self.b + 2 * self.c * middle, half * half / 3
        volume = 2 * math.pi * half * (self.square(middle) + self.c * third)
        return volume, volume * middle + 2 * math.pi * half * slope * third


_TURN = np.arange(3)
_FEW: Final = 48  # triangles; up to this number of triangles, a loop is faster than arrays
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)
# with z = sin θ, the area below the plane is a smooth function of θ also where the plane touches the rim of a disc
_PLACES: Final = np.sin(_NODES * math.pi / 2)
_SHARES: Final = _WEIGHTS * np.cos(_NODES * math.pi / 2) * math.pi / 2


class SolidOfRevolution(Solid):
    """Solid of revolution about the z axis, made of segments."""

    def __init__(self, segments: tuple[RevolvedSegment, ...]) -> None:
        self._segments = segments
        self.centre, self.volume, self.reach = np.zeros(3), 0.0, math.inf
        self.volume, *moment = self.cut(0.0, 0.0, 1.0, math.inf)
        self.centre = np.array(moment) / self.volume
        ends = [
            (z - self.centre[2]) ** 2 + max(s.a + z * (s.b + z * s.c), 0.0)
            for s in segments
            for z in np.linspace(s.low, s.high, 33).tolist()
        ]
        self.reach = math.sqrt(max(ends)) * 1.01

    def cut(self, x: float, y: float, z: float, height: float) -> Part:
        aside = math.hypot(x, y)
        volume = out = up = 0.0
        for segment in self._segments:
            for low, high in itertools.pairwise(_bounds(segment, z, aside, height)):
                middle, half = (low + high) / 2, (high - low) / 2
                room, edge = height - z * middle, aside * math.sqrt(max(segment.square(middle), 0.0))
                if room >= edge:  # all discs of this interval are below the plane
                    added, upwards = segment.between(middle, half)
                    volume += added
                    up += upwards
                elif room > -edge:
                    places = middle + half * _PLACES
                    squares = np.maximum(segment.square(places), 0.0)
                    areas, moments = _segments(squares, height - z * places, aside)
                    volume += half * float(matmul(areas, _SHARES))
                    up += half * float(matmul(areas, places * _SHARES))
                    out += half * float(matmul(moments, _SHARES))
        if aside > 0:
            out /= aside
        return volume, out * x, out * y, up


def _segments(squares: Vector, room: Vector, aside: float) -> tuple[Vector, Vector]:
    """Compute the part of discs below the plane: the points with aside · u <= room.

    Args:
        squares: Square of the radius of each disc [m²].
        room: Distance of the plane from the centre of each disc, along the plane's normal [m].
        aside: Horizontal component of the plane's unit normal; u is the coordinate in its direction.

    Returns:
        Areas [m²], and areas times the u coordinate of their centres [m³].
    """
    radii = np.sqrt(squares)
    cut = np.clip(room / np.maximum(aside * radii, 1e-300), -1.0, 1.0)
    rest = 1.0 - cut * cut
    root = np.sqrt(rest)
    areas = squares * (arccos(-cut) + cut * root)
    return areas, -2 / 3 * squares * radii * rest * root


def _bounds(segment: RevolvedSegment, up: float, aside: float, height: float) -> list[float]:
    """Return the lower and upper z of a segment, and each z between them at which the plane touches the rim of a disc.

    These z are the roots of (height − up·z)² = aside²·radius².
    """
    crossings = []
    if math.isfinite(height):
        s = aside * aside
        a, b, c = up * up - s * segment.c, -2 * height * up - s * segment.b, height * height - s * segment.a
        crossings = [z for z in _roots(a, b, c) if segment.low < z < segment.high]
    return [segment.low, *sorted(crossings), segment.high]


def _roots(a: float, b: float, c: float) -> list[float]:
    """Return the real roots of a z² + b z + c."""
    if abs(a) < 1e-14:
        return [-c / b] if abs(b) > 1e-14 else []
    inside = b * b - 4 * a * c
    if inside < 0:
        # for a plane that is tangent to a cone, there is a double root, which rounding errors may hide
        return [-b / (2 * a)] if inside > -1e-12 * b * b else []
    half = -(b + math.copysign(math.sqrt(inside), b)) / 2
    return [half / a, c / half] if half else [0.0]


def solid_of(shape: Geometry, triangles: Callable[[Geometry], Triangles | None]) -> Solid | None:
    """Return the solid of a shape; None for shapes without a volume (plane, heightmap, open mesh).

    Args:
        shape: Geometry of a collision.
        triangles: Function that returns the triangles of a mesh or an extruded outline; None without a volume.
    """
    match shape:
        case Box(size=(x, y, z)):
            return Polyhedron(_box(x / 2, y / 2, z / 2))
        case Sphere(radius=r):
            return EllipsoidSolid((r, r, r))
        case Ellipsoid(radii=radii):
            return EllipsoidSolid(radii)
        case Cylinder(radius=r, length=h):
            return SolidOfRevolution((RevolvedSegment(-h / 2, h / 2, r * r, 0.0, 0.0),))
        case Capsule(radius=r, length=h):
            e = h / 2  # radius² = r² − (|z| − e)² on the caps
            caps = [
                RevolvedSegment(*ends, r * r - e * e, k * 2 * e, -1.0)
                for ends, k in (((-e - r, -e), -1), ((e, e + r), 1))
            ]
            return SolidOfRevolution((caps[0], RevolvedSegment(-e, e, r * r, 0.0, 0.0), caps[1]))
        case Cone(radius=r, length=h):
            k = r / h  # radius = k (h/2 − z)
            return SolidOfRevolution((RevolvedSegment(-h / 2, h / 2, k * k * h * h / 4, -k * k * h, k * k),))
        case Mesh() | Polyline():
            corners = triangles(shape)
            solid = None if corners is None or not len(corners) else Polyhedron(corners)
            return solid if solid is not None and solid.volume > 1e-15 else None
    return None


def _box(x: float, y: float, z: float) -> Triangles:
    """Return the twelve triangles of a box from its half sizes."""
    triangles = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (-1.0, 1.0):
            corners = np.zeros((4, 3))
            corners[:, axis] = side
            corners[:, u], corners[:, v] = (-1, 1, 1, -1), (-1, -1, 1, 1)
            quad = corners if side > 0 else corners[::-1]
            triangles += [quad[[0, 1, 2]], quad[[0, 2, 3]]]
    return np.array(triangles) * (x, y, z)
