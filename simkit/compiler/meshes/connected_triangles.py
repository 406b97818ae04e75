"""Connected parts of triangles that share corners, and whether a part is closed."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from simkit.loaders.meshes.mesh_part import Indices, Ints

Corners = Ints | Indices
"""Numbers of the corners of triangles, shape (m, 3)."""


def part_numbers(corners: Corners) -> Indices:
    """Return the number of the connected part of each triangle; some numbers may belong to no triangle."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    if not len(corners):
        return np.zeros(0, np.int64)
    row, column = corners[:, (0, 1)].reshape(-1), corners[:, (1, 2)].reshape(-1)
    count = int(corners.max()) + 1
    graph = coo_matrix((np.ones(len(row), bool), (row, column)), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    numbers: Indices = label[corners[:, 0]].astype(np.int64)
    return numbers


def members_of(numbers: Indices) -> list[Indices]:
    """Return the places of each number that occurs, in ascending order of the numbers."""
    order = np.argsort(numbers, kind="stable")
    members: list[npt.NDArray[np.int64]] = np.split(order, np.flatnonzero(np.diff(numbers[order])) + 1)
    return members if len(numbers) else []


def is_closed(corners: Corners) -> bool:
    """Check whether each edge belongs to two triangles with the same side outside."""
    edges = np.concatenate([corners[:, (0, 1)], corners[:, (1, 2)], corners[:, (2, 0)]]).astype(np.int64)
    count = int(corners.max()) + 1
    ahead, back = np.sort(edges[:, 0] * count + edges[:, 1]), np.sort(edges[:, 1] * count + edges[:, 0])
    return bool(np.array_equal(ahead, back) and (ahead[1:] != ahead[:-1]).all())
