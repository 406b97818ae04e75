"""How much of a solid lies below a plane, and where the middle of that is: exact, at any slant.

Polyhedra by the divergence theorem: the sum over triangles of tetrahedra from a point of the plane, so that the cut
face itself adds nothing. Balls and ellipsoids in closed form. Cylinders, capsules and cones as stacks of discs, each
cut to a segment of a circle; the integral along the axis is taken between the heights at which the plane enters and
leaves the discs, with nodes that crowd there: that leaves an error of about 1e-9 of the volume.
"""

from __future__ import annotations

import itertools
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from simkit.pose import Vector
from simkit.scene import Box, Capsule, Cone, Cylinder, Ellipsoid, Geometry, Mesh, Polyline, Sphere

Triangles = Vector
"""Corners of triangles, counter-clockwise seen from outside, shape (n, 3, 3)."""


class Solid(ABC):
    """A body that takes up space. Lengths in its own frame.

    Attributes:
        volume: [m³].
        centre: of the volume [m], shape (3,).
        reach: from the centre to its farthest point at most [m].
    """

    volume: float
    centre: Vector
    reach: float

    @abstractmethod
    def below(self, normal: Vector, height: float) -> tuple[float, Vector]:
        """The part with normal · x <= height.

        Args:
            normal: unit vector, shape (3,).
            height: [m].

        Returns:
            Its volume [m³], and its volume times its centre [m⁴], shape (3,).
        """


class Ball(Solid):
    """An ellipsoid about the origin."""

    def __init__(self, radii: tuple[float, float, float]) -> None:
        self._radii = x, y, z = radii
        self.volume = 4 / 3 * math.pi * x * y * z
        self.centre, self.reach = np.zeros(3), max(radii)

    def below(self, normal: Vector, height: float) -> tuple[float, Vector]:
        """As of the unit ball, which stretching along the axes makes this of."""
        (rx, ry, rz), (nx, ny, nz) = self._radii, normal.tolist()
        sx, sy, sz = rx * nx, ry * ny, rz * nz
        length = math.sqrt(sx * sx + sy * sy + sz * sz)
        depth = min(max(height / length + 1.0, 0.0), 2.0)  # of the cap, in a ball of radius 1
        volume = depth * depth * (3.0 - depth) / 4.0 * self.volume
        out = -0.75 * (2.0 - depth) ** 2 / (3.0 - depth) * volume / length
        return volume, np.array((out * rx * sx, out * ry * sy, out * rz * sz))


class Polyhedron(Solid):
    """What triangles enclose.

    Attributes:
        corners: of the triangles.
    """

    def __init__(self, triangles: Triangles) -> None:
        self.corners = np.ascontiguousarray(triangles, float)
        first = np.zeros(len(triangles), dtype=np.intp)
        volumes, moments = _enclosed(self.corners, first, np.zeros((1, 3)))
        if volumes[0] < 0:  # turned inside out
            self.corners = np.ascontiguousarray(self.corners[:, ::-1])
        self.volume = abs(float(volumes[0]))
        self.centre = moments[0] / volumes[0] if self.volume > 0 else np.zeros(3)
        away = self.corners.reshape(-1, 3) - self.centre
        self.reach = float(np.sqrt((away * away).sum(axis=1).max())) if len(away) else 0.0

    def below(self, normal: Vector, height: float) -> tuple[float, Vector]:
        volumes, moments = polyhedra_below([self], normal[None, :], np.array((height,)))
        return float(volumes[0]), moments[0]


def polyhedra_below(solids: Sequence[Polyhedron], normals: Vector, heights: Vector) -> tuple[Vector, Vector]:
    """`Polyhedron.below` of many at once.

    Args:
        solids: k of them.
        normals: unit vectors, shape (k, 3).
        heights: [m], shape (k,).

    Returns:
        Volumes, shape (k,), and volumes times their centres, shape (k, 3).
    """
    corners = np.concatenate([solid.corners for solid in solids])
    owners = np.repeat(np.arange(len(solids)), [len(solid.corners) for solid in solids])
    above = (corners * normals[owners][:, None, :]).sum(axis=2) - heights[owners][:, None]  # shape (triangles, 3)
    dry = (above > 0).sum(axis=1)
    is_wet, is_split = dry <= 1, (dry == 1) | (dry == 2)  # of those with one corner above, its tip is taken off again
    tips = _tips(corners[is_split], above[is_split], dry[is_split])
    pieces = np.concatenate([corners[is_wet], tips])
    signs = np.ones(len(pieces))
    signs[len(pieces) - len(tips) :] -= 2.0 * (dry[is_split] == 1)
    whose = np.concatenate([owners[is_wet], owners[is_split]])
    return _enclosed(pieces, whose, normals * heights[:, None], signs)


