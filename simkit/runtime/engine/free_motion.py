"""Accurate integration of mechanisms without damping and of bodies that tumble.

MuJoCo's implicit integrators are of first order. With them, a double pendulum changes its energy by 3 % at a step of
1 ms. A falling chain of 50 links gains energy until it diverges, and a top with 400 rad/s on a ball joint falls over.
An arm with servos or damping is not affected. The kinematic trees without damping are integrated by the Runge-Kutta
method of fourth order, in substeps that follow the fastest joint. This needs a second `MjData` if there are other
trees. Trees without constraint forces do not depend on each other, so all other trees keep their bits.

A contact or a joint limit needs the engine's integrator, so a tree with such a force is left to it in that step. One
case is an exception: a mechanism whose base rests on its contacts. A very large armature then holds the base, and only
the joints above it are integrated here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.state_transfer import JOINT_WIDTHS
from simkit.linear_algebra import squared_length

MIN_CHAIN_LENGTH: Final = 2
"""Least number of passive joints in a row that make a tree a chain."""

MAX_SHORT_CHAIN_LENGTH: Final = 7
"""Largest number of passive joints in a row without substeps: seven links keep their energy within 0.001 % at 4 ms."""

MIN_SQUARED_TURN_RATE: Final = 0.002
"""Least squared angular velocity times the step [rad²/s] at which this module integrates a body that is not in a chain.

The engine takes about 5 % of this value from the energy of a tumbling body in a second: 0.01 % at the limit, which is
1.4 rad/s at a step of 1 ms.
"""

MAX_SUBSTEP_TURN: Final = 0.05
"""Largest rotation of the fastest joint in a substep [rad]; 0.05 keeps the energy of 50 links within 0.03 %."""

MAX_SUBSTEP_DECAY: Final = 0.2
"""Largest fraction of a joint's velocity that damping may remove in a substep."""

MAX_SUBSTEPS: Final = 16

MAX_RESTING_SPEED: Final = 1e-3
"""Largest speed [m/s, rad/s] of a base that rests on its contacts."""

MIN_SPEED_ON_BASE: Final = 0.01
"""Least angular velocity [rad/s] of a mechanism on such a base; slower ones rest, such as a cupboard with a hinge."""

MAX_FLYING_MODELS: Final = 8
"""Largest number of models with collisions whose tumbling is integrated here.

With more, some fly nearly always in a heap, for a short time: 30 capsules that fall would take a tenth longer.
"""

_STATE: Final = int(mujoco.mjtState.mjSTATE_INTEGRATION)
_NO_CONSTRAINTS: Final = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
_SLEEP: Final = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
_RUNGE_KUTTA: Final = int(mujoco.mjtIntegrator.mjINT_RK4)
_ORDER: Final = 4
_HOLDING_ARMATURE: Final = 1e12  # [kg, kg m²] of the six degrees of freedom of a base that rests
_EQUAL: Final = 1e-6  # relative difference of moments of inertia that counts as none
_FREE, _BALL, _HINGE = (
    int(kind) for kind in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL, mujoco.mjtJoint.mjJNT_HINGE)
)

Integrator = Callable[[mujoco.MjModel, mujoco.MjData], None]
"""Function of MuJoCo that integrates over a step."""


class JointGroup(NamedTuple):
    """Successive joints of one kinematic tree.

    Attributes:
        dofs: their degrees of freedom.
        coordinates: their coordinates.
    """

    dofs: slice
    coordinates: slice


