"""Command and state interfaces of the hardware: named numbers that controllers read and write in groups."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.pose import Vector

Indices = npt.NDArray[np.intp]
"""Indices of an array, shape (n,)."""

POSITION: Final = "position"
VELOCITY: Final = "velocity"
EFFORT: Final = "effort"


def array_index(places: Sequence[int]) -> slice | Indices:
    """Convert indices to an array index: a slice if they are consecutive, which is the fastest kind."""
    first, count = (places[0], len(places)) if len(places) else (0, 0)
    if count and list(places) == list(range(first, first + count)):
        return slice(first, first + count)
    return np.array(places, dtype=np.intp)


Reading = tuple[Indices, Callable[[], Vector]]
"""Indices of a table, and the function that reads their values."""


class InterfaceTable:
    """All interfaces of one direction, in one array.

    Attributes:
        names: `<joint or sensor>/<interface>`, such as `arm_1_joint/position`, in the order of the description.
        values: values of the interfaces [rad, m, rad/s, m/s, N·m, N]; NaN without a value (yet).
        deferred: pending readings, such as those of a sensor, that are done at the first access.
        deferred_places: all indices of `values` whose readings can be pending.
    """

    def __init__(self, names: Iterable[str] = ()) -> None:
        self.names: tuple[str, ...] = tuple(dict.fromkeys(names))
        self._index = {name: k for k, name in enumerate(self.names)}
        self.values: Vector = np.full(len(self.names), np.nan)
        self.deferred: list[Reading] = []
        self.deferred_places: frozenset[int] = frozenset()

    def read_deferred(self, requested: frozenset[int]) -> None:
        """Do the pending readings of the requested indices."""
        now: list[Reading] = []
        later: list[Reading] = []
        for entry in self.deferred:
            (later if requested.isdisjoint(entry[0].tolist()) else now).append(entry)
        self.deferred[:] = later
        for places, read in now:
            self.values[places] = read()

    def index(self, name: str) -> int:
        """Return the index of a name in `values`.

        Raises:
            InputError: the name is not known; the message has the closest one.
        """
        found = self._index.get(name)
        if found is None:
            near = did_you_mean(name, self.names)
            raise InputError(f"there is no interface {name!r}{near and '; ' + near}")
        return found

    def select(self, names: Sequence[str]) -> InterfaceSelection:
        """Select some interfaces, in the given order.

        Raises:
            InputError: a name is not known.
        """
        return InterfaceSelection(self, names)


class InterfaceSelection(SharedByCopies):
    """Some interfaces of a table, in the order of a controller."""

    def __init__(self, table: InterfaceTable, names: Sequence[str]) -> None:
        self._table = table
        self.names = tuple(names)
        places = [table.index(name) for name in names]
        self._places = frozenset(places)
        self._array_index = array_index(places)
        self._is_view = isinstance(self._array_index, slice)

    def __len__(self) -> int:
        return len(self.names)

    @property
    def values(self) -> Vector:
        """Copy of the values."""
        table = self._table
        if table.deferred and not table.deferred_places.isdisjoint(self._places):
            table.read_deferred(self._places)
        found: Vector = table.values[self._array_index]
        return found.copy() if self._is_view else found

    @values.setter
    def values(self, values: Vector | Sequence[float]) -> None:
        self._table.values[self._array_index] = values
