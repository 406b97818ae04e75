"""Functions of several values, or of a list of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from simkit.testing.conditions.bound_expression import (
    UNLIMITED_ARGUMENTS,
    BoundNode,
    ExpressionBinder,
    Function,
    ValueGetter,
    as_numbers,
    as_vector,
)
from simkit.testing.conditions.syntax_tree import Call, UndecidedValue
from simkit.testing.conditions.value_types import NUMBER, TRUTH, is_vector_like

Reduction = Callable[[Any], float]


def cached_by_message(part: BoundNode, get: ValueGetter) -> ValueGetter:
    """What gives a value that comes from one topic's newest message, worked out once a message."""
    feed = part.feed
    if feed is None:
        return get
    latest, seen, value = feed.latest, None, None

    def remembered() -> Any:
        nonlocal seen, value
        message = latest()
        if message is not seen:
            value = get()
            seen = message
        return value

    return remembered


def _bind_reduction(usage: str, function: Reduction, *, of_none: float | None) -> Function:
    """A function of several numbers, or of a list of them.

    Args:
        usage: how it is written.
        function: of an array that is not empty.
        of_none: its value where there are no numbers; None where it has none then.
    """

    def make(binder: ExpressionBinder, call: Call) -> BoundNode:
        parts = tuple(binder.part(node) for node in call.arguments)
        source = call.span.text(binder.source)
        if len(parts) > 1 or parts[0].kind is NUMBER:
            for part in parts:
                if part.kind is not NUMBER:
                    raise binder.not_a_number(part)
            gets = [part.get for part in parts]
            return BoundNode(call, NUMBER, lambda: float(function(np.array([get() for get in gets]))), parts)
        numbers = as_numbers(parts[0])
        if numbers is None:
            raise binder.not_a_number(parts[0])

        def value() -> float:
            found = numbers()
            if len(found):
                return float(function(found))
            if of_none is None:
                raise UndecidedValue(f"{source} is of no numbers at all")
            return of_none

        return BoundNode(call, NUMBER, cached_by_message(parts[0], value), parts, parts[0].feed)

    return Function(usage, 1, UNLIMITED_ARGUMENTS, make)


def _norm(values: Any) -> float:
    return math.sqrt(float(values.dot(values)))


def _abs(binder: ExpressionBinder, call: Call) -> BoundNode:
    part = binder.number(call.arguments[0])
    get = part.get
    return BoundNode(call, NUMBER, lambda: abs(get()), (part,))


def _len(binder: ExpressionBinder, call: Call) -> BoundNode:
    part = binder.part(call.arguments[0])
    get = part.get
    if part.kind.item is None:
        text = f"{part.node.span.text(binder.source)} is {part.kind}, and len counts the items of a list"
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
    """`any` (decided by a true one) and `all` (decided by a false one), of arguments or of a list."""

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
    "min": _bind_reduction("min(list), min(a, b, …)", np.min, of_none=math.inf),
    "max": _bind_reduction("max(list), max(a, b, …)", np.max, of_none=-math.inf),
    "mean": _bind_reduction("mean(list), mean(a, b, …)", np.mean, of_none=None),
    "sum": _bind_reduction("sum(list), sum(a, b, …)", np.sum, of_none=0.0),
    "norm": _bind_reduction("norm(vector), norm(a, b, …)", _norm, of_none=0.0),
    "abs": Function("abs(a)", 1, 1, _abs),
    "len": Function("len(list)", 1, 1, _len),
    "isfinite": Function("isfinite(a)", 1, 1, _isfinite),
    "any": _bind_any_or_all("any(a, b, …)", True),
    "all": _bind_any_or_all("all(a, b, …)", False),
}
