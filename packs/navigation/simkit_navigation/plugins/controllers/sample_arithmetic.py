"""Arithmetic for arrays of samples that gives the same bits on every processor.

Sines are polynomials made of elementwise products and sums. Sums add whole rows, or halves of rows, in a fixed order:
NumPy's own sums of a row choose their order by the processor.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]
"""Array of float32 or float64; a function returns the type of its argument."""

_SINE: Final = tuple((-1.0) ** (order // 2) / math.factorial(order) for order in (11, 9, 7, 5, 3))
"""Coefficients of the Taylor series, from the highest power on; the error within ±π/2 is below 6e-8."""


def sine(angles: Array) -> Array:
    """Return the sines of angles [rad]; the error is below 6e-8, and 1e-6 for float32."""
    halves = np.rint(angles * (1.0 / math.pi))  # half turns
    rest = angles - halves * math.pi
    halves *= 0.5
    halves -= np.floor(halves)  # 0.5 for an odd number of half turns, whose sine has the other sign
    halves *= -4.0
    halves += 1.0
    square = rest * rest
    value = square * _SINE[0]
    for coefficient in _SINE[1:]:
        value += coefficient
        value *= square
    value += 1.0
    value *= rest
    value *= halves
    return value


def cosine(angles: Array) -> Array:
    """Return the cosines of angles [rad], as exact as `sine`."""
    return sine(angles + math.pi / 2)


def wrapped(angles: Array) -> Array:
    """Return angles [rad] within ±π."""
    result: Array = angles - np.rint(angles * (1.0 / math.tau)) * math.tau
    return result


def sum_over_steps(values: Array) -> Array:
    """Return the sum over the first axis."""
    total: Array = values[0].copy()
    for row in values[1:]:
        total += row
    return total


def sum_over_samples(values: Array) -> Array:
    """Return the sum over the last axis, by repeated addition of its halves."""
    count = values.shape[-1]
    while count > 1:
        half = (count + 1) // 2
        lower = values[..., :half].copy()
        lower[..., : count - half] += values[..., half:count]
        values, count = lower, half
    total: Array = values[..., 0]
    return total
