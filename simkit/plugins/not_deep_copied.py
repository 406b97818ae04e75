"""Objects that a deep copy shares instead of copying, for example in a snapshot."""

from __future__ import annotations

from typing import TypeVar

T = TypeVar("T")


class SharedByCopies:
    """Base class of handles and immutable values: a deep copy contains the same object, not a copy."""

    __slots__ = ()

    def __deepcopy__(self: T, memo: dict[int, object]) -> T:
        return self


class ImmutableValue(SharedByCopies):
    """Base class of values that never change and that a plugin replaces during the run: a pickled snapshot stores them.

    A pickled snapshot has references instead of other shared objects, which exist since the plugin was loaded.
    """

    __slots__ = ()

    is_immutable_value = True
