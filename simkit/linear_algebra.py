"""Products, norms and linear systems with the same bits on every processor.

NumPy computes `@`, `dot`, `np.linalg` and the norm of one vector with BLAS and LAPACK. These choose their code, and so
the order of additions, by the processor. The functions of this module use only sums, products, quotients and square
roots in a fixed order. `einsum` is NumPy's own code and does not choose by processor; it takes 0.7 µs longer than `@`
for small matrices. Python's floats take less than either for three numbers.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

_LONG = 500  # rows from which the product by a small matrix is faster column by column than with einsum
_SMALL = 4  # rows and columns of the small matrix up to which this holds
_SMALL_SYSTEM = 8  # unknowns up to which elimination with Python's floats is faster than with arrays
_SHORT = 16  # numbers up to which a loop over Python's floats is faster than einsum
_NEXT_TO_LIMIT = 1e-9  # BLAS rounds sums of millions of squares to better than this


def matmul(first: ArrayLike, second: ArrayLike, *more: ArrayLike) -> Any:
    """Return the matrix product of two or more arrays, as `first @ second @ ...`.

    Args:
        first: Array of shape (..., m, n) or (n,).
        second: Array of shape (..., n, k) or (n,).
        more: Further factors, multiplied from left to right.

    Raises:
        ValueError: The shapes do not fit.
    """
    a, b = np.asarray(first), np.asarray(second)
    if a.shape[-1] != b.shape[-2 if b.ndim > 1 else 0]:  # einsum repeats an axis of length one
        raise ValueError(f"arrays of shapes {a.shape} and {b.shape} cannot be multiplied")
    if a.ndim == 2 and b.ndim == 2:
        is_long = len(a) >= _LONG and max(b.shape) <= _SMALL
        # einsum takes ten times as long where rows are not contiguous, and its result would not be contiguous
        product = (
            _columns(a, b) if is_long else np.einsum("ij,jk->ik", np.ascontiguousarray(a), np.ascontiguousarray(b))
        )
    elif a.ndim == 2 and b.ndim == 1:
        product = np.einsum("ij,j->i", a, b)
    elif b.ndim == 1:
        product = np.einsum("...j,j->...", a, b)
    elif a.ndim == 1:
        product = np.einsum("j,...jk->...k", a, b)
    else:
        product = np.einsum("...ij,...jk->...ik", a, b)
    for factor in more:
        product = matmul(product, factor)
    return product


def _columns(a: NDArray[np.generic], b: NDArray[np.generic]) -> NDArray[np.generic]:
    """Return the product of many short rows and a small matrix; a third of einsum's time for 5000 points."""
    rows = np.ascontiguousarray(a.T)
    product = np.zeros((b.shape[1], len(a)), np.result_type(a, b))
    for k, column in enumerate(product):
        for j, row in enumerate(rows):
            column += row * b[j, k]
    return product.T


def dot(first: Any, second: Any) -> float:
    """Return the scalar product of two vectors of equal length.

    Raises:
        ValueError: The lengths differ.
    """
    if isinstance(first, np.ndarray):
        if first.size > _SHORT:
            if np.size(second) != first.size:
                raise ValueError(f"vectors of {first.size} and {np.size(second)} numbers cannot be multiplied")
            flat = (first, second) if first.ndim == 1 else (first.ravel(), np.ravel(second))
            if first.dtype.kind in "biu":  # a sum of integers may have too few bits, and that of booleans has one
                flat = (flat[0].astype(np.float64), flat[1])
            return float(np.einsum("i,i->", *flat))
        first = first.tolist() if first.ndim == 1 else first.ravel().tolist()
    if isinstance(second, np.ndarray):
        second = second.tolist() if second.ndim == 1 else second.ravel().tolist()
    total = 0.0
    for x, y in zip(first, second, strict=True):
        total += x * y
    return float(total)


def norm(vector: ArrayLike) -> float:
    """Return the Euclidean length of a vector, or the Frobenius norm of a matrix."""
    numbers = np.asarray(vector, np.float64).ravel()
    return math.sqrt(dot(numbers, numbers))


def squared_length(vector: Floats, limit: float) -> float:
    """Return the squared length of a vector, for a comparison with a limit that has one result on every processor.

    The step loop makes such comparisons at each step. BLAS takes a quarter of the time of a fixed order. Its rounding
    can decide only next to the limit, so there the fixed order is used.
    """
    square = float(np.vdot(vector, vector))  # no warning for an overflow: the engine reports the divergence
    return dot(vector, vector) if abs(square - limit) <= _NEXT_TO_LIMIT * limit else square


def det(matrix: ArrayLike) -> Any:
    """Return the determinant of a square matrix, or those of a stack of 3 × 3 matrices."""
    m = np.asarray(matrix, np.float64)
    if m.shape[-2:] == (3, 3):
        a, b, c, d, e, f, g, h, i = (m[..., j, k] for j in range(3) for k in range(3))
        determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
        return float(determinant) if m.ndim == 2 else determinant
    rows = square_rows(m)
    return _eliminate(rows, [[] for _ in rows])


