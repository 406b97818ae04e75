"""Kinematic trees without actuators and damping that the engine's own integrator does not suit."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.state_transfer import JOINT_WIDTHS
from simkit.runtime.contact.rigid_rotation import RigidRotation

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

_BODY, _SITE = int(mujoco.mjtObj.mjOBJ_BODY), int(mujoco.mjtObj.mjOBJ_SITE)
_EQUAL: Final = 1e-6  # relative difference of moments of inertia that counts as none
_FREE, _BALL, _HINGE = (
    int(kind) for kind in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL, mujoco.mjtJoint.mjJNT_HINGE)
)


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
        rotation: motion without forces of a tree that is a single free body without loop joints; otherwise None.
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
        is_single = kinds[0] == _FREE and len(self.bodies) == 1 and not _is_joined(model, int(self.bodies[0]))
        self.rotation = RigidRotation(model, first) if is_single else None
        weights = model.dof_invweight0[dofs]
        frequency = math.sqrt(max(0.0, float((model.jnt_stiffness[joints] * weights).max())))
        decay = float((model.dof_damping[dofs] * weights).max())
        self.substeps = math.ceil(step * max(frequency / MAX_SUBSTEP_TURN, decay / MAX_SUBSTEP_DECAY))


def find_passive_trees(model: mujoco.MjModel) -> list[PassiveTree]:
    """Return the trees of a model that need another integrator."""
    driven, lengths = _driven_trees(model), _chain_lengths(model)
    turning, collides = _turning_dofs(model), (model.geom_contype | model.geom_conaffinity) != 0
    trees = []
    for number in range(model.ntree):
        length = lengths.get(number, 0)
        is_chain = length >= MIN_CHAIN_LENGTH
        turns = turning[_index_range(model.tree_dofadr, model.tree_dofnum, number)].any()
        if number not in driven and turns and (is_chain or _may_spin(model, number)):
            geoms_collide = collides[model.body_treeid[model.geom_bodyid] == number]
            trees.append(
                PassiveTree(model, number, length, not is_chain and bool(geoms_collide.any()) and collides.sum() > 1)
            )
    return trees


def _index_range(starts: npt.NDArray[np.int32], counts: npt.NDArray[np.int32], index: int) -> slice:
    return slice(int(starts[index]), int(starts[index]) + int(counts[index]))


def _turning_dofs(model: mujoco.MjModel) -> npt.NDArray[np.bool_]:
    """Return a mask of the degrees of freedom whose velocity is in rad/s."""
    kinds = model.jnt_type[model.dof_jntid]
    offset = np.arange(model.nv) - model.jnt_dofadr[model.dof_jntid]
    is_turning: npt.NDArray[np.bool_] = (kinds == _BALL) | (kinds == _HINGE) | ((kinds == _FREE) & (offset >= 3))
    return is_turning


def joint_friction(model: mujoco.MjModel) -> npt.NDArray[np.float64]:
    """Return the dry friction of the degrees of freedom, without that of free joints, which changes in heaps."""
    is_free = model.jnt_type[model.dof_jntid] == _FREE
    friction: npt.NDArray[np.float64] = np.where(is_free, 0.0, model.dof_frictionloss)
    return friction


def _resisting_dofs(model: mujoco.MjModel) -> npt.NDArray[np.bool_]:
    """Return a mask of the degrees of freedom that have damping or friction."""
    resists: npt.NDArray[np.bool_] = (model.dof_damping != 0) | (joint_friction(model) != 0)
    resists |= (model.dof_dampingpoly != 0).any(axis=1)
    return resists


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


def _is_joined(model: mujoco.MjModel, body: int) -> bool:
    """Check whether a loop joint of the model acts on a body."""
    for kind, *ends in zip(model.eq_objtype.tolist(), model.eq_obj1id.tolist(), model.eq_obj2id.tolist(), strict=True):
        if kind == _SITE:
            ends = [int(model.site_bodyid[end]) for end in ends]
        if kind in (_SITE, _BODY) and body in ends:
            return True
    return False


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
