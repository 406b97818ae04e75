"""Accurate integration of long undamped chains and of bodies that spin fast.

MuJoCo's implicit integrators are of first order. With them, a falling chain of 50 links gains energy until it diverges.
A top with 400 rad/s on a ball joint falls over and diverges. An arm with servos or damping is not affected. These
kinematic trees are integrated by the Runge-Kutta method of fourth order on a second `MjData`, in substeps that follow
the fastest joint. Trees without constraint forces do not depend on each other, so all other trees keep their bits.
"""

from __future__ import annotations

import math
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.state_transfer import JOINT_WIDTHS

MIN_CHAIN_LENGTH: Final = 8
"""Least number of passive joints in a row that make a tree a chain; arms have seven."""

MIN_TURN: Final = 0.005
"""Least rotation per step [rad] at which this module integrates a body that may spin and is not in a chain."""

MAX_SUBSTEP_TURN: Final = 0.05
"""Largest rotation of the fastest joint in a substep [rad]; 0.05 keeps the energy of 50 links within 0.03 %."""

MAX_SUBSTEPS: Final = 16

_STATE: Final = int(mujoco.mjtState.mjSTATE_INTEGRATION)
_NO_CONSTRAINTS: Final = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
_SLEEP: Final = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
_RUNGE_KUTTA: Final = int(mujoco.mjtIntegrator.mjINT_RK4)
_FREE, _BALL, _HINGE = (
    int(kind) for kind in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL, mujoco.mjtJoint.mjJNT_HINGE)
)


class PassiveTree:
    """Degrees of freedom and coordinates of one kinematic tree.

    Attributes:
        turning: indices of the degrees of freedom whose velocity is in rad/s.
        is_chain: True for a tree with a chain; False for a tree with a body that may spin.
    """

    def __init__(self, model: mujoco.MjModel, number: int, is_chain: bool) -> None:
        self.number, self.is_chain = number, is_chain
        self.dofs = _index_range(model.tree_dofadr, model.tree_dofnum, number)
        joints = model.dof_jntid[self.dofs]
        kinds = model.jnt_type[joints]
        offset = np.arange(self.dofs.start, self.dofs.stop) - model.jnt_dofadr[joints]
        turns = (kinds == _BALL) | (kinds == _HINGE) | ((kinds == _FREE) & (offset >= 3))
        self.turning = self.dofs.start + np.flatnonzero(turns)
        first, last = int(joints[0]), int(joints[-1])
        width, _ = JOINT_WIDTHS.get(int(model.jnt_type[last]), (1, 1))
        self.coordinates = slice(int(model.jnt_qposadr[first]), int(model.jnt_qposadr[last]) + width)


