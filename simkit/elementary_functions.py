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
from functools import partial
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
        return _guarded(function, *(float(c) for c in columns))
    lists = [c.ravel().tolist() for c in columns]
    try:
        found = np.fromiter(map(function, *lists), np.float64, first.size)
    except (OverflowError, ValueError):
        found = np.fromiter(map(partial(_guarded, function), *lists), np.float64, first.size)
    return found.reshape(first.shape)


def _guarded(function: Callable[..., float], *values: float) -> float:
    """Apply a function; infinity or NaN, as NumPy gives, where Python's `math` raises an error."""
    try:
        return function(*values)
    except OverflowError:
        return math.copysign(math.inf, values[0])
    except ValueError:
        return math.nan


def exp(values: ArrayLike) -> Any:
    """Return e to the power of each number; infinity where the result is too large for a float."""
    return _each(math.exp, values)


def expm1(values: ArrayLike) -> Any:
    """Return e to the power of each number, less one, exact for numbers near zero."""
    return _each(math.expm1, values)


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
    return _each(math.tan, angles)


def arcsin(values: ArrayLike) -> Any:
    """Return the angle in [-π/2, π/2] of each sine; NaN outside [-1, 1]."""
    return _each(math.asin, values)


def arccos(values: ArrayLike) -> Any:
    """Return the angle in [0, π] of each cosine; NaN outside [-1, 1]."""
    return _each(math.acos, values)


def arctan(values: ArrayLike) -> Any:
    """Return the angle in (-π/2, π/2) of each tangent."""
    return _each(math.atan, values)


def arctan2(y: ArrayLike, x: ArrayLike) -> Any:
    """Return the angle in [-π, π] of each point (x, y)."""
    return _each(math.atan2, y, x)


def sinh(values: ArrayLike) -> Any:
    """Return the hyperbolic sine of each number."""
    return _each(math.sinh, values)


def power(values: ArrayLike, exponent: ArrayLike) -> Any:
    """Return each number to a power; NaN for a negative number with a fractional exponent."""
    return _each(_power, values, exponent)


def _power(value: float, exponent: float) -> float:
    if value == 0.0 and exponent < 0.0:
        return math.copysign(math.inf, value) if exponent % 2.0 == 1.0 else math.inf
    try:
        return math.pow(value, exponent)
    except OverflowError:
        return math.inf if value > 0.0 or exponent % 2.0 == 0.0 else -math.inf
