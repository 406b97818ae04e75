"""Operators and functions for numbers and lists as in IEEE 754: results may be NaN, but never an exception.

For many worlds at once, numbers are arrays of the shape (worlds,) and vectors of the shape (worlds, n). A function of
numbers is then applied to each of them, by NumPy where this gives the same bits.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from functools import partial
from typing import Any, Final, SupportsFloat, TypeVar

import numpy as np

from simkit.elementary_functions import each
from simkit.linear_algebra import dot
from simkit.pose import Vector, wrap_angle
from simkit.testing.conditions.bound_expression import (
    UNLIMITED_ARGUMENTS,
    BoundNode,
    ExpressionBinder,
    Function,
    ValueGetter,
    as_numbers,
    as_vector,
    vector_of,
)
from simkit.testing.conditions.syntax_tree import Call, UndecidedValue
from simkit.testing.conditions.value_types import NUMBER, TRUTH, is_vector_like

BinaryOperator = Callable[[float, float], float]


def divide(a: float, b: float) -> float:
    """Return a / b; infinity or NaN if b is zero."""
    if b:
        return a / b
    if not a or a != a or b != b:
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def remainder(a: float, b: float) -> float:
    """Return a - b·floor(a / b), which has the sign of b."""
    if not b or not math.isfinite(a) or b != b:
        return math.nan
    return a % b


def power(a: float, b: float) -> float:
    """Return a raised to the power b."""
    try:
        result = math.pow(a, b)
    except OverflowError:
        odd = b % 2 == 1
        return -math.inf if a < 0 and odd else math.inf
    except ValueError:
        return math.inf if not a else math.nan
    return result


def nan_where_undefined(function: Callable[..., float], otherwise: float = math.nan) -> Callable[..., float]:
    """Wrap a function of `math`: return NaN where the function is undefined, infinity where the result is too large."""

    def value(*numbers: float) -> float:
        try:
            return float(function(*numbers))
        except ValueError:
            return otherwise
        except OverflowError:
            return math.inf

    return value


def logarithm(a: float) -> float:
    """Return the natural logarithm; -inf at zero."""
    return math.log(a) if a > 0 else -math.inf if a == 0 else math.nan


def round_finite(function: Callable[[float], int]) -> Callable[[float], float]:
    """Wrap a rounding function so that NaN and infinity are returned unchanged."""
    return lambda a: float(function(a)) if math.isfinite(a) else a


def wrapped_angle(angle: float) -> float:
    """Wrap an angle [rad] to (-pi, pi]."""
    if not math.isfinite(angle):
        return math.nan
    wrapped = wrap_angle(angle)
    return wrapped if wrapped > -math.pi else wrapped + 2 * math.pi


Operand = TypeVar("Operand")


def _without_warnings(act: Callable[[Operand, Operand], Operand]) -> Callable[[Operand, Operand], Operand]:
    def value(a: Operand, b: Operand) -> Operand:
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
ROW_OPERATORS: Final[dict[str, Callable[[Any, Any], Any]]] = {
    **NUMBER_OPERATORS,
    "/": _without_warnings(np.divide),
    "%": partial(each, remainder),
    "**": partial(each, power),
}
"""Operators for the numbers of many worlds."""

VECTOR_OPERATORS: Final = {
    "+": _without_warnings(operator.add),
    "-": _without_warnings(operator.sub),
    "*": _without_warnings(operator.mul),
    "/": _without_warnings(np.divide),
}


def _numeric(
    usage: str, count: int, function: Callable[..., float], rows: Callable[..., Any] | None = None
) -> Function:
    """Return a function of the expression language that has a fixed number of numeric arguments.

    Args:
        usage: Call syntax, for messages.
        count: Number of arguments.
        function: Function of numbers.
        rows: The same function of arrays; None applies `function` to each number.
    """

    def make(binder: ExpressionBinder, call: Call) -> BoundNode:
        parts = tuple(binder.number(node) for node in call.arguments)
        gets, act = [part.get for part in parts], function
        if binder.in_rows:
            act = partial(each, function) if rows is None else rows
        if count == 1:
            get = gets[0]
            return BoundNode(call, NUMBER, lambda: act(get()), parts)
        return BoundNode(call, NUMBER, lambda: act(*[get() for get in gets]), parts)

    return Function(usage, count, count, make, has_rows=True)


def _clamp(value: float, low: float, high: float) -> float:
    return max(low, min(high, value))


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
    "wrap": wrapped_angle,
}

_OF_ARRAYS: dict[str, np.ufunc] = {"sqrt": np.sqrt, "sin": np.sin, "cos": np.cos}

NUMBER_FUNCTIONS: Final[dict[str, Function]] = {
    **{name: _numeric(f"{name}(a)", 1, function, _OF_ARRAYS.get(name)) for name, function in _ONE_NUMBER.items()},
    "atan2": _numeric("atan2(y, x)", 2, math.atan2),
    "angle": _numeric("angle(a, b)", 2, lambda a, b: wrapped_angle(a - b)),
    "clamp": _numeric("clamp(a, low, high)", 3, _clamp, lambda a, low, high: np.maximum(low, np.minimum(high, a))),
}


# ---------------------------------------------------------------------- functions of lists


Reduction = Callable[[Vector], SupportsFloat]
"""Function that reduces the last axis of an array."""


def cached_by_message(part: BoundNode, get: ValueGetter) -> ValueGetter:
    """Wrap a getter so that the value is computed only once for each message of a topic."""
    feed = part.feed
    if feed is None:
        return get
    latest, seen, value = feed.latest, None, None

    def cached_value() -> object:
        nonlocal seen, value
        message = latest()
        if message is not seen:
            value = get()
            seen = message
        return value

    return cached_value


def _bind_reduction(usage: str, function: Reduction, *, empty_value: float | None) -> Function:
    """Return a function of the expression language that accepts several numbers or one list.

    Args:
        usage: Call syntax, for messages.
        function: Reduction of a non-empty array to a number.
        empty_value: Result for an empty list; None if the result is undefined.
    """

    def make(binder: ExpressionBinder, call: Call) -> BoundNode:
        parts = tuple(binder.part(node) for node in call.arguments)
        source = call.span.text(binder.source)
        if len(parts) > 1 or parts[0].kind is NUMBER:
            for part in parts:
                if part.kind is not NUMBER:
                    raise binder.not_a_number(part)
            gets = [part.get for part in parts]
            if binder.in_rows:
                return BoundNode(call, NUMBER, lambda: function(vector_of([get() for get in gets])), parts)
            return BoundNode(call, NUMBER, lambda: float(function(np.array([get() for get in gets]))), parts)
        numbers = as_numbers(parts[0])
        if numbers is None:
            raise binder.not_a_number(parts[0])
        if binder.in_rows:
            return BoundNode(call, NUMBER, lambda: function(numbers()), parts)

        def value() -> float:
            values = numbers()
            if len(values):
                return float(function(values))
            if empty_value is None:
                raise UndecidedValue(f"{source} has an empty list")
            return empty_value

        return BoundNode(call, NUMBER, cached_by_message(parts[0], value), parts, parts[0].feed)

    return Function(usage, 1, UNLIMITED_ARGUMENTS, make, has_rows=True)


def length(values: Vector) -> float | Vector:
    """Return the length of a vector, or of the vector of each world, without a warning for an overflow."""
    if np.ndim(values) == 2:
        with np.errstate(all="ignore"):
            lengths: Vector = np.sqrt(np.square(values).sum(axis=1))
        return lengths
    return math.sqrt(dot(values, values))


def _len(binder: ExpressionBinder, call: Call) -> BoundNode:
    part = binder.part(call.arguments[0])
    get = part.get
    if part.kind.item is None:
        text = f"{part.node.span.text(binder.source)} is {part.kind}, but len needs a list"
        raise binder.fault("SK-COND-004", text, part.node.span)
    return BoundNode(call, NUMBER, lambda: float(len(get())), (part,), part.feed)


def _isfinite(binder: ExpressionBinder, call: Call) -> BoundNode:
    part = binder.part(call.arguments[0])
    if part.kind is NUMBER:
        get = part.get
        return BoundNode(call, TRUTH, lambda: math.isfinite(get()), (part,))

    if not is_vector_like(part.kind):
        raise binder.not_a_number(part)
    vector = as_vector(part)
    return BoundNode(
        call, TRUTH, cached_by_message(part, lambda: bool(np.isfinite(vector()).all())), (part,), part.feed
    )


def _bind_any_or_all(usage: str, decisive: bool) -> Function:
    """Return the function `any` or `all`, which accepts several arguments or one list.

    Args:
        usage: Call syntax, for messages.
        decisive: Operand value that decides the result alone: True for `any`, False for `all`.
    """

    def make(binder: ExpressionBinder, call: Call) -> BoundNode:
        first = binder.part(call.arguments[0])
        if len(call.arguments) == 1 and first.kind.item is TRUTH:
            get = first.get
            return BoundNode(
                call, TRUTH, lambda: any(bool(v) is decisive for v in get()) is decisive, (first,), first.feed
            )
        parts = tuple(binder.truth(node) for node in call.arguments)
        gets = [part.get for part in parts]

        def value() -> bool:
            return any(get() is decisive for get in gets) is decisive

        return BoundNode(call, TRUTH, value, parts)

    return Function(usage, 1, UNLIMITED_ARGUMENTS, make)


LIST_FUNCTIONS: Final[dict[str, Function]] = {
    "min": _bind_reduction("min(list), min(a, b, …)", partial(np.min, axis=-1), empty_value=math.inf),
    "max": _bind_reduction("max(list), max(a, b, …)", partial(np.max, axis=-1), empty_value=-math.inf),
    "mean": _bind_reduction("mean(list), mean(a, b, …)", partial(np.mean, axis=-1), empty_value=None),
    "sum": _bind_reduction("sum(list), sum(a, b, …)", partial(np.sum, axis=-1), empty_value=0.0),
    "norm": _bind_reduction("norm(vector), norm(a, b, …)", length, empty_value=0.0),
    "abs": _numeric("abs(a)", 1, abs, np.abs),
    "len": Function("len(list)", 1, 1, _len),
    "isfinite": Function("isfinite(a)", 1, 1, _isfinite),
    "any": _bind_any_or_all("any(a, b, …)", True),
    "all": _bind_any_or_all("all(a, b, …)", False),
}
