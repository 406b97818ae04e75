"""Values that the nodes of a behaviour tree share."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(eq=False)
class Blackboard:
    """Values by name, which the nodes of a tree share.

    Attributes:
        values: values by name.
        parent: blackboard of the tree that contains this one as a subtree.
        remapped: names of this blackboard whose values are in the parent, with their name there.
        remaps_all: True if the parent has each name that this blackboard does not have.
    """

    values: dict[str, Any] = field(default_factory=dict)
    parent: Blackboard | None = None
    remapped: dict[str, str] = field(default_factory=dict)
    remaps_all: bool = False

    def _owner(self, name: str) -> tuple[Blackboard, str]:
        """Return the blackboard with the value of a name, and its name there."""
        board: Blackboard = self
        while (outer := board.parent) is not None:
            if name.startswith("@"):
                board = outer
            elif name in board.remapped:
                board, name = outer, board.remapped[name]
            elif board.remaps_all and name not in board.values and not name.startswith("_"):
                board = outer
            else:
                break
        return board, name.removeprefix("@")

    def has(self, name: str) -> bool:
        """Check whether there is a value."""
        board, key = self._owner(name)
        return key in board.values

    def get(self, name: str, default: Any = None) -> Any:
        """Return a value."""
        board, key = self._owner(name)
        return board.values.get(key, default)

    def set(self, name: str, value: object) -> None:
        """Store a value."""
        board, key = self._owner(name)
        board.values[key] = value

    def unset(self, name: str) -> None:
        """Remove a value."""
        board, key = self._owner(name)
        board.values.pop(key, None)
