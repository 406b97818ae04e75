"""Products, norms, linear systems and decompositions with the same bits on every processor.

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
_WELL_CONDITIONED = 1e-3  # ratio of pivots above which normal equations lose less than six of 16 digits
_NEXT_TO_LIMIT = 1e-9  # BLAS rounds sums of millions of squares to better than this
_SWEEPS = 60  # Jacobi's method converges quadratically: 6 to 10 sweeps are usual


def matmul(first: Any, second: Any, *more: Any) -> Any:
    """Return the matrix product of two or more arrays, as `first @ second @ ...`.

    Args:
        first: Array of shape (..., m, n) or (n,).
        second: Array of shape (..., n, k) or (n,).
        more: Further factors, multiplied from left to right.

    Raises:
        ValueError: The shapes do not fit.
    """
    a, b = np.asarray(first), np.asarray(second)
    if a.ndim == 2 and b.ndim == 2:
        is_long = len(a) >= _LONG and max(b.shape) <= _SMALL
        # einsum takes ten times as long where rows are not contiguous, and its result would not be contiguous
        found = _columns(a, b) if is_long else np.einsum("ij,jk->ik", np.ascontiguousarray(a), np.ascontiguousarray(b))
    elif a.ndim == 2 and b.ndim == 1:
        found = np.einsum("ij,j->i", a, b)
    elif b.ndim == 1:
        found = np.einsum("...j,j->...", a, b)
    elif a.ndim == 1:
        found = np.einsum("j,...jk->...k", a, b)
    else:
        found = np.einsum("...ij,...jk->...ik", a, b)
    for factor in more:
        found = matmul(found, factor)
    return found


def _columns(a: NDArray[Any], b: NDArray[Any]) -> NDArray[Any]:
    """Return the product of many short rows and a small matrix; a third of einsum's time for 5000 points."""
    if len(b) != a.shape[1]:
        raise ValueError(f"arrays of shapes {a.shape} and {b.shape} cannot be multiplied")
    rows = np.ascontiguousarray(a.T)
    found = np.zeros((b.shape[1], len(a)), np.result_type(a, b))
    for k, column in enumerate(found):
        for j, row in enumerate(rows):
            column += row * b[j, k]
    return found.T


def dot(first: Any, second: Any) -> float:
    """Return the scalar product of two vectors of equal length.

    Raises:
        ValueError: The lengths differ.
    """
    if isinstance(first, np.ndarray):
        if first.size > _SHORT:
            flat = (first, second) if first.ndim == 1 else (first.ravel(), np.ravel(second))
            return float(np.einsum("i,i->", *flat))
        first = first.tolist() if first.ndim == 1 else first.ravel().tolist()
    if isinstance(second, np.ndarray):
        second = second.tolist() if second.ndim == 1 else second.ravel().tolist()
    total = 0.0
    for x, y in zip(first, second, strict=True):
        total += x * y
    return float(total)


def norm(vector: Any) -> float:
    """Return the Euclidean length of a vector, or the Frobenius norm of a matrix."""
    numbers = np.asarray(vector, np.float64).ravel()
    return math.sqrt(dot(numbers, numbers))


def squared_length(vector: NDArray[Any], limit: float) -> float:
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
        found = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
        return float(found) if m.ndim == 2 else found
    rows = _square(m)
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
    rows, sides = _square(m), r.reshape(len(r), -1).tolist()
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


def _square(matrix: Floats) -> list[list[float]]:
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
    return determinant if determinant else math.ulp(0.0)  # an underflow of the product does not make it singular


def cholesky(matrix: ArrayLike) -> Floats:
    """Return the lower triangular factor of a symmetric, positive definite matrix.

    Raises:
        numpy.linalg.LinAlgError: The matrix is not positive definite.
    """
    return np.asarray(_cholesky(_square(np.asarray(matrix, np.float64))), np.float64)


def _cholesky(rows: list[list[float]]) -> list[list[float]]:
    found = [[0.0] * len(rows) for _ in rows]
    for i, (row, own) in enumerate(zip(rows, found, strict=True)):
        for j in range(i + 1):
            rest, other = row[j], found[j]
            for k in range(j):
                rest -= own[k] * other[k]
            if i != j:
                own[j] = rest / other[j]
            elif rest > 0.0:
                own[i] = math.sqrt(rest)
            else:
                raise np.linalg.LinAlgError("Matrix is not positive definite")
    return found


