"""Rolling resistance of slow bodies in heaps, so that heaps of balls, capsules and cylinders come to rest.

Nothing stops a ball that rolls on a flat floor, unless the file gives rolling friction. In a heap, balls then roll over
and between each other for many seconds, and some of them never stop. Real bodies have a rolling resistance of 0.1 to
2 % of their radius. This module gives such a resistance to round bodies, under conditions that a body which rolls
alone or meets a single other body does not fulfil:

- The body is in a heap: it touches something, at least two free bodies are next to it, and near it two free bodies
  touch each other or one sleeps.
- The body and all free bodies next to it are slow: rolling at its speed, each could climb `SLOW` of its radius at most.
- The touching bodies around it may all sleep, that is, none is driven or measured, and no force is applied to it.
- The file gives the body no rolling friction of its own.

The resistance is dry friction of the body's rotation, a constraint of the engine. Its torque about each axis is at most
`RESISTANCE` times weight times radius. It holds a ball on a slope of 0.4°; on a slope of 0.8° or more a ball rolls.
The conditions are checked at the rate of `Sleep`, and depend only on the state and on the torques of the last check.
"""

from __future__ import annotations

import math
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.engine_options import contact_time_constant, has_engine_contacts

RESISTANCE: Final = 0.008
"""Coefficient of the rolling resistance about one axis, in units of the radius."""

SLOW: Final = 0.03
"""Height, in units of the radius, that a slow body could climb by its kinetic energy."""

_ROLLING_ENERGY: Final = 0.7  # kinetic energy of a rolling ball, in units of mass times squared speed
_NEXT, _NEAR = 2.0, 4.0  # largest distance of such centres, in units of the sum of the radii of their bounding spheres
_LEAST_NEIGHBOURS: Final = 2  # bodies next to a body of a heap; together they are a heap of `_LEAST_BODIES`
_LEAST_BODIES: Final = _LEAST_NEIGHBOURS + 1
_SOLIMP: Final = (0.97, 0.97, 0.0005, 0.5, 2.0)  # stiffer friction takes twice the time; this one creeps by 12 µm/s
_WITHOUT_ROLLING: Final = (3, 4)  # dimensions of contacts with friction, but without rolling friction
_BOX: Final = int(mujoco.mjtGeom.mjGEOM_BOX)

Floats = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]
Ints = npt.NDArray[np.int64]


