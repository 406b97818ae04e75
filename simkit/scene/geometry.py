"""Shapes. Lengths in metres, in the shape's own frame (centred; axes along z; a plane's normal as given)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

Vec3 = tuple[float, float, float]


def vec3(values: Iterable[float]) -> Vec3:
    """Return three numbers, such as those of an array, as a tuple of Python's floats."""
    x, y, z = (float(v) for v in values)
    return x, y, z


@dataclass(frozen=True, slots=True)
class Box:
    size: Vec3


@dataclass(frozen=True, slots=True)
class Sphere:
    radius: float


@dataclass(frozen=True, slots=True)
class Cylinder:
    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Capsule:
    """`length` is that of the cylindrical part, without the caps."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Cone:
    """Base at -length/2, tip at +length/2 on z."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Ellipsoid:
    radii: Vec3


@dataclass(frozen=True, slots=True)
class Plane:
    """Endless for collisions; `size` (x, y) bounds only what is drawn."""

    normal: Vec3 = (0.0, 0.0, 1.0)
    size: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True, slots=True)
class Mesh:
    """A mesh file, found and readable at load time.

    Attributes:
        file: absolute path.
        uri: as written in the file.
        submesh: name of the one sub-mesh to use, or empty for all.
        center: whether that sub-mesh is moved to the origin.
        missing: the file is not there; the shape is left out, and that has been said.
        optimization: what a collision that is not convex becomes: "" (the compiler's choice), "convex_hull" or
            "convex_decomposition".
        max_hulls: pieces of a convex decomposition.
        bone: only what this bone of the file's skeleton carries, in its frame and before the file's unit counts.
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
        uri: as written in the file.
        size: extent in x and y, and the height of white [m].
        position: of its centre, in the shape's frame [m].
    """

    file: Path
    uri: str
    size: Vec3 = (1.0, 1.0, 1.0)
    position: Vec3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Polyline:
    """Closed outlines in x, y extruded from z = 0 to `height`."""

    outlines: tuple[tuple[tuple[float, float], ...], ...]
    height: float


@dataclass(frozen=True, slots=True)
class Empty:
    """No shape."""


Geometry = Box | Sphere | Cylinder | Capsule | Cone | Ellipsoid | Plane | Mesh | Heightmap | Polyline | Empty
