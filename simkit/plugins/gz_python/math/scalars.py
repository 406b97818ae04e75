"""Plain functions of gz-math on numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

DEFAULT_TOLERANCE: Final = 1e-6
"""How far two numbers may be apart that gz-math calls equal."""


def clamp(value: float, minimum: float, maximum: float) -> float:
    """The value within its limits."""
    return max(min(value, maximum), minimum)


def isnan(value: float) -> bool:
    return math.isnan(value)


def fixnan(value: float) -> float:
    """The value, or 0 where it is not finite."""
    return value if math.isfinite(value) else 0.0


def is_even(value: int) -> bool:
    return value % 2 == 0


def is_odd(value: int) -> bool:
    return value % 2 != 0


def sgn(value: float) -> int:
    """-1, 0 or 1."""
    return (value > 0) - (value < 0)


signum = sgn


def mean(values: Sequence[float]) -> float:
    return math.fsum(values) / len(values)


def variance(values: Sequence[float]) -> float:
    """The mean square of what the values differ from their mean."""
    middle = mean(values)
    return math.fsum((v - middle) ** 2 for v in values) / len(values)


def equal(a: float, b: float, epsilon: float = DEFAULT_TOLERANCE) -> bool:
    """Check whether two numbers are at most `epsilon` apart."""
    return abs(a - b) <= epsilon


def less_or_near_equal(a: float, b: float, epsilon: float = DEFAULT_TOLERANCE) -> bool:
    return a < b + epsilon


def greater_or_near_equal(a: float, b: float, epsilon: float = DEFAULT_TOLERANCE) -> bool:
    return a > b - epsilon


def precision(value: float, digits: int) -> float:
    """The value rounded to that many decimal places."""
    if not math.isfinite(value):
        return value
    power = 10.0**digits
    return round_half_away(value * power) / power


def round_half_away(value: float) -> float:
    """To the nearest whole number, halves away from zero, as C++ rounds."""
    return math.copysign(math.floor(abs(value) + 0.5), value) if math.isfinite(value) else value


def sort2(a: float, b: float) -> tuple[float, float]:
    return (a, b) if a <= b else (b, a)


def sort3(a: float, b: float, c: float) -> tuple[float, float, float]:
    first, second, third = sorted((a, b, c))
    return first, second, third


def is_power_of_two(value: int) -> bool:
    return value != 0 and value & (value - 1) == 0


def round_up_power_of_two(value: int) -> int:
    """The smallest power of two that is not smaller."""
    return 1 if value <= 1 else 1 << (value - 1).bit_length()


def round_up_multiple(value: int, multiple: int) -> int:
    """The nearest multiple that is not smaller; of a negative one the one nearer to zero."""
    return value if multiple == 0 else -(-value // multiple) * multiple


def parse_int(text: str) -> int:
    """The whole number that a text starts with; gz-math's mark for none is 0."""
    try:
        return int(text)
    except ValueError:
        return 0


def parse_float(text: str) -> float:
    """The number a text holds; NaN where it holds none."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def format_number(value: float) -> str:
    """A number as C++ streams print it: six digits, and no sign on zero."""
    return f"{value:.6g}" if value else "0"
