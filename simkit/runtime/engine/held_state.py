"""A physics state that is kept so that a sensor can be read later, and the forces of its last step."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import mujoco


class HeldState:
    """The physics state of one tick.

    Attributes:
        tick: the tick.
        model: of the engine, that the state is of.
        values: of the engine (`mjSTATE_INTEGRATION`).
        request: what plugins asked of contacts at that tick, for `ContactShaper.shape`.
        uses_law, is_fast: whether its step follows the contact law, and has speculative contacts; None where that is
            still to be found from the state.
        probes: whether controls or forces have changed before that step so that contacts may begin to slide.
    """

    __slots__ = ("is_fast", "model", "probes", "request", "tick", "uses_law", "values")

    def __init__(
        self,
        tick: int,
        model: mujoco.MjModel,
        values: npt.NDArray[np.float64],
        request: object,
        uses_law: bool | None,
        is_fast: bool | None,
        probes: bool,
    ) -> None:
        self.tick, self.model, self.values, self.request = tick, model, values, request
        self.uses_law, self.is_fast, self.probes = uses_law, is_fast, probes

    def __deepcopy__(self, memo: dict[int, object]) -> HeldState:
        return self


class ForcedPhysics(Protocol):
    """Physics with the forces of its last step.

    Attributes:
        data: the engine's.
        shows_applied: whether what held for one step is gone from `data`.
        last_applied, last_pushed: forces of the last step that are gone from `data`.
    """

    data: mujoco.MjData
    shows_applied: bool
    last_applied: npt.NDArray[np.float64]
    last_pushed: npt.NDArray[np.float64]


def applied_forces(physics: ForcedPhysics) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Forces on joints, shape (nv,), and on bodies, shape (nbody, 6), of the last step [N, N m].

    Those that hold for one step are gone from the state by then, and remembered.
    """
    applied, pushed = physics.data.qfrc_applied, physics.data.xfrc_applied
    if physics.shows_applied:
        return physics.last_applied + applied, physics.last_pushed + pushed
    return applied, pushed
