"""Patches of a surface, the planes that divide them, and their division."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from simkit.linear_algebra import matmul
from simkit.loaders.meshes.mesh_part import Floats
from simkit.matrix_decompositions import eigh

_FEW_TRIANGLES: Final = 6
"""Number of triangles up to which a patch is divided between triangles, and never through one: a triangle is exact."""


@dataclass(eq=False, slots=True)
class Patch:
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


def area_vectors(corners: Floats) -> Floats:
    """Return the normals of triangles with twice their areas as lengths; `np.cross` is slow for few triangles."""
    (ax, ay, az), (bx, by, bz) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    return np.column_stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def plane_between_layers(levels: Floats, up: Floats, width: float) -> tuple[Floats, float] | None:
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


def middle_plane(points: Floats, corners: Floats) -> tuple[Floats, float]:
    """Return the plane across the longest side of a patch, through the median of its triangles."""
    along = np.eye(3)[int(np.ptp(points, axis=0).argmax())]
    low, high = matmul(corners, along).min(), matmul(corners, along).max()
    at = float(np.median(matmul(corners.mean(axis=1), along)))
    return along, float(np.clip(at, low + 0.2 * (high - low), high - 0.2 * (high - low)))


def best_plane(patch: Patch, up: Floats, areas: Floats) -> tuple[Floats, float]:
    """Return the plane across the bend through the deepest point, or through the middle."""
    points = patch.corners.reshape(-1, 3)
    if patch.deepest is not None:
        across = patch.normals - matmul(patch.normals, up)[:, None] * up
        values, vectors = eigh(matmul((across * areas[:, None]).T, across))
        direction = vectors[:, 2]
        places = matmul(points, direction)
        at, start, end = float(matmul(patch.deepest, direction)), places.min(), places.max()
        if values[2] > 0.0 and start + 0.15 * (end - start) < at < end - 0.15 * (end - start):
            return direction, float(at)
    flat = points - matmul(points, up)[:, None] * up
    flat -= flat.mean(axis=0)
    _, vectors = eigh(matmul(flat.T, flat))
    direction = vectors[:, 2]
    places = matmul(points, direction)
    return direction, float(0.5 * (places.min() + places.max()))


def divide(patch: Patch, snap: float) -> list[Patch]:
    """Return the parts of a patch on both sides of its plane; triangles across the plane are divided."""
    assert patch.cut is not None
    normal, offset = patch.cut
    sides = matmul(patch.corners, normal) - offset
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
        areas = np.linalg.norm(area_vectors(corners), axis=1)
        keep = areas > snap * snap
        if keep.any():
            result.append(Patch(corners[keep], normals[keep], depths[keep]))
    return result
