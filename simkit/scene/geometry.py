"""Shapes. Lengths in metres.

Each shape is centred in its own frame. Its axis of symmetry is z; a plane has the normal that it specifies.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

Vec3 = tuple[float, float, float]


def vec3(values: Iterable[float]) -> Vec3:
    """Return three numbers, such as the elements of an array, as a tuple of Python's floats."""
    x, y, z = (float(v) for v in values)
    return x, y, z


def six(values: Iterable[float]) -> tuple[float, float, float, float, float, float]:
    """Return six numbers, such as the elements of an inertia tensor, as a tuple of Python's floats."""
    xx, yy, zz, xy, xz, yz = (float(v) for v in values)
    return xx, yy, zz, xy, xz, yz


@dataclass(frozen=True, slots=True)
class Box:
    """Box; `size` holds the full edge lengths along x, y, z [m]."""

    size: Vec3


@dataclass(frozen=True, slots=True)
class Sphere:
    """Sphere; `radius` in metres."""

    radius: float


@dataclass(frozen=True, slots=True)
class Cylinder:
    """Cylinder about z; `radius` and `length` in metres."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Capsule:
    """Cylinder with hemispherical caps; `length` is the length of the cylindrical part, without the caps."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Cone:
    """Cone with its base at z = -length/2 and its tip at z = +length/2."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Ellipsoid:
    """Ellipsoid; `radii` holds the semi-axes along x, y, z [m]."""

    radii: Vec3


@dataclass(frozen=True, slots=True)
class Plane:
    """Plane, infinite for collisions; `size` (x, y) [m] limits only the drawn area."""

    normal: Vec3 = (0.0, 0.0, 1.0)
    size: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True, slots=True)
class Mesh:
    """Mesh file, located and readable at load time.

    Attributes:
        file: absolute path.
        uri: URI, as written in the file.
        scale: scale factors along x, y, z.
        submesh: name of the one sub-mesh to use, or empty for all.
        center: true if that sub-mesh is moved to the origin.
        missing: true if the file does not exist; the shape is then left out, and a diagnostic has been recorded.
        optimization: treatment of a non-convex collision: "" (the compiler decides), "convex_hull" or
            "convex_decomposition".
        max_hulls: maximum number of pieces of a convex decomposition.
        bone: name of one bone of the file's skeleton. Only the triangles of that bone are used, in the bone's frame and
            before the file's unit is applied.
    """

    file: Path
    uri: str
    scale: Vec3 = (1.0, 1.0, 1.0)
    submesh: str = ""
    center: bool = False
    missing: bool = False
    optimization: str = ""
    max_hulls: int = 16
    bone: str = ""


@dataclass(frozen=True, slots=True)
class Heightmap:
    """Heights from the grey values of an image: black at z = 0, white at z = `size[2]`, centred in x and y.

    Attributes:
        file: absolute path.
        uri: URI, as written in the file.
        size: extent in x and y, and the height of white [m].
        position: position of its centre in the shape's frame [m].
    """

    file: Path
    uri: str
    size: Vec3 = (1.0, 1.0, 1.0)
    position: Vec3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Polyline:
    """Closed outlines in x and y [m], extruded from z = 0 to `height` [m]."""

    outlines: tuple[tuple[tuple[float, float], ...], ...]
    height: float


@dataclass(frozen=True, slots=True)
class Empty:
    """Geometry without a shape."""


Geometry = Box | Sphere | Cylinder | Capsule | Cone | Ellipsoid | Plane | Mesh | Heightmap | Polyline | Empty
