"""Anderson acceleration of a fixed-point iteration."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final

_NEAR_FACTOR: Final = 50.0
"""Largest root mean square of the residual, in units of the tolerance, at which the iteration counts as near a
solution."""

_MAX_EXTRAPOLATION: Final = 100.0
"""Largest ratio of the squared extrapolation to the squared residual; above it, the plain iterate is used."""

_MAX_OVERSHOOT: Final = 10.0
"""Largest growth of the square of the residual in a step past the solution; with more, contacts have opened."""


class AndersonAcceleration:
    """Anderson acceleration of a fixed-point iteration, with the last two differences.

    Plain iteration removes a tenth of the error per iteration with light wheels. If four wheels share the load of a
    stiff vehicle, it removes only 2 %, because load that changes from one wheel to another moves nothing.

    Attributes:
        best: iterate with the smallest residual. It is used if the iteration does not converge. This happens if
            friction on a lever increases its own normal force.
    """

    def __init__(self) -> None:
        self.best: list[float] = []
        self._least = math.inf
        self._residuals: list[list[float]] = []
        self._results: list[list[float]] = []

    def has_come_near(self, tolerance: float) -> bool:
        """Check whether the root mean square of the residual was ever below `_NEAR_FACTOR` tolerances, about g."""
        return bool(self.best) and self._least < (_NEAR_FACTOR * tolerance) ** 2 * len(self.best)

    def next(self, iterate: list[float], result: list[float]) -> list[float]:
        """Return the next iterate.

        Args:
            iterate: present iterate.
            result: result of the iteration for `iterate`.
        """
        residual = [g - x for x, g in zip(iterate, result, strict=True)]
        size = math.fsum(value * value for value in residual)
        if size < self._least:
            self._least, self.best = size, iterate
        if self._residuals and _has_grown(residual, size, self._residuals[-1]):
            self._residuals, self._results = [], []  # contacts have opened or closed: earlier results do not apply
        self._residuals, self._results = [*self._residuals[-2:], residual], [*self._results[-2:], result]
        if len(self._residuals) < 2:
            return result
        steps = [_difference(b, a) for a, b in pairwise(self._residuals)]
        moves = [_difference(b, a) for a, b in pairwise(self._results)]
        shares = _least_squares(steps, residual)
        further = [
            -math.fsum(share * move[i] for share, move in zip(shares, moves, strict=True)) for i in range(len(result))
        ]
        if math.fsum(value * value for value in further) > _MAX_EXTRAPOLATION * size:
            return result
        return [g + one for g, one in zip(result, further, strict=True)]


def _has_grown(residual: list[float], size: float, before: list[float]) -> bool:
    """Check whether a residual is larger than the one before it, and not a moderate step past the solution.

    In a narrow groove, plain iteration steps past the solution, farther each time. The residuals are then opposite, and
    the solution lies between both iterates.

    Args:
        residual: present residual.
        size: its square.
        before: residual before it.
    """
    last = math.fsum(value * value for value in before)
    if size <= last:
        return False
    return size > _MAX_OVERSHOOT * last or math.fsum(x * y for x, y in zip(residual, before, strict=True)) >= 0.0


def _difference(a: list[float], b: list[float]) -> list[float]:
    return [x - y for x, y in zip(a, b, strict=True)]


def _least_squares(columns: list[list[float]], target: list[float]) -> list[float]:
    """Return the least-squares coefficients of one or two columns for a vector."""
    first, second = columns[-1], columns[0]
    a = math.fsum(x * x for x in first)
    e = math.fsum(x * y for x, y in zip(first, target, strict=True))
    if len(columns) == 1:
        return [e / a if a > 0.0 else 0.0]
    b = math.fsum(x * y for x, y in zip(first, second, strict=True))
    c = math.fsum(x * x for x in second)
    f = math.fsum(x * y for x, y in zip(second, target, strict=True))
    determinant = a * c - b * b
    if determinant <= 1e-8 * a * c:
        return [0.0, e / a if a > 0.0 else 0.0]
    return [(a * f - b * e) / determinant, (c * e - b * f) / determinant]
