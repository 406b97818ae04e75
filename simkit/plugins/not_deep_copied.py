"""Objects that a deep copy, such as that of a snapshot, shares instead of copying."""

from __future__ import annotations

from typing import TypeVar

T = TypeVar("T")


class SharedByCopies:
    """Base of handles of a simulation and of immutable values: a deep copy keeps the object itself."""

    __slots__ = ()

    def __deepcopy__(self: T, memo: dict[int, object]) -> T:
        return self