def _enclosed(
    corners: Triangles, owners: npt.NDArray[np.intp], origins: Vector, signs: Vector | None = None
) -> tuple[Vector, Vector]:
    """Volumes and their moments, by owner, of the tetrahedra from the owner's origin to triangles, by their signs."""
    count, away = len(origins), corners - origins[owners][:, None, :]
    a, b, c = away.transpose(1, 2, 0)
    sixth = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    sixth /= 6.0
    if signs is not None:
        sixth *= signs
    volumes = np.asarray(np.bincount(owners, sixth, count), float)
    quarters = away.sum(axis=1) * (sixth / 4)[:, None]
    moments = np.stack([np.bincount(owners, quarters[:, axis], count) for axis in range(3)], axis=1)
    return volumes, moments + volumes[:, None] * origins


def _tips(corners: Triangles, above: Vector, dry: npt.NDArray[np.intp]) -> Triangles:
    """Of triangles that a plane cuts, the piece at the corner that is alone on its side."""
    is_above = above > 0
    first = np.where(dry[:, None] == 1, is_above, ~is_above).argmax(axis=1)
    order = (first[:, None] + _TURN) % 3
    rows = np.arange(len(corners))[:, None]
    turned: Triangles = corners[rows, order]
    levels = above[rows, order]
    parts = levels[:, :1] / (levels[:, :1] - levels[:, 1:])  # of the edges, up to the plane
    turned[:, 1:] = turned[:, :1] + parts[:, :, None] * (turned[:, 1:] - turned[:, :1])
    return turned


@dataclass(frozen=True, slots=True)
class Stretch:
    """A part of a solid of revolution about z: radius² = a + b·z + c·z² from `low` to `high`."""

    low: float
    high: float
    a: float
    b: float
    c: float


_TURN = np.arange(3)
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)
# θ from -90° to 90°, z = sin θ: where a disc only just gets wet, the area is smooth in θ
_PLACES: Final = np.sin(_NODES * math.pi / 2)
_SHARES: Final = _WEIGHTS * np.cos(_NODES * math.pi / 2) * math.pi / 2


class Spindle(Solid):
    """A solid of revolution about z."""

    def __init__(self, stretches: tuple[Stretch, ...]) -> None:
        self._stretches = stretches
        self.centre, self.volume, self.reach = np.zeros(3), 0.0, math.inf
        self.volume, moment = self.below(np.array((0.0, 0.0, 1.0)), math.inf)
        self.centre = moment / self.volume
        ends = [
            (z - self.centre[2]) ** 2 + max(s.a + z * (s.b + z * s.c), 0.0)
            for s in stretches
            for z in np.linspace(s.low, s.high, 33).tolist()
        ]
        self.reach = math.sqrt(max(ends)) * 1.01

    def below(self, normal: Vector, height: float) -> tuple[float, Vector]:
        up, aside = float(normal[2]), math.hypot(normal[0], normal[1])
        parts = []
        for stretch in self._stretches:
            bounds = _bounds(stretch, up, aside, height)
            parts += [(*ends, stretch.a, stretch.b, stretch.c) for ends in itertools.pairwise(bounds)]
        low, high, a, b, c = np.array(parts).T[:, :, None]
        half = (high - low) / 2
        z = (low + high) / 2 + half * _PLACES
        areas, moments = _segments(np.maximum(a + z * (b + z * c), 0.0), height - up * z, aside)
        shares = half * _SHARES
        wet = shares * areas
        out = float((shares * moments).sum()) / aside if aside > 0 else 0.0
        return float(wet.sum()), np.array((out * normal[0], out * normal[1], (wet * z).sum()))


