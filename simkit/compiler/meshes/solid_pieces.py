"""Convex pieces of closed parts that few cuts make nearly convex, such as rings, pipes and legs of furniture.

A closed part encloses a solid. Each plane divides the solid in two, and the hull of one side of the surface is the hull
of one side of the solid. Therefore no surface is added along the planes. A pipe needs one solid piece where its curved
surface needs several height fields. A part is left to other methods as soon as its error decreases too slowly.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from simkit.compiler.meshes.connected_triangles import is_closed
from simkit.compiler.meshes.convex_pieces import hull_volume
from simkit.compiler.meshes.flat_areas import connected_areas
from simkit.compiler.meshes.patch_division import Patch, area_vectors, divide
from simkit.float_sum import float_sum
from simkit.linear_algebra import dot, matmul, norm
from simkit.loaders.meshes.mesh_part import Floats, Indices, Ints
from simkit.matrix_decompositions import eigh

TRIANGLES_PER_PIECE: Final = 12
"""Least number of triangles for one piece; height fields and patches do not need fewer pieces than that."""

_LARGEST_PART: Final = 2000
"""Largest number of triangles of a divided part; larger parts have large height fields and take seconds here."""

_FAILURES_MOST: Final = 20
"""Number of different parts that need too many pieces after which no further part is tried."""

_EQUAL: Final = 1e-6
"""Largest difference of equal parts, relative to the largest coordinate of the mesh: the rounding of a file."""

_SETTLED: Final = 6
"""Number of pieces from which the error must decrease with the square of the number of pieces, as along a pipe."""

_SLACK: Final = 1.5
"""Factor by which the error may exceed this law."""

_MARGIN: Final = 0.15
"""Least distance of a plane from the ends of a cell, relative to the extent across the plane."""

_GAIN: Final = 0.8
"""Share of the largest decrease of the volume of the hulls from which a plane across a longer axis is used."""

_LEAST_GAIN: Final = 1e-4
"""Decrease of the volume, relative to the volume, up to which all planes are equal: the first cuts of a ring."""

_EQUAL_MOMENTS: Final = 1e-4
"""Difference of two moments, relative to the largest one, below which they are equal but for rounding."""

_SNAP: Final = 1e-7
"""Distance to a plane, relative to the size of the part, below which a corner lies in the plane."""

_PROBES: Final = ((1 / 3, 1 / 3, 1 / 3), (0.1, 0.45, 0.45), (0.45, 0.1, 0.45), (0.45, 0.45, 0.1))
"""Places in a triangle of a hull from which rays measure the distance to the surface."""


class SolidPieces(NamedTuple):
    """Convex pieces of a closed part.

    Attributes:
        pieces: corners of each piece [m].
        error: largest distance between a piece and the surface [m].
    """

    pieces: list[Floats]
    error: float


class SolidParts(NamedTuple):
    """Convex pieces of all closed parts that need few of them.

    Attributes:
        pieces: corners of each different piece [m].
        copies: number of a piece and offset [m] of each further place of it.
        error: largest distance between a piece and the surface [m].
        faces: numbers of the triangles of the divided parts.
    """

    pieces: list[Floats]
    copies: list[tuple[int, Floats]]
    error: float
    faces: list[Indices]


def solid_parts(vertices: Floats, faces: Ints, parts: list[Indices], tolerance: float) -> SolidParts:
    """Return the convex pieces of closed parts; equal parts at several places are divided once.

    Args:
        vertices: vertices of the mesh [m], shape (n, 3).
        faces: vertex indices, shape (m, 3).
        parts: numbers of the triangles of each connected part that encloses a solid.
        tolerance: largest distance between a piece and the surface [m].
    """
    rounding = _EQUAL * float(np.abs(vertices).max(initial=0.0))
    known: dict[int, list[tuple[Floats, range]]] = {}
    result, failures = SolidParts([], [], 0.0, []), 0
    for part in parts:
        if not 2 * TRIANGLES_PER_PIECE <= len(part) <= _LARGEST_PART or not is_closed(faces[part]):
            continue
        corners = vertices[faces[part]]
        same = known.setdefault(len(part), [])
        same_shape = next((item for item in same if _is_equal(item[0], corners, rounding)), None)
        if same_shape is None:
            if failures >= _FAILURES_MOST:
                continue
            solid = solid_pieces(corners, tolerance)
            failures += solid is None
            first = len(result.pieces)
            if solid is not None:
                result = result._replace(error=max(result.error, solid.error + rounding))
                result.pieces.extend(solid.pieces)
            same_shape = corners, range(first, len(result.pieces))
            same.append(same_shape)
        else:
            offset = corners.mean(axis=(0, 1)) - same_shape[0].mean(axis=(0, 1))
            result.copies.extend((number, offset) for number in same_shape[1])
        if same_shape[1]:
            result.faces.append(part)
    return result


def _is_equal(values: Floats, other: Floats, rounding: float) -> bool:
    """Check whether two parts have the same triangles at different places."""
    shift = other - values
    return bool(np.abs(shift - shift[0, 0]).max() <= 4.0 * rounding)


@dataclass(eq=False, slots=True)
class _Cell:
    """Part of a solid between planes.

    Attributes:
        corners: corners of the triangles of its surface, without those in the planes [m], shape (n, 3, 3).
        planes: outward normals and offsets of the planes, shape (k, 4).
        points: corners of its hull [m], shape (m, 3).
        error: largest distance between the hull and the surface [m].
        deepest: point of the surface that is deepest below the hull [m].
        outside: triangles of the hull that lie in no plane [m], shape (k, 3, 3).
    """

    corners: Floats
    planes: Floats
    points: Floats
    error: float = 0.0
    deepest: Floats | None = None
    outside: Floats | None = None


def solid_pieces(corners: Floats, tolerance: float) -> SolidPieces | None:
    """Return convex pieces of the solid in a closed surface; None if it needs too many pieces.

    Args:
        corners: corners of the triangles, counter-clockwise from outside [m], shape (n, 3, 3).
        tolerance: largest distance between a piece and the surface [m].
    """
    most = len(corners) // TRIANGLES_PER_PIECE
    points = corners.reshape(-1, 3)
    size = float(np.ptp(points, axis=0).max())
    surface = _RayTarget(corners)
    waiting: list[_Cell] = [_Cell(corners, np.zeros((0, 4)), points)]
    done: list[_Cell] = []
    while waiting:
        for cell in waiting:
            if not _measure(cell, _SNAP * size):
                return None
        fitting = [cell for cell in waiting if cell.error <= tolerance]
        if not surface.add_gaps(fitting, _SNAP * size, tolerance):
            return None
        done += [cell for cell in fitting if cell.error <= tolerance]
        worst = max(cell.error for cell in waiting)
        waiting = [cell for cell in waiting if cell.error > tolerance]
        count = len(done) + len(waiting)
        is_slow = count >= _SETTLED and min(worst, size) * (count / most) ** 2 > _SLACK * tolerance
        if waiting and (is_slow or count + len(waiting) > most):
            return None
        waiting = [part for cell in waiting for part in _divided(cell, _SNAP * size)]
    return SolidPieces([cell.points for cell in done], max(cell.error for cell in done))


def _measure(cell: _Cell, snap: float) -> bool:
    """Compute the hull of a cell and the largest depth of its surface below it; return False for a flat cell."""
    from scipy.spatial import ConvexHull, QhullError

    points = _distinct(cell.corners.reshape(-1, 3))
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return False
    cell.points = points[hull.vertices]
    across = matmul(hull.equations[:, :3], cell.planes[:, :3].T)
    is_cut = ((across > 1.0 - 1e-6) & (np.abs(hull.equations[:, 3:] + cell.planes[:, 3]) < 100.0 * snap)).any(axis=1)
    planes = hull.equations[~is_cut]
    if not len(planes):
        return False
    cell.outside = hull.points[hull.simplices[~is_cut]]
    middles = np.concatenate([cell.corners.mean(axis=1)[:, None], 0.5 * (cell.corners + cell.corners[:, (1, 2, 0)])], 1)
    probes = np.concatenate([points, middles.reshape(-1, 3)])
    depths = -(matmul(probes, planes[:, :3].T) + planes[:, 3]).max(axis=1)
    deepest = int(depths.argmax())
    cell.error, cell.deepest = float(depths[deepest]), probes[deepest]
    return True


class _RayTarget:
    """Surface of a closed part that is hit by rays.

    Args:
        corners: corners of the triangles [m], shape (n, 3, 3).
    """

    def __init__(self, corners: Floats) -> None:
        import trimesh

        faces = np.arange(3 * len(corners)).reshape(-1, 3)
        self._mesh = trimesh.Trimesh(corners.reshape(-1, 3), faces, process=False)

    def add_gaps(self, cells: list[_Cell], least: float, limit: float) -> bool:
        """Increase the errors of cells to the distances from their hulls to the surface.

        Args:
            cells: cells whose hulls are known.
            least: height of triangles that are too thin for a normal [m].
            limit: largest distance along a ray that is not computed again as the shortest distance [m].

        Returns:
            False if this platform has no ray tracer.
        """
        outside = [cell.outside for cell in cells if cell.outside is not None]
        if not outside:
            return True
        triangles = np.concatenate(outside)
        of = np.repeat(np.arange(len(cells)), [len(each) for each in outside])
        inward = area_vectors(triangles)
        lengths = np.linalg.norm(inward, axis=1)
        sides = np.linalg.norm(triangles - triangles[:, (1, 2, 0)], axis=2).max(axis=1)
        keep = lengths > least * sides
        triangles, of, inward = triangles[keep], of[keep], inward[keep] / lengths[keep, None]
        middles = np.stack([np.einsum("ijk,j->ik", triangles, weights) for weights in _PROBES], axis=1).reshape(-1, 3)
        hulls = np.array([cell.points.mean(axis=0) for cell in cells])
        inward *= np.sign(np.einsum("ij,ij->i", hulls[of] - triangles[:, 0], inward))[:, None]
        of, inward = np.repeat(of, len(_PROBES)), np.repeat(inward, len(_PROBES), axis=0)
        skin = 1e-4 * float(self._mesh.scale)
        gaps = np.full(len(of), np.inf)
        try:
            points, rays, _ = self._mesh.ray.intersects_location(middles - skin * inward, inward, multiple_hits=False)
        except ImportError:
            return False
        gaps[rays] = np.einsum("ij,ij->i", points - middles[rays], inward[rays])
        largest = np.zeros(len(cells))
        for k in np.flatnonzero(gaps > limit).tolist():  # a ray along a hole goes on to the other end
            gaps[k] = _distance(middles[k], cells[of[k]].corners) if largest[of[k]] <= limit else 0.0
            largest[of[k]] = max(largest[of[k]], gaps[k])
        np.maximum.at(largest, of, gaps)
        for cell, gap in zip(cells, largest.tolist(), strict=True):
            cell.error = max(cell.error, gap)
        return True


def _distance(point: Floats, triangles: Floats) -> float:
    """Return the distance from a point to the nearest of some triangles [m]."""
    from trimesh.triangles import closest_point

    nearest = closest_point(triangles, np.broadcast_to(point, (len(triangles), 3)))
    return float(np.linalg.norm(nearest - point, axis=1).min())


def _divided(cell: _Cell, snap: float) -> list[_Cell]:
    """Return the connected cells on both sides of the plane that is chosen for a cell."""
    normal, offset = _best_plane(cell)
    triangles = cell.corners
    patch = Patch(triangles, triangles[:, 0], np.zeros(len(triangles)), cut=(normal, offset))
    result = []
    for part in divide(patch, snap):
        sign = 1.0 if float(matmul(part.corners.mean(axis=(0, 1)), normal)) < offset else -1.0
        planes = np.vstack([cell.planes, np.append(sign * normal, sign * offset)])
        members = connected_areas(part.corners, np.zeros(len(part.corners), np.int64))
        pieces = [part.corners[of] for of in members]
        if len(pieces) > 1 and not all(_is_enclosed(corners, planes, 100.0 * snap) for corners in pieces):
            pieces = [part.corners]
        result += [_Cell(corners, planes, corners.reshape(-1, 3)) for corners in pieces]
    return result


def _is_enclosed(corners: Floats, planes: Floats, snap: float) -> bool:
    """Check whether a connected surface encloses a solid, together with areas of its own in the planes.

    The inner side of a pipe does not: its borders go around holes. The upper side of a plate does not: its borders in
    one plane are open lines.
    """
    start, end = corners.reshape(-1, 3), corners[:, (1, 2, 0)].reshape(-1, 3)
    heights_of_start, heights_of_end = (
        np.abs(matmul(at, planes[:, :3].T) - planes[:, 3]) <= snap for at in (start, end)
    )
    is_border = heights_of_start & heights_of_end
    for k, plane in enumerate(planes):
        a, b = start[is_border[:, k]], end[is_border[:, k]]
        if not len(a):
            continue
        origin = a.mean(axis=0)
        length = float(np.linalg.norm(b - a, axis=1).sum())
        area = -0.5 * float(matmul(np.cross(a - origin, b - origin).sum(axis=0), plane[:3]))
        if norm((b - a).sum(axis=0)) > max(1e-3 * length, snap) or area <= 0.0:
            return False
    return True


def _best_plane(cell: _Cell) -> tuple[Floats, float]:
    """Return the plane across an axis of a cell whose sides have small hulls, first across the longest axis."""
    triangles = cell.corners
    points, weights = triangles.reshape(-1, 3), np.linalg.norm(area_vectors(triangles), axis=1)
    offsets = points - np.average(triangles.mean(axis=1), axis=0, weights=weights)
    middles = offsets.reshape(-1, 3, 3).sum(axis=1)
    moments = matmul((offsets * np.repeat(weights, 3)[:, None]).T, offsets) + matmul(
        (middles * weights[:, None]).T, middles
    )
    axes = _principal_axes(moments)
    lows, highs = matmul(points, axes.T).min(axis=0), matmul(points, axes.T).max(axis=0)
    order = np.argsort(lows - highs, kind="stable")
    # across the shortest axis, the parts would be layers, and the surface of a layer does not have all of its corners
    planes = [(axes[k], 0.5 * float(lows[k] + highs[k])) for k in order[:2].tolist()]
    first = int(order[0])
    deepest = float(matmul(cell.deepest, axes[first])) if cell.deepest is not None else -np.inf
    margin = _MARGIN * float(highs[first] - lows[first])
    if lows[first] + margin < deepest < highs[first] - margin:
        planes.append((axes[first], deepest))
    volumes = np.array([float_sum(map(hull_volume, _side_points(triangles, *plane))) for plane in planes])
    volume = hull_volume(points)
    gains = volume - volumes
    if gains.max() <= _LEAST_GAIN * volume:
        return planes[0]
    return planes[int(np.argmax(gains >= _GAIN * gains.max()))]


def _principal_axes(moments: Floats) -> Floats:
    """Return the principal axes of a tensor as rows.

    Of equal moments, as of a ring, any axes are principal, and the rounding of the corners would choose. There the axes
    are those next to the coordinate axes, so that copies of a part are divided alike.
    """
    values, axes = eigh(moments)
    near = np.diff(values) <= _EQUAL_MOMENTS * values[2]
    if near.all():
        return np.eye(3)
    if near.any():
        normal = axes[:, 2 if near[0] else 0]
        first = np.eye(3)[int(np.abs(normal).argmin())]
        first = first - dot(first, normal) * normal
        first = first / norm(first)
        return np.array((first, np.cross(normal, first), normal))
    turned: Floats = axes.T
    return turned


def _side_points(triangles: Floats, normal: Floats, offset: float) -> list[Floats]:
    """Return the points of the surface on both sides of a plane."""
    patch = Patch(triangles, triangles[:, 0], np.zeros(len(triangles)), cut=(normal, offset))
    return [part.corners.reshape(-1, 3) for part in divide(patch, 0.0)]


def _distinct(points: Floats) -> Floats:
    """Return each point once."""
    ordered = points[np.lexsort(points.T)]
    distinct: Floats = ordered[np.append(True, (ordered[1:] != ordered[:-1]).any(axis=1))]
    return distinct
