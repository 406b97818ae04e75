"""What stands between the engine's stages: states that are kept for later readings, and laws that change contacts."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import numpy.typing as npt


class HeldState:
    """The physics state of one tick, kept so that a reading can be made of it later."""

    __slots__ = ("model", "tick", "told", "values")

    def __init__(self, tick: int, model: Any, values: npt.NDArray[np.float64], told: Any = None) -> None:
        self.tick, self.model, self.values, self.told = tick, model, values, told

    def __deepcopy__(self, memo: dict[int, Any]) -> HeldState:
        return self


class ContactLaw(Protocol):
    """What changes contacts in every forward pass, once velocities are known and before forces are."""

    model: Any

    @property
    def acts(self) -> bool:
        """Whether there is anything to change; else the engine goes on by itself."""

    def shape(self, data: Any, told: Any = None) -> None:
        """Changes the contacts of data of its model, as is asked for now or as was once `told`."""

    def solve(self, data: Any) -> None:
        """Solves for the forces, after that."""

    def told(self) -> Any:
        """What is asked of contacts now, for `shape`."""
