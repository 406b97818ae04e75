"""Connected parts of triangles that share corners."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from simkit.compiler.meshes.mesh_part import Indices, Ints

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
