"""Shapes of the file as MuJoCo's primitives, or as points and triangles."""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from simkit.compiler.meshes.part import Floats, Ints
from simkit.pose import IDENTITY, Pose
from simkit.scene import Box, Capsule, Cone, Cylinder, Ellipsoid, Geometry, Heightmap, Plane, Polyline, Sphere

_SIDES = 48


@dataclass(frozen=True, slots=True)
class Primitive:
    """MuJoCo type and size, and the shape's pose in the file's shape frame."""

    type: mujoco.mjtGeom
    size: tuple[float, float, float]
    pose: Pose = IDENTITY


def primitive_of(shape: Geometry, is_visual: bool) -> Primitive | None:
    """The primitive for a shape, or None when it needs a mesh."""
    kind = mujoco.mjtGeom
    match shape:
        case Box(size=(x, y, z)):
            return Primitive(kind.mjGEOM_BOX, (x / 2, y / 2, z / 2))
        case Sphere(radius=r):
            return Primitive(kind.mjGEOM_SPHERE, (r, 0.0, 0.0))
        case Cylinder(radius=r, length=h):
            return Primitive(kind.mjGEOM_CYLINDER, (r, h / 2, 0.0))
        case Capsule(radius=r, length=h):
            return Primitive(kind.mjGEOM_CAPSULE, (r, h / 2, 0.0))
        case Ellipsoid(radii=(x, y, z)):
            return Primitive(kind.mjGEOM_ELLIPSOID, (x, y, z))
        case Plane(normal=normal, size=(x, y)):
            half = (x / 2, y / 2) if is_visual else (0.0, 0.0)
            return Primitive(kind.mjGEOM_PLANE, (*half, 1.0), Pose((0, 0, 0), turn_z_to(normal)))
        case _:
            return None


def sizes_of(shape: Geometry) -> tuple[float, ...]:
    """The numbers that must be positive for the shape to exist."""
    match shape:
        case Box(size=size):
            return size
        case Sphere(radius=r):
            return (r,)
        case Cylinder(radius=r, length=h) | Capsule(radius=r, length=h) | Cone(radius=r, length=h):
            return (r, h)
        case Ellipsoid(radii=radii):
            return radii
        case Plane(size=size):
            return size
        case Heightmap(size=size):
            return size
        case Polyline(height=h):
            return (h,)
        case _:
            return (1.0,)


def turn_z_to(normal: tuple[float, float, float]) -> tuple[float, float, float, float]:
    """The shortest rotation (w, x, y, z) that takes +z to a direction; none for a zero vector."""
    length = math.sqrt(sum(c * c for c in normal))
    if length < 1e-12:
        return 1.0, 0.0, 0.0, 0.0
    x, y, z = (c / length for c in normal)
    if z < -1.0 + 1e-12:
        return 0.0, 1.0, 0.0, 0.0
    w = math.sqrt((1.0 + z) / 2.0)
    return w, -y / (2.0 * w), x / (2.0 * w), 0.0


def cone(shape: Cone) -> tuple[Floats, Ints]:
    """Triangles of a cone with 48 sides."""
    angle = np.linspace(0.0, 2.0 * np.pi, _SIDES, endpoint=False)
    ring = np.column_stack(
        [shape.radius * np.cos(angle), shape.radius * np.sin(angle), np.full(_SIDES, -shape.length / 2)]
    )
    vertices = np.vstack([ring, [(0.0, 0.0, -shape.length / 2), (0.0, 0.0, shape.length / 2)]])
    i = np.arange(_SIDES)
    after = (i + 1) % _SIDES
    sides = np.column_stack([i, after, np.full(_SIDES, _SIDES + 1)])
    base = np.column_stack([after, i, np.full(_SIDES, _SIDES)])
    return vertices, np.vstack([sides, base]).astype(np.int32)


def polyline(shape: Polyline) -> tuple[Floats, Ints]:
    """Triangles of extruded outlines; an outline inside another is a hole. Raises ValueError."""
    import trimesh

    meshes = [trimesh.creation.extrude_triangulation(*flat, shape.height) for flat in _areas(shape)]
    whole = trimesh.util.concatenate(meshes)
    return np.asarray(whole.vertices, float), np.asarray(whole.faces, np.int32)


