"""Limits of one expansion: steps, sizes of values, depth. Files can be untrusted, and xacro evaluates expressions."""

from __future__ import annotations

from typing import TypeVar

Value = TypeVar("Value")

MAX_STEPS = 1_000_000
MAX_ITEMS = 10_000
MAX_TEXT = 100_000
MAX_BITS = 4096
MAX_FILES_DEEP = 48


class ExpansionError(Exception):
    """Expression or element that cannot be expanded; the text is for the user."""


class BoundError(ExpansionError):
    """Expansion that exceeds a limit; each limit is far above the needs of a robot."""


class Budget:
    """Remaining steps of one expansion."""

    def __init__(self, steps: int = MAX_STEPS) -> None:
        self.left = steps

    def spend(self, steps: int = 1) -> None:
        """Subtract steps; raise BoundError if none are left."""
        self.left -= steps
        if self.left < 0:
            raise BoundError(f"it needs more than {MAX_STEPS} steps")

    def value(self, value: Value) -> Value:
        """Return the same value if its size is within the limits, else raise BoundError."""
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
        """Return the number of items in nested values, and spend as many steps; shared items count every time."""
        weight, stack = 0, list(values)
        while stack:
            item = stack.pop()
            weight += 1 + (len(item) // 16 if isinstance(item, str) else 0)
            if isinstance(item, dict):
                stack += [*dict.keys(item), *dict.values(item)]
            elif isinstance(item, (list, tuple)):
                stack += list.__iter__(item) if isinstance(item, list) else item
            elif isinstance(item, (set, frozenset)):
                stack += item
            if weight + len(stack) > 10 * MAX_ITEMS:
                raise BoundError("a value is too large")
        self.spend(weight)
        return weight
