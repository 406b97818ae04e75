"""Eigenvalues, singular values, least squares and Cholesky factors with the same bits on every processor.

They replace those of `np.linalg`, whose bits depend on the processor (`simkit.linear_algebra` says why). Jacobi's
rotations suit the small matrices of a simulator: three unknowns take 40 µs, six take 0.3 ms.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from simkit.linear_algebra import dot, matmul, norm, square_rows

Floats = NDArray[np.float64]

_SWEEPS = 60  # Jacobi's method converges quadratically: 6 to 10 sweeps are usual
_LARGEST = 1e300  # numbers above it are scaled, because their sums and differences may be infinite
_WELL_CONDITIONED = 1e-3  # ratio of pivots above which normal equations lose less than six of 16 digits


def cholesky(matrix: ArrayLike) -> Floats:
    """Return the lower triangular factor of a symmetric, positive definite matrix.

    Raises:
        numpy.linalg.LinAlgError: The matrix is not positive definite.
    """
    m = np.asarray(matrix, np.float64)
    return np.asarray(_cholesky(square_rows(m)), np.float64).reshape(m.shape)


def _cholesky(rows: list[list[float]]) -> list[list[float]]:
    lower = [[0.0] * len(rows) for _ in rows]
    for i, (row, lower_row) in enumerate(zip(rows, lower, strict=True)):
        for j in range(i + 1):
            rest, other = row[j], lower[j]
            for k in range(j):
                rest -= lower_row[k] * other[k]
            if i != j:
                lower_row[j] = rest / other[j]
            elif rest > 0.0:
                lower_row[i] = math.sqrt(rest)
            else:
                raise np.linalg.LinAlgError("Matrix is not positive definite")
    return lower


def _substitute(lower: list[list[float]], right: list[float]) -> list[float]:
    """Solve a system from the Cholesky factor of its matrix."""
    solution = list(right)
    for i, row in enumerate(lower):
        rest = solution[i]
        for k in range(i):
            rest -= row[k] * solution[k]
        solution[i] = rest / row[i]
    for i in reversed(range(len(lower))):
        rest = solution[i]
        for k in range(i + 1, len(lower)):
            rest -= lower[k][i] * solution[k]
        solution[i] = rest / lower[i][i]
    return solution


def eigh(matrix: ArrayLike) -> tuple[Floats, Floats]:
    """Return the eigenvalues and eigenvectors of a symmetric matrix, or of a stack of them, by Jacobi's rotations.

    Returns:
        The eigenvalues (..., n), ascending, and the unit eigenvectors (..., n, n) as columns. The largest number of
        each eigenvector is positive.

    Raises:
        numpy.linalg.LinAlgError: A number is NaN or infinite, or the matrix is not square.
    """
    m = np.asarray(matrix, np.float64)
    if m.ndim == 2:
        return _eigh(m)
    if not m.size:
        return np.zeros(m.shape[:-1]), np.zeros(m.shape)
    pairs = [_eigh(square) for square in m.reshape(-1, *m.shape[-2:])]
    values, axes = np.zeros(m.shape[:-1]), np.zeros(m.shape)
    for k, (value, axis) in enumerate(pairs):
        values.reshape(-1, m.shape[-1])[k], axes.reshape(-1, *m.shape[-2:])[k] = value, axis
    return values, axes


def eigvalsh(matrix: ArrayLike) -> Floats:
    """Return the eigenvalues of a symmetric matrix, ascending."""
    return eigh(matrix)[0]


def _eigh(matrix: Floats) -> tuple[Floats, Floats]:
    a = square_rows(matrix)
    if not np.isfinite(matrix).all():
        raise np.linalg.LinAlgError("Array must not contain infs or NaNs")
    if np.abs(matrix).max(initial=0.0) > _LARGEST:
        smaller, exponent = _scaled(matrix)
        values, columns = _eigh(smaller)
        return _unscaled(values, exponent), columns
    n = len(a)
    axes = [[float(i == j) for j in range(n)] for i in range(n)]  # rows are eigenvectors
    for _ in range(_SWEEPS):
        is_diagonal = True
        for p in range(n - 1):
            for q in range(p + 1, n):
                off = a[p][q]
                # what a rotation by this number would change is below the last bit of both eigenvalues
                if abs(off) <= 1e-17 * min(abs(a[p][p]), abs(a[q][q])) or off == 0.0:
                    continue
                is_diagonal = False
                cosine, sine = _rotation(a[p][p], a[q][q], off)
                for row in a:
                    row[p], row[q] = cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]
                for rows in (a, axes):
                    first, other = rows[p], rows[q]
                    rows[p] = [cosine * x - sine * y for x, y in zip(first, other, strict=True)]
                    rows[q] = [sine * x + cosine * y for x, y in zip(first, other, strict=True)]
                a[p][q] = a[q][p] = 0.0
        if is_diagonal:
            break
    order = sorted(range(n), key=lambda k: a[k][k])
    upright = [axes[k] if max(axes[k], key=abs) > 0.0 else [-x for x in axes[k]] for k in order]
    return np.array([a[k][k] for k in order], np.float64), np.array(upright, np.float64).reshape(n, n).T


def _rotation(first: float, other: float, off: float) -> tuple[float, float]:
    """Return cosine and sine of the smaller rotation that makes a symmetric 2 × 2 matrix diagonal."""
    half = (other - first) / (2.0 * off)
    if abs(half) > 1e150:  # its square is infinite
        tangent = 0.5 / half
    else:
        tangent = math.copysign(1.0, half) / (abs(half) + math.sqrt(half * half + 1.0))
    cosine = 1.0 / math.sqrt(tangent * tangent + 1.0)
    return cosine, tangent * cosine


def svd(matrix: ArrayLike) -> tuple[Floats, Floats, Floats]:
    """Return the singular value decomposition of a matrix, or of a stack of matrices, by Jacobi's rotations of columns.

    Args:
        matrix: Array (..., m, n).

    Returns:
        `u` (..., m, k), the singular values (..., k), descending, and `v` transposed (..., k, n), with k = min(m, n).

    Raises:
        numpy.linalg.LinAlgError: A number is NaN or infinite.
    """
    m = np.asarray(matrix, np.float64)
    if not m.size:
        *stack, rows, columns = m.shape
        least = min(rows, columns)
        u, v = (np.broadcast_to(np.eye(count, least), (*stack, count, least)).copy() for count in (rows, columns))
        return u, np.zeros((*stack, least)), np.swapaxes(v, -1, -2)
    if m.ndim > 2:
        decompositions = [svd(layer) for layer in m.reshape(-1, *m.shape[-2:])]
        parts = [np.array(part) for part in zip(*decompositions, strict=True)]
        u, s, vt = (part.reshape(*m.shape[:-2], *part.shape[1:]) for part in parts)
        return u, s, vt
    if m.shape[0] < m.shape[1]:
        v, s, ut = svd(m.T)
        return ut.T, s, v.T
    m, exponent = _scaled(m)
    columns, turns = _orthogonal_columns(m)
    lengths = [norm(column) for column in columns]
    order = sorted(range(len(lengths)), key=lambda k: -lengths[k])
    u = np.zeros(m.shape)
    for place, k in enumerate(order):
        if lengths[k] > 0.0:
            u[:, place] = columns[k] / lengths[k]
    _complete(u, [lengths[k] for k in order])
    values = _unscaled([lengths[k] for k in order], exponent)
    return u, values, np.array([turns[k] for k in order]).reshape(-1, m.shape[1])


def _scaled(matrix: Floats) -> tuple[Floats, int]:
    """Return a matrix by a power of two whose largest number is about 1, and the exponent that undoes it.

    The products of columns of very large or small numbers overflow or underflow. A power of two changes no other bit.
    """
    largest = float(np.abs(matrix).max(initial=0.0))
    if not math.isfinite(largest):
        raise np.linalg.LinAlgError("Array must not contain infs or NaNs")
    exponent = math.frexp(largest)[1]
    return _unscaled(matrix, -exponent), exponent


def _unscaled(numbers: ArrayLike, exponent: int) -> Floats:
    """Return numbers times a power of two; those that are too large for a float are infinite."""
    with np.errstate(over="ignore", under="ignore"):
        scaled: Floats = np.ldexp(np.asarray(numbers, np.float64), exponent)
    return scaled


def _orthogonal_columns(matrix: Floats) -> tuple[list[Floats], list[Floats]]:
    """Turn the columns of a matrix into orthogonal ones: columns and the rows of the rotation that made them."""
    columns, turns = [c.copy() for c in matrix.T], list(np.eye(matrix.shape[1]))
    for _ in range(_SWEEPS):
        is_orthogonal = True
        for p in range(len(columns) - 1):
            for q in range(p + 1, len(columns)):
                first, other = columns[p], columns[q]
                alpha, beta, off = dot(first, first), dot(other, other), dot(first, other)
                if abs(off) <= 1e-15 * math.sqrt(alpha * beta) or off == 0.0:
                    continue
                is_orthogonal = False
                cosine, sine = _rotation(alpha, beta, off)
                for rows in (columns, turns):
                    a, b = rows[p], rows[q]
                    rows[p], rows[q] = cosine * a - sine * b, sine * a + cosine * b
        if is_orthogonal:
            break
    return columns, turns


def _complete(u: Floats, lengths: list[float]) -> None:
    """Replace the columns of singular values that are zero by unit vectors at right angles to the others, in place."""
    for place, length in enumerate(lengths):
        if length > 0.0:
            continue
        for axis in np.eye(len(u)):
            for column in u.T[:place]:
                axis = axis - dot(axis, column) * column
            if (size := norm(axis)) > 0.5 / math.sqrt(len(u)):
                u[:, place] = axis / size
                break


def pinv(matrix: ArrayLike, rcond: float = 1e-15) -> Floats:
    """Return the pseudo-inverse (n, m) of a matrix (m, n).

    Args:
        matrix: The matrix.
        rcond: Singular values up to this share of the largest one count as zero.
    """
    u, s, vt = svd(matrix)
    is_large = s > rcond * s.max(initial=0.0)
    inverse: Floats = matmul(vt[is_large].T / s[is_large], u[:, is_large].T)
    return inverse


def lstsq(matrix: ArrayLike, right: ArrayLike, rcond: float | None = None) -> Floats:
    """Return the shortest of the vectors that solve a linear system with the least sum of squared errors.

    Args:
        matrix: Array (m, n).
        right: Right-hand side (m,) or (m, k).
        rcond: Singular values up to this share of the largest one count as zero; by default machine precision times
            the larger side of the matrix.
    """
    m, r = np.asarray(matrix, np.float64), np.asarray(right, np.float64)
    share = float(np.finfo(np.float64).eps) * max(m.shape) if rcond is None else rcond
    if m.shape[0] >= m.shape[1]:  # 30 µs for six unknowns; the singular values take 600
        scaled, exponent = _scaled(m)
        lower = _well_conditioned_factor(matmul(scaled.T, scaled))
        if lower is not None:
            sides = matmul(scaled.T, r).reshape(m.shape[1], r[:1].size).T.tolist()
            solution = np.array([_substitute(lower, side) for side in sides]).T.reshape(m.shape[1:] + r.shape[1:])
            return _unscaled(solution, -exponent)
    shortest: Floats = matmul(pinv(m, share), r)
    return shortest


def _well_conditioned_factor(gram: Floats) -> list[list[float]] | None:
    """Return the Cholesky factor of a symmetric matrix that is far from singular, else None."""
    try:
        lower = _cholesky(square_rows(gram))
    except np.linalg.LinAlgError:
        return None
    pivots = [lower[k][k] * lower[k][k] for k in range(len(lower))] or [0.0]
    return lower if min(pivots) > _WELL_CONDITIONED * max(pivots) else None