def solve(matrix: ArrayLike, right: ArrayLike) -> Floats:
    """Solve linear systems by Gaussian elimination with partial pivoting.

    Args:
        matrix: Square matrix (n, n), or a stack of them (..., n, n).
        right: Right-hand side (n,) or (n, k); for a stack (..., n, k).

    Returns:
        The solution, with the shape of `right`.

    Raises:
        numpy.linalg.LinAlgError: A matrix is singular.
    """
    m, r = np.asarray(matrix, np.float64), np.asarray(right, np.float64)
    if not m.shape[-1] and not r.size:
        return np.zeros(r.shape)
    if m.shape[-2:] == (1, 1) and r.ndim == m.ndim:
        if not m.all():
            raise np.linalg.LinAlgError("Singular matrix")
        return r / m
    if m.ndim > 2:
        shape = np.broadcast_shapes(m.shape[:-2], r.shape[:-2])
        m, r = np.broadcast_to(m, (*shape, *m.shape[-2:])), np.broadcast_to(r, (*shape, *r.shape[-2:]))
        return _solve_stack(m.reshape(-1, *m.shape[-2:]), r.reshape(-1, *r.shape[-2:])).reshape(r.shape)
    if len(m) > _SMALL_SYSTEM:
        return _solve_stack(m[None], r.reshape(1, len(r), -1)).reshape(r.shape)
    rows, sides = square_rows(m), r.reshape(len(r), -1).tolist()
    if len(sides) != len(rows):
        raise ValueError(f"a matrix with {len(rows)} rows needs as many right-hand numbers, not {len(sides)}")
    if _eliminate(rows, sides) == 0.0:
        raise np.linalg.LinAlgError("Singular matrix")
    for i in reversed(range(len(rows))):
        row, side = rows[i], sides[i]
        for j in range(i + 1, len(rows)):
            factor = row[j]
            if factor:
                side = [x - factor * y for x, y in zip(side, sides[j], strict=True)]
        pivot = row[i]
        sides[i] = [x / pivot for x in side]
    return np.asarray(sides, np.float64).reshape(r.shape)


def _solve_stack(matrices: Floats, sides: Floats) -> Floats:
    """Solve stacks of systems by the elimination of Gauss and Jordan, all systems at once, column by column."""
    count = matrices.shape[-1]
    if matrices.shape[-2] != count or sides.shape[-2] != count:
        raise ValueError(f"matrices {matrices.shape[1:]} and right-hand sides {sides.shape[1:]} do not fit together")
    work, every = np.concatenate((matrices, sides), axis=2), np.arange(len(matrices))
    for i in range(count):
        best = i + np.abs(work[:, i:, i]).argmax(axis=1)
        chosen = work[every, best]
        work[every, best] = work[:, i]
        pivots = chosen[:, i, None]
        if not pivots.all():
            raise np.linalg.LinAlgError("Singular matrix")
        chosen /= pivots
        factors = work[:, :, i].copy()
        work[:, :, i:] -= factors[:, :, None] * chosen[:, None, i:]
        work[:, i] = chosen
    return work[:, :, count:]


def inverse(matrix: ArrayLike) -> Floats:
    """Return the inverse of a square matrix, or those of a stack of matrices.

    Raises:
        numpy.linalg.LinAlgError: A matrix is singular.
    """
    m = np.asarray(matrix, np.float64)
    return solve(m, np.broadcast_to(np.eye(m.shape[-1]), m.shape))


def square_rows(matrix: Floats) -> list[list[float]]:
    """Return the rows of a square matrix as lists.

    Raises:
        numpy.linalg.LinAlgError: The matrix is not square.
    """
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1]:
        raise np.linalg.LinAlgError(f"a square matrix is needed, not one of shape {matrix.shape}")
    rows: list[list[float]] = matrix.tolist()
    return rows


def _eliminate(rows: list[list[float]], sides: list[list[float]]) -> float:
    """Make a matrix upper triangular in place, with its right-hand sides, and return its determinant."""
    determinant, count = 1.0, len(rows)
    for i in range(count):
        best = max(range(i, count), key=lambda j: abs(rows[j][i]))
        if best != i:
            rows[i], rows[best] = rows[best], rows[i]
            sides[i], sides[best] = sides[best], sides[i]
            determinant = -determinant
        pivot_row, side = rows[i], sides[i]
        pivot = pivot_row[i]
        determinant *= pivot
        if pivot == 0.0:
            return 0.0
        for j in range(i + 1, count):
            factor = rows[j][i] / pivot
            if factor:
                rows[j] = [x - factor * y for x, y in zip(rows[j], pivot_row, strict=True)]
                sides[j] = [x - factor * y for x, y in zip(sides[j], side, strict=True)]
    # an underflow of the product does not make the matrix singular
    return determinant if determinant else math.copysign(math.ulp(0.0), determinant)
