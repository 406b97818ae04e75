"""Shapes of the file as MuJoCo's primitives, points, triangles with texture coordinates, or height fields."""

from __future__ import annotations

import io
import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.float_sum import float_sum
from simkit.input_file import read_input
from simkit.linear_algebra import dot
from simkit.loaders.meshes.mesh_part import Floats, Ints, MeshFileError, MeshPart
from simkit.pose import IDENTITY, Pose
from simkit.scene import Box, Capsule, Cone, Cylinder, Ellipsoid, Geometry, Heightmap, Plane, Polyline, Sphere

if TYPE_CHECKING:
    from PIL.Image import Image as PilImage

_SIDES = 48


@dataclass(frozen=True, slots=True)
class Primitive:
    """MuJoCo type and size of a shape, and its pose in the file's shape frame."""

    type: mujoco.mjtGeom
    size: tuple[float, float, float]
    pose: Pose = IDENTITY


def primitive_of(shape: Geometry, is_visual: bool) -> Primitive | None:
    """Return the primitive for a shape, or None if it needs a mesh."""
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


def shape_sizes(shape: Geometry) -> tuple[float, ...]:
    """Return the numbers that must be positive for a valid shape."""
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
    """Return the shortest rotation (w, x, y, z) from +z to a direction; the identity for a zero vector."""
    length = math.sqrt(float_sum(c * c for c in normal))
    if length < 1e-12:
        return 1.0, 0.0, 0.0, 0.0
    x, y, z = (c / length for c in normal)
    if z < -1.0 + 1e-12:
        return 0.0, 1.0, 0.0, 0.0
    w = math.sqrt((1.0 + z) / 2.0)
    return w, -y / (2.0 * w), x / (2.0 * w), 0.0


def cone_triangles(shape: Cone) -> tuple[Floats, Ints]:
    """Return the triangles of a cone with 48 sides."""
    angle = np.linspace(0.0, 2.0 * np.pi, _SIDES, endpoint=False)
    bottom = np.full(_SIDES, -shape.length / 2)
    ring = np.column_stack([shape.radius * np.cos(angle), shape.radius * np.sin(angle), bottom])
    vertices = np.vstack([ring, [(0.0, 0.0, -shape.length / 2), (0.0, 0.0, shape.length / 2)]])
    i = np.arange(_SIDES)
    after = (i + 1) % _SIDES
    sides = np.column_stack([i, after, np.full(_SIDES, _SIDES + 1)])
    base = np.column_stack([after, i, np.full(_SIDES, _SIDES)])
    return vertices, np.vstack([sides, base]).astype(np.int32)


def polyline_triangles(shape: Polyline) -> tuple[Floats, Ints]:
    """Return the triangles of extruded outlines; an outline inside another is a hole.

    Raises:
        ValueError: the outlines enclose no area or cross themselves.
    """
    import trimesh

    meshes = [trimesh.creation.extrude_triangulation(*flat, shape.height) for flat in _outline_areas(shape)]
    mesh = trimesh.util.concatenate(meshes)
    return np.asarray(mesh.vertices, float), np.asarray(mesh.faces, np.int32)


def polyline_pieces(shape: Polyline) -> list[Floats]:
    """Return the corners of convex bodies that together are exactly the extruded outlines.

    Raises:
        ValueError: the outlines enclose no area or cross themselves.
    """
    pieces = []
    for points, faces in _outline_areas(shape):
        for polygon in _convex_polygons(points, faces):
            flat = points[polygon]
            pieces.append(np.vstack([np.column_stack([flat, np.full(len(flat), z)]) for z in (0.0, shape.height)]))
    return pieces


