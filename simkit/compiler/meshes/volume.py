"""How much a mesh encloses, beside its convex hull."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.compiler.meshes.part import Floats, Ints

_CELLS: Final = 24  # along each axis
_SAMPLES: Final = 80_000


def volume_of(vertices: Floats, faces: Ints) -> float:
    """Volume of a closed mesh [m³]; 0 for an open one."""
    corners = faces.astype(np.int64)
    edges = np.sort(corners[:, (0, 1, 1, 2, 2, 0)].reshape(-1, 2), axis=1)
    counts = np.unique(edges[:, 0] * len(vertices) + edges[:, 1], return_counts=True)[1]
    if not len(counts) or (counts != 2).any():
        return 0.0
    a, b, c = (np.asarray(vertices, np.float64)[corners[:, i]] for i in range(3))
    normals = np.cross(b - a, c - b)
    return abs(float((normals[:, 0] * (a + b + c)[:, 0]).sum() / 6.0))


def filled_ratio(vertices: Floats, faces: Ints, sets: list[Floats]) -> float:
    """How many times as large hulls are as what a mesh encloses that need not be closed: an estimate, at least 1.

    A point is enclosed where triangles lie on both of its sides along each axis. Hulls are measured in the same way, so
    that the coarseness of the cells does not count.

    Args:
        vertices, faces: the mesh.
        sets: corners of the hulls that stand for it, shape (n, 3) each.
    """
    from scipy.spatial import ConvexHull, QhullError

    low = vertices.min(axis=0)
    size = np.maximum(np.ptp(vertices, axis=0), 1e-12) / _CELLS
    own = _enclosed(vertices[faces], low, size)
    whole = np.zeros_like(own)
    for points in sets:
        try:
            whole |= _enclosed(points[ConvexHull(points).simplices], low, size)
        except (QhullError, ValueError):
            continue
    return max(1.0, float(whole.sum()) / max(1.0, float((own & whole).sum())))


def _enclosed(corners: Floats, low: Floats, size: Floats) -> npt.NDArray[np.bool_]:
    """The cells that triangles enclose, shape (cells, cells, cells)."""
    cells = np.clip(((_spread(corners) - low) / size).astype(int), 0, _CELLS - 1)
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


def _spread(corners: Floats) -> Floats:
    """Points spread evenly over triangles, always the same ones, and their corners."""
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
