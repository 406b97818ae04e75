"""Efforts that hold joints against gravity in the current state of the simulation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from simkit.extend import SharedByCopies, Vector

if TYPE_CHECKING:
    from simkit import Simulation


class GravityEfforts(SharedByCopies):
    """Efforts that balance gravity and the forces of the current motion on some one-axis joints.

    Gravity acts on all links of the model that a joint carries. The forces of the motion are Coriolis and centrifugal
    forces. Contact forces are not included, so the weight of an object in a gripper is not balanced.

    Args:
        sim: simulation that the joints belong to.
        joints: scoped names of the joints.
    """

    def __init__(self, sim: Simulation, joints: Sequence[str]) -> None:
        self._sim, self._joints = sim, tuple(joints)
        self._model: mujoco.MjModel | None = None

    def efforts(self) -> Vector:
        """Return the efforts [N·m or N], shape (n,)."""
        sim, physics = self._sim, self._sim.engine.physics
        model, data = physics.model, physics.data
        if model is not self._model:
            self._model, self._own = model, np.zeros(model.nv)
            self._dofs = np.array([sim.engine.names.joint(name).dofs[0] for name in self._joints], np.intp)
        if physics.fresh_velocities():
            bias: Vector = data.qfrc_bias.take(self._dofs)
            return bias
        # this part of a forward pass takes a tenth of the time, and its results are bit-identical
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 0, self._own)
        efforts: Vector = self._own.take(self._dofs)
        return efforts