def _outline_areas(shape: Polyline) -> list[tuple[Floats, Ints]]:
    """Return plane triangles of each outline that is not a hole; the areas of its holes are left out."""
    rings = [np.asarray(outline, float) for outline in shape.outlines]
    rings = [r[:-1] if len(r) > 1 and np.array_equal(r[0], r[-1]) else r for r in rings]
    rings = [r for r in rings if len(r) >= 3 and abs(_signed_area(r)) > 0.0]
    around = [[o for o, other in enumerate(rings) if o != i and _encloses(other, r[0])] for i, r in enumerate(rings)]
    areas = []
    for i, outer in enumerate(rings):
        if len(around[i]) % 2 == 0:
            holes = [rings[k] for k in range(len(rings)) if i in around[k] and len(around[k]) == len(around[i]) + 1]
            areas.append(_triangulate([outer, *holes]))
    if not areas:
        raise ValueError("the outlines enclose no area")
    return areas


def _convex_polygons(points: Floats, faces: Ints) -> list[list[int]]:
    """Merge triangles across their common edges while the result is convex (Hertel and Mehlhorn)."""
    polygons: dict[int, list[int]] = dict(enumerate(faces.tolist()))
    for i, (a, b, c) in polygons.items():
        if _turn_direction(points[a], points[b], points[c]) < 0.0:
            polygons[i] = [a, c, b]
    of_edge = {(p[k], p[(k + 1) % 3]): i for i, p in polygons.items() for k in range(3)}
    for (a, b), first in list(of_edge.items()):
        first, second = of_edge[(a, b)], of_edge.get((b, a), -1)
        if second < 0 or first == second:
            continue
        polygon, other = polygons[first], polygons[second]
        at, there = polygon.index(b), other.index(a)
        merged = polygon[at:] + polygon[:at] + (other[there:] + other[:there])[1:-1]
        if len(set(merged)) == len(merged) and _is_convex(points[merged]):
            polygons[first] = merged
            del polygons[second]
            for edge in zip(other, other[1:] + other[:1], strict=True):
                of_edge[edge] = first
    return list(polygons.values())


def _turn_direction(a: Floats, b: Floats, c: Floats) -> float:
    return float((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]))


def _is_convex(ring: Floats) -> bool:
    before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
    u, v = ring - before, after - ring
    turns = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return bool((turns >= -1e-12 * float(np.abs(ring).max()) ** 2).all())


def _triangulate(rings: list[Floats]) -> tuple[Floats, Ints]:
    """Return triangles of an outline (first) with holes (the others)."""
    import mapbox_earcut

    points = np.concatenate(rings)
    ends = np.cumsum([len(r) for r in rings]).astype(np.uint32)
    faces = np.asarray(mapbox_earcut.triangulate_float64(points, ends), np.int32).reshape(-1, 3)
    if not len(faces):
        raise ValueError("an outline crosses itself")
    return points, faces


def _signed_area(ring: Floats) -> float:
    x, y = ring[:, 0], ring[:, 1]
    return 0.5 * float(dot(x, np.roll(y, -1)) - dot(y, np.roll(x, -1)))


def _encloses(ring: Floats, point: Floats) -> bool:
    """Check whether a point is inside an outline: a ray to the right crosses the outline an odd number of times."""
    a, b = ring, np.roll(ring, -1, axis=0)
    crosses = (a[:, 1] > point[1]) != (b[:, 1] > point[1])
    rise = np.where(b[:, 1] == a[:, 1], 1.0, b[:, 1] - a[:, 1])
    at = a[:, 0] + (point[1] - a[:, 1]) / rise * (b[:, 0] - a[:, 0])
    return bool(np.count_nonzero(crosses & (at > point[0])) % 2)


_SEGMENTS_AROUND: Final = 96
"""Number of sides of a round shape: a cylinder's surface is 0.05 % of its radius inside the true one."""

_SEGMENTS_UP: Final = 48


def textured_triangles(shape: Geometry) -> MeshPart | None:
    """Return a box or a round shape as triangles with texture coordinates; None for all other shapes."""
    match shape:
        case Box(size=size):
            return MeshPart("box", *_textured_box(np.asarray(size, float) / 2))
        case Sphere(radius=r):
            return MeshPart("sphere", *_textured_ellipsoid(np.array((r, r, r)), 0.0))
        case Ellipsoid(radii=radii):
            return MeshPart("ellipsoid", *_textured_ellipsoid(np.asarray(radii, float), 0.0))
        case Capsule(radius=r, length=h):
            return MeshPart("capsule", *_textured_ellipsoid(np.array((r, r, r)), h))
        case Cylinder(radius=r, length=h):
            return MeshPart("cylinder", *_textured_cylinder(r, h / 2))
        case _:
            return None


