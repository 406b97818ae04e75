"""Anderson's acceleration of a fixed-point iteration."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final

_NEAR_FACTOR: Final = 50.0
"""Root mean square of what was missed, in units of the tolerance, up to which the iteration has come near."""

_MAX_EXTRAPOLATION: Final = 100.0
"""Ratio of squares of the extrapolation to what was missed, beyond which the plain iterate is used."""


class AndersonAcceleration:
    """Anderson's acceleration of a fixed-point iteration, with the last two differences.

    Plain repetition gains a tenth of the distance a time where wheels are light, and 2 % where four wheels share the
    load of a stiff vehicle, as a change of that share moves nothing.

    Attributes:
        best: what was asked when the least was missed, for contacts whose iteration does not converge: where friction
            on a lever presses harder the more it is pressed.
    """

    def __init__(self) -> None:
        self.best: list[float] = []
        self._least = math.inf
        self._misses: list[list[float]] = []
        self._given: list[list[float]] = []

    def has_come_near(self, tolerance: float) -> bool:
        """Return whether the root mean square of what was missed was ever within some tolerances, about g."""
        return bool(self.best) and self._least < (_NEAR_FACTOR * tolerance) ** 2 * len(self.best)

    def next(self, asked: list[float], given: list[float]) -> list[float]:
        """Return what to ask next, after `asked` has given `given`."""
        miss = [g - x for x, g in zip(asked, given, strict=True)]
        size = math.fsum(one * one for one in miss)
        if size < self._least:
            self._least, self.best = size, asked
        if self._misses and size > math.fsum(one * one for one in self._misses[-1]):
            self._misses, self._given = [], []  # contacts have opened or closed: what was before says nothing
        self._misses, self._given = [*self._misses[-2:], miss], [*self._given[-2:], given]
        if len(self._misses) < 2:
            return given
        steps = [_difference(b, a) for a, b in pairwise(self._misses)]
        moves = [_difference(b, a) for a, b in pairwise(self._given)]
        shares = _least_squares(steps, miss)
        further = [
            -math.fsum(share * move[i] for share, move in zip(shares, moves, strict=True)) for i in range(len(given))
        ]
        if math.fsum(one * one for one in further) > _MAX_EXTRAPOLATION * size:
            return given
        return [g + one for g, one in zip(given, further, strict=True)]


def _difference(a: list[float], b: list[float]) -> list[float]:
    return [x - y for x, y in zip(a, b, strict=True)]


def _least_squares(columns: list[list[float]], wanted: list[float]) -> list[float]:
    """Return the shares of one or two columns that come nearest to a vector."""
    first, second = columns[-1], columns[0]
    a = math.fsum(x * x for x in first)
    e = math.fsum(x * y for x, y in zip(first, wanted, strict=True))
    if len(columns) == 1:
        return [e / a if a > 0.0 else 0.0]
    b = math.fsum(x * y for x, y in zip(first, second, strict=True))
    c = math.fsum(x * x for x in second)
    f = math.fsum(x * y for x, y in zip(second, wanted, strict=True))
    determinant = a * c - b * b
    if determinant <= 1e-8 * a * c:
        return [0.0, e / a if a > 0.0 else 0.0]
    return [(a * f - b * e) / determinant, (c * e - b * f) / determinant]
