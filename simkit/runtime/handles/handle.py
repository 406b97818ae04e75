"""Base class of handles, which stay valid while the engine's objects are replaced."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from simkit.argument_checks import check_kind
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.in_process import InProcess

if TYPE_CHECKING:
    from simkit.runtime.handles.entity_handles import EntityHandles

T = TypeVar("T")


class Handle(InProcess):
    """Named entity of a simulation.

    Attributes:
        name: name in the file.
        scoped: names from the world down, joined with `::`.
    """

    _internal_names = frozenset({"check_present", "mark_present"})

    def __init__(self, handles: EntityHandles, name: str, scoped: str) -> None:
        self._handles, self._engine, self._physics = handles, handles.engine, handles.engine.physics
        self.name, self.scoped = name, scoped
        self._is_present = True

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.scoped!r}{'' if self._is_present else ' (removed)'}>"

    @property
    def is_present(self) -> bool:
        """False after the entity has been removed."""
        return self._is_present

    def mark_present(self, is_present: bool = True) -> None:
        """Record that the entity is in the world, or that it was removed."""
        self._is_present = is_present

    def check_present(self) -> None:
        """Raise InputError if the entity was removed."""
        if not self._is_present:
            self._engine.check_open()  # closing a simulation ends the presence of all its handles
            text = f"{type(self).__name__.lower()} {self.scoped!r} was removed"
            raise InputError("SK-NAME-002", text, shows_code=False)


class UnknownName(KeyError):
    """Unknown name; the message suggests the closest name."""

    code = "SK-NAME-006"

    def __str__(self) -> str:
        return str(self.args[0])


def look_up(table: dict[str, T], name: str, kind: str) -> T:
    """Return the entry of a table; a KeyError suggests the closest name."""
    try:
        return table[name]
    except (KeyError, TypeError):
        check_kind(name, str, f"the name of a {kind}", "a text")
        near = did_you_mean(name, table) or ("there is " + ", ".join(list(table)[:20]) if table else "there is none")
        raise UnknownName(f"no {kind} {name!r}; {near}") from None
