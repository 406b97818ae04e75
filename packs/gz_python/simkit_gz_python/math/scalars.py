"""Functions of gz-math for numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

DEFAULT_TOLERANCE: Final = 1e-6
"""Largest difference of two numbers that gz-math treats as equal."""


def clamp(value: float, minimum: float, maximum: float) -> float:
    """Clamp a value to its limits."""
    return max(min(value, maximum), minimum)


def isnan(value: float) -> bool:
    """Check whether a number is NaN."""
    return math.isnan(value)


def fixnan(value: float) -> float:
    """Return the value, or 0 if it is NaN or infinite."""
    return value if math.isfinite(value) else 0.0


def is_even(value: int) -> bool:
    """Check whether an integer is even."""
    return value % 2 == 0


def is_odd(value: int) -> bool:
    """Check whether an integer is odd."""
    return value % 2 != 0


def sgn(value: float) -> int:
    """Return the sign: -1, 0 or 1."""
    return (value > 0) - (value < 0)


signum = sgn


def mean(values: Sequence[float]) -> float:
    """Return the mean of the values."""
    return math.fsum(values) / len(values)


def variance(values: Sequence[float]) -> float:
    """Return the mean squared difference of the values from their mean."""
    middle = mean(values)
    return math.fsum((v - middle) ** 2 for v in values) / len(values)


def equal(a: float, b: float, epsilon: float = DEFAULT_TOLERANCE) -> bool:
    """Check whether two numbers are at most `epsilon` apart."""
    return abs(a - b) <= epsilon


def less_or_near_equal(a: float, b: float, epsilon: float = DEFAULT_TOLERANCE) -> bool:
    """Check whether a is less than b + `epsilon`."""
    return a < b + epsilon


def greater_or_near_equal(a: float, b: float, epsilon: float = DEFAULT_TOLERANCE) -> bool:
    """Check whether a is greater than b - `epsilon`."""
    return a > b - epsilon


def precision(value: float, digits: int) -> float:
    """Round a value to a number of decimal places."""
    if not math.isfinite(value):
        return value
    power = 10.0**digits
    return round_half_away(value * power) / power


def round_half_away(value: float) -> float:
    """Round to the nearest integer, with halves away from zero, as C++ does."""
    return math.copysign(math.floor(abs(value) + 0.5), value) if math.isfinite(value) else value


def sort2(a: float, b: float) -> tuple[float, float]:
    """Return two numbers in increasing order."""
    return (a, b) if a <= b else (b, a)


def sort3(a: float, b: float, c: float) -> tuple[float, float, float]:
    """Return three numbers in increasing order."""
    first, second, third = sorted((a, b, c))
    return first, second, third


def is_power_of_two(value: int) -> bool:
    """Check whether an integer is a power of two."""
    return value != 0 and value & (value - 1) == 0


def round_up_power_of_two(value: int) -> int:
    """Return the smallest power of two that is not smaller than the value."""
    return 1 if value <= 1 else 1 << (value - 1).bit_length()


def round_up_multiple(value: int, multiple: int) -> int:
    """Round up to a multiple of `multiple`; a negative value is rounded towards zero."""
    return value if multiple == 0 else -(-value // multiple) * multiple


def parse_int(text: str) -> int:
    """Parse an integer; return 0 for an invalid text, as gz-math does."""
    try:
        return int(text)
    except ValueError:
        return 0


def parse_float(text: str) -> float:
    """Parse a number; return NaN for an invalid text."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def format_number(value: float) -> str:
    """Format a number with six digits, as a C++ stream does; zero has no sign."""
    return f"{value:.6g}" if value else "0"
