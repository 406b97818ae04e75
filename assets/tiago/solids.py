"""Solids that the meshes are put together from, and how a mesh is written as OBJ text. Needs trimesh and shapely."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
import shapely
import trimesh
from shapely.geometry import Point as Spot
from shapely.geometry import Polygon
from trimesh.creation import extrude_polygon
from trimesh.transformations import rotation_matrix

Mesh = trimesh.Trimesh
Point = tuple[float, float]


def moved(mesh: Mesh, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Mesh:
    """The same mesh, shifted [m]."""
    mesh.apply_translation((x, y, z))
    return mesh


def along_x(mesh: Mesh) -> Mesh:
    """The same mesh with its z axis laid along x."""
    mesh.apply_transform(rotation_matrix(math.pi / 2, (0, 1, 0)))
    return mesh


def along_y(mesh: Mesh) -> Mesh:
    """The same mesh with its z axis laid along y; x stays."""
    mesh.apply_transform(rotation_matrix(-math.pi / 2, (1, 0, 0)))
    return mesh


def block(low: Sequence[float], high: Sequence[float]) -> Mesh:
    """A box from its lowest to its highest corner [m]."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    return moved(trimesh.creation.box(extents=high - low), *((low + high) / 2))


def lathe(profile: Sequence[Point], sections: int = 28) -> Mesh:
    """A closed solid of revolution about z from (radius, z) pairs."""
    return trimesh.creation.revolve(np.array([*profile, profile[0]]), sections=sections)


def barrel(radius: float, low: float, high: float, edge: float = 0.004, sections: int = 28) -> Mesh:
    """A cylinder about z with broken edges."""
    e = min(edge, radius / 2, (high - low) / 2)
    profile = [(0.0, low), (radius - e, low), (radius, low + e), (radius, high - e), (radius - e, high), (0.0, high)]
    return trimesh.creation.revolve(np.array(profile), sections=sections)


def disc(radius: float, x: float = 0.0, y: float = 0.0, segments: int = 7) -> Polygon:
    """A circle around (x, y)."""
    return Spot(x, y).buffer(radius, quad_segs=segments)


def slab(outline: Polygon, bottom: float, top: float) -> Mesh:
    """`outline` in the x-y plane, from z = `bottom` to z = `top` [m]."""
    return moved(extrude_polygon(outline, top - bottom), z=bottom)


def rectangle(low: Point, high: Point, radius: float, segments: int = 3) -> Polygon:
    """A rectangle with rounded corners."""
    inner = shapely.box(low[0] + radius, low[1] + radius, high[0] - radius, high[1] - radius)
    return inner.buffer(radius, quad_segs=segments)


def sector(inner: float, outer: float, start: float, end: float, segments: int = 40) -> Polygon:
    """A part of a ring, between two angles [deg] counter-clockwise from x."""
    angles = np.radians(np.linspace(start, end, segments))
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return Polygon(np.concatenate([ring * outer, ring[::-1] * inner]))


def hull(*sections: tuple[Polygon, float]) -> Mesh:
    """The smallest convex solid around outlines that lie at heights z."""
    points = []
    for outline, height in sections:
        corners = np.array(outline.exterior.coords)[:-1]
        points.append(np.column_stack([corners, np.full(len(corners), height)]))
    return trimesh.convex.convex_hull(np.concatenate(points))


def stack(*sections: tuple[Polygon, float]) -> list[Mesh]:
    """Convex solids one on the other, from each outline to the next."""
    return [hull(one, other) for one, other in itertools.pairwise(sections)]


def band(radius: float, depth: float, low: float, high: float, start: float, end: float) -> Mesh:
    """A strip around z with round ends, on a cylinder of that outer radius, between two angles [deg]."""
    half = (high - low) / 2
    middle = (high + low) / 2
    ends = np.linspace(0, half, 7)
    length = math.radians(end - start) * radius
    along = np.concatenate(
        [half - half * np.cos(ends / half * math.pi / 2), np.linspace(half, length - half, 60)[1:-1]]
    )
    along = np.concatenate([along, length - along[: len(ends)][::-1]])
    reach = np.sqrt(np.maximum(half**2 - (half - np.clip(np.minimum(along, length - along), 0, half)) ** 2, 0))
    angles = math.radians(start) + along / radius
    corners = []
    for r in (radius, radius - depth):
        for side in (1, -1):
            corners.append(np.stack([r * np.cos(angles), r * np.sin(angles), middle + side * reach], axis=1))
    count = len(angles)
    outer_high, outer_low, inner_high, inner_low = (k * count for k in range(4))
    faces = []
    for a, b in ((outer_high, outer_low), (inner_low, inner_high), (inner_high, outer_high), (outer_low, inner_low)):
        for k in range(count - 1):
            faces += [(a + k, b + k, b + k + 1), (a + k, b + k + 1, a + k + 1)]
    return trimesh.Trimesh(np.concatenate(corners), faces, process=False)


def obj_text(name: str, parts: Sequence[Mesh]) -> str:
    """The parts as one OBJ with a normal for each face, rounded so that it is the same on every machine."""
    lines = [f"# {name}: written by make_meshes.py", f"o {name}"]
    faces: list[str] = []
    vertices: dict[tuple[str, ...], int] = {}
    normals: dict[tuple[str, ...], int] = {}

    def index(table: dict[tuple[str, ...], int], values: np.ndarray, digits: int) -> int:
        key = tuple(f"{round(float(v), digits) + 0.0:.{digits}f}" for v in values)
        return table.setdefault(key, len(table) + 1)

    for mesh in parts:
        for triangle in mesh.triangles:
            normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
            length = float(np.linalg.norm(normal))
            corners = [index(vertices, corner, 5) for corner in triangle]
            if len(set(corners)) == 3 and length > 1e-12:
                ending = index(normals, normal / length, 3)
                faces.append("f " + " ".join(f"{c}//{ending}" for c in corners))
    lines += ["v " + " ".join(v) for v in vertices]
    lines += ["vn " + " ".join(n) for n in normals]
    return "\n".join([*lines, *faces]) + "\n"
