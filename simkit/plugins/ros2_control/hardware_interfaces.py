"""Command and state interfaces of the hardware: named numbers that controllers read and write together."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.plugins.shared_by_copies import SharedByCopies
from simkit.pose import Vector

Indices = npt.NDArray[np.intp]
"""Places in an array, shape (n,)."""

POSITION: Final = "position"
VELOCITY: Final = "velocity"
EFFORT: Final = "effort"


def array_index(places: Sequence[int]) -> slice | Indices:
    """Return places of an array as an index: a slice where they are consecutive, which is the fastest."""
    first, count = (places[0], len(places)) if len(places) else (0, 0)
    if count and list(places) == list(range(first, first + count)):
        return slice(first, first + count)
    return np.array(places, dtype=np.intp)


Reading = tuple[Indices, Callable[[], Vector]]
"""Places of a table, and the function that reads their values."""


class InterfaceTable:
    """All interfaces of one direction, in one array.

    Attributes:
        names: `<joint or sensor>/<interface>`, such as `arm_1_joint/position`, in the order of the description.
        values: theirs; rad, m, rad/s, m/s, N·m, N; NaN where there is none (yet).
        deferred: what is only read when somebody asks for it, such as a sensor: where it is, and what reads it.
        deferred_places: all places in `values` that may be late.
    """

    def __init__(self, names: Iterable[str] = ()) -> None:
        self.names: tuple[str, ...] = tuple(dict.fromkeys(names))
        self._index = {name: k for k, name in enumerate(self.names)}
        self.values: Vector = np.full(len(self.names), np.nan)
        self.deferred: list[Reading] = []
        self.deferred_places: frozenset[int] = frozenset()

    def read_deferred(self, wanted: frozenset[int]) -> None:
        """Reads what is late and wanted."""
        now: list[Reading] = []
        later: list[Reading] = []
        for one in self.deferred:
            (later if wanted.isdisjoint(one[0].tolist()) else now).append(one)
        self.deferred[:] = later
        for places, read in now:
            self.values[places] = read()

    def index(self, name: str) -> int:
        """Return the place of a name in `values`. Raises InputError naming the closest."""
        found = self._index.get(name)
        if found is None:
            near = did_you_mean(name, self.names)
            raise InputError(f"there is no interface {name!r}{near and '; ' + near}")
        return found

    def select(self, names: Sequence[str]) -> InterfaceSelection:
        """Some of them, in the order asked for. Raises InputError."""
        return InterfaceSelection(self, names)


class InterfaceSelection(SharedByCopies):
    """Some interfaces of a table, in the order in which a controller has them."""

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
        """A copy of their values."""
        table = self._table
        if table.deferred and not table.deferred_places.isdisjoint(self._places):
            table.read_deferred(self._places)
        found: Vector = table.values[self._array_index]
        return found.copy() if self._is_view else found

    @values.setter
    def values(self, values: Vector | Sequence[float]) -> None:
        self._table.values[self._array_index] = values