def _textured_box(half: Floats) -> tuple[Floats, Ints, Floats]:
    """Return six sides with the whole image on each, seen from outside with z up (y up on top and bottom)."""
    sides = [
        # outward normal, right and up of the image
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


def _unit_circle() -> tuple[Floats, Floats]:
    """Return the angles of a full turn and the points on the unit circle; the last point equals the first."""
    turn = np.linspace(0.0, 2.0 * np.pi, _SEGMENTS_AROUND + 1)
    points = np.column_stack([np.cos(turn), np.sin(turn)])
    points[-1] = points[0]
    return turn, points


def _grid_triangles(rows: int, columns: int) -> Ints:
    """Return triangles between rows of `columns` + 1 points, counter-clockwise seen from outside.

    Each row is above the previous one.
    """
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns), indexing="ij")
    a = (i * (columns + 1) + j).reshape(-1)
    b, c, d = a + 1, a + columns + 2, a + columns + 1
    return np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])]).astype(np.int32)


def _textured_ellipsoid(radii: Floats, length: float) -> tuple[Floats, Ints, Floats]:
    """Return an ellipsoid that is cut at its equator into halves, which are `length` apart (a capsule).

    The image is wrapped around it once, from pole to pole.
    """
    turn, circle = _unit_circle()
    rise = np.linspace(-np.pi / 2, np.pi / 2, _SEGMENTS_UP + 1)
    height = radii[2] * np.sin(rise) + np.sign(rise) * length / 2
    ring = np.cos(rise)
    ring[[0, -1]] = 0.0
    if length > 0.0:  # two equators, one for each half
        middle = _SEGMENTS_UP // 2
        ring = np.insert(ring, middle, ring[middle])
        height = np.insert(height, middle, -length / 2)
        height[middle + 1] = length / 2
    x, y = radii[0] * np.outer(ring, circle[:, 0]), radii[1] * np.outer(ring, circle[:, 1])
    z = np.repeat(height[:, None], len(turn), axis=1)
    u, v = np.meshgrid(turn / (2.0 * np.pi), (height - height[0]) / (height[-1] - height[0]))
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    faces = _grid_triangles(len(ring), _SEGMENTS_AROUND)
    lowest, highest = faces < _SEGMENTS_AROUND + 1, faces >= len(vertices) - (_SEGMENTS_AROUND + 1)
    faces = faces[(lowest.sum(axis=1) < 2) & (highest.sum(axis=1) < 2)]  # without degenerate triangles at the poles
    return vertices, faces, np.stack([u, v], axis=-1).reshape(-1, 2)


def _textured_cylinder(radius: float, half: float) -> tuple[Floats, Ints, Floats]:
    """Return a cylinder; the image is wrapped around the side once, and covers each end once."""
    turn, ring = _unit_circle()
    sides = [np.column_stack([radius * ring, np.full(len(turn), z)]) for z in (-half, half)]
    side_uv = [np.column_stack([turn / (2.0 * np.pi), np.full(len(turn), v)]) for v in (0.0, 1.0)]
    vertices, uv, faces = [*sides], [*side_uv], [_grid_triangles(2, _SEGMENTS_AROUND)]
    count = 2 * len(turn)
    for z, mirror in ((half, 1.0), (-half, -1.0)):
        vertices.append(np.vstack([np.column_stack([radius * ring, np.full(len(turn), z)]), (0.0, 0.0, z)]))
        uv.append(np.vstack([0.5 + 0.5 * ring * (mirror, 1.0), (0.5, 0.5)]))
        i = count + np.arange(_SEGMENTS_AROUND)
        middle = np.full(_SEGMENTS_AROUND, count + len(turn))
        faces.append(np.column_stack([i, i + 1, middle] if mirror > 0.0 else [i + 1, i, middle]).astype(np.int32))
        count += len(turn) + 1
    return np.vstack(vertices), np.vstack(faces).astype(np.int32), np.vstack(uv)


