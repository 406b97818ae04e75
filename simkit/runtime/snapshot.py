"""The whole state of a simulation at one tick."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from simkit.runtime.parts import Structure


@dataclass(frozen=True)
class Snapshot:
    """What `restore` brings back; made by `Simulation.snapshot`.

    Attributes:
        tick: where the run stood.
        structure: what was in the world.
    """

    tick: int
    structure: Structure
    data: Any
    fields: dict[str, Any]
    sensors: list[tuple[Any, Any]]
    plugins: list[tuple[Any, Any]]
    handles: list[tuple[Any, Any]]
    inbox: tuple[tuple[str, Any], ...]
    one_shot: bool
    last_applied: Any
    sleep: tuple[Any, ...] = (False,)

    def __deepcopy__(self, memo: dict[int, Any]) -> Snapshot:
        return self
