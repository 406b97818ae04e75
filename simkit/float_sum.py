"""Sum of floats that has the same bits on every version of Python."""

from __future__ import annotations

from collections.abc import Iterable


def float_sum(numbers: Iterable[float]) -> float:
    """Return the sum of numbers, added one after the other.

    From Python 3.12 on, the built-in `sum` compensates the rounding errors of floats. Its last bits then differ from
    those of Python 3.11. `tests/test_float_sums.py` allows the built-in only for integers and arrays. The sum of no
    numbers and of integers is an integer, as with the built-in.
    """
    total: float = 0
    for number in numbers:
        total = total + number
    return total