def _substitute(lower: list[list[float]], right: list[float]) -> list[float]:
    """Solve a system from the Cholesky factor of its matrix."""
    found = list(right)
    for i, row in enumerate(lower):
        rest = found[i]
        for k in range(i):
            rest -= row[k] * found[k]
        found[i] = rest / row[i]
    for i in reversed(range(len(lower))):
        rest = found[i]
        for k in range(i + 1, len(lower)):
            rest -= lower[k][i] * found[k]
        found[i] = rest / lower[i][i]
    return found


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
    pairs = [_eigh(one) for one in m.reshape(-1, *m.shape[-2:])]
    values, axes = np.zeros(m.shape[:-1]), np.zeros(m.shape)
    for k, (value, axis) in enumerate(pairs):
        values.reshape(-1, m.shape[-1])[k], axes.reshape(-1, *m.shape[-2:])[k] = value, axis
    return values, axes


def eigvalsh(matrix: ArrayLike) -> Floats:
    """Return the eigenvalues of a symmetric matrix, ascending."""
    return eigh(matrix)[0]


def _eigh(matrix: Floats) -> tuple[Floats, Floats]:
    a = _square(matrix)
    if not np.isfinite(matrix).all():
        raise np.linalg.LinAlgError("Array must not contain infs or NaNs")
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
                    one, other = rows[p], rows[q]
                    rows[p] = [cosine * x - sine * y for x, y in zip(one, other, strict=True)]
                    rows[q] = [sine * x + cosine * y for x, y in zip(one, other, strict=True)]
                a[p][q] = a[q][p] = 0.0
        if is_diagonal:
            break
    order = sorted(range(n), key=lambda k: a[k][k])
    upright = [axes[k] if max(axes[k], key=abs) > 0.0 else [-x for x in axes[k]] for k in order]
    return np.array([a[k][k] for k in order], np.float64), np.array(upright, np.float64).reshape(n, n).T


def _rotation(one: float, other: float, off: float) -> tuple[float, float]:
    """Return cosine and sine of the smaller rotation that makes a symmetric 2 × 2 matrix diagonal."""
    half = (other - one) / (2.0 * off)
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
    """
    m = np.asarray(matrix, np.float64)
    if m.ndim > 2:
        found = [svd(one) for one in m.reshape(-1, *m.shape[-2:])]
        parts = [np.array(part) for part in zip(*found, strict=True)]
        u, s, vt = (part.reshape(*m.shape[:-2], *part.shape[1:]) for part in parts)
        return u, s, vt
    if m.shape[0] < m.shape[1]:
        v, s, ut = svd(m.T)
        return ut.T, s, v.T
    columns, turns = _orthogonal_columns(m)
    lengths = [norm(column) for column in columns]
    order = sorted(range(len(lengths)), key=lambda k: -lengths[k])
    u = np.zeros(m.shape)
    for place, k in enumerate(order):
        if lengths[k] > 0.0:
            u[:, place] = columns[k] / lengths[k]
    _complete(u, [lengths[k] for k in order])
    return u, np.array([lengths[k] for k in order]), np.array([turns[k] for k in order]).reshape(-1, m.shape[1])


def _orthogonal_columns(matrix: Floats) -> tuple[list[Floats], list[Floats]]:
    """Turn the columns of a matrix into orthogonal ones: columns and the rows of the rotation that made them."""
    columns, turns = [c.copy() for c in matrix.T], list(np.eye(matrix.shape[1]))
    for _ in range(_SWEEPS):
        is_orthogonal = True
        for p in range(len(columns) - 1):
            for q in range(p + 1, len(columns)):
                one, other = columns[p], columns[q]
                alpha, beta, off = dot(one, one), dot(other, other), dot(one, other)
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
    kept = s > rcond * s.max(initial=0.0)
    found: Floats = matmul(vt[kept].T / s[kept], u[:, kept].T)
    return found


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
        lower = _well_conditioned_factor(matmul(m.T, m))
        if lower is not None:
            sides = matmul(m.T, r).reshape(m.shape[1], -1).T.tolist()
            return np.array([_substitute(lower, side) for side in sides]).T.reshape(m.shape[1:] + r.shape[1:])
    found: Floats = matmul(pinv(m, share), r)
    return found


def _well_conditioned_factor(gram: Floats) -> list[list[float]] | None:
    """Return the Cholesky factor of a symmetric matrix that is far from singular, else None."""
    try:
        lower = _cholesky(_square(gram))
    except np.linalg.LinAlgError:
        return None
    pivots = [lower[k][k] * lower[k][k] for k in range(len(lower))] or [0.0]
    return lower if min(pivots) > _WELL_CONDITIONED * max(pivots) else None
