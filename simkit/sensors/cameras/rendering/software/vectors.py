"""Products of arrays of 3-vectors in a fixed order of sums, so that each processor computes the same bits."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]
Floats = npt.NDArray[np.float32]
Integers = npt.NDArray[np.int32]


def rotate(vectors: Array, matrix: Array) -> Array:
    """Return `matrix` times each of the vectors, shape (n, 3)."""
    x, y, z = vectors[:, 0], vectors[:, 1], vectors[:, 2]
    rotated = np.empty(vectors.shape, vectors.dtype)
    m = matrix.astype(vectors.dtype)
    for row in range(3):
        out = rotated[:, row]
        np.multiply(x, m[row, 0], out=out)
        out += y * m[row, 1]
        out += z * m[row, 2]
    return rotated


def dot(a: Array, b: Array) -> Array:
    """Return the scalar products of the rows of two arrays, shape (n,); one of them may be a single vector."""
    total: Array = a[..., 0] * b[..., 0]
    total += a[..., 1] * b[..., 1]
    total += a[..., 2] * b[..., 2]
    return total


def cross(a: Array, b: Array) -> Array:
    """Return the vector products of the rows of two arrays, shape (n, 3)."""
    result = np.empty(np.broadcast_shapes(a.shape, b.shape), np.result_type(a, b))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        result[..., i] = a[..., j] * b[..., k] - a[..., k] * b[..., j]
    return result


def unit(vectors: Array) -> Array:
    """Return the vectors at length 1; a zero vector stays zero."""
    lengths = np.asarray(np.sqrt(dot(vectors, vectors)))[..., None]
    lengths[lengths == 0.0] = 1.0
    unit_vectors: Array = vectors / lengths
    return unit_vectors


def power(base: Floats, exponents: Floats) -> Floats:
    """Return each base in 0…1 to the power of its exponent in 0…128, by squares and square roots.

    The exponents are rounded to eighths. NumPy's own power has other bits on other processors.
    """
    steps = np.rint(exponents * np.float32(8.0)).astype(np.int32)
    result = np.ones_like(base)
    factor = np.sqrt(np.sqrt(np.sqrt(base)))
    while True:
        np.multiply(result, factor, out=result, where=(steps & 1).astype(bool))
        steps >>= 1
        if not steps.any():
            return result
        factor = factor * factor
