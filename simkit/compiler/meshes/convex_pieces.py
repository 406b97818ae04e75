"""Convex pieces for the contacts of a non-convex mesh, and the volume that a mesh encloses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from simkit.compiler.meshes.connected_triangles import is_closed, members_of, part_numbers
from simkit.linear_algebra import matmul, norm
from simkit.loaders.meshes.mesh_part import Floats, Indices, Ints

HULLS_MOST: Final = 64
THICKNESS: Final = 0.05
_THINNEST: Final = 0.002
_CLOSED_MOST: Final = 8000
"""Largest number of closed convex parts of a mesh that are pieces of their own."""

SURFACE_TOLERANCE: Final = 1e-4
"""Largest depth of a mesh's surface inside its hull, relative to its size, up to which rays use the hull."""

_COMPARED_AT_A_TIME: Final = 1 << 20
"""Number of pairs of a triangle and a plane of the hull that are compared at a time."""

_FEW_FACES: Final = 128
"""Number of faces up to which arrays are faster than a mesh of trimesh."""


@dataclass(frozen=True, eq=False)
class ConvexPiece:
    """Convex body: points, shape (n, 3) [m]; `is_solid` is True if the body fills a closed part or a piece of one."""

    points: Floats
    is_solid: bool


def is_convex(vertices: Floats, faces: Ints) -> bool:
    """Check whether a mesh is closed and fills its hull to 0.1 %."""
    import trimesh

    mesh = trimesh.Trimesh(vertices, faces, process=False)
    if not mesh.is_watertight:
        return False
    hull = hull_volume(vertices)
    return hull > 0.0 and bool(abs(mesh.volume) > 0.999 * hull)