class FreeMotionIntegrator:
    """Integrator for the trees of a compiled model that the engine's own integrator does not suit.

    Use in every step: `prepare`, the engine's own step, `correct`.
    """

    def __init__(self, model: mujoco.MjModel, trees: list[PassiveTree]) -> None:
        self.model, self.trees = model, trees
        self._data = mujoco.MjData(model)
        self._state = np.empty(mujoco.mj_stateSize(model, _STATE))
        self._moving: list[PassiveTree] = []

    @classmethod
    def of(cls, model: mujoco.MjModel) -> FreeMotionIntegrator | None:
        """Return the integrator of a model; None if no tree needs it."""
        driven, lengths = _driven_trees(model), _chain_lengths(model)
        found = []
        for number in range(model.ntree):
            is_chain = lengths.get(number, 0) >= MIN_CHAIN_LENGTH
            if number not in driven and (is_chain or _may_spin(model, number)):
                found.append(PassiveTree(model, number, is_chain))
        return cls(model, found) if found else None

    def prepare(self, data: mujoco.MjData) -> None:
        """Integrate over the coming step, from data that are not stepped yet."""
        model, own, option = self.model, self._data, self.model.opt
        step, velocity = float(option.timestep), data.qvel
        fastest, self._moving = 0.0, []
        for tree in self.trees:
            turn = float(np.abs(velocity[tree.turning]).max()) * step
            if math.isfinite(turn) and (tree.is_chain or turn > MIN_TURN) and data.tree_asleep[tree.number] < 0:
                self._moving.append(tree)
                fastest = max(fastest, turn)
        if not self._moving:
            return
        mujoco.mj_getState(model, data, self._state, _STATE)
        mujoco.mj_setState(model, own, self._state, _STATE)
        count = min(MAX_SUBSTEPS, max(1, math.ceil(fastest / MAX_SUBSTEP_TURN)))
        integrator, disabled, enabled = option.integrator, option.disableflags, option.enableflags
        option.timestep, option.integrator = step / count, _RUNGE_KUTTA
        option.disableflags, option.enableflags = disabled | _NO_CONSTRAINTS, enabled & ~_SLEEP
        try:
            mujoco.mj_step(model, own, count)
        finally:
            option.timestep, option.integrator = step, integrator
            option.disableflags, option.enableflags = disabled, enabled

    def correct(self, data: mujoco.MjData) -> None:
        """Write the integrated states to the stepped data, for all trees without constraint forces."""
        own, forces = self._data, data.qfrc_constraint
        for tree in self._moving:
            dofs, at = tree.dofs, tree.coordinates
            if forces[dofs].any() or not (np.isfinite(own.qvel[dofs]).all() and np.isfinite(own.qpos[at]).all()):
                continue
            data.qvel[dofs] = own.qvel[dofs]
            data.qpos[at] = own.qpos[at]


def _index_range(starts: npt.NDArray[np.int32], counts: npt.NDArray[np.int32], index: int) -> slice:
    return slice(int(starts[index]), int(starts[index]) + int(counts[index]))


def _resisting_dofs(model: mujoco.MjModel) -> npt.NDArray[np.bool_]:
    """Return a mask of the degrees of freedom that have damping, friction or armature."""
    found: npt.NDArray[np.bool_] = (model.dof_damping != 0) | (model.dof_frictionloss != 0) | (model.dof_armature != 0)
    return found


def _chain_lengths(model: mujoco.MjModel) -> dict[int, int]:
    """Return the largest number of successive bodies on passive joints alone, by tree."""
    resisting = _resisting_dofs(model)
    longest: dict[int, int] = {}
    length = np.zeros(model.nbody, int)
    for body in range(1, model.nbody):
        length[body] = length[model.body_parentid[body]]
        dofs = _index_range(model.body_dofadr, model.body_dofnum, body)
        tree = int(model.body_treeid[body])
        if dofs.start < 0 or dofs.start == dofs.stop or tree < 0:
            continue
        length[body] = 0 if resisting[dofs].any() else length[body] + 1
        longest[tree] = max(longest.get(tree, 0), int(length[body]))
    return longest


def _may_spin(model: mujoco.MjModel, tree: int) -> bool:
    """Check whether a tree is passive and has a ball joint, or moves freely without collisions."""
    dofs = _index_range(model.tree_dofadr, model.tree_dofnum, tree)
    kinds = set(model.jnt_type[model.dof_jntid[dofs]].tolist())
    if _resisting_dofs(model)[dofs].any():
        return False
    if _BALL in kinds:
        return True
    own = model.body_treeid[model.geom_bodyid] == tree
    return _FREE in kinds and not (model.geom_contype[own] | model.geom_conaffinity[own]).any()


def _driven_trees(model: mujoco.MjModel) -> set[int]:
    """Return the trees with an actuated joint; an actuator of any other kind counts as driving all trees."""
    driven: set[int] = set()
    joints = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
    for kind, target in zip(model.actuator_trntype.tolist(), model.actuator_trnid[:, 0].tolist(), strict=True):
        if kind in joints:
            driven.add(int(model.body_treeid[model.jnt_bodyid[target]]))
        else:
            driven.update(range(model.ntree))
    return driven
