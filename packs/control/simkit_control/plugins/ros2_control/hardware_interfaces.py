"""Command and state interfaces of the hardware: named values that controllers read and write."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.errors import InputError
from simkit.extend import SharedByCopies, Vector, did_you_mean

Indices = npt.NDArray[np.intp]
"""Indices of an array, shape (n,)."""

POSITION: Final = "position"
VELOCITY: Final = "velocity"
EFFORT: Final = "effort"
KP: Final = "kp"
KD: Final = "kd"


def array_index(indices: Sequence[int]) -> slice | Indices:
    """Convert indices to an array index: a slice, which is faster, if the indices are consecutive."""
    first, count = (indices[0], len(indices)) if len(indices) else (0, 0)
    if count and list(indices) == list(range(first, first + count)):
        return slice(first, first + count)
    return np.array(indices, dtype=np.intp)


Reading = tuple[Indices, Callable[[], Vector]]
"""Indices of an `InterfaceTable`, and the function that reads the values for these indices."""


class InterfaceTable:
    """All command interfaces or all state interfaces, with their values in one array.

    Attributes:
        names: `<joint or sensor>/<interface>`, such as `arm_1_joint/position`, in the order of the description.
        values: values of the interfaces [rad, m, rad/s, m/s, N·m, N]; NaN before the first value.
        deferred: readings that are postponed until the first access, such as sensor measurements.
        deferred_indices: all indices of `values` that can have a postponed reading.
    """

    def __init__(self, names: Iterable[str] = ()) -> None:
        self.names: tuple[str, ...] = tuple(dict.fromkeys(names))
        self._index = {name: k for k, name in enumerate(self.names)}
        self.values: Vector = np.full(len(self.names), np.nan)
        self.deferred: list[Reading] = []
        self.deferred_indices: frozenset[int] = frozenset()

    def read_deferred(self, requested: frozenset[int]) -> None:
        """Perform the postponed readings of the requested indices."""
        now: list[Reading] = []
        later: list[Reading] = []
        for entry in self.deferred:
            (later if requested.isdisjoint(entry[0].tolist()) else now).append(entry)
        self.deferred[:] = later
        for indices, read in now:
            self.values[indices] = read()

    def index(self, name: str) -> int:
        """Return the index of a name in `values`.

        Raises:
            InputError: the name is not known; the message suggests the closest name.
        """
        number = self._index.get(name)
        if number is None:
            near = did_you_mean(name, self.names)
            raise InputError(f"there is no interface {name!r}{near and '; ' + near}")
        return number

    def select(self, names: Sequence[str]) -> InterfaceSelection:
        """Return the interfaces with these names, in the order of the names.

        Raises:
            InputError: a name is not known.
        """
        return InterfaceSelection(self, names)


class InterfaceSelection(SharedByCopies):
    """Interfaces of a table that one controller uses, in the controller's order."""

    def __init__(self, table: InterfaceTable, names: Sequence[str]) -> None:
        self._table = table
        self.names = tuple(names)
        indices = [table.index(name) for name in names]
        self._indices = frozenset(indices)
        self._array_index = array_index(indices)

    def __len__(self) -> int:
        return len(self.names)

    @property
    def values(self) -> Vector:
        """Copy of the values."""
        table = self._table
        if table.deferred and not table.deferred_indices.isdisjoint(self._indices):
            table.read_deferred(self._indices)
        if isinstance(self._array_index, slice):
            return table.values[self._array_index].copy()
        return table.values.take(self._array_index)  # takes a third of the time of an index

    @values.setter
    def values(self, values: Vector | Sequence[float]) -> None:
        self._table.values[self._array_index] = values