class PassiveTree:
    """Kinematic tree to integrate.

    Attributes:
        turning: indices of the degrees of freedom whose velocity is in rad/s.
        whole: all joints.
        base: degrees of freedom of a free joint that carries all other joints; None without such a joint.
        mechanism: all joints except that of the base.
        min_speed: angular velocity [rad/s] above which the tree is integrated here; -1 for always.
        is_short_chain: True for a chain that needs no substeps for its angular velocities.
        needs_accuracy: True for a long chain and for a ball joint, with which the engine's integrator may diverge.
        bodies: numbers of the bodies.
        may_touch: True for a tree that is integrated here only while it flies.
        substeps: least number of substeps, for its springs and its damping.
    """

    def __init__(self, model: mujoco.MjModel, number: int, length: int, may_touch: bool) -> None:
        """Create the tree `number`, in which `length` passive joints follow each other."""
        step = float(model.opt.timestep)
        self.number, self.may_touch = number, may_touch
        self.bodies = np.flatnonzero(model.body_treeid == number)
        dofs = _index_range(model.tree_dofadr, model.tree_dofnum, number)
        joints = model.dof_jntid[dofs]
        kinds = model.jnt_type[joints]
        is_hinged = not (kinds == _BALL).any() and not (kinds == _FREE).any()
        self.min_speed = -1.0 if length >= MIN_CHAIN_LENGTH else math.sqrt(MIN_SQUARED_TURN_RATE / step)
        self.is_short_chain = MIN_CHAIN_LENGTH <= length <= MAX_SHORT_CHAIN_LENGTH and is_hinged
        self.needs_accuracy = length > MAX_SHORT_CHAIN_LENGTH or bool((kinds == _BALL).any())
        self.turning = dofs.start + np.flatnonzero(_turning_dofs(model)[dofs])
        first, last = int(joints[0]), int(joints[-1])
        width, _ = JOINT_WIDTHS.get(int(kinds[-1]), (1, 1))
        start, end = int(model.jnt_qposadr[first]), int(model.jnt_qposadr[last]) + width
        self.whole = self.mechanism = JointGroup(dofs, slice(start, end))
        self.base: slice | None = None
        if kinds[0] == _FREE and first != last:
            inner = int(model.jnt_dofadr[first + 1])
            self.base = slice(dofs.start, inner)
            self.mechanism = JointGroup(slice(inner, dofs.stop), slice(int(model.jnt_qposadr[first + 1]), end))
        weights = model.dof_invweight0[dofs]
        frequency = math.sqrt(max(0.0, float((model.jnt_stiffness[joints] * weights).max())))
        decay = float((model.dof_damping[dofs] * weights).max())
        self.substeps = math.ceil(step * max(frequency / MAX_SUBSTEP_TURN, decay / MAX_SUBSTEP_DECAY))


