"""Functions that xacro expressions may call, by their names in xacro."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable

from simkit.loaders.xacro.expansion_limits import MAX_ITEMS, BoundError, ExpansionError
from simkit.loaders.xacro.expression import Evaluator, Function, Value

DIRECT_NAMES = ("list", "dict", "map", "len", "str", "float", "int", "bool", "min", "max", "round", "sorted", "range")
"""Functions that can be called without the prefix `python.`."""

_LARGEST_FACTORIAL = 1000


def python_functions(evaluator: Evaluator) -> dict[str, Function]:
    """Return Python's own functions by name: those of xacro's name space `python`."""

    def plain(function: Value) -> Value:
        return evaluator._callable(function) if isinstance(function, Function) else function

    def over(function: Value) -> Callable[..., Value]:
        return lambda *args: function(*(plain(a) for a in args))

    def mapped(function: Value, *lists: Value) -> list[Value]:
        return [evaluator.call(function, *items) for items in zip(*lists, strict=False)]

    def filtered(function: Value, items: Value) -> list[Value]:
        return [i for i in items if (i if function is None else evaluator.call(function, i))]

    def is_instance(value: Value, kinds: Value) -> bool:
        accepted = kinds if isinstance(kinds, (tuple, list)) else (kinds,)
        return isinstance(value, tuple(k.kind for k in accepted if isinstance(k, Function) and k.kind))

    table: dict[str, Function] = {
        kind.__name__: Function(kind, kind)
        for kind in (list, dict, str, float, int, bool, complex, set, tuple, frozenset)
    }
    for function in (len, min, max, abs, all, any, divmod, hash, ord, repr, slice):
        table[function.__name__] = Function(function)
    for lazy in (enumerate, reversed, zip):
        table[lazy.__name__] = Function(lambda *args, _lazy=lazy: list(_lazy(*args)))
    table |= {
        "map": Function(mapped),
        "filter": Function(filtered),
        "range": Function(_range),
        "round": Function(_round),
        "sorted": Function(sorted),
        "sum": Function(_sum),
        "type": Function(lambda value: type(value).__name__),
        "isinstance": Function(is_instance),
    }
    table["chr"] = Function(over(chr))
    return table


def math_functions() -> dict[str, Value]:
    """Return all public names of the module `math`."""
    table: dict[str, Value] = {}
    for name, value in vars(math).items():
        if name.startswith("_"):
            continue
        table[name] = Function(value) if callable(value) else value
    for name in ("factorial", "comb", "perm"):
        table[name] = Function(_check_size(getattr(math, name)))
    return table


def tokenize(text: str, sep: str = ",; ", skip_empty: bool = True) -> list[str]:
    """Split a text at any of the characters of `sep`."""
    parts = re.split("[" + re.escape(str(sep)) + "]", str(text)) if sep else [str(text)]
    return [p for p in parts if p] if skip_empty else parts


def _range(*args: int) -> list[int]:
    numbers = range(*args)
    if len(numbers) > MAX_ITEMS:
        raise BoundError(f"a range has more than {MAX_ITEMS} items")
    return list(numbers)


def _round(value: Value, digits: int | None = None) -> Value:
    if digits is not None and abs(digits) > 300:
        raise ExpansionError("round to at most 300 digits")
    return round(value) if digits is None else round(value, digits)


def _sum(items: Iterable[Value], start: Value = 0) -> Value:
    """Return the sum of `start` and items. The built-in `sum` has other bits from Python 3.12 on (see `float_sum`)."""
    if isinstance(start, str):
        raise ExpansionError("sum() adds no texts; write ''.join(…)")
    total = start
    for item in items:
        total = total + item
    return total


def _check_size(function: Callable[..., int]) -> Callable[..., int]:
    def call(*args: int) -> int:
        if any(abs(a) > _LARGEST_FACTORIAL for a in args):
            raise BoundError("a number is too large")
        return function(*args)

    return call
