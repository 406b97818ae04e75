"""Large convex pieces for the surface of a static mesh with many triangles.

One prism for each triangle makes a world slow to load and to step: MuJoCo takes 0.2 ms to compile a piece, and 1 ns to
pass over it in each step. Therefore the surface is divided into patches that are nearly convex. A patch and its copy
moved inwards have one convex hull. The patch with the largest error is cut in two until no error exceeds a tolerance.
"""

from __future__ import annotations

import heapq
from typing import Final, NamedTuple

import numpy as np

from simkit.compiler.meshes.convex_pieces import ConvexPiece, closed_convex_parts, has_more_prisms, layer_depths
from simkit.compiler.meshes.curved_tiles import curved_tiles
from simkit.compiler.meshes.flat_areas import connected_areas, dividing_line, flat_areas
from simkit.compiler.meshes.height_tiles import HeightTile, Mask, height_tiles
from simkit.compiler.meshes.patch_division import (
    Patch,
    area_vectors,
    best_plane,
    divide,
    middle_plane,
    plane_between_layers,
)
from simkit.compiler.meshes.solid_pieces import solid_parts
from simkit.linear_algebra import matmul
from simkit.loaders.meshes.mesh_part import Floats, Indices, Ints

TRIANGLES_FROM: Final = 4000
"""Number of triangles up to which a static mesh is divided into prisms, which are exact, instead of patches."""

_COUNTED_MOST: Final = 10_000
"""Number of triangles up to which a mesh with fewer prisms than `TRIANGLES_FROM` is divided into prisms too."""

_PIECES_MOST, _TRIANGLES_PER_PIECE = 2500, 8

TOLERANCE: Final = 1e-4
"""Error of a patch, relative to the size of the mesh, below which it is not cut."""

LEAST_TOLERANCE: Final = 0.5e-3
"""Least value of this error [m]."""

_TILE_ERROR: Final = 8e-4
"""Largest error of a height field on a curved surface or of a solid piece, relative to the size of the mesh."""

_LEAST_TILE_ERROR: Final = 1e-3
"""Least value of this error [m]."""

_MOST_TRIANGLES: Final = 128
"""Number of triangles from which a curved patch is cut without computing its hull."""

_FEW_POINTS: Final = 16
"""Number of points up to which a patch keeps all of them."""

_BATCH: Final = 256
"""Largest number of patches that are cut before their parts are measured together."""

_SNAP: Final = 1e-7
"""Distance to a plane, relative to the size of the mesh, below which a corner lies in the plane."""

_THIN: Final = 1e-6
"""Height of a triangle, relative to its largest coordinate, below which it is left out."""

_STEEP: Final = 1e-3
"""Sine of the slope from which a side of a piece belongs to its top or bottom."""

_LEAST_SHARE: Final = 0.25
"""Least thickness at the edge of a curved patch, relative to the layer below the surface."""


def is_large(vertices: Floats, faces: Ints) -> bool:
    """Check whether a mesh is divided into patches. Coplanar triangles can share one prism and count once."""
    if len(faces) <= TRIANGLES_FROM or len(faces) > _COUNTED_MOST:
        return len(faces) > TRIANGLES_FROM
    return has_more_prisms(vertices, faces, TRIANGLES_FROM)


class LargeSurface(NamedTuple):
    """Bodies that cover the surface of a large static mesh.

    Attributes:
        pieces: convex pieces.
        tiles: height fields of regular grids.
        error: largest distance between a body and the surface [m].
        copies: number of a piece and offset [m] of each further place of it.
    """

    pieces: list[ConvexPiece]
    tiles: list[HeightTile]
    error: float
    copies: list[tuple[int, Floats]]


def large_surface_pieces(vertices: Floats, faces: Ints) -> LargeSurface:
    """Return the bodies of a large static mesh.

    Closed parts are solid pieces if few are enough. Regular grids are height fields. All other triangles are divided
    into patches.
    """
    vertices = np.asarray(vertices, float)
    closed, others, is_rest = closed_convex_parts(vertices, faces)
    pieces = [ConvexPiece(points, True) for points in closed]
    if not is_rest.any():
        return LargeSurface(pieces, [], 0.0, [])
    solids = solid_parts(vertices, faces, others, _largest_error(_usual_size(vertices[faces[is_rest]])))
    copies = [(len(pieces) + number, offset) for number, offset in solids.copies]
    pieces += [ConvexPiece(points, True) for points in solids.pieces]
    for part in solids.faces:
        is_rest[part] = False
    rest = _surface_bodies(vertices, faces, is_rest)
    return LargeSurface(pieces + rest.pieces, rest.tiles, max(rest.error, solids.error), copies)