LARGEST: Final = 4097
_LARGEST_FILE: Final = 256 << 20
_TIFF_WIDTH: Final = 256
_TIFF_HEIGHT: Final = 257
_FORMATS: Final = ("PNG", "JPEG", "TIFF", "BMP", "TGA", "GIF", "PPM", "WEBP")


def heightmap_rows(shape: Heightmap) -> Floats:
    """Return the heights in an image as rows from -y to +y, scaled so that the highest value is 1, as in Gazebo.

    8-bit and 16-bit images and TIFF with numbers of 32 or 64 bits are supported; colours are converted to brightness.

    Raises:
        MeshFileError: the file is not such an image, or is too large; the size is checked before decoding.
    """
    from PIL import Image, UnidentifiedImageError

    try:
        content = read_input(shape.file, _LARGEST_FILE)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                with Image.open(io.BytesIO(content), formats=_FORMATS) as image:
                    _check_image_size(image.width, image.height)
                    grey = _grey_values(image)
            except UnidentifiedImageError:
                grey = _wide_tiff_values(content)
    except MeshFileError:
        raise
    except OSError as problem:
        text = problem.strerror or "it is not a PNG, JPEG or TIFF image"
        raise MeshFileError(f"cannot be read: {text}") from None
    except Exception as problem:  # noqa: BLE001 -- a decoder of broken data may raise anything
        raise MeshFileError(f"cannot be read: {' '.join(str(problem).split())[:200]}") from None
    if grey.ndim != 2 or min(grey.shape) < 2:
        raise MeshFileError("is smaller than 2×2")
    if not np.isfinite(grey).all():
        raise MeshFileError("has NaN or infinite heights")
    most = float(np.abs(grey).max()) if float(grey.max()) <= 0.0 else float(grey.max())
    return np.ascontiguousarray(grey[::-1]) / (most if most > 0.0 else 1.0)


def _check_image_size(width: int, height: int) -> None:
    if width > LARGEST or height > LARGEST:
        raise MeshFileError(f"is {width}×{height}; at most {LARGEST}×{LARGEST} is supported")


def _wide_tiff_values(content: bytes) -> Floats:
    """Return the values of a grey TIFF with numbers of 64 bits, which Pillow does not read.

    Raises:
        OSError: the file is not a TIFF.
        ValueError: its encoding is not supported, or the file is damaged.
        MeshFileError: the file is too large; the size is checked before decoding.
    """
    from PIL.TiffImagePlugin import PREFIXES, ImageFileDirectory_v2

    if not content.startswith(tuple(PREFIXES)):
        raise OSError("it is not a PNG, JPEG or TIFF image")
    header = ImageFileDirectory_v2(content[: 16 if content[2] == 43 or content[3] == 43 else 8])
    stream = io.BytesIO(content)
    stream.seek(header.next)
    header.load(stream)
    if not {_TIFF_WIDTH, _TIFF_HEIGHT} <= set(header):
        raise ValueError("the TIFF file is damaged")
    _check_image_size(int(header[_TIFF_WIDTH]), int(header[_TIFF_HEIGHT]))
    import cv2

    log = cv2.utils.logging
    level = log.getLogLevel()
    log.setLogLevel(log.LOG_LEVEL_SILENT)  # OpenCV writes about damaged files to the terminal
    try:
        values = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_UNCHANGED)
    finally:
        log.setLogLevel(level)
    if values is None or values.ndim != 2:
        raise ValueError("its TIFF encoding is not supported")
    return np.asarray(values, float)


def _grey_values(image: PilImage) -> Floats:
    if image.mode in ("L", "F") or image.mode.startswith("I"):
        return np.asarray(image, float)
    return np.asarray(image.convert("L"), float)
