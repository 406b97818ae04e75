"""Base class of objects that belong to one process."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NoReturn, Self

from simkit.completion import Completed
from simkit.errors import ArgumentTypeError


class InProcess(Completed):
    """Base class of objects that belong to one process: deep copies share them, and they cannot be pickled.

    A pickled snapshot has references to such objects. They are resolved in the simulation that restores it.
    """

    __slots__ = ()

    def __deepcopy__(self, memo: Mapping[int, object]) -> Self:
        return self

    def __reduce__(self) -> NoReturn:
        reason = f"a {type(self).__name__} cannot be pickled, because it belongs to a simulation of this process"
        help_ = "pickle the RunSpec `sim.run_spec` and `sim.snapshot()`; load and restore them in the other process"
        raise ArgumentTypeError(f"{reason}; {help_}")