def _surface_bodies(vertices: Floats, faces: Ints, is_rest: Mask) -> LargeSurface:
    """Return height fields and patches for a part of the surface of a mesh.

    Args:
        vertices: vertices of the whole mesh [m], shape (n, 3).
        faces: vertex indices of the whole mesh, shape (m, 3).
        is_rest: mask of the triangles without a body.
    """
    tiles, is_left = height_tiles(vertices, faces, vertices[faces[is_rest]], LEAST_TOLERANCE)
    rest = np.flatnonzero(is_rest)[is_left]
    rest = rest[_have_area(vertices[faces[rest]])]
    if not len(rest):
        return LargeSurface([], tiles, LEAST_TOLERANCE if tiles else 0.0, [])
    corners = vertices[faces[rest]]
    depths, _ = layer_depths(vertices, faces, corners)
    most = min(_PIECES_MOST, len(rest) // _TRIANGLES_PER_PIECE)
    groups, flat_count = _groups(corners, most)
    curved = np.flatnonzero(groups >= flat_count)
    size = _usual_size(corners)
    fields = curved_tiles(vertices, faces, rest[curved], depths[curved], groups[curved], _largest_error(size))
    is_left = np.ones(len(rest), bool)
    is_left[curved[~fields.is_left]] = False
    few = min(most, max(int(is_left.sum()) // _TRIANGLES_PER_PIECE, most // 4))
    patches, error = _nearly_convex_patches(corners[is_left], depths[is_left], groups[is_left], (few, 4 * most), size)
    pieces = [ConvexPiece(points, False) for points in patches]
    return LargeSurface(pieces, [*tiles, *fields.tiles], max(error, fields.error), [])


def _largest_error(size: float) -> float:
    """Return the largest error of a height field or a solid piece [m] for a mesh of this size [m]."""
    return max(_LEAST_TILE_ERROR, _TILE_ERROR * size)


def _have_area(corners: Floats) -> Mask:
    """Return a mask of the triangles that are higher than the rounding of their corners."""
    # the normal of a triangle that is thinner than the rounding of its corners may have any direction
    longest = np.linalg.norm(corners - corners[:, (1, 2, 0)], axis=2).max(axis=1)
    least = _THIN * np.abs(corners).max(axis=(1, 2))
    has_area: Mask = np.linalg.norm(area_vectors(corners), axis=1) > least * longest
    return has_area


def _usual_size(corners: Floats) -> float:
    """Return the largest extent of triangles [m], at most ten times that of 98 % of them: a corner may be far away."""
    middles = corners.mean(axis=1)
    low, high = np.percentile(middles, (1.0, 99.0), axis=0)
    return float(min(np.ptp(corners.reshape(-1, 3), axis=0).max(), max(10.0 * float((high - low).max()), 1e-3)))


def _groups(corners: Floats, most: int) -> tuple[Indices, int]:
    """Return the number of the area of each triangle, and the number of flat areas, which come first.

    Args:
        corners: corners of the triangles [m], shape (n, 3, 3).
        most: number of pieces of a quarter of which the connected areas are separate.
    """
    normals = area_vectors(corners)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    axis = np.abs(normals).argmax(axis=1)
    side = 2 * axis + (normals[np.arange(len(axis)), axis] < 0.0)
    areas = flat_areas(corners, normals)
    groups = np.full(len(corners), -1, np.int64)
    for number, area in enumerate(areas):
        groups[area] = number
    curved = np.flatnonzero(groups < 0)
    parts = connected_areas(corners[curved], side[curved])
    # parts of one patch would be joined by its hull until cuts have separated them
    if len(parts) > 4 * most:
        groups[curved] = len(areas) + side[curved]
    else:
        for number, part in enumerate(parts, len(areas)):
            groups[curved[part]] = number
    return groups, len(areas)


def _nearly_convex_patches(
    corners: Floats, depths: Floats, groups: Indices, most: tuple[int, int], size: float
) -> tuple[list[Floats], float]:
    """Return the points of pieces that cover triangles, and their largest error [m].

    Args:
        corners: corners of the triangles, counter-clockwise from outside [m], shape (n, 3, 3).
        depths: thickness of the layer below each triangle [m], shape (n,).
        groups: number of the first patch of each triangle.
        most: number of pieces from which only patches with ten times the tolerance are cut, and the limit of pieces.
        size: largest extent of most triangles [m].
    """
    if not len(corners):
        return [], 0.0
    normals = area_vectors(corners)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    tolerance = max(LEAST_TOLERANCE, TOLERANCE * size)
    coarse = 10.0 * tolerance
    order = np.argsort(groups, kind="stable")
    members = np.split(order, np.flatnonzero(np.diff(groups[order])) + 1)
    waiting = [Patch(corners[group], normals[group], depths[group]) for group in members]
    heap: list[tuple[float, int, Patch]] = []
    done: list[Patch] = []
    count = 0
    while True:
        _measure(waiting, tolerance)
        for patch in waiting:
            count += 1
            if patch.error > tolerance and patch.cut is not None:
                heapq.heappush(heap, (-patch.error, count, patch))
            else:
                done.append(patch)
        number, worst = len(heap) + len(done), -heap[0][0] if heap else 0.0
        if not heap or (number >= most[0] and worst <= coarse) or (number >= most[1] and worst < np.inf):
            break
        waiting = []
        # patches with a similar error are measured together; none is cut that could stay
        least, room = max(0.5 * worst, coarse if number >= most[0] else 0.0), _BATCH
        if worst <= coarse:
            room = min(room, most[0] - number)
        while room and heap and (not waiting or -heap[0][0] >= least):
            waiting += divide(heapq.heappop(heap)[2], _SNAP * size)
            room -= 1
    done += [patch for _, _, patch in sorted(heap, key=lambda item: item[1])]
    pieces = [(p.piece, p.error) for p in done if p.piece is not None]
    return [points for points, _ in pieces], max((error for _, error in pieces), default=0.0)


def _measure(patches: list[Patch], tolerance: float) -> None:
    """Compute the pieces of patches, their errors, and the planes that would divide them best.

    Sums over the triangles of all patches are computed together, because calls of NumPy for few triangles are slow.
    """
    if not patches:
        return
    corners, normals = (np.concatenate([getattr(p, name) for p in patches]) for name in ("corners", "normals"))
    counts = np.array([len(p.corners) for p in patches])
    starts = np.append(0, np.cumsum(counts))
    areas = 0.5 * np.linalg.norm(area_vectors(corners), axis=1)
    ups = np.add.reduceat(normals * areas[:, None], starts[:-1])
    ups /= np.maximum(np.linalg.norm(ups, axis=1), 1e-300)[:, None]
    up_of_face = np.repeat(ups, counts, axis=0)
    levels = np.einsum("ijk,ik->ij", corners, up_of_face)
    covered = np.add.reduceat(areas * np.einsum("ij,ij->i", normals, up_of_face), starts[:-1])
    heights = np.maximum.reduceat(levels.max(axis=1), starts[:-1]) - np.minimum.reduceat(
        levels.min(axis=1), starts[:-1]
    )
    middles = np.concatenate([corners.mean(axis=1)[:, None], 0.5 * (corners + corners[:, (2, 0, 1)])], axis=1)
    for i, patch in enumerate(patches):
        of = slice(starts[i], starts[i + 1])
        flat = patch.corners.reshape(-1, 3) - levels[of].reshape(-1, 1) * ups[i]
        width = float(np.ptp(flat, axis=0).max())
        if counts[i] > _MOST_TRIANGLES and heights[i] > tolerance:
            points = patch.corners.reshape(-1, 3)
            patch.cut = plane_between_layers(levels[of], ups[i], width) or middle_plane(points, patch.corners)
            continue
        # between its corners, a triangle may be further below the piece than at its corners
        _measure_hull(patch, ups[i], middles[of].reshape(-1, 3), float(covered[i]), tolerance)
        if patch.error > tolerance and patch.cut is None:
            is_flat = heights[i] <= tolerance
            patch.cut = (
                dividing_line(patch.corners, ups[i]) if is_flat else plane_between_layers(levels[of], ups[i], width)
            ) or (best_plane(patch, ups[i], areas[of]))


def _measure_hull(patch: Patch, up: Floats, middles: Floats, covered: float, tolerance: float) -> None:
    """Compute the piece of a patch and its error.

    Args:
        patch: patch that receives the results.
        up: normal of the patch.
        middles: centres of the triangles and of their edges [m], shape (n, 3).
        covered: area of the triangles, seen along the normal [m²].
        tolerance: largest error that is not divided [m].
    """
    from scipy.spatial import ConvexHull, QhullError

    points = _distinct(patch.corners.reshape(-1, 3))
    depth = float(patch.depths.min())
    chosen, outside = points, 0.0
    try:
        if len(points) > _FEW_POINTS:
            chosen = points[_support_points(points, up)]
            hull = ConvexHull(np.concatenate([chosen, chosen - depth * up]))
            outside = float((matmul(points, hull.equations[:, :3].T) + hull.equations[:, 3]).max())
        if len(points) <= _FEW_POINTS or outside > tolerance:
            chosen, outside = points, 0.0
            hull = ConvexHull(np.concatenate([points, points - depth * up]))
    except (QhullError, ValueError):
        patch.error = 0.0
        return
    planes, offsets = hull.equations[:, :3], hull.equations[:, 3]
    slopes = matmul(planes, up)
    probes = np.concatenate([points, middles])
    is_top, is_bottom = slopes > _STEEP, slopes < -_STEEP
    sags = -(matmul(probes, planes[is_top].T) + offsets[is_top]).max(axis=1)
    lows = (matmul(points, planes[is_bottom].T) + (offsets[is_bottom] - depth * slopes[is_bottom])).max(axis=1)
    low = max(0.0, -float(lows.min()))
    triangles = hull.points[hull.simplices]
    shadow = 0.25 * float(np.abs(matmul(area_vectors(triangles), up)).sum())  # the hull has two sides
    flat = points - matmul(points, up)[:, None] * up
    sides = flat.max(axis=0) - flat.min(axis=0)
    gap = max(0.0, shadow - covered) / max(2.0 * float(np.sqrt(matmul(sides, sides))), 1e-300)
    deepest = int(sags.argmax())
    sag = float(sags[deepest])
    patch.error = max(sag, low - depth, gap, outside)
    thickness = max(_LEAST_SHARE * depth, depth - low)
    patch.piece = np.concatenate([chosen, chosen - thickness * up])[hull.vertices]
    patch.deepest = probes[deepest] if sag >= patch.error else None


_TILTS: Final = np.radians([3.0, 10.0, 30.0, 90.0, 150.0, 170.0, 177.0])
_ROUND: Final = np.arange(16) * np.pi / 8.0
_DIRECTIONS: Final = np.array(
    [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)]
    + [(np.sin(t) * np.cos(a), np.sin(t) * np.sin(a), np.cos(t)) for t in _TILTS for a in _ROUND]
)
"""Directions in which a patch has its extreme points; most are close to its normal, because a patch is nearly flat."""


def _support_points(points: Floats, up: Floats) -> Ints:
    """Return the indices of the extreme points of a patch: hulls of a few points are fast to compute and to collide."""
    x, y, z = up.tolist()
    u = (0.0, z, -y) if abs(x) <= 0.6 else (-z, 0.0, x)
    length = (u[0] ** 2 + u[1] ** 2 + u[2] ** 2) ** 0.5
    a, b, c = u[0] / length, u[1] / length, u[2] / length
    axes = np.array([(a, b, c), (y * c - z * b, z * a - x * c, x * b - y * a), (x, y, z)])
    directions = matmul(_DIRECTIONS, axes)
    chosen = np.zeros(len(points), bool)
    chosen[matmul(points, directions.T).argmax(axis=0)] = True
    return np.flatnonzero(chosen).astype(np.int32)


def _distinct(points: Floats) -> Floats:
    """Return each point once; `np.unique` needs ten times as long for rows."""
    ordered = points[np.lexsort(points.T)]
    distinct: Floats = ordered[np.append(True, (ordered[1:] != ordered[:-1]).any(axis=1))]
    return distinct
