"""What the parts share that a simulation is written in: `Interfaces`, `WorldControl`, `Contents`, `EngineAccess`."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation


class Aspect:
    """One side of a simulation, which asks the others through the whole."""

    @property
    def _whole(self) -> Simulation:
        return cast("Simulation", self)
