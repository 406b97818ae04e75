"""Arithmetic that has an answer for all numbers: as IEEE 754 has it, infinite or no number, never an exception."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any, Final

import numpy as np

Binary = Callable[[float, float], float]


def divided(a: float, b: float) -> float:
    """a / b."""
    if b:
        return a / b
    if not a or a != a or b != b:
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def remainder(a: float, b: float) -> float:
    """a - b·floor(a / b): it has the sign of b."""
    if not b or not math.isfinite(a) or b != b:
        return math.nan
    return a % b


def power(a: float, b: float) -> float:
    """a to the b."""
    try:
        found = math.pow(a, b)
    except OverflowError:
        odd = b % 2 == 1
        return -math.inf if a < 0 and odd else math.inf
    except ValueError:
        return math.inf if not a else math.nan
    return found


def total(function: Callable[..., float], otherwise: float = math.nan) -> Callable[..., float]:
    """A function of `math` that is no number where it is not defined, and infinite where it is too large."""

    def value(*numbers: float) -> float:
        try:
            return float(function(*numbers))
        except ValueError:
            return otherwise
        except OverflowError:
            return math.inf

    return value


def logarithm(a: float) -> float:
    """Natural; -inf at zero."""
    return math.log(a) if a > 0 else -math.inf if a == 0 else math.nan


def whole(function: Callable[[float], int]) -> Callable[[float], float]:
    """A rounding that leaves what is not finite as it is."""
    return lambda a: float(function(a)) if math.isfinite(a) else a


def wrapped(angle: float) -> float:
    """An angle [rad] in (-pi, pi]."""
    if not math.isfinite(angle):
        return math.nan
    found = math.remainder(angle, 2 * math.pi)
    return found if found > -math.pi else found + 2 * math.pi


def _quiet(act: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    def value(a: Any, b: Any) -> Any:
        with np.errstate(all="ignore"):
            return act(a, b)

    return value


SIGNS: Final[dict[str, Binary]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": divided,
    "%": remainder,
    "**": power,
}
VECTOR_SIGNS: Final = {
    "+": _quiet(operator.add),
    "-": _quiet(operator.sub),
    "*": _quiet(operator.mul),
    "/": _quiet(np.divide),
}
