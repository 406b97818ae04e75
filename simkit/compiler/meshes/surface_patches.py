"""Large convex pieces for the surface of a static mesh with many triangles.

One prism for each triangle makes a world slow to load and to step: MuJoCo takes 0.2 ms to compile a piece, and 1 ns to
pass over it in each step. Therefore the surface is divided into patches that are nearly convex. A patch and its copy
moved inwards have one convex hull. The patch with the largest error is cut in two until no error exceeds a tolerance.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from simkit.compiler.meshes.convex_pieces import ConvexPiece, closed_convex_parts, layer_depths, prism_count
from simkit.compiler.meshes.flat_areas import connected_areas, dividing_line, flat_areas
from simkit.compiler.meshes.height_tiles import HeightTile, height_tiles
from simkit.compiler.meshes.mesh_part import Floats, Ints

TRIANGLES_FROM: Final = 4000
"""Number of triangles up to which a static mesh is divided into prisms, which are exact, instead of patches."""

_COUNTED_MOST: Final = 10_000
"""Number of triangles up to which a mesh with fewer prisms than `TRIANGLES_FROM` is divided into prisms too."""

_PIECES_MOST, _TRIANGLES_PER_PIECE = 2500, 8

TOLERANCE: Final = 1e-4
"""Error of a patch, relative to the size of the mesh, below which it is not cut."""

LEAST_TOLERANCE: Final = 0.5e-3
"""Least value of this error [m]."""

_MOST_TRIANGLES: Final = 128
"""Number of triangles from which a curved patch is cut without computing its hull."""

_FEW_TRIANGLES: Final = 6
"""Number of triangles up to which a patch is divided between triangles, and never through one: a triangle is exact."""

_FEW_POINTS: Final = 16
"""Number of points up to which a patch keeps all of them."""

_BATCH: Final = 256
"""Largest number of patches that are cut before their parts are measured together."""

_SNAP: Final = 1e-7
"""Distance to a plane, relative to the size of the mesh, below which a corner lies in the plane."""

_THIN: Final = 1e-6
"""Height of a triangle, relative to the size of the mesh, below which it is left out."""

_STEEP: Final = 1e-3
"""Sine of the slope from which a side of a piece belongs to its top or bottom."""

_LEAST_SHARE: Final = 0.25
"""Least thickness at the edge of a curved patch, relative to the layer below the surface."""


@dataclass(eq=False, slots=True)
class _Patch:
    """Triangles of one side of the surface.

    Attributes:
        corners: corners of the triangles [m], shape (n, 3, 3).
        normals: unit normals, shape (n, 3).
        depths: largest depth of a piece below each triangle [m], shape (n,).
        error: largest distance between the piece and the layer below the triangles [m]; infinite if it is not computed.
        cut: normal and offset of the plane that divides the patch.
        deepest: point of the triangles that is deepest below the piece [m]; None if another error is larger.
        piece: corners of the convex piece [m], shape (n, 3).
    """

    corners: Floats
    normals: Floats
    depths: Floats
    error: float = np.inf
    cut: tuple[Floats, float] | None = None
    deepest: Floats | None = None
    piece: Floats | None = None


def is_large(vertices: Floats, faces: Ints) -> bool:
    """Check whether a mesh is divided into patches. Coplanar triangles can share one prism and count once."""
    if len(faces) <= TRIANGLES_FROM or len(faces) > _COUNTED_MOST:
        return len(faces) > TRIANGLES_FROM
    return prism_count(vertices, faces) > TRIANGLES_FROM


class LargeSurface(NamedTuple):
    """Bodies that cover the surface of a large static mesh.

    Attributes:
        pieces: convex pieces.
        tiles: height fields of regular grids.
        error: largest distance between a body and the surface [m].
    """

    pieces: list[ConvexPiece]
    tiles: list[HeightTile]
    error: float


def large_surface_pieces(vertices: Floats, faces: Ints) -> LargeSurface:
    """Return the bodies of a large static mesh.

    Closed convex parts are pieces of their own. Regular grids are height fields. All other triangles are divided into
    patches.
    """
    vertices = np.asarray(vertices, float)
    closed, rest = closed_convex_parts(vertices, faces)
    pieces = [ConvexPiece(points, True) for points in closed]
    if not len(rest):
        return LargeSurface(pieces, [], 0.0)
    tiles, is_left = height_tiles(vertices, faces, vertices[rest], LEAST_TOLERANCE)
    if not is_left.any():
        return LargeSurface(pieces, tiles, LEAST_TOLERANCE)
    rest = rest[is_left]
    corners = vertices[rest]
    depths, _ = layer_depths(vertices, faces, corners)
    most = min(_PIECES_MOST, len(rest) // _TRIANGLES_PER_PIECE)
    patches, error = _nearly_convex_patches(corners, depths, most)
    return LargeSurface([*pieces, *(ConvexPiece(points, False) for points in patches)], tiles, error)


def _nearly_convex_patches(corners: Floats, depths: Floats, most: int) -> tuple[list[Floats], float]:
    """Return the points of pieces that cover triangles, and their largest error [m].

    Args:
        corners: corners of the triangles, counter-clockwise from outside [m], shape (n, 3, 3).
        depths: thickness of the layer below each triangle [m], shape (n,).
        most: number of pieces from which only patches with ten times the tolerance are cut. Four times as many pieces
            are the limit.
    """
    normals = _area_vectors(corners)
    lengths = np.linalg.norm(normals, axis=1)
    size = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    # the normal of a triangle that is thinner than the rounding of its corners may have any direction
    longest = np.linalg.norm(corners - corners[:, (1, 2, 0)], axis=2).max(axis=1)
    has_area = lengths > _THIN * size * longest
    if not has_area.any():
        return [], 0.0
    corners, depths, normals = corners[has_area], depths[has_area], normals[has_area] / lengths[has_area, None]
    tolerance = max(LEAST_TOLERANCE, TOLERANCE * size)
    coarse = 10.0 * tolerance
    axis = np.abs(normals).argmax(axis=1)
    side = 2 * axis + (normals[np.arange(len(axis)), axis] < 0.0)
    areas = flat_areas(corners, normals)
    side[np.concatenate([np.zeros(0, int), *areas])] = -1
    curved = np.flatnonzero(side >= 0)
    parts = [curved[part] for part in connected_areas(corners[curved], side[curved])]
    # parts of one patch would be joined by its hull until cuts have separated them
    groups = [*areas, *(parts if len(parts) <= 4 * most else (np.flatnonzero(side == k) for k in range(6)))]
    waiting = [_Patch(corners[group], normals[group], depths[group]) for group in groups if len(group)]
    heap: list[tuple[float, int, _Patch]] = []
    done: list[_Patch] = []
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
        if not heap or (number >= most and worst <= coarse) or (number >= 4 * most and worst < np.inf):
            break
        waiting = []
        # patches with a similar error are measured together; none is cut that could stay
        least, room = max(0.5 * worst, coarse if number >= most else 0.0), _BATCH
        if worst <= coarse:
            room = min(room, most - number)
        while room and heap and (not waiting or -heap[0][0] >= least):
            waiting += _cut(heapq.heappop(heap)[2], _SNAP * size)
            room -= 1
    done += [patch for _, _, patch in sorted(heap, key=lambda item: item[1])]
    pieces = [(p.piece, p.error) for p in done if p.piece is not None]
    return [points for points, _ in pieces], max((error for _, error in pieces), default=0.0)


def _measure(patches: list[_Patch], tolerance: float) -> None:
    """Compute the pieces of patches, their errors, and the planes that would divide them best.

    Sums over the triangles of all patches are computed together, because calls of NumPy for few triangles are slow.
    """
    if not patches:
        return
    corners, normals = (np.concatenate([getattr(p, name) for p in patches]) for name in ("corners", "normals"))
    counts = np.array([len(p.corners) for p in patches])
    starts = np.append(0, np.cumsum(counts))
    areas = 0.5 * np.linalg.norm(_area_vectors(corners), axis=1)
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
            patch.cut = _between_layers(levels[of], ups[i], width) or _middle(points, patch.corners)
            continue
        # between its corners, a triangle may be further below the piece than at its corners
        _measure_hull(patch, ups[i], middles[of].reshape(-1, 3), float(covered[i]), tolerance)
        if patch.error > tolerance and patch.cut is None:
            is_flat = heights[i] <= tolerance
            patch.cut = (
                dividing_line(patch.corners, ups[i]) if is_flat else _between_layers(levels[of], ups[i], width)
            ) or (_best_cut(patch, ups[i], areas[of]))


def _measure_hull(patch: _Patch, up: Floats, middles: Floats, covered: float, tolerance: float) -> None:
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
            outside = float((points @ hull.equations[:, :3].T + hull.equations[:, 3]).max())
        if len(points) <= _FEW_POINTS or outside > tolerance:
            chosen, outside = points, 0.0
            hull = ConvexHull(np.concatenate([points, points - depth * up]))
    except (QhullError, ValueError):
        patch.error = 0.0
        return
    planes, offsets = hull.equations[:, :3], hull.equations[:, 3]
    slopes = planes @ up
    probes = np.concatenate([points, middles])
    is_top, is_bottom = slopes > _STEEP, slopes < -_STEEP
    sags = -(probes @ planes[is_top].T + offsets[is_top]).max(axis=1)
    lows = (points @ planes[is_bottom].T + (offsets[is_bottom] - depth * slopes[is_bottom])).max(axis=1)
    low = max(0.0, -float(lows.min()))
    triangles = hull.points[hull.simplices]
    shadow = 0.25 * float(np.abs(_area_vectors(triangles) @ up).sum())  # the hull has two sides
    flat = points - (points @ up)[:, None] * up
    sides = flat.max(axis=0) - flat.min(axis=0)
    gap = max(0.0, shadow - covered) / max(2.0 * float(np.sqrt(sides @ sides)), 1e-300)
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
    directions = _DIRECTIONS @ axes
    chosen = np.zeros(len(points), bool)
    chosen[(points @ directions.T).argmax(axis=0)] = True
    return np.flatnonzero(chosen).astype(np.int32)


def _distinct(points: Floats) -> Floats:
    """Return each point once; `np.unique` needs ten times as long for rows."""
    ordered = points[np.lexsort(points.T)]
    distinct: Floats = ordered[np.append(True, (ordered[1:] != ordered[:-1]).any(axis=1))]
    return distinct


def _area_vectors(corners: Floats) -> Floats:
    """Return the normals of triangles with twice their areas as lengths; `np.cross` is slow for few triangles."""
    (ax, ay, az), (bx, by, bz) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    return np.column_stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def _between_layers(levels: Floats, up: Floats, width: float) -> tuple[Floats, float] | None:
    """Return the plane in the widest gap between layers of triangles; None without a wide gap.

    Args:
        levels: heights of the corners of each triangle along `up` [m], shape (n, 3).
        up: normal of the patch.
        width: extent of the patch across the normal [m].
    """
    low, high = levels.min(axis=1), levels.max(axis=1)
    order = low.argsort(kind="stable")
    gaps = low[order][1:] - np.maximum.accumulate(high[order])[:-1]
    height = float(high.max() - low.min())
    # a stack of many even layers, higher than it is wide, has no wide gap, but no other cut would separate the layers
    least = 0.3 if height < width else 0.3 / len(low)
    if not len(gaps) or gaps.max() <= least * height:
        return None
    widest = int(gaps.argmax())
    return up, float(low[order][widest + 1] - 0.5 * gaps[widest])


def _middle(points: Floats, corners: Floats) -> tuple[Floats, float]:
    """Return the plane across the longest side of a patch, through the median of its triangles."""
    along = np.eye(3)[int(np.ptp(points, axis=0).argmax())]
    low, high = (corners @ along).min(), (corners @ along).max()
    at = float(np.median(corners.mean(axis=1) @ along))
    return along, float(np.clip(at, low + 0.2 * (high - low), high - 0.2 * (high - low)))


def _best_cut(patch: _Patch, up: Floats, areas: Floats) -> tuple[Floats, float]:
    """Return the plane across the bend through the deepest point, or through the middle."""
    points = patch.corners.reshape(-1, 3)
    if patch.deepest is not None:
        across = patch.normals - (patch.normals @ up)[:, None] * up
        values, vectors = np.linalg.eigh((across * areas[:, None]).T @ across)
        direction = vectors[:, 2]
        places = points @ direction
        at, start, end = float(patch.deepest @ direction), places.min(), places.max()
        if values[2] > 0.0 and start + 0.15 * (end - start) < at < end - 0.15 * (end - start):
            return direction, float(at)
    flat = points - (points @ up)[:, None] * up
    flat -= flat.mean(axis=0)
    _, vectors = np.linalg.eigh(flat.T @ flat)
    direction = vectors[:, 2]
    places = points @ direction
    return direction, float(0.5 * (places.min() + places.max()))


def _cut(patch: _Patch, snap: float) -> list[_Patch]:
    """Return the parts of a patch on both sides of its plane; triangles across the plane are divided."""
    assert patch.cut is not None
    normal, offset = patch.cut
    sides = patch.corners @ normal - offset
    if len(sides) <= _FEW_TRIANGLES:
        places = sides.mean(axis=1)
        is_above = places >= 0.0
        if is_above.all() or not is_above.any():
            is_above = places >= np.sort(places)[len(places) // 2]
        sides = np.where(is_above, 1.0, -1.0)[:, None] * np.ones(3)
    sides[np.abs(sides) <= snap] = 0.0
    above, below = (sides >= 0.0).all(axis=1), (sides <= 0.0).all(axis=1) & ~(sides >= 0.0).all(axis=1)
    parts: dict[bool, list[tuple[Floats, Floats, Floats]]] = {
        True: [(patch.corners[above], patch.normals[above], patch.depths[above])],
        False: [(patch.corners[below], patch.normals[below], patch.depths[below])],
    }
    crossing = np.flatnonzero(~above & ~below)
    if len(crossing):
        s = sides[crossing]
        # the first corner is alone on its side, or its side has one corner and the plane passes through another
        alone = np.where((s > 0.0).sum(axis=1) == 1, (s > 0.0).argmax(axis=1), (s < 0.0).argmax(axis=1))
        order = (alone[:, None] + np.arange(3)) % 3
        c = np.take_along_axis(patch.corners[crossing], order[:, :, None], axis=1)
        s = np.take_along_axis(s, order, axis=1)
        n, d = patch.normals[crossing], patch.depths[crossing]
        p, q = (c[:, 0] + (s[:, 0] / (s[:, 0] - s[:, k]))[:, None] * (c[:, k] - c[:, 0]) for k in (1, 2))
        positive = s[:, 0] > 0.0
        pieces = ((c[:, 0], p, q), (p, c[:, 1], c[:, 2]), (p, c[:, 2], q))
        for k, piece in enumerate(pieces):
            t = np.stack(piece, axis=1)
            for which in (True, False):
                here = (positive if k == 0 else ~positive) == which
                parts[which].append((t[here], n[here], d[here]))
    result = []
    for which in (True, False):
        corners, normals, depths = (np.concatenate([part[k] for part in parts[which]]) for k in range(3))
        areas = np.linalg.norm(_area_vectors(corners), axis=1)
        keep = areas > snap * snap
        if keep.any():
            result.append(_Patch(corners[keep], normals[keep], depths[keep]))
    return result
