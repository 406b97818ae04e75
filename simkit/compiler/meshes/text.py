"""Numbers in the text of mesh files, and the bounds on what a mesh file may hold."""

from __future__ import annotations

import warnings
from typing import Any, Final

import numpy as np

from simkit.compiler.meshes.part import Floats, Ints, MeshFileError

LARGEST_FILE: Final = 512 << 20
LARGEST_FACES: Final = 4_000_000
FARTHEST_VERTEX: Final = 1e9  # [m]; volumes of farther ones leave the single precision that the engine keeps them in
DEEPEST_NODE: Final = 64
MOST_NODES: Final = 20_000


def numbers_of(text: bytes | str, what: str) -> Floats:
    """Numbers separated by white space. Raises MeshFileError where something else is among them."""
    return np.asarray(_parsed(text, float, what), float)


def integers_of(text: bytes | str, what: str) -> Any:
    """Whole numbers separated by white space, int64. Raises MeshFileError."""
    return _parsed(text, np.int64, what)


def _parsed(text: bytes | str, kind: Any, what: str) -> Any:
    if not text or text.isspace():
        return np.zeros(0, kind)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return np.fromstring(text, kind, sep=" ")
        except (ValueError, DeprecationWarning, OverflowError):
            pass
    try:
        return np.array(text.split(), dtype=kind)
    except (ValueError, OverflowError):
        raise MeshFileError(f"has something in its {what} that is not a number") from None


def fan(counts: Any) -> Any:
    """Triangles of polygons that lie one behind the other: rows of positions, polygon by polygon.

    Args:
        counts: corners of each polygon, shape (p,).

    Returns:
        Shape (t, 3): positions in the list of all corners; each polygon is a fan around its first corner.
    """
    counts = np.asarray(counts, np.int64)
    start = np.concatenate([[0], np.cumsum(counts)[:-1]]) if len(counts) else counts
    triangles = np.maximum(counts - 2, 0)
    of = np.repeat(np.arange(len(counts)), triangles)
    k = np.arange(len(of)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return np.column_stack([start[of], start[of] + k + 1, start[of] + k + 2])


def indexed(rows: Any) -> tuple[Any, Ints]:
    """The different rows of an integer array, in order of appearance, and for each row which one it is."""
    _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return rows[first[order]], rank[np.asarray(inverse).reshape(-1)].astype(np.int32)
