"""Kinematic trees of the joints that are driven together, and bounds on their efforts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.plugins.joints.joint_axis import JointAxis
from simkit.pose import Vector

Integers = npt.NDArray[np.intp]
Flags = npt.NDArray[np.bool_]

Keys = tuple[tuple[str, int], ...]
"""Scoped name and axis of each of some joints."""

_HOLD: Final = 10.0
"""Weights of all that hangs together: what a joint without an effort limit gives against what holds it."""

_GRAVITY: Final = 9.81  # [m/s²]; of weights, also where the world has none


@dataclass(frozen=True, slots=True)
class KinematicTrees:
    """What stays the same of some joints as long as the engine's model does; sorted by their kinematic trees.

    Attributes:
        axes, order: of the joints, and their places among those that were given.
        keys: their names.
        dofs, joints, positions, bodies: their numbers among the engine's things, each (n,).
        tree, starts: of each joint, and where each tree begins (trees,).
        is_used: of the slots for the joints of each tree, those that there is a joint for (trees, slots).
        damped: which of the engine's degrees of freedom are damped (nv,).
        is_damped: whether one is that counts here.
        all: the joints' degrees of freedom, in those slots, then the damped ones of the same tree (trees, all slots).
        is_any: which slots of these are in use.
        place: where the joints are in that, flattened.
        units: unit efforts on all of them, a slot a row (all slots, nv).
        hold: what a joint without an effort limit may give beyond what moves it when nothing is touched.
    """

    axes: tuple[JointAxis, ...]
    order: Integers
    keys: Keys
    dofs: Integers
    joints: Integers
    positions: Integers
    bodies: tuple[int, ...]
    tree: Integers
    starts: Integers
    is_used: Flags
    damped: Flags
    is_damped: bool
    all: Integers
    is_any: Any
    place: Integers
    units: Vector
    hold: Vector

    @classmethod
    def of(cls, model: mujoco.MjModel, axes: Sequence[JointAxis]) -> KinematicTrees:
        last = {(axis.joint.scoped, axis.index): i for i, axis in enumerate(axes)}
        numbers = {tree: i for i, tree in enumerate(dict.fromkeys(int(model.dof_treeid[a.dof]) for a in axes))}
        tree_of = {key: numbers[int(model.dof_treeid[axes[i].dof])] for key, i in last.items()}
        keys = tuple(sorted(last, key=lambda key: (tree_of[key], last[key])))
        order = np.array([last[key] for key in keys])
        chosen = tuple(axes[i] for i in order.tolist())
        dofs, damped = np.array([axis.dof for axis in chosen]), model.dof_damping > 0.0
        own: list[list[int]] = [[] for _ in numbers]
        for key, dof in zip(keys, dofs.tolist(), strict=True):
            own[tree_of[key]].append(dof)
        others = [np.flatnonzero(damped & (model.dof_treeid == tree)).tolist() for tree in numbers]
        both = [[*mine, *(d for d in more if d not in mine)] for mine, more in zip(own, others, strict=True)]
        table, is_any = _padded(both)
        slots = np.nonzero(is_any)[1]
        units = np.zeros((table.shape[1], model.nv))
        units[slots, table[is_any]] = 1.0
        is_used = _padded(own)[1]
        tree, slot = np.nonzero(is_used)
        joints = model.dof_jntid[dofs]
        return cls(
            axes=chosen,
            order=order,
            keys=keys,
            dofs=dofs,
            joints=joints,
            positions=model.jnt_qposadr[joints],
            bodies=tuple(dict.fromkeys(model.dof_bodyid[dofs].tolist())),
            tree=tree,
            starts=np.searchsorted(tree, np.arange(len(numbers))),
            is_used=is_used,
            damped=damped,
            is_damped=any(others),
            all=table,
            is_any=is_any,
            place=tree * table.shape[1] + slot,
            units=units,
            hold=_HOLD * _weights(model, dofs.tolist()),
        )

    def fits(self, model: mujoco.MjModel) -> bool:
        """Whether the same degrees of freedom are damped as when it was made."""
        return np.array_equal(model.dof_damping > 0.0, self.damped)

    def spread(self, values: Vector) -> Vector:
        """Values of the joints in the slots of their trees (trees, slots), zero in the others."""
        found = np.zeros(self.is_used.shape)
        found[self.is_used] = values
        return found

    def times(self, matrices: Vector, values: Vector) -> Vector:
        """A matrix of each tree (trees, slots, slots) times the values of its joints (n,)."""
        found: Vector = (matrices @ self.spread(values)[..., None])[..., 0][self.is_used]
        return found

    def any_of_tree(self, flags: Flags) -> Flags:
        """Whether a flag of a tree's joints (n,) is set (trees,)."""
        found: Flags = np.logical_or.reduceat(flags, self.starts)
        return found

    def most_of_tree(self, values: Vector) -> Vector:
        """The largest of the values of each tree's joints (trees,)."""
        found: Vector = np.maximum.reduceat(values, self.starts)
        return found


def _padded(rows: list[list[int]]) -> tuple[Integers, Flags]:
    """Rows of different lengths as one table, and which of it is in use; the rest is 0."""
    width = max(map(len, rows))
    table = np.array([[*row, *[0] * (width - len(row))] for row in rows])
    return table, np.arange(width) < np.array([[len(row)] for row in rows])


def _weights(model: mujoco.MjModel, dofs: Sequence[int]) -> Vector:
    """Of all that hangs together with each joint: [N] of a slider; of a hinge [N·m] at the length of what it moves."""
    reach, found = _reaches(model), []
    for dof in dofs:
        joint, body = int(model.dof_jntid[dof]), int(model.dof_bodyid[dof])
        weight = float(model.body_subtreemass[model.body_rootid[body]]) * _GRAVITY
        is_slider = model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE
        found.append(weight * (1.0 if is_slider else reach[body] + float(np.linalg.norm(model.jnt_pos[joint]))))
    return np.array(found)


def _reaches(model: mujoco.MjModel) -> list[float]:
    """How far from the frame of each body anything of it, or of what hangs on it, can be [m]."""
    own = np.linalg.norm(model.body_ipos, axis=1)
    # of a body without shape nothing but its inertia says how large it is: by the radius of gyration
    gyration = np.sqrt(model.body_inertia.max(axis=1) / np.maximum(model.body_mass, mujoco.mjMINVAL))
    own += np.where(model.body_geomnum == 0, gyration, 0.0)
    np.maximum.at(own, model.geom_bodyid, np.linalg.norm(model.geom_pos, axis=1) + model.geom_rbound)
    reach, shifts, parents = own.tolist(), np.linalg.norm(model.body_pos, axis=1).tolist(), model.body_parentid.tolist()
    for body in range(model.nbody - 1, 0, -1):  # a body comes after its parent
        reach[parents[body]] = max(reach[parents[body]], shifts[body] + reach[body])
    return reach  # type: ignore[no-any-return]
