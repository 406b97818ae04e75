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

_SLOW: Final = 0.25
"""Ratio of the squares of two opposite residuals above which the second step past the solution is one too many."""

_MIN_SHARE: Final = 0.1
"""Least distance of the next iterate from both ends of an interval that contains the solution, as a fraction of it."""

_MIN_DETERMINANT: Final = 1e-8
"""Least determinant of two differences, relative to the product of their squares, at which both are used."""


class AndersonAcceleration:
    """Anderson acceleration of a fixed-point iteration, with the last two differences.

    Plain iteration removes a tenth of the error per iteration with light wheels. If four wheels share the load of a
    stiff vehicle, it removes only 2 %, because load that changes from one wheel to another moves nothing.

    Args:
        may_overshoot: True to search between two iterates after a step past the solution.

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
        self._last: tuple[list[float], list[float]] | None = None
        self._end: tuple[list[float], list[float]] | None = None
        self._turns = 0

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
        between = self._between(iterate, residual, size)
        if size > self._size and between is None:
            self._residuals, self._results = [], []  # contacts have opened or closed: earlier results do not apply
        self._size = size
        self._residuals, self._results = [*self._residuals[-2:], residual], [*self._results[-2:], result]
        if between is not None or len(self._residuals) < 2:
            return between or result
        further = self._extrapolation()
        if _product(further, further) > _MAX_EXTRAPOLATION * size:
            return result
        return [g + correction for g, correction in zip(result, further, strict=True)]

    def _between(self, iterate: list[float], residual: list[float], size: float) -> list[float] | None:
        """Return the next iterate after a step past the solution; None if there was no such step.

        In a narrow groove, friction holds a log or lets it go, and plain iteration steps past the solution, farther
        each time. The residuals are then opposite, and the solution lies between both iterates. The next iterate is
        there where a straight line through both residuals vanishes. The older end counts half as much each time that
        it stays (Illinois algorithm), so that the interval shrinks from both sides.

        Args:
            iterate: present iterate.
            residual: its residual.
            size: square of the residual.
        """
        last, self._last = self._last, (iterate, residual)
        if not self._may_overshoot or last is None:
            return None
        if _product(last[1], residual) < 0.0:
            self._turns += 1
            if self._end is not None or size > (_SLOW if self._turns > 1 else 1.0) * self._size:
                self._end = last
        elif self._end is not None:
            self._end = self._end[0], [0.5 * step for step in self._end[1]]
        if self._end is None or _product(self._end[1], residual) >= 0.0:
            self._end = None
            return None
        other, opposite = self._end
        change = [x - y for x, y in zip(residual, opposite, strict=True)]
        share = min(max(_product(residual, change) / _product(change, change), _MIN_SHARE), 1.0 - _MIN_SHARE)
        return [x + share * (y - x) for x, y in zip(iterate, other, strict=True)]

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
            damped = [x + weights[place] * (results[place] - x) for x, place in zip(last, members, strict=True)]
            for place, correction in zip(members, self._sequences[island].next(last, damped), strict=True):
                after[place] = correction
        return after

    def settle(self, iterates: list[float], tolerances: Sequence[float], least: float) -> tuple[list[float], list[int]]:
        """Return the best iterates, and the islands in which even the best iterate is far from a solution.

        Args:
            iterates: present iterate of each contact.
            tolerances: tolerance of each contact.
            least: least tolerance that decides whether an iterate is far from a solution.
        """
        after, failed = iterates.copy(), []
        for island in self._unsettled:
            members, sequence = self._members[island], self._sequences[island]
            if sequence.has_come_near(max(least, *(tolerances[place] for place in members))):
                for place, value in zip(members, sequence.best, strict=True):
                    after[place] = value
            else:
                failed.append(island)
        return after, failed


def _product(first: list[float], second: list[float]) -> float:
    """Return the scalar product; the order of the sum does not depend on the processor."""
    total = 0.0
    for x, y in zip(first, second, strict=True):
        total += x * y
    return total