def polyline_pieces(shape: Polyline) -> list[Floats]:
    """Convex bodies that together are the extruded outlines, exactly: corners of each. Raises ValueError."""
    pieces = []
    for points, faces in _areas(shape):
        for polygon in _convex_polygons(points, faces):
            flat = points[polygon]
            pieces.append(np.vstack([np.column_stack([flat, np.full(len(flat), z)]) for z in (0.0, shape.height)]))
    return pieces


def _areas(shape: Polyline) -> list[tuple[Floats, Ints]]:
    """Triangles in the plane of each outline that is no hole, without its holes."""
    rings = [np.asarray(outline, float) for outline in shape.outlines]
    rings = [r[:-1] if len(r) > 1 and np.array_equal(r[0], r[-1]) else r for r in rings]
    rings = [r for r in rings if len(r) >= 3 and abs(_signed_area(r)) > 0.0]
    around = [[o for o, other in enumerate(rings) if o != i and _encloses(other, r[0])] for i, r in enumerate(rings)]
    areas = []
    for i, outer in enumerate(rings):
        if len(around[i]) % 2 == 0:
            holes = [rings[k] for k in range(len(rings)) if i in around[k] and len(around[k]) == len(around[i]) + 1]
            areas.append(_filled([outer, *holes]))
    if not areas:
        raise ValueError("the outlines enclose no area")
    return areas


def _convex_polygons(points: Floats, faces: Ints) -> list[list[int]]:
    """Triangles joined across their common edges as long as what comes of it is convex (Hertel and Mehlhorn)."""
    polygons: dict[int, list[int]] = dict(enumerate(faces.tolist()))
    for i, (a, b, c) in polygons.items():
        if _turn(points[a], points[b], points[c]) < 0.0:
            polygons[i] = [a, c, b]
    of_edge = {(p[k], p[(k + 1) % 3]): i for i, p in polygons.items() for k in range(3)}
    for (a, b), first in list(of_edge.items()):
        first, second = of_edge[(a, b)], of_edge.get((b, a), -1)
        if second < 0 or first == second:
            continue
        one, other = polygons[first], polygons[second]
        at, there = one.index(b), other.index(a)
        merged = one[at:] + one[:at] + (other[there:] + other[:there])[1:-1]
        if len(set(merged)) == len(merged) and _is_convex(points[merged]):
            polygons[first] = merged
            del polygons[second]
            for edge in zip(other, other[1:] + other[:1], strict=True):
                of_edge[edge] = first
    return list(polygons.values())


def _turn(a: Floats, b: Floats, c: Floats) -> float:
    return float((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]))


def _is_convex(ring: Floats) -> bool:
    before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
    u, v = ring - before, after - ring
    turns = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return bool((turns >= -1e-12 * float(np.abs(ring).max()) ** 2).all())


def _filled(rings: list[Floats]) -> tuple[Floats, Ints]:
    """Triangles of an outline (first) with holes (the others)."""
    import mapbox_earcut

    points = np.concatenate(rings)
    ends = np.cumsum([len(r) for r in rings]).astype(np.uint32)
    faces = np.asarray(mapbox_earcut.triangulate_float64(points, ends), np.int32).reshape(-1, 3)
    if not len(faces):
        raise ValueError("an outline crosses itself")
    return points, faces


def _signed_area(ring: Floats) -> float:
    x, y = ring[:, 0], ring[:, 1]
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def _encloses(ring: Floats, point: Floats) -> bool:
    """Whether a point lies inside an outline: a ray to the right crosses it an odd number of times."""
    a, b = ring, np.roll(ring, -1, axis=0)
    crosses = (a[:, 1] > point[1]) != (b[:, 1] > point[1])
    rise = np.where(b[:, 1] == a[:, 1], 1.0, b[:, 1] - a[:, 1])
    at = a[:, 0] + (point[1] - a[:, 1]) / rise * (b[:, 0] - a[:, 0])
    return bool(np.count_nonzero(crosses & (at > point[0])) % 2)
