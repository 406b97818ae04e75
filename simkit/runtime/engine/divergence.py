"""Report of a physics that diverged: the joint, the time, and a hint."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np

from simkit.errors import SimulationDiverged
from simkit.runtime.engine.simulated_time import Clock

BAD_POSITION: Final = int(mujoco.mjtWarning.mjWARN_BADQPOS)
BAD_VELOCITY: Final = int(mujoco.mjtWarning.mjWARN_BADQVEL)
BAD_ACCELERATION: Final = int(mujoco.mjtWarning.mjWARN_BADQACC)
_BAD: Final = (BAD_POSITION, BAD_VELOCITY, BAD_ACCELERATION)


class EngineWarnings:
    """Texts of MuJoCo's warnings, which has one place for them in a process."""

    def __init__(self) -> None:
        self._texts: list[str] = []

    def record(self, text: str) -> None:
        """Keeps a text; an exception here would end the interpreter."""
        if len(self._texts) < 8:
            self._texts.append(text)

    def take_first(self) -> str:
        """Returns the first text and forgets all."""
        text = self._texts[0] if self._texts else ""
        self._texts.clear()
        return text


ENGINE_WARNINGS: Final = EngineWarnings()


def divergence(model: mujoco.MjModel, data: mujoco.MjData, clock: Clock, tick: int) -> SimulationDiverged:
    """Return the error for a state of which MuJoCo counts NaN or infinite numbers.

    Args:
        model, data: of MuJoCo.
        clock: gives the time of a tick.
        tick: of the state.
    """
    counts = data.warning.number
    first = max(0, tick - max(int(counts[w]) for w in _BAD))
    dof = next((int(i) for a in (data.qvel, data.qacc) for i in np.flatnonzero(~(np.abs(a) < 1e10))), None)
    if dof is None:
        info = next(int(data.warning[w].lastinfo) for w in _BAD if counts[w])
        dof = min(info, model.nv - 1)
    joint = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, int(model.dof_jntid[dof])) or f"dof {dof}"
    hint = (
        f"a gain, a force or a stiffness is too large for the step of {clock.timestep:g} s; "
        "try a smaller max_step_size, a smaller gain or command, or a larger inertia"
    )
    return SimulationDiverged(joint.split("#")[0], clock.time(first), hint, ENGINE_WARNINGS.take_first())