class FreeMotionIntegrator:
    """Integrator for the trees of a compiled model that the engine's own integrator does not suit.

    Attributes:
        acts_always: True if every step needs `integrate`; otherwise only steps by the contact law need it, which all
            tumbling bodies have while they fly.
    """

    def __init__(self, model: mujoco.MjModel, trees: list[PassiveTree]) -> None:
        self.model, self.trees = model, trees
        self.acts_always = not all(tree.may_touch for tree in trees)
        self._data = mujoco.MjData(model)
        self._state = np.empty(mujoco.mj_stateSize(model, _STATE))
        self._turning = np.concatenate([tree.turning for tree in trees])
        self._first_turning = np.cumsum([0, *(len(tree.turning) for tree in trees[:-1])])
        self._dofs = np.concatenate([np.arange(tree.whole.dofs.start, tree.whole.dofs.stop) for tree in trees])
        self._first_dofs = np.cumsum([0, *(tree.whole.dofs.stop - tree.whole.dofs.start for tree in trees[:-1])])
        self._unloaded = [False] * len(trees)
        self._min_speed = min(tree.min_speed for tree in trees)
        self._can_sleep = bool(model.opt.enableflags & _SLEEP)
        self._count, self._bases = 1, list[slice]()

    @classmethod
    def of(cls, model: mujoco.MjModel) -> FreeMotionIntegrator | None:
        """Return the integrator of a model; None if no tree needs it."""
        driven, lengths = _driven_trees(model), _chain_lengths(model)
        turning, collides = _turning_dofs(model), (model.geom_contype | model.geom_conaffinity) != 0
        found = []
        for number in range(model.ntree):
            length = lengths.get(number, 0)
            is_chain = length >= MIN_CHAIN_LENGTH
            turns = turning[_index_range(model.tree_dofadr, model.tree_dofnum, number)].any()
            if number not in driven and turns and (is_chain or _may_spin(model, number)):
                own = collides[model.body_treeid[model.geom_bodyid] == number]
                tree = PassiveTree(model, number, length, not is_chain and bool(own.any()) and collides.sum() > 1)
                if tree.substeps <= MAX_SUBSTEPS:
                    found.append(tree)
        if len([tree for tree in found if tree.may_touch]) > MAX_FLYING_MODELS:
            found = [tree for tree in found if not tree.may_touch]
        return cls(model, found) if found else None

    def is_needed(self, data: mujoco.MjData) -> bool:
        """Check whether a tree is so fast that it needs this integrator."""
        least = self._min_speed
        if least < 0.0:
            return True
        velocities = data.qvel.take(self._turning)
        if squared_length(velocities, least * least) <= least * least:  # usual: no joint can be faster
            return False
        return bool(np.abs(velocities).max() > least)

    def is_alone(self) -> bool:
        """Check whether every step integrates all trees of the model here in one substep, as nothing else can act."""
        model, trees = self.model, self.trees
        has_constraints = model.neq or model.ntendon or model.jnt_limited.any()
        are_simple = all(tree.is_short_chain and tree.substeps <= 1 for tree in trees)
        return len(trees) == model.ntree and are_simple and not has_constraints

    def advance(self, data: mujoco.MjData, count: int) -> bool:
        """Make steps in a model for which `is_alone` is True, with the bits of `integrate` and in less time.

        Returns:
            True if the steps were made; False if forces are applied, which `integrate` considers.
        """
        if data.qfrc_applied.any() or data.xfrc_applied.any():
            return False
        self._count, self._bases = 1, []
        self._runge_kutta(data, count)
        return True

    def integrate(self, model: mujoco.MjModel, data: mujoco.MjData, integrate: Integrator) -> None:
        """Integrate over a step, from data with a complete forward pass.

        Args:
            model: the model.
            data: its data.
            integrate: integrator of the engine, for all other trees.
        """
        moving = self._find_moving(data)
        if not moving:
            integrate(model, data)
        elif len(moving) == model.ntree and not self._bases:
            end = data.time + model.opt.timestep
            self._runge_kutta(data, 1, is_fresh=True)
            data.time = end
        else:
            own = self._data
            mujoco.mj_getState(model, data, self._state, _STATE)
            mujoco.mj_setState(model, own, self._state, _STATE)
            self._runge_kutta(own, 1)
            integrate(model, data)
            for dofs, at in moving:
                velocities, positions = own.qvel[dofs], own.qpos[at]
                if np.isfinite(velocities).all() and np.isfinite(positions).all():
                    data.qvel[dofs], data.qpos[at] = velocities, positions

    def _find_moving(self, data: mujoco.MjData) -> list[JointGroup]:
        """Return the joints to integrate in this step; set the number of substeps and the bases to hold."""
        if not self.is_needed(data):
            return []
        step = float(self.model.opt.timestep)
        speeds = np.maximum.reduceat(np.abs(data.qvel.take(self._turning)), self._first_turning).tolist()
        forces, loaded = data.qfrc_constraint, self._unloaded
        if data.nefc:
            loaded = np.logical_or.reduceat(forces.take(self._dofs) != 0.0, self._first_dofs).tolist()
        asleep = data.tree_asleep.tolist() if self._can_sleep else None
        is_pushed = data.qfrc_applied.any() or data.xfrc_applied.any()
        moving, count, self._bases = [], 1, []
        for tree, speed, is_loaded in zip(self.trees, speeds, loaded, strict=True):
            if not tree.min_speed < speed < math.inf or (asleep is not None and asleep[tree.number] >= 0):
                continue
            if is_pushed and not tree.needs_accuracy and self._is_pushed(data, tree):
                continue
            if not is_loaded:
                moving.append(tree.whole)
            elif tree.base is not None and speed > MIN_SPEED_ON_BASE and not forces[tree.mechanism.dofs].any():
                if np.abs(data.qvel[tree.base]).max() > MAX_RESTING_SPEED:
                    continue
                moving.append(tree.mechanism)
                self._bases.append(tree.base)
            else:
                continue
            turn = 0.0 if tree.is_short_chain else speed * step
            count = max(count, tree.substeps, math.ceil(turn / MAX_SUBSTEP_TURN))
        self._count = min(MAX_SUBSTEPS, count)
        return moving

    @staticmethod
    def _is_pushed(data: mujoco.MjData, tree: PassiveTree) -> bool:
        """Check whether a force is applied to a tree.

        Such forces are constant during a step. Springs and drives that plugins compute in this way, such as buoyancy,
        keep their energy with the engine's integrator only.
        """
        return bool(data.qfrc_applied[tree.whole.dofs].any() or data.xfrc_applied[tree.bodies].any())

    def _runge_kutta(self, data: mujoco.MjData, steps: int, *, is_fresh: bool = False) -> None:
        """Advance data by steps without constraints, in substeps.

        Args:
            data: data of the model.
            steps: number of steps.
            is_fresh: True for data with a forward pass.
        """
        model, option, count = self.model, self.model.opt, self._count
        step, integrator = option.timestep, option.integrator
        disabled, enabled = option.disableflags, option.enableflags
        armatures = [model.dof_armature[base].copy() for base in self._bases]
        option.timestep, option.integrator = step / count, _RUNGE_KUTTA
        option.disableflags, option.enableflags = disabled | _NO_CONSTRAINTS, enabled & ~_SLEEP
        try:
            for base in self._bases:
                model.dof_armature[base] = _HOLDING_ARMATURE
            if is_fresh:
                mujoco.mj_RungeKutta(model, data, _ORDER)
            if count * steps > is_fresh:
                mujoco.mj_step(model, data, count * steps - is_fresh)
        finally:
            for base, armature in zip(self._bases, armatures, strict=True):
                model.dof_armature[base] = armature
            option.timestep, option.integrator = step, integrator
            option.disableflags, option.enableflags = disabled, enabled


