"""Rolling resistance of slow bodies in heaps, so that heaps of balls, capsules and cylinders come to rest.

Nothing stops a ball that rolls on a flat floor, unless the file gives rolling friction. In a heap, balls then roll over
and between each other for many seconds, and some of them never stop. Real bodies have a rolling resistance of 0.1 to
1 % of their radius. This module gives it to round bodies under conditions that a single rolling body never meets:

- The body touches something, and is next to at least two free bodies that touch each other or a third one.
- The body and all free bodies next to it are slow: rolling at this speed, they could climb `SLOW` of their radius.
- No body of its group of touching bodies is driven or measured, and no force is applied to the body.

Two bodies are next to each other if the gap between their bounding spheres is at most the sum of the radii. A surface
of a body with rolling friction from the file keeps this friction alone.

The resistance is dry friction of the rotation of the body, a constraint of the engine: a torque of at most `RESISTANCE`
times weight times radius about each axis. It holds a body at rest on a slope of less than 0.4°, and none on 1°.
"""

from __future__ import annotations

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
NEXT, NEAR = 2.0, 4.0
_LEAST_NEIGHBOURS: Final = 2
_LEAST_BODIES: Final = 3
_SOLIMP: Final = (0.95, 0.95, 0.0005, 0.5, 2.0)  # stiffer friction takes twice the time; this one creeps by 20 µm/s
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
        first = model.tree_dofadr.astype(int)
        is_free = (model.tree_dofnum == 6) & (model.tree_bodynum == 1)
        is_free &= model.jnt_type[model.dof_jntid[first]] == mujoco.mjtJoint.mjJNT_FREE
        is_free &= model.dof_frictionloss[first] == 0.0  # an MJCF file gives all axes the same friction
        model.dof_frictionloss[first[is_free][:, None] + np.arange(3, 6)] = 0.0
        self._trees = (is_free & may_sleep).nonzero()[0]
        self.acts = self._is_allowed and len(self._trees) >= _LEAST_BODIES
        if not self.acts:
            self._trees = self._trees[:0]
        self._turns = first[self._trees][:, None] + np.arange(3, 6)
        model.dof_solref[self._turns] = contact_time_constant(float(model.opt.timestep)), 1.0
        model.dof_solimp[self._turns] = _SOLIMP

    # ------------------------------------------------------------------ state

    @property
    def torques(self) -> Floats:
        """Largest torques of the resistance of the free bodies about each axis [N·m], shape (k,)."""
        found: Floats = self._model.dof_frictionloss[self._turns[:, 0]]
        return found

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
        is_paired |= sleeps & (data.tree_asleep[trees] != trees)  # the trees of an island sleep in a cycle
        rows = (touches & ~sleeps).nonzero()[0]
        if np.count_nonzero(is_paired) < _LEAST_NEIGHBOURS or not rows.size:
            return in_heap, torques
        radii, reaches, can_roll = self._shapes()
        is_next, is_near = self._next_to(data, rows, reaches)
        found = (is_next.sum(axis=1) > _LEAST_NEIGHBOURS) & (is_near & is_paired).any(axis=1)
        in_heap[trees[rows[found]]] = True
        x, y, z = model.opt.gravity.tolist()
        gravity = (x * x + y * y + z * z) ** 0.5
        v = data.qvel[self._turns - 3]
        squares = v[:, 0] * v[:, 0] + v[:, 1] * v[:, 1] + v[:, 2] * v[:, 2]
        is_fast = _ROLLING_ENERGY * squares > SLOW * gravity * radii
        found &= can_roll[rows] & ~(is_next & is_fast).any(axis=1) & self._is_apart(data, trees[rows], pushed)
        rolling = rows[found]
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
        return order[np.append(model.body_treeid[model.geom_bodyid], -1)]

    def _shapes(self) -> tuple[Floats, Floats, Flags]:
        """Return the radius and the radius of the bounding sphere [m] of each free body, and whether it can roll."""
        model, count = self._model, len(self._trees)
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        geoms = (collides & (self._owners()[:-1] < count)).nonzero()[0]
        owners = self._owners()[geoms]
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
        return squares < NEXT * NEXT, squares < NEAR * NEAR

    def _is_apart(self, data: mujoco.MjData, trees: Ints, pushed: Ints) -> Flags:
        """Return which trees touch no tree outside of the free bodies, and have no force on them."""
        other = np.ones(self._model.ntree, bool)
        other[self._trees] = False
        islands = data.tree_island
        joined = np.isin(islands[trees], islands[other & (islands >= 0)])
        return ~joined & ~np.isin(trees, pushed)