class HeapResistance:
    """Rolling resistance of the free bodies of a model.

    Args:
        model: MuJoCo's model.

    Attributes:
        acts: True if the model has enough free bodies for a heap.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._is_allowed = not has_engine_contacts(model)
        self._trees: Ints = np.zeros(0, int)
        self._turns: Ints = np.zeros((0, 3), int)
        self.acts = False

    def restrict(self, may_sleep: Flags) -> None:
        """Set the trees that may sleep, shape (ntree,), and begin without resistance.

        Only the bodies of these trees can be in a heap.
        """
        model = self._model
        clear_resistance(model, model.dof_frictionloss)
        self._trees = (_free_trees(model) & may_sleep).nonzero()[0]
        self.acts = self._is_allowed and len(self._trees) >= _LEAST_BODIES
        if not self.acts:
            self._trees = self._trees[:0]
        self._turns = _turns(model, self._trees)
        model.dof_solref[self._turns] = contact_time_constant(float(model.opt.timestep)), 1.0
        model.dof_solimp[self._turns] = _SOLIMP

    # ------------------------------------------------------------------ state

    @property
    def torques(self) -> Floats:
        """Largest torques of the resistance of the free bodies about each axis [N·m], shape (k,)."""
        torques: Floats = self._model.dof_frictionloss[self._turns[:, 0]]
        return torques

    @torques.setter
    def torques(self, values: Floats) -> None:
        self._model.dof_frictionloss[self._turns] = values[:, None]

    # ------------------------------------------------------------------ heaps

    def find(self, data: mujoco.MjData, pushed: Ints) -> tuple[Flags, Floats]:
        """Find the bodies in heaps and their resistance.

        Args:
            data: MuJoCo's data with a fresh forward pass.
            pushed: trees that a force is applied to.

        Returns:
            True for each tree in a heap that is awake, shape (ntree,), and the torques, shape (k,). A body that sleeps
            keeps its torque.
        """
        model, trees = self._model, self._trees
        in_heap = np.zeros(model.ntree, bool)
        sleeps = data.tree_asleep[trees] >= 0
        torques = np.where(sleeps, self.torques, 0.0)
        touches, is_paired = self._contacts(data)
        is_paired |= sleeps  # what sleeps has no contacts in the data
        rows = (touches & ~sleeps).nonzero()[0]
        if not (is_paired.any() and rows.size):
            return in_heap, torques
        radii, reaches, can_roll = self._shapes()
        is_next, is_near = self._next_to(data, rows, reaches)
        is_enclosed = (is_next.sum(axis=1) > _LEAST_NEIGHBOURS) & (is_near & is_paired).any(axis=1)
        in_heap[trees[rows[is_enclosed]]] = True
        gravity = math.hypot(*model.opt.gravity.tolist())
        x, y, z = data.qvel[self._turns - 3].T
        is_fast = _ROLLING_ENERGY * (x * x + y * y + z * z) > SLOW * gravity * radii
        is_enclosed &= can_roll[rows] & ~(is_next & is_fast).any(axis=1) & self._is_apart(data, trees[rows], pushed)
        rolling = rows[is_enclosed]
        weights = gravity * model.body_mass[model.tree_bodyadr[trees[rolling]]]
        torques[rolling] = RESISTANCE * weights * radii[rolling]
        return in_heap, torques

    def _contacts(self, data: mujoco.MjData) -> tuple[Flags, Flags]:
        """Return the free bodies that touch something, and those that touch another free body, each of shape (k,)."""
        count, contact = len(self._trees), data.contact
        bodies = self._owners()[contact.geom[contact.dist <= 0.0]]  # speculative contacts are distant
        touches, is_paired = np.zeros(count + 1, bool), np.zeros(count + 1, bool)
        touches[bodies] = True
        is_paired[bodies[(bodies < count).all(axis=1)]] = True
        return touches[:-1], is_paired[:-1]

    def _owners(self) -> Ints:
        """Return the number of the free body of each geom; k for all other geoms and for contacts without a geom."""
        model, count = self._model, len(self._trees)
        order = np.full(model.ntree + 1, count)
        order[self._trees] = np.arange(count)
        owners: Ints = order[np.append(model.body_treeid[model.geom_bodyid], -1)]
        return owners

    def _shapes(self) -> tuple[Floats, Floats, Flags]:
        """Return the radius and the radius of the bounding sphere [m] of each free body, and whether it can roll."""
        model, count = self._model, len(self._trees)
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        owners = self._owners()[:-1]
        geoms = (collides & (owners < count)).nonzero()[0]
        owners = owners[geoms]
        arms = model.geom_pos[geoms] - model.body_ipos[model.geom_bodyid[geoms]]
        x, y, z = arms.T
        radii, reaches, can_roll = np.full(count, np.inf), np.zeros(count), np.ones(count, bool)
        np.minimum.at(radii, owners, model.geom_aabb[geoms, 3:].min(axis=1))
        np.maximum.at(reaches, owners, np.sqrt(x * x + y * y + z * z) + model.geom_rbound[geoms])
        rolls = (model.geom_type[geoms] != _BOX) & np.isin(model.geom_condim[geoms], _WITHOUT_ROLLING)
        np.logical_and.at(can_roll, owners, rolls)
        return radii, reaches, can_roll

    def _next_to(self, data: mujoco.MjData, rows: Ints, reaches: Floats) -> tuple[Flags, Flags]:
        """Return which free bodies are next to some of them (and to themselves) and which are near, shape (rows, k)."""
        centres = data.xipos[self._model.tree_bodyadr[self._trees]].T
        squares = np.zeros((len(rows), len(reaches)))
        for places in centres:
            apart = places[rows][:, None] - places
            squares += apart * apart
        together = reaches[rows][:, None] + reaches
        squares /= together * together
        return squares < _NEXT * _NEXT, squares < _NEAR * _NEAR

    def _is_apart(self, data: mujoco.MjData, trees: Ints, pushed: Ints) -> Flags:
        """Return which trees touch no tree outside of the free bodies, and have no force on them."""
        other = np.ones(self._model.ntree, bool)
        other[self._trees] = False
        islands = data.tree_island
        joined = np.isin(islands[trees], islands[other & (islands >= 0)])
        return ~joined & ~np.isin(trees, pushed)


def clear_resistance(model: mujoco.MjModel, friction: Floats) -> None:
    """Remove the resistance from the dry friction of a model, shape (nv,), so that it has its compiled values."""
    friction[_turns(model, _free_trees(model).nonzero()[0])] = 0.0


def _free_trees(model: mujoco.MjModel) -> Flags:
    """Return which trees are free bodies of one link, without friction from an MJCF file, shape (ntree,)."""
    first = model.tree_dofadr
    is_free: Flags = (model.tree_dofnum == 6) & (model.tree_bodynum == 1)
    is_free &= model.jnt_type[model.dof_jntid[first]] == mujoco.mjtJoint.mjJNT_FREE
    is_free &= model.dof_frictionloss[first] == 0.0  # a file gives all axes the same friction
    return is_free


def _turns(model: mujoco.MjModel, trees: Ints) -> Ints:
    """Return the degrees of freedom of the rotation of free bodies, shape (k, 3)."""
    dofs: Ints = model.tree_dofadr[trees].astype(int)[:, None] + np.arange(3, 6)
    return dofs
