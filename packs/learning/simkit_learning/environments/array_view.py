"""Poses, velocities, joints and contacts of all environments of a batch, as arrays."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np
import numpy.typing as npt
from mujoco.batch import Batch

from simkit import Simulation
from simkit.linear_algebra import matmul, norm
from simkit.runtime.state_arrays import ReadState, StateArrays
from simkit.testing.conditions.contact_query import ContactQuery

if TYPE_CHECKING:
    from simkit_learning.environments.message_arrays import Array

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
_GROUND: Final = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))


class ArrayView(StateArrays):
    """State of all environments; the first axis of every array is the environment.

    Functions for arrays (`simkit.gym.Batched`) receive this object.

    Args:
        sim: simulation of the environment that resets all others.
        batch: MuJoCo's batch.
        read_state: function that returns model and data of one environment.

    Attributes:
        count: number of environments.
        memory: numbers that `on_reset` stored in `env.memory`, as arrays by name; functions may write to them.
        action: last actions within their bounds, shape (count, n).
        observation: last observations.
        time: simulated time since the reset [s], shape (count,).
        sim_time: time of the simulations [s], shape (count,).
        varies_model: the environments have models of their own, which differ in drawn or written values.
    """

    def __init__(self, sim: Simulation, batch: Batch, read_state: ReadState) -> None:
        super().__init__(sim, batch, read_state)
        self.varies_model = False
        self.memory: dict[str, Any] = {}
        self.action: Floats = np.zeros((self.count, 0))
        self.observation: Array | dict[str, Array] | None = None
        self.time: Floats = np.zeros(self.count)
        self.sim_time: Floats = np.zeros(self.count)
        self._contacts: dict[str, _TouchSearch] = {}

    # ------------------------------------------------------------------ contacts

    def contact(self, name: str) -> Bools:
        """Return in which environments a model or link touches something other than the ground, shape (count,).

        Bounds of the geoms exclude most environments; the engine detects the contacts of the others.
        """
        if name not in self._contacts:
            self._contacts[name] = _TouchSearch(self.sim, name)
        search = self._contacts[name]
        touches = np.zeros(self.count, np.bool_)
        # the bounds are those of one model
        rows = np.arange(self.count)
        if not self.varies_model:
            rows = np.flatnonzero(search.may_touch(self.field("geom_xpos"), self.field("geom_xmat")))
        for row in rows.tolist():
            model, data = self.state_of(row)
            mujoco.mj_fwdPosition(model, data)
            touches[row] = bool(search.query.among(data))
        return touches


class _TouchSearch:
    """Search for environments in which an entity may touch another, by bounds of geoms.

    Args:
        sim: simulation of the environment that resets all others.
        name: scoped name of a model or link.
    """

    def __init__(self, sim: Simulation, name: str) -> None:
        model = sim.mj_model
        self.query = ContactQuery(sim, name)
        mine, others = (np.array(part[:-1], dtype=np.bool_) for part in self.query.masks())
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        is_ground = np.isin(model.geom_type, _GROUND) & (model.body_weldid[model.geom_bodyid] == 0)
        gravity = model.opt.gravity.copy()
        up = -gravity / norm(gravity) if gravity.any() else np.array((0.0, 0.0, 1.0))
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        # the front of a plane that is steeper than a ramp is a wall
        steep = matmul(data.geom_xmat[:, 2::3], up) < math.cos(math.radians(45.0))
        is_wall = (model.geom_type == _GROUND[0]) & steep
        self._mine = np.flatnonzero(mine & collides)
        self._others = np.flatnonzero(others & collides & ~(is_ground & ~is_wall))
        self._radii = model.geom_rbound[self._mine] + model.geom_margin[self._mine]
        is_plane = model.geom_type[self._others] == _GROUND[0]
        self._middles = model.geom_aabb[self._others, :3]
        self._halves = np.where(is_plane[:, None], (np.inf, np.inf, 0.0), model.geom_aabb[self._others, 3:])

    def may_touch(self, positions: Floats, rotations: Floats) -> Bools:
        """Check in which environments the spheres around the entity's geoms reach into the boxes around the others."""
        if not (len(self._mine) and len(self._others)):
            return np.zeros(len(positions), np.bool_)
        centres = positions[:, self._mine]
        turns = rotations[:, self._others].reshape(len(positions), -1, 3, 3)
        offsets = centres[:, :, None] - positions[:, None, self._others]  # environment, own geom, other geom, axis
        local = np.einsum("nmoi,noij->nmoj", offsets, turns) - self._middles
        outside = np.maximum(np.abs(local) - self._halves, 0.0)
        square = np.einsum("nmoj,nmoj->nmo", outside, outside)
        reach = (self._radii * (1.0 + 1e-9) + 1e-9) ** 2
        is_apart: Bools = (square > reach[None, :, None]).all(axis=(1, 2))
        return ~is_apart
