"""Functions of numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from simkit.conditions.arithmetic import logarithm, total, whole, wrapped
from simkit.conditions.function import Function
from simkit.conditions.kinds import NUMBER
from simkit.conditions.parts import Part
from simkit.conditions.syntax import Call

if TYPE_CHECKING:
    from simkit.conditions.binding import Binder


def _numeric(usage: str, count: int, function: Callable[..., float]) -> Function:
    """A function of so many numbers."""

    def make(binder: Binder, call: Call) -> Part:
        parts = tuple(binder.number(node) for node in call.arguments)
        gets = [part.get for part in parts]
        if count == 1:
            get = gets[0]
            return Part(call, NUMBER, lambda: function(get()), parts)
        return Part(call, NUMBER, lambda: function(*[get() for get in gets]), parts)

    return Function(usage, count, count, make)


def _clamped(value: float, low: float, high: float) -> float:
    return max(low, min(high, value))


def _angle_between(a: float, b: float) -> float:
    return wrapped(a - b)


_ONE_NUMBER: dict[str, Callable[[float], float]] = {
    "sqrt": total(math.sqrt),
    "exp": total(math.exp),
    "log": logarithm,
    "sin": total(math.sin),
    "cos": total(math.cos),
    "tan": total(math.tan),
    "asin": total(math.asin),
    "acos": total(math.acos),
    "atan": math.atan,
    "floor": whole(math.floor),
    "ceil": whole(math.ceil),
    "round": whole(round),
    "rad": math.radians,
    "deg": math.degrees,
    "wrap": wrapped,
}

NUMBER_FUNCTIONS: Final[dict[str, Function]] = {
    **{name: _numeric(f"{name}(a)", 1, function) for name, function in _ONE_NUMBER.items()},
    "atan2": _numeric("atan2(y, x)", 2, math.atan2),
    "angle": _numeric("angle(a, b)", 2, _angle_between),
    "clamp": _numeric("clamp(a, low, high)", 3, _clamped),
}