def _index_range(starts: npt.NDArray[np.int32], counts: npt.NDArray[np.int32], index: int) -> slice:
    return slice(int(starts[index]), int(starts[index]) + int(counts[index]))


def _turning_dofs(model: mujoco.MjModel) -> npt.NDArray[np.bool_]:
    """Return a mask of the degrees of freedom whose velocity is in rad/s."""
    kinds = model.jnt_type[model.dof_jntid]
    offset = np.arange(model.nv) - model.jnt_dofadr[model.dof_jntid]
    found: npt.NDArray[np.bool_] = (kinds == _BALL) | (kinds == _HINGE) | ((kinds == _FREE) & (offset >= 3))
    return found


def joint_friction(model: mujoco.MjModel) -> npt.NDArray[np.float64]:
    """Return the dry friction of the degrees of freedom, without that of free joints, which changes in heaps."""
    is_free = model.jnt_type[model.dof_jntid] == _FREE
    found: npt.NDArray[np.float64] = np.where(is_free, 0.0, model.dof_frictionloss)
    return found


def _resisting_dofs(model: mujoco.MjModel) -> npt.NDArray[np.bool_]:
    """Return a mask of the degrees of freedom that have damping or friction."""
    found: npt.NDArray[np.bool_] = (model.dof_damping != 0) | (joint_friction(model) != 0)
    found |= (model.dof_dampingpoly != 0).any(axis=1)
    return found


def _chain_lengths(model: mujoco.MjModel) -> dict[int, int]:
    """Return the largest number of successive passive joints, by tree."""
    resisting = _resisting_dofs(model)
    longest: dict[int, int] = {}
    length = np.zeros(model.nbody, int)
    for body in range(1, model.nbody):
        length[body] = length[model.body_parentid[body]]
        dofs = _index_range(model.body_dofadr, model.body_dofnum, body)
        tree = int(model.body_treeid[body])
        if dofs.start < 0 or dofs.start == dofs.stop or tree < 0:
            continue
        length[body] = 0 if resisting[dofs].any() else length[body] + model.body_jntnum[body]
        longest[tree] = max(longest.get(tree, 0), int(length[body]))
    return longest


def _may_spin(model: mujoco.MjModel, tree: int) -> bool:
    """Check whether a tree is passive and has a ball joint, or moves freely and does not spin steadily.

    A body with three equal moments of inertia about its origin spins steadily, and the engine integrates it exactly.
    """
    dofs = _index_range(model.tree_dofadr, model.tree_dofnum, tree)
    joints = model.dof_jntid[dofs]
    kinds = model.jnt_type[joints]
    if _resisting_dofs(model)[dofs].any():
        return False
    if (kinds == _BALL).any():
        return True
    body = int(model.jnt_bodyid[joints[0]])
    inertia = model.body_inertia[body]
    is_alone = np.count_nonzero(model.body_treeid == tree) == 1 and not model.body_ipos[body].any()
    return bool((kinds == _FREE).any()) and not (is_alone and np.ptp(inertia) <= _EQUAL * inertia.max())


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
