"""Flat areas of a surface, such as walls and floors, and the lines that divide them into convex areas."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np

from simkit.compiler.meshes.connected_triangles import members_of, part_numbers
from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul, norm
from simkit.loaders.meshes.mesh_part import Floats, Indices

_LEAST_AREA: Final = 8.0
"""Area relative to the median triangle from which triangles in one plane are divided along their own outline."""

_ANGLE: Final = 1e-4
"""Difference between the normals of triangles in one plane."""

_EXACT: Final = 1e-9
"""Difference between the area of triangles and that of their hull, relative to the area, that is rounding."""

_FEW_TRIANGLES: Final = 8
"""Number of triangles up to which the hull is computed without Qhull."""

_LINES: Final = 10
"""Number of lines that are compared, the longest sides of the outline."""

_LEAST_DISTANCE: Final = 1e-3
"""Least distance of a line from the ends of the area, relative to its size."""


def flat_areas(corners: Floats, normals: Floats) -> list[Indices]:
    """Return the triangles of each connected area in one plane; the triangles that are left are not in the result.

    Args:
        corners: corners of the triangles [m], shape (n, 3, 3).
        normals: unit normals, shape (n, 3).
    """
    size = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    offsets = np.einsum("ij,ij->i", corners[:, 0], normals)
    plane = np.column_stack([np.rint(normals / _ANGLE), np.rint(offsets / (_ANGLE * size))])
    point = np.rint(corners.reshape(-1, 3) / (1e-6 * size))
    planes, points = _numbers(plane), _numbers(np.column_stack([np.repeat(plane, 3, axis=0), point]))
    sizes = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    least = _LEAST_AREA * float(np.median(sizes))
    chosen = np.flatnonzero((np.bincount(planes, sizes)[planes] >= least) & (np.bincount(planes)[planes] > 1))
    if not len(chosen):
        return []
    areas = [chosen[area] for area in members_of(part_numbers(points.reshape(-1, 3)[chosen]))]
    return [area for area in areas if len(area) > 1 and sizes[area].sum() >= least]


def connected_areas(corners: Floats, sides: Indices) -> list[Indices]:
    """Return the triangles of each connected area of one side.

    Args:
        corners: corners of the triangles [m], shape (n, 3, 3).
        sides: number of the side of each triangle, shape (n,).
    """
    if not len(corners):
        return []
    size = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    point = np.rint(corners.reshape(-1, 3) / (1e-6 * size))
    return members_of(part_numbers(_numbers(np.column_stack([np.repeat(sides, 3), point])).reshape(-1, 3)))


def _numbers(rows: Floats) -> Indices:
    """Return a number for each row, equal for equal rows; `np.unique` of rows is ten times as slow."""
    order = np.lexsort(rows.T)
    numbers = np.empty(len(rows), np.int64)
    numbers[order] = np.cumsum(np.append(False, (rows[order][1:] != rows[order][:-1]).any(axis=1)))
    return numbers


def dividing_line(corners: Floats, up: Floats) -> tuple[Floats, float] | None:
    """Return the plane along a side of the outline of a flat area whose parts have the least hulls; None without one.

    Args:
        corners: corners of the triangles [m], shape (n, 3, 3).
        up: unit normal of the area.
    """
    u = np.cross(up, np.eye(3)[int(np.abs(up).argmin())])
    u /= norm(u)
    v = np.cross(up, u)
    flat = np.stack([matmul(corners, u), matmul(corners, v)], axis=-1)
    size = float(np.ptp(flat.reshape(-1, 2), axis=0).max())
    lines = _outline_lines(flat, size)
    middles, best, least = flat.mean(axis=1), None, np.inf
    (a, b), (c, d) = (flat[:, 1] - flat[:, 0]).T, (flat[:, 2] - flat[:, 0]).T
    covered = 0.5 * float(np.abs(a * d - b * c).sum())
    for direction, offset in lines:
        across = np.array((-direction[1], direction[0]))
        distances = matmul(flat, across) - offset
        if distances.max() < _LEAST_DISTANCE * size or distances.min() > -_LEAST_DISTANCE * size:
            continue
        is_above = matmul(middles, across) > offset
        total = _hull_area(flat[is_above]) + _hull_area(flat[~is_above])
        if total < least * (1.0 - 1e-6):
            best, least = (across[0] * u + across[1] * v, float(offset)), total
            if abs(total - covered) <= _EXACT * covered:  # both parts are convex
                break
    return best


def _outline_lines(flat: Floats, size: float) -> list[tuple[Floats, float]]:
    """Return direction and offset of the longest lines of an outline: of edges that only one triangle has."""
    start, end = flat.reshape(-1, 2), flat[:, (1, 2, 0)].reshape(-1, 2)
    ends = np.rint(np.concatenate([start, end], axis=1) / (1e-6 * size))
    is_swapped = (ends[:, 0] > ends[:, 2]) | ((ends[:, 0] == ends[:, 2]) & (ends[:, 1] > ends[:, 3]))
    numbers = _numbers(np.where(is_swapped[:, None], ends[:, (2, 3, 0, 1)], ends))
    is_single = np.bincount(numbers)[numbers] == 1
    along = (end - start)[is_single]
    lengths = np.linalg.norm(along, axis=1)
    along, first, lengths = along[lengths > 0.0], start[is_single][lengths > 0.0], lengths[lengths > 0.0]
    if not len(along):
        return []
    along /= lengths[:, None]
    along *= np.where((along[:, 0] < -_ANGLE) | ((np.abs(along[:, 0]) <= _ANGLE) & (along[:, 1] < 0.0)), -1.0, 1.0)[
        :, None
    ]
    offsets = first[:, 1] * along[:, 0] - first[:, 0] * along[:, 1]
    lines = _numbers(np.column_stack([np.rint(along / 1e-3), np.rint(offsets / (1e-3 * size))]))
    totals = np.bincount(lines, lengths)
    longest = np.argsort(-totals, kind="stable")[:_LINES]
    first_edges = [int(np.flatnonzero(lines == line)[0]) for line in longest]
    return [(along[k], float(offsets[k])) for k in first_edges]


def _hull_area(flat: Floats) -> float:
    """Return the area of the hull of triangles in a plane [m²]; 0 for none."""
    from scipy.spatial import ConvexHull, QhullError

    if len(flat) <= _FEW_TRIANGLES:
        return _few_points_area(flat.reshape(-1, 2))
    try:
        return float(ConvexHull(flat.reshape(-1, 2)).volume)
    except (QhullError, ValueError):
        return 0.0


def _few_points_area(points: Floats) -> float:
    """Return the area of the hull of points in a plane [m²]; for few points, this is faster than Qhull."""
    if not len(points):
        return 0.0
    ordered = sorted(map(tuple, (points - points[0]).tolist()))
    area = 0.0
    for side in (ordered, ordered[::-1]):
        hull: list[tuple[float, float]] = []
        for x, y in side:
            while len(hull) > 1 and (hull[-1][0] - hull[-2][0]) * (y - hull[-2][1]) <= (
                (hull[-1][1] - hull[-2][1]) * (x - hull[-2][0])
            ):
                hull.pop()
            hull.append((x, y))
        area += float_sum(a[0] * b[1] - a[1] * b[0] for a, b in pairwise(hull))
    return 0.5 * area
