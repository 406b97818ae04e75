"""Anderson acceleration of a fixed-point iteration, separately for each island of contacts."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from typing import Final

_NEAR_FACTOR: Final = 50.0
"""Largest root mean square of the residual, in units of the tolerance, at which the iteration counts as near a
solution."""

_MAX_EXTRAPOLATION: Final = 100.0
"""Largest ratio of the squared extrapolation to the squared residual; above it, the plain iterate is used."""

_MAX_OVERSHOOT: Final = 10.0
"""Largest growth of the square of the residual in a step past the solution; with more, contacts have opened."""

_MIN_DETERMINANT: Final = 1e-8
"""Least determinant of two differences, relative to the product of their squares, at which both are used."""


class AndersonAcceleration:
    """Anderson acceleration of a fixed-point iteration, with the last two differences.

    Plain iteration removes a tenth of the error per iteration with light wheels. If four wheels share the load of a
    stiff vehicle, it removes only 2 %, because load that changes from one wheel to another moves nothing.

    Args:
        may_overshoot: True to keep the history after a moderate step past the solution.

    Attributes:
        best: iterate with the smallest residual. It is used if the iteration does not converge. This happens if
            friction on a lever increases its own normal force.
    """

    def __init__(self, may_overshoot: bool) -> None:
        self._may_overshoot = may_overshoot
        self.best: list[float] = []
        self._least = math.inf
        self._size = math.inf
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
        size = _product(residual, residual)
        if size < self._least:
            self._least, self.best = size, iterate
        if size > self._size and self._has_left(residual, size):
            self._residuals, self._results = [], []  # contacts have opened or closed: earlier results do not apply
        self._size = size
        self._residuals, self._results = [*self._residuals[-2:], residual], [*self._results[-2:], result]
        if len(self._residuals) < 2:
            return result
        further = self._extrapolation()
        if _product(further, further) > _MAX_EXTRAPOLATION * size:
            return result
        return [g + one for g, one in zip(result, further, strict=True)]

    def _has_left(self, residual: list[float], size: float) -> bool:
        """Check whether a residual that has grown is not a moderate step past the solution.

        In a narrow groove, plain iteration steps past the solution, farther each time. The residuals are then opposite,
        and the solution lies between both iterates.

        Args:
            residual: present residual.
            size: its square.
        """
        if not self._may_overshoot:
            return True
        return size > _MAX_OVERSHOOT * self._size or _product(residual, self._residuals[-1]) >= 0.0

    def _extrapolation(self) -> list[float]:
        """Return the difference from the last result to the next iterate, by least squares of the residuals."""
        residual, before, now, earlier = self._residuals[-1], self._residuals[-2], self._results[-1], self._results[-2]
        first = [x - y for x, y in zip(residual, before, strict=True)]
        a, e = _product(first, first), _product(first, residual)
        near = e / a if a > 0.0 else 0.0
        if len(self._residuals) > 2:
            second = [x - y for x, y in zip(before, self._residuals[0], strict=True)]
            b, c, f = _product(first, second), _product(second, second), _product(second, residual)
            determinant = a * c - b * b
            if determinant > _MIN_DETERMINANT * a * c:
                near, far = (c * e - b * f) / determinant, (a * f - b * e) / determinant
                oldest = self._results[0]
                return [-near * (x - y) - far * (y - z) for x, y, z in zip(now, earlier, oldest, strict=True)]
        return [-near * (x - y) for x, y in zip(now, earlier, strict=True)]


class IslandIterations:
    """Accelerated iterations of all islands of a step; islands do not influence each other.

    Args:
        islands: number of the island of each contact.
        weights: factor of over-relaxation of each contact.
        hits: islands with a closing contact, in which a step past the solution means that contacts have opened.
    """

    def __init__(self, islands: Sequence[int], weights: Sequence[float], hits: Collection[int]) -> None:
        self._members: dict[int, list[int]] = {}
        for place, island in enumerate(islands):
            self._members.setdefault(island, []).append(place)
        self._weights = weights
        self._sequences = {island: AndersonAcceleration(island not in hits) for island in self._members}
        self._unsettled: list[int] = []

    def next(self, iterates: list[float], results: list[float], unsettled: Iterable[int]) -> list[float]:
        """Return the next iterates; those of settled islands stay.

        Args:
            iterates: present iterate of each contact.
            results: results of the iteration for `iterates`.
            unsettled: islands that have not converged.
        """
        weights, after = self._weights, iterates.copy()
        self._unsettled = list(unsettled)
        for island in self._unsettled:
            members = self._members[island]
            last = [iterates[place] for place in members]
            found = [x + weights[place] * (results[place] - x) for x, place in zip(last, members, strict=True)]
            for place, one in zip(members, self._sequences[island].next(last, found), strict=True):
                after[place] = one
        return after

    def settle(self, iterates: list[float], tolerances: Sequence[float]) -> tuple[list[float], list[int]]:
        """Return the best iterates, and the islands in which even the best iterate is far from a solution."""
        after, failed = iterates.copy(), []
        for island in self._unsettled:
            members, sequence = self._members[island], self._sequences[island]
            if sequence.has_come_near(max(tolerances[place] for place in members)):
                for place, one in zip(members, sequence.best, strict=True):
                    after[place] = one
            else:
                failed.append(island)
        return after, failed


def _product(first: list[float], second: list[float]) -> float:
    """Return the scalar product; the order of the sum does not depend on the processor."""
    total = 0.0
    for x, y in zip(first, second, strict=True):
        total += x * y
    return total
