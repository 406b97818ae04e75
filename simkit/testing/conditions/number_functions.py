"""Arithmetic and functions of numbers as IEEE 754 defines them: infinite or NaN, never an exception."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from simkit.testing.conditions.bound_expression import BoundNode, ExpressionBinder, Function
from simkit.testing.conditions.syntax_tree import Call
from simkit.testing.conditions.value_types import NUMBER

BinaryOperator = Callable[[float, float], float]


def divide(a: float, b: float) -> float:
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


def nan_where_undefined(function: Callable[..., float], otherwise: float = math.nan) -> Callable[..., float]:
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


def round_finite(function: Callable[[float], int]) -> Callable[[float], float]:
    """A rounding that leaves what is not finite as it is."""
    return lambda a: float(function(a)) if math.isfinite(a) else a


def wrap_angle(angle: float) -> float:
    """An angle [rad] in (-pi, pi]."""
    if not math.isfinite(angle):
        return math.nan
    found = math.remainder(angle, 2 * math.pi)
    return found if found > -math.pi else found + 2 * math.pi


def _without_warnings(act: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    def value(a: Any, b: Any) -> Any:
        with np.errstate(all="ignore"):
            return act(a, b)

    return value


NUMBER_OPERATORS: Final[dict[str, BinaryOperator]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": divide,
    "%": remainder,
    "**": power,
}
VECTOR_OPERATORS: Final = {
    "+": _without_warnings(operator.add),
    "-": _without_warnings(operator.sub),
    "*": _without_warnings(operator.mul),
    "/": _without_warnings(np.divide),
}


def _numeric(usage: str, count: int, function: Callable[..., float]) -> Function:
    """A function of so many numbers."""

    def make(binder: ExpressionBinder, call: Call) -> BoundNode:
        parts = tuple(binder.number(node) for node in call.arguments)
        gets = [part.get for part in parts]
        if count == 1:
            get = gets[0]
            return BoundNode(call, NUMBER, lambda: function(get()), parts)
        return BoundNode(call, NUMBER, lambda: function(*[get() for get in gets]), parts)

    return Function(usage, count, count, make)


def _clamp(value: float, low: float, high: float) -> float:
    return max(low, min(high, value))


def _angle_between(a: float, b: float) -> float:
    return wrap_angle(a - b)


_ONE_NUMBER: dict[str, Callable[[float], float]] = {
    "sqrt": nan_where_undefined(math.sqrt),
    "exp": nan_where_undefined(math.exp),
    "log": logarithm,
    "sin": nan_where_undefined(math.sin),
    "cos": nan_where_undefined(math.cos),
    "tan": nan_where_undefined(math.tan),
    "asin": nan_where_undefined(math.asin),
    "acos": nan_where_undefined(math.acos),
    "atan": math.atan,
    "floor": round_finite(math.floor),
    "ceil": round_finite(math.ceil),
    "round": round_finite(round),
    "rad": math.radians,
    "deg": math.degrees,
    "wrap": wrap_angle,
}

NUMBER_FUNCTIONS: Final[dict[str, Function]] = {
    **{name: _numeric(f"{name}(a)", 1, function) for name, function in _ONE_NUMBER.items()},
    "atan2": _numeric("atan2(y, x)", 2, math.atan2),
    "angle": _numeric("angle(a, b)", 2, _angle_between),
    "clamp": _numeric("clamp(a, low, high)", 3, _clamp),
}