def _segments(squares: Any, room: Any, aside: float) -> tuple[Any, Any]:
    """Of discs of radius² `squares`, the part with aside · u <= room: areas, and areas times their middle in u."""
    radii = np.sqrt(squares)
    cut = np.clip(room / np.maximum(aside * radii, 1e-300), -1.0, 1.0)
    rest = 1.0 - cut * cut
    root = np.sqrt(rest)
    areas = squares * (np.arccos(-cut) + cut * root)
    return areas, -2 / 3 * squares * radii * rest * root


def _bounds(stretch: Stretch, up: float, aside: float, height: float) -> list[float]:
    """Where along the axis the plane enters or leaves the discs, with both ends: (height − up·z)² = aside²·radius²."""
    found = []
    if math.isfinite(height):
        s = aside * aside
        a, b, c = up * up - s * stretch.c, -2 * height * up - s * stretch.b, height * height - s * stretch.a
        found = [z for z in _roots(a, b, c) if stretch.low < z < stretch.high]
    return [stretch.low, *sorted(found), stretch.high]


def _roots(a: float, b: float, c: float) -> list[float]:
    """Real roots of a z² + b z + c."""
    if abs(a) < 1e-14:
        return [-c / b] if abs(b) > 1e-14 else []
    inside = b * b - 4 * a * c
    if inside < 0:
        # a plane across the axis touches every disc at once: rounding must not lose that
        return [-b / (2 * a)] if inside > -1e-12 * b * b else []
    half = -(b + math.copysign(math.sqrt(inside), b)) / 2
    return [half / a, c / half] if half else [0.0]


def all_below(solids: Sequence[Solid], normals: Vector, heights: Vector) -> tuple[Vector, Vector]:
    """`Solid.below` of many; arguments and results as of `polyhedra_below`."""
    volumes, moments = np.empty(len(solids)), np.empty((len(solids), 3))
    faceted = [i for i, solid in enumerate(solids) if isinstance(solid, Polyhedron)]
    if faceted:
        of_them = [solid for solid in solids if isinstance(solid, Polyhedron)]
        volumes[faceted], moments[faceted] = polyhedra_below(of_them, normals[faceted], heights[faceted])
    for i, solid in enumerate(solids):
        if not isinstance(solid, Polyhedron):
            volumes[i], moments[i] = solid.below(normals[i], float(heights[i]))
    return volumes, moments


def solid_of(shape: Geometry, triangles: Callable[[Geometry], Triangles | None]) -> Solid | None:
    """The solid that a shape is; None for what takes up no space (a plane, a heightmap, an open mesh).

    Args:
        shape: of a collision.
        triangles: gives those of a mesh or an extruded outline.
    """
    match shape:
        case Box(size=(x, y, z)):
            return Polyhedron(_box(x / 2, y / 2, z / 2))
        case Sphere(radius=r):
            return Ball((r, r, r))
        case Ellipsoid(radii=radii):
            return Ball(radii)
        case Cylinder(radius=r, length=h):
            return Spindle((Stretch(-h / 2, h / 2, r * r, 0.0, 0.0),))
        case Capsule(radius=r, length=h):
            e = h / 2  # radius² = r² − (|z| − e)² on the caps
            caps = [Stretch(*ends, r * r - e * e, k * 2 * e, -1.0) for ends, k in (((-e - r, -e), -1), ((e, e + r), 1))]
            return Spindle((caps[0], Stretch(-e, e, r * r, 0.0, 0.0), caps[1]))
        case Cone(radius=r, length=h):
            k = r / h  # radius = k (h/2 − z)
            return Spindle((Stretch(-h / 2, h / 2, k * k * h * h / 4, -k * k * h, k * k),))
        case Mesh() | Polyline():
            found = triangles(shape)
            solid = None if found is None or not len(found) else Polyhedron(found)
            return solid if solid is not None and solid.volume > 1e-15 else None
    return None


def _box(x: float, y: float, z: float) -> Triangles:
    """A box of half sizes, as twelve triangles."""
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
