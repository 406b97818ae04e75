"""What one expansion may cost: steps, sizes of values, depth. Files come from anywhere, and xacro computes."""

from __future__ import annotations

from typing import TypeVar

Value = TypeVar("Value")

MAX_STEPS = 1_000_000
MAX_ITEMS = 10_000
MAX_TEXT = 100_000
MAX_BITS = 4096
MAX_FILES_DEEP = 48


class ExpansionError(Exception):
    """An expression or element that cannot be expanded; the text is for the user."""


class BoundError(ExpansionError):
    """The expansion costs more than any robot's does."""


class Budget:
    """Steps left of one expansion."""

    def __init__(self, steps: int = MAX_STEPS) -> None:
        self.left = steps

    def spend(self, steps: int = 1) -> None:
        """Takes steps; raises BoundError when none are left."""
        self.left -= steps
        if self.left < 0:
            raise BoundError(f"it needs more than {MAX_STEPS} steps")

    def value(self, value: Value) -> Value:
        """The same value, if its size is within bounds."""
        if isinstance(value, str):
            if len(value) > MAX_TEXT:
                raise BoundError(f"a text has more than {MAX_TEXT} characters")
        elif isinstance(value, (list, tuple, dict, set, frozenset)):
            if len(value) > MAX_ITEMS:
                raise BoundError(f"a list has more than {MAX_ITEMS} items")
        elif isinstance(value, int) and value.bit_length() > MAX_BITS:
            raise BoundError("a number is too large")
        return value

    def weigh(self, *values: object) -> int:
        """Everything inside nested lists and texts, counted as often as it stands there; spends as many steps."""
        weight, stack = 0, list(values)
        while stack:
            one = stack.pop()
            weight += 1 + (len(one) // 16 if isinstance(one, str) else 0)
            if isinstance(one, dict):
                stack += [*dict.keys(one), *dict.values(one)]
            elif isinstance(one, (list, tuple)):
                stack += list.__iter__(one) if isinstance(one, list) else one
            elif isinstance(one, (set, frozenset)):
                stack += one
            if weight + len(stack) > 10 * MAX_ITEMS:
                raise BoundError("a value is too large")
        self.spend(weight)
        return weight
