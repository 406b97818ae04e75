"""Elementary functions of arrays with the same bits on every processor.

NumPy computes `exp`, `log`, `tan`, `arctan2`, `power` and others of whole arrays with AVX-512 instructions where a
processor has them, and the last bits differ from those of other processors. The functions of this module call the
C library for each number, as Python's `math` does. It takes 32 ns a number where NumPy takes 1 to 10, so large arrays
are better looked up in a table of their distinct values. NumPy's `sin`, `cos`, `sqrt` and `hypot` of float64 do not
depend on the processor and are not here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


def _each(function: Callable[..., float], *arrays: ArrayLike) -> Any:
    """Apply a function to each number: an array of the broadcast shape, or a float for plain numbers."""
    columns = [np.asarray(array, np.float64) for array in arrays]
    if len(columns) > 1:
        columns = list(np.broadcast_arrays(*columns))
    first = columns[0]
    if not first.ndim:
        return function(*(float(c) for c in columns))
    numbers = map(function, *(c.ravel().tolist() for c in columns))
    return np.fromiter(numbers, np.float64, first.size).reshape(first.shape)


def exp(values: ArrayLike) -> Any:
    """Return e to the power of each number; infinity where the result is too large for a float."""
    return _each(_exp, values)


def _exp(value: float) -> float:
    try:
        return math.exp(value)
    except OverflowError:
        return math.inf


def expm1(values: ArrayLike) -> Any:
    """Return e to the power of each number, less one, exact for numbers near zero."""
    return _each(_expm1, values)


def _expm1(value: float) -> float:
    try:
        return math.expm1(value)
    except OverflowError:
        return math.inf


def log(values: ArrayLike) -> Any:
    """Return the natural logarithm of each number; minus infinity for zero, NaN for negative numbers."""
    return _each(_log, values)


def _log(value: float, function: Callable[[float], float] = math.log) -> float:
    if value > 0.0 or value != value:
        return function(value)
    return -math.inf if value == 0.0 else math.nan


def log10(values: ArrayLike) -> Any:
    """Return the decimal logarithm of each number; minus infinity for zero, NaN for negative numbers."""
    return _each(lambda value: _log(value, math.log10), values)


def log2(values: ArrayLike) -> Any:
    """Return the logarithm to base 2 of each number; minus infinity for zero, NaN for negative numbers."""
    return _each(lambda value: _log(value, math.log2), values)


def tan(angles: ArrayLike) -> Any:
    """Return the tangent of each angle [rad]; NaN for an infinite one."""
    return _each(_tan, angles)


def _tan(angle: float) -> float:
    return math.nan if math.isinf(angle) else math.tan(angle)


def arcsin(values: ArrayLike) -> Any:
    """Return the angle in [-π/2, π/2] of each sine; NaN outside [-1, 1]."""
    return _each(_arcsin, values)


def _arcsin(value: float) -> float:
    return math.asin(value) if -1.0 <= value <= 1.0 else math.nan


def arccos(values: ArrayLike) -> Any:
    """Return the angle in [0, π] of each cosine; NaN outside [-1, 1]."""
    return _each(_arccos, values)


def _arccos(value: float) -> float:
    return math.acos(value) if -1.0 <= value <= 1.0 else math.nan


def arctan(values: ArrayLike) -> Any:
    """Return the angle in (-π/2, π/2) of each tangent."""
    return _each(math.atan, values)


def arctan2(y: ArrayLike, x: ArrayLike) -> Any:
    """Return the angle in [-π, π] of each point (x, y)."""
    return _each(math.atan2, y, x)


def sinh(values: ArrayLike) -> Any:
    """Return the hyperbolic sine of each number; infinity where the result is too large for a float."""
    return _each(_sinh, values)


def _sinh(value: float) -> float:
    try:
        return math.sinh(value)
    except OverflowError:
        return math.copysign(math.inf, value)


def power(values: ArrayLike, exponent: ArrayLike) -> Any:
    """Return each number to a power; NaN for a negative number with a fractional exponent."""
    return _each(_power, values, exponent)


def _power(value: float, exponent: float) -> float:
    try:
        return math.pow(value, exponent)
    except OverflowError:
        return math.inf if value > 0.0 or exponent % 2.0 == 0.0 else -math.inf
    except ValueError:
        if value:
            return math.nan
        return math.copysign(math.inf, value) if exponent % 2.0 == 1.0 else math.inf