def is_own_hull(vertices: Floats, faces: Ints) -> bool:
    """Check whether no triangle of a mesh is deeper inside its convex hull than `SURFACE_TOLERANCE` times its size.

    The depth is measured at the centres of the triangles. No point of a triangle is deeper than three times its centre,
    because the depth is a concave function.
    """
    from scipy.spatial import ConvexHull, QhullError

    try:
        planes = ConvexHull(vertices).equations
    except (QhullError, ValueError):
        return False
    centres = vertices[faces].mean(axis=1)
    rows = max(1, _COMPARED_AT_A_TIME // len(planes))
    least = -SURFACE_TOLERANCE / 3.0 * float(np.ptp(vertices, axis=0).max())
    return all(
        bool(((matmul(centres[i : i + rows], planes[:, :3].T) + planes[:, 3]).max(axis=1) >= least).all())
        for i in range(0, len(centres), rows)
    )


def hull_volume(vertices: Floats) -> float:
    """Return the volume of the convex hull [m³]; 0 for points in a plane."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        return float(ConvexHull(vertices).volume)
    except (QhullError, ValueError):
        return 0.0


def connected_pieces(vertices: Floats, faces: Ints) -> list[tuple[Floats, Ints]]:
    """Return the connected pieces of a mesh, in the order of their first face."""
    of_face = part_numbers(faces)
    pieces = []
    for piece in dict.fromkeys(of_face.tolist()):
        used, inverse = np.unique(faces[of_face == piece], return_inverse=True)
        pieces.append((vertices[used], np.asarray(inverse).reshape(-1, 3).astype(np.int32)))
    return pieces


def moving_pieces(vertices: Floats, faces: Ints) -> list[tuple[Floats, Ints]]:
    """Return the meshes whose hulls collide for a moving mesh: its connected pieces, or itself if they are too many."""
    pieces = connected_pieces(vertices, faces)
    return [(vertices, faces)] if len(pieces) > HULLS_MOST else pieces


def convex_pieces(vertices: Floats, faces: Ints) -> list[ConvexPiece]:
    """Return convex bodies that together cover the surface of a static mesh."""
    pieces: list[ConvexPiece] = []
    parts = connected_pieces(vertices, faces)
    low, high = (np.array([end(v, axis=0) for v, _ in parts]) for end in (np.min, np.max))
    inverted = np.array([is_inside_out(v, f) for v, f in parts])
    for i, (v, f) in enumerate(parts):
        hollow = bool((inverted & (low > low[i]).all(axis=1) & (high < high[i]).all(axis=1)).any())
        if not inverted[i] and not hollow and is_convex(v, f):
            pieces.append(ConvexPiece(v, True))
        else:
            pieces += [ConvexPiece(p, False) for p in surface_prisms(v, f)]
    return pieces


class ClosedParts(NamedTuple):
    """Connected parts of a mesh.

    Attributes:
        convex: points of each closed convex part that is no cavity [m].
        others: numbers of the triangles of each other part that is no cavity and has none.
        is_rest: mask of the faces of all parts that are not closed and convex.
    """

    convex: list[Floats]
    others: list[Indices]
    is_rest: npt.NDArray[np.bool_]


def closed_convex_parts(vertices: Floats, faces: Ints) -> ClosedParts:
    """Return the connected parts of a mesh, divided into closed convex ones and others."""
    of_face = part_numbers(faces)
    parts = members_of(of_face)
    corners = vertices[faces]
    volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    inverted = np.bincount(of_face, volumes)[[of_face[p[0]] for p in parts]] < 0.0
    low = np.array([corners[p].min(axis=(0, 1)) for p in parts])
    high = np.array([corners[p].max(axis=(0, 1)) for p in parts])
    result = ClosedParts([], [], np.ones(len(faces), bool))
    for i, part in enumerate(parts):
        hollow = inverted & (low > low[i]).all(axis=1) & (high < high[i]).all(axis=1) if inverted.any() else inverted
        if inverted[i] or hollow.any():
            continue
        used, inverse = np.unique(faces[part], return_inverse=True)
        local = np.asarray(inverse).reshape(-1, 3)
        if len(result.convex) < _CLOSED_MOST and _is_closed_convex(vertices[used], local.astype(np.int32)):
            result.convex.append(vertices[used])
            result.is_rest[part] = False
        else:
            result.others.append(part)
    return result


def _is_closed_convex(vertices: Floats, faces: Ints) -> bool:
    """Check whether a part is closed and convex. For few faces, arrays are 20 times as fast as a mesh of trimesh."""
    if len(faces) > _FEW_FACES:
        return is_convex(vertices, faces)
    if not is_closed(faces):
        return False
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    over = matmul(vertices, normals.T) - np.einsum("ij,ij->i", a, normals)
    return bool((over <= 1e-4 * float(np.ptp(vertices, axis=0).max()) * lengths).all())


def is_inside_out(vertices: Floats, faces: Ints) -> bool:
    """Check whether the faces of a closed piece point inwards, as for the walls of a room or of a cavity."""
    a, b, c = (np.asarray(vertices, float)[np.asarray(faces)[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) < 0.0  # six times the volume


def surface_prisms(vertices: Floats, faces: Ints) -> list[Floats]:
    """Return one prism for each flat convex patch: the patch and its copy moved inwards."""
    import trimesh

    mesh = trimesh.Trimesh(vertices, faces, process=False)
    patches = [_patch_outline(mesh, patch) for patch in _patches(mesh)]
    normals = np.array([n for _, n in patches])
    inset = [p.mean(axis=0) + 0.9 * (p - p.mean(axis=0)) for p, _ in patches]
    probes = [np.vstack([p.mean(axis=0), p]) for p in inset]
    room = _inward_distances(mesh, probes, normals)
    size = float(np.ptp(vertices, axis=0).max())
    most = min(THICKNESS, 0.1 * size)
    least = min(_THINNEST, most)
    out = []
    for (points, normal), free in zip(patches, room, strict=True):
        out.append(np.vstack([points, points - normal * float(np.clip(0.95 * free, least, most))]))
    return out


def has_more_prisms(vertices: Floats, faces: Ints, most: int) -> bool:
    """Check whether the surface of a mesh has more than a number of prisms."""
    import trimesh

    mesh = trimesh.Trimesh(vertices, faces, process=False)
    facets = mesh.facets
    # without a hull: the prisms if each flat area were convex
    if len(faces) - sum(map(len, facets)) + len(facets) > most:
        return True
    return len(_patches(mesh)) > most


def layer_depths(vertices: Floats, faces: Ints, corners: Floats, up: Floats | None = None) -> tuple[Floats, Floats]:
    """Return the thickness of the layer of contacts below triangles of a mesh, and the distance to the next surface.

    The layer is as thick as prisms. Both results have the shape (n,) [m]; a distance may be infinite.

    Args:
        vertices: vertices of the mesh [m], shape (n, 3).
        faces: vertex indices of the whole mesh, shape (m, 3).
        corners: corners of the triangles, which have an area [m], shape (k, 3, 3).
        up: direction opposite to that of the distances; None for the normals of the triangles.
    """
    import trimesh

    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    if up is not None:
        normals = np.broadcast_to(up, normals.shape)
    room = _inward_distances(
        trimesh.Trimesh(vertices, faces, process=False), list(corners.mean(axis=1)[:, None]), normals
    )
    most = min(THICKNESS, 0.1 * float(np.ptp(vertices, axis=0).max()))
    return np.clip(0.95 * room, min(_THINNEST, most), most), room


Trimesh = Any
"""Mesh of trimesh, whose own types are incomplete."""
Patch = Ints | npt.NDArray[np.int64]


def _patches(mesh: Trimesh) -> list[Patch]:
    """Return groups of coplanar faces with a convex outline; every other face is its own group."""
    patches: list[Patch] = []
    grouped = np.zeros(len(mesh.faces), bool)
    for facet, boundary in zip(mesh.facets, mesh.facets_boundary, strict=True):
        if _fills_its_hull(mesh, facet, boundary):
            patches.append(facet)
            grouped[facet] = True
    patches += [np.array([i]) for i in np.flatnonzero(~grouped)]
    return patches


def _fills_its_hull(mesh: Trimesh, facet: Patch, boundary: Patch) -> bool:
    from scipy.spatial import ConvexHull, QhullError

    points = mesh.vertices[np.unique(boundary)]
    if len(points) < 3:  # faces that coincide have no outline
        return False
    u, v, normal = _patch_axes(mesh.face_normals[facet[0]])
    if np.ptp(matmul(points, normal)) > 1e-6 * max(1.0, float(mesh.scale)):
        return False
    try:
        area = ConvexHull(np.column_stack([matmul(points, u), matmul(points, v)])).volume
    except (QhullError, ValueError):
        return False
    return bool(mesh.area_faces[facet].sum() > (1.0 - 1e-6) * area)


def _patch_outline(mesh: Trimesh, patch: Patch) -> tuple[Floats, Floats]:
    """Return the corner points and the outward normal of a patch."""
    points = mesh.vertices[np.unique(mesh.faces[patch])]
    return np.asarray(points, float), np.asarray(mesh.face_normals[patch[0]], float)


def _patch_axes(normal: Floats) -> tuple[Floats, Floats, Floats]:
    helper = np.eye(3)[int(np.argmin(np.abs(normal)))]
    u = np.cross(normal, helper)
    u /= norm(u)
    return u, np.cross(normal, u), np.asarray(normal, float)


def _inward_distances(mesh: Trimesh, probes: list[Floats], normals: Floats) -> Floats:
    """Return the distance [m] from each patch, along its inward normal, to the next surface; inf without one."""
    counts = [len(p) for p in probes]
    inward = -np.repeat(normals, counts, axis=0)
    skin = 1e-5 * max(1e-3, float(mesh.scale))
    origins = np.vstack(probes) + skin * inward
    distance = np.full(len(origins), np.inf)
    try:
        points, rays, _ = mesh.ray.intersects_location(origins, inward, multiple_hits=False)
    except ImportError:  # no ray tracer on this platform: use thin prisms everywhere
        return np.full(len(probes), 2.0 * _THINNEST)
    if len(rays):
        distance[rays] = np.einsum("ij,ij->i", points - origins[rays], inward[rays]) + skin
    return np.minimum.reduceat(distance, np.cumsum([0, *counts[:-1]]))


_CELLS: Final = 24  # number of cells along each axis
_SAMPLES: Final = 80_000


def mesh_volume(vertices: Floats, faces: Ints) -> float:
    """Return the volume of a closed mesh [m³]; 0 for an open one."""
    corners = faces.astype(np.int64)
    edges = np.sort(corners[:, (0, 1, 1, 2, 2, 0)].reshape(-1, 2), axis=1)
    counts = np.unique(edges[:, 0] * len(vertices) + edges[:, 1], return_counts=True)[1]
    if not len(counts) or (counts != 2).any():
        return 0.0
    a, b, c = (np.asarray(vertices, np.float64)[corners[:, i]] for i in range(3))
    normals = np.cross(b - a, c - b)
    return abs(float((normals[:, 0] * (a + b + c)[:, 0]).sum() / 6.0))


def filled_ratio(vertices: Floats, faces: Ints, sets: list[Floats]) -> float:
    """Estimate the ratio of the volume of hulls to the volume that a mesh encloses, at least 1.

    The mesh may be open. A point is enclosed if triangles lie on both of its sides along each axis. The volume of the
    hulls is estimated in the same way, so that the error of the cell size has no effect.

    Args:
        vertices: vertices of the mesh [m], shape (n, 3).
        faces: vertex indices, shape (m, 3).
        sets: corners of each hull, shape (n, 3).
    """
    from scipy.spatial import ConvexHull, QhullError

    low = vertices.min(axis=0)
    size = np.maximum(np.ptp(vertices, axis=0), 1e-12) / _CELLS
    inside = _enclosed_cells(vertices[faces], low, size)
    covered = np.zeros_like(inside)
    for points in sets:
        try:
            covered |= _enclosed_cells(points[ConvexHull(points).simplices], low, size)
        except (QhullError, ValueError):
            continue
    return max(1.0, float(covered.sum()) / max(1.0, float((inside & covered).sum())))


def _enclosed_cells(corners: Floats, low: Floats, size: Floats) -> npt.NDArray[np.bool_]:
    """Return a mask of the cells that triangles enclose, shape (cells, cells, cells)."""
    cells = np.clip(((_sample_points(corners) - low) / size).astype(int), 0, _CELLS - 1)
    inside = np.ones((_CELLS,) * 3, bool)
    along = np.arange(_CELLS)
    for axis in range(3):
        i, j = (cells[:, k] for k in range(3) if k != axis)
        first, last = np.full((_CELLS, _CELLS), _CELLS), np.full((_CELLS, _CELLS), -1)
        np.minimum.at(first, (i, j), cells[:, axis])
        np.maximum.at(last, (i, j), cells[:, axis])
        between = (along >= first[:, :, None]) & (along <= last[:, :, None])
        inside &= np.moveaxis(between, 2, axis)
    return inside


def _sample_points(corners: Floats) -> Floats:
    """Return evenly distributed, reproducible points on triangles, and the corners of the triangles."""
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    random = np.random.default_rng(0)
    chosen = np.searchsorted(np.cumsum(areas), random.random(_SAMPLES) * areas.sum())
    triangles = corners[np.minimum(chosen, len(corners) - 1)]
    u, v = random.random((2, _SAMPLES, 1))
    folded = u + v > 1.0
    u, v = np.where(folded, 1.0 - u, u), np.where(folded, 1.0 - v, v)
    origin = triangles[:, 0]
    points = origin + u * (triangles[:, 1] - origin) + v * (triangles[:, 2] - origin)
    return np.vstack([points, corners.reshape(-1, 3)])
