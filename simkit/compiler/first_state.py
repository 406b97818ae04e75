"""First state of a compiled model, and the effective inertia of a joint in it."""

from __future__ import annotations

import mujoco
import numpy as np


def first_state(model: mujoco.MjModel, data: mujoco.MjData | None = None) -> mujoco.MjData:
    """Return the state at the start, with the poses of all bodies computed, in `data` if it is given."""
    if data is None:
        data = mujoco.MjData(model)
    else:
        mujoco.mj_resetData(model, data)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return data


def first_mass_matrix(model: mujoco.MjModel, data: mujoco.MjData | None = None) -> mujoco.MjData:
    """Return the first state with the mass matrix M and its factorisation; `data` is this state without them."""
    data = first_state(model) if data is None else data
    mujoco.mj_makeM(model, data)
    mujoco.mj_factorM(model, data)
    return data


def inverse_inertia(model: mujoco.MjModel, data: mujoco.MjData, dof: int) -> float:
    """Return (M⁻¹)_jj [1/(kg·m²) or 1/kg] of a degree of freedom, with all others free to move.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data with the factors of M.
        dof: degree of freedom.
    """
    unit, solved = np.zeros((1, model.nv)), np.zeros((1, model.nv))
    unit[0, dof] = 1.0
    mujoco.mj_solveM(model, data, solved, unit)
    return float(solved[0, dof])
