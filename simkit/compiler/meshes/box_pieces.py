"""Convex pieces of a mesh that are boxes, such as those of walls and floors. The engine needs no hull for them."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from simkit.linear_algebra import det, matmul
from simkit.loaders.meshes.mesh_part import Floats, Indices

_ROUNDING: Final = 1e-5
"""Largest distance of a corner from that of a box, relative to the largest coordinate: the rounding of a file."""

_LARGEST_DISTANCE: Final = 1e-4
"""Largest value of this distance [m]."""

_TRIPLES: Final = np.array([(i, j, k) for i in range(1, 8) for j in range(i + 1, 8) for k in range(j + 1, 8)])
"""Corners that may be the ends of the three edges at the first corner."""


class BoxPiece(NamedTuple):
    """Box.

    Attributes:
        centre: centre in the frame of the mesh [m].
        axes: directions of the edges, as columns of a rotation matrix.
        half: half the lengths of the edges [m].
    """

    centre: Floats
    axes: Floats
    half: Floats


def box_pieces(pieces: list[Floats]) -> list[BoxPiece | None]:
    """Return the box of each convex piece, or None for a piece that is no box.

    Args:
        pieces: corners of the pieces [m], each of shape (n, 3).
    """
    result: list[BoxPiece | None] = [None] * len(pieces)
    numbers = [number for number, points in enumerate(pieces) if len(points) == 8]
    if not numbers:
        return result
    corners = np.stack([pieces[number] for number in numbers])
    tolerance = np.minimum(_ROUNDING * np.abs(corners).max(axis=(1, 2)), _LARGEST_DISTANCE)
    centres = corners.mean(axis=1)
    ends = corners - corners[:, :1]
    # three edges of a box end together at the corner that is opposite to the first one
    gaps = ends[:, _TRIPLES].sum(axis=2) - 2.0 * (centres - corners[:, 0])[:, None]
    chosen = _TRIPLES[_straightest(ends, gaps, tolerance)]
    edges = np.take_along_axis(ends, chosen[:, :, None], axis=1)
    axes = _right_angles(edges)
    half = 0.5 * np.abs(np.einsum("nij,nij->ni", edges, axes))
    places = np.abs(matmul(corners - centres[:, None], axes.transpose(0, 2, 1))) - half[:, None]
    is_box = (np.abs(places).max(axis=(1, 2)) <= tolerance) & (half.min(axis=1) > 4.0 * tolerance)
    for k in np.flatnonzero(is_box).tolist():
        result[numbers[k]] = BoxPiece(centres[k], np.ascontiguousarray(axes[k].T), half[k])
    return result


def _right_angles(edges: Floats) -> Floats:
    """Return orthogonal unit vectors along edges, as rows, shape (n, 3, 3); longer edges have more exact directions."""
    order = np.argsort(-np.linalg.norm(edges, axis=2), axis=1, kind="stable")
    first, second = (np.take_along_axis(edges, order[:, k, None, None], axis=1)[:, 0] for k in (0, 1))
    first = first / np.maximum(np.linalg.norm(first, axis=1), 1e-300)[:, None]
    second = second - np.einsum("ij,ij->i", second, first)[:, None] * first
    second = second / np.maximum(np.linalg.norm(second, axis=1), 1e-300)[:, None]
    axes = np.empty_like(edges)
    np.put_along_axis(axes, order[:, :, None], np.stack([first, second, np.cross(first, second)], axis=1), axis=1)
    axes[det(axes) < 0.0, 2] *= -1.0
    return axes


def _straightest(ends: Floats, gaps: Floats, tolerance: Floats) -> Indices:
    """Return for each piece the number of the triple of edges that is closest to right angles.

    Args:
        ends: corners relative to the first corner [m], shape (n, 8, 3).
        gaps: distance of the sum of each triple from the opposite corner [m], shape (n, triples, 3).
        tolerance: largest distance of a corner from that of a box [m], shape (n,).
    """
    units = ends / np.maximum(np.linalg.norm(ends, axis=2), 1e-300)[:, :, None]
    cosines = np.abs(matmul(units, units.transpose(0, 2, 1)))
    i, j, k = _TRIPLES.T
    worst = np.maximum(np.maximum(cosines[:, i, j], cosines[:, i, k]), cosines[:, j, k])
    worst[np.linalg.norm(gaps, axis=2) > 4.0 * tolerance[:, None]] = np.inf
    best: Indices = worst.argmin(axis=1)
    return best
