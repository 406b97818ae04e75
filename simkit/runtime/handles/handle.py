"""What all handles share: they stay valid while the engine's objects change under them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Self, TypeVar

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.runtime.handles.entity_handles import EntityHandles

T = TypeVar("T")


class Handle:
    """A name in a simulation.

    Attributes:
        name: as in the file.
        scoped: from the world down, joined with `::`.
    """

    def __init__(self, handles: EntityHandles, name: str, scoped: str) -> None:
        self._handles, self._engine, self._physics = handles, handles.engine, handles.engine.physics
        self.name, self.scoped = name, scoped
        self._is_present = True

    def __deepcopy__(self, memo: dict[int, object]) -> Self:
        return self

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.scoped!r}{'' if self._is_present else ' (removed)'}>"

    def _check(self) -> None:
        if not self._is_present:
            raise InputError(f"{type(self).__name__.lower()} {self.scoped!r} was removed", "SK-NAME-002")


class UnknownName(KeyError):
    """No such name; the message names the closest one."""

    def __str__(self) -> str:
        return str(self.args[0])


def look_up(table: dict[str, T], name: str, what: str) -> T:
    """The entry, or a KeyError that names the closest one."""
    try:
        return table[name]
    except KeyError:
        near = did_you_mean(name, table) or ("there is " + ", ".join(list(table)[:20]) if table else "there is none")
        raise UnknownName(f"no {what} {name!r}; {near}") from None
