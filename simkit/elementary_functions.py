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
from dataclasses import dataclass
from functools import partial
from typing import Any, Final, Generic, TypeVar, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Numbers = TypeVar("Numbers", float, Floats)
"""A number, or an array of numbers."""


@overload
def each(function: Callable[..., float], *arrays: float) -> float: ...
@overload
def each(function: Callable[..., float], *arrays: ArrayLike) -> Floats: ...
def each(function: Callable[..., float], *arrays: ArrayLike) -> float | Floats:
    """Apply a function to each number: an array of the broadcast shape, or a float for plain numbers."""
    columns = [np.asarray(array, np.float64) for array in arrays]
    if len(columns) > 1:
        columns = list(np.broadcast_arrays(*columns))
    first = columns[0]
    if not first.ndim:
        return _guarded(function, *(float(c) for c in columns))
    lists = [c.ravel().tolist() for c in columns]
    try:
        results = np.fromiter(map(function, *lists), np.float64, first.size)
    except (OverflowError, ValueError):
        results = np.fromiter(map(partial(_guarded, function), *lists), np.float64, first.size)
    return results.reshape(first.shape)


def _guarded(function: Callable[..., float], *values: float) -> float:
    """Apply a function; infinity or NaN, as NumPy gives, where Python's `math` raises an error."""
    try:
        return function(*values)
    except OverflowError:
        return math.copysign(math.inf, values[0])
    except ValueError:
        return math.nan


def exp(values: Numbers) -> Numbers:
    """Return e to the power of each number; infinity where the result is too large for a float."""
    return each(math.exp, values)


def expm1(values: Numbers) -> Numbers:
    """Return e to the power of each number, less one, exact for numbers near zero."""
    return each(math.expm1, values)


def log(values: Numbers) -> Numbers:
    """Return the natural logarithm of each number; minus infinity for zero, NaN for negative numbers."""
    return each(_log, values)


def _log(value: float, function: Callable[[float], float] = math.log) -> float:
    if value > 0.0 or value != value:
        return function(value)
    return -math.inf if value == 0.0 else math.nan


def log10(values: Numbers) -> Numbers:
    """Return the decimal logarithm of each number; minus infinity for zero, NaN for negative numbers."""
    return each(lambda value: _log(value, math.log10), values)


def log2(values: Numbers) -> Numbers:
    """Return the logarithm to base 2 of each number; minus infinity for zero, NaN for negative numbers."""
    return each(lambda value: _log(value, math.log2), values)


def tan(angles: Numbers) -> Numbers:
    """Return the tangent of each angle [rad]; NaN for an infinite one."""
    return each(math.tan, angles)


def arcsin(values: Numbers) -> Numbers:
    """Return the angle in [-π/2, π/2] of each sine; NaN outside [-1, 1]."""
    return each(math.asin, values)


def arccos(values: Numbers) -> Numbers:
    """Return the angle in [0, π] of each cosine; NaN outside [-1, 1]."""
    return each(math.acos, values)


def arctan(values: Numbers) -> Numbers:
    """Return the angle in (-π/2, π/2) of each tangent."""
    return each(math.atan, values)


def arctan2(y: Numbers, x: Numbers) -> Numbers:
    """Return the angle in [-π, π] of each point (x, y)."""
    return each(math.atan2, y, x)


def sinh(values: Numbers) -> Numbers:
    """Return the hyperbolic sine of each number."""
    return each(math.sinh, values)


@overload
def power(values: float, exponent: float) -> float: ...
@overload
def power(values: ArrayLike, exponent: ArrayLike) -> Floats: ...
def power(values: ArrayLike, exponent: ArrayLike) -> float | Floats:
    """Return each number to a power; NaN for a negative number with a fractional exponent."""
    return each(_power, values, exponent)


def _power(value: float, exponent: float) -> float:
    if value == 0.0 and exponent < 0.0:
        return math.copysign(math.inf, value) if exponent % 2.0 == 1.0 else math.inf
    try:
        return math.pow(value, exponent)
    except OverflowError:
        return math.inf if value > 0.0 or exponent % 2.0 == 0.0 else -math.inf


@dataclass(frozen=True, slots=True)
class Arithmetic(Generic[Numbers]):
    """Functions of one kind of numbers, so that a rule is written once for a float and for arrays of floats.

    `FLOATS` and `ARRAYS` give the same bits. Python's own functions are several times faster for one number.

    Attributes:
        where: function that returns its second argument where the first is true, else its third.
        maximum, minimum: larger and smaller number of two.
        copysign: number with the size of its first argument and the sign of its second.
        arctan2, arcsin: angle of a point (y, x), and angle of a sine [rad].
    """

    where: Callable[[Any, Numbers | float, Numbers | float], Numbers]  # a bool, or an array of them
    maximum: Callable[[Numbers | float, Numbers | float], Numbers]
    minimum: Callable[[Numbers | float, Numbers | float], Numbers]
    copysign: Callable[[Numbers | float, Numbers | float], Numbers]
    arctan2: Callable[[Numbers, Numbers], Numbers]
    arcsin: Callable[[Numbers], Numbers]


FLOATS: Final[Arithmetic[float]] = Arithmetic(
    lambda condition, a, b: a if condition else b, max, min, math.copysign, math.atan2, math.asin
)
ARRAYS: Final[Arithmetic[Floats]] = Arithmetic(np.where, np.maximum, np.minimum, np.copysign, arctan2, arcsin)


def arithmetic_of(number: Numbers) -> Arithmetic[Numbers]:
    """Return the functions for a number or an array."""
    return ARRAYS if isinstance(number, np.ndarray) else FLOATS
