"""Kinematic trees of the joints that are driven together, and limits of their efforts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul, norm
from simkit.plugins.joints.joint_axis import JointAxis
from simkit.pose import Vector

Integers = npt.NDArray[np.intp]
Flags = npt.NDArray[np.bool_]

Keys = tuple[tuple[str, int], ...]
"""Scoped name and axis index of each joint."""

_HOLD: Final = 10.0
"""Effort of a joint without an effort limit against an obstacle, as a multiple of the weight of its whole tree."""

_GRAVITY: Final = 9.81  # [m/s²]; also used in a world without gravity, because the limit must not be zero


@dataclass(frozen=True, slots=True)
class KinematicTrees:
    """Constant data of the driven joints for one compiled model, sorted by kinematic tree.

    There are n joints. Each tree has the same number of slots for its joints; unused slots are padding.

    Attributes:
        axes: Joint axes, sorted by tree.
        order: Index of each axis in the sequence from which this object was made (n,).
        keys: Scoped name and axis index of each joint.
        dofs, joints, positions: MuJoCo's indices of the degrees of freedom, joints and qpos entries, each (n,).
        bodies: MuJoCo's indices of the moved bodies.
        tree: Index of each joint's tree (n,).
        starts: Index of the first joint of each tree (trees,).
        is_used: True for slots that have a driven joint (trees, slots).
        damped: True for damped degrees of freedom of the compiled model (nv,).
        is_damped: True if a tree of the driven joints has a damped degree of freedom.
        all: Degrees of freedom of the slots, then the other damped degrees of freedom of the same tree (trees, all
            slots).
        is_any: True for slots of `all` that are in use (trees, all slots).
        place: Index of each joint's degree of freedom in the flattened `all` (n,).
        units: Unit efforts on all degrees of freedom, one row per slot (all slots, nv).
        hold: Additional effort of a joint without a limit, beyond the effort that moves it without contacts.
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
    is_any: Flags
    place: Integers
    units: Vector
    hold: Vector

    @classmethod
    def of(cls, model: mujoco.MjModel, axes: Sequence[JointAxis]) -> KinematicTrees:
        """Sort joint axes by kinematic tree.

        Args:
            model: Compiled model.
            axes: Driven axes; if an axis occurs twice, the last one counts.
        """
        last = {(axis.joint.scoped, axis.index): i for i, axis in enumerate(axes)}
        numbers = {tree: i for i, tree in enumerate(dict.fromkeys(int(model.dof_treeid[a.dof]) for a in axes))}
        tree_of = {key: numbers[int(model.dof_treeid[axes[i].dof])] for key, i in last.items()}
        keys = tuple(sorted(last, key=lambda key: (tree_of[key], last[key])))
        order = np.array([last[key] for key in keys])
        chosen = tuple(axes[i] for i in order.tolist())
        dofs, damped = np.array([axis.dof for axis in chosen]), model.dof_damping > 0.0
        driven_dofs: list[list[int]] = [[] for _ in numbers]
        for key, dof in zip(keys, dofs.tolist(), strict=True):
            driven_dofs[tree_of[key]].append(dof)
        others = [np.flatnonzero(damped & (model.dof_treeid == tree)).tolist() for tree in numbers]
        both = [[*mine, *(d for d in more if d not in mine)] for mine, more in zip(driven_dofs, others, strict=True)]
        table, is_any = _padded(both)
        slots = np.nonzero(is_any)[1]
        units = np.zeros((table.shape[1], model.nv))
        units[slots, table[is_any]] = 1.0
        is_used = _padded(driven_dofs)[1]
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
        """Check whether the model still has the same damped degrees of freedom as when this object was made."""
        return np.array_equal(model.dof_damping > 0.0, self.damped)

    def spread(self, values: Vector) -> Vector:
        """Return joint values in the slots of their trees (trees, slots), with zeros in the unused slots."""
        table = np.zeros(self.is_used.shape)
        table[self.is_used] = values
        return table

    def times(self, matrices: Vector, values: Vector) -> Vector:
        """Multiply a matrix of each tree (trees, slots, slots) by the values of its joints (n,)."""
        products: Vector = matmul(matrices, self.spread(values)[..., None])[..., 0][self.is_used]
        return products

    def any_of_tree(self, flags: Flags) -> Flags:
        """Check for each tree whether a flag of its joints (n,) is set; the result has shape (trees,)."""
        is_set: Flags = np.logical_or.reduceat(flags, self.starts)
        return is_set

    def most_of_tree(self, values: Vector) -> Vector:
        """Return the largest value of each tree's joints (trees,)."""
        largest: Vector = np.maximum.reduceat(values, self.starts)
        return largest


def _padded(rows: list[list[int]]) -> tuple[Integers, Flags]:
    """Return rows of different lengths as one zero-padded table, and the mask of its used entries."""
    width = max(map(len, rows))
    table = np.array([[*row, *[0] * (width - len(row))] for row in rows])
    return table, np.arange(width) < np.array([[len(row)] for row in rows])


def _weights(model: mujoco.MjModel, dofs: Sequence[int]) -> Vector:
    """Return the weight of each joint's tree: [N] for a slider; for a hinge, times the links' reach [N·m]."""
    reach, weights = _reaches(model), []
    for dof in dofs:
        joint, body = int(model.dof_jntid[dof]), int(model.dof_bodyid[dof])
        weight = float(model.body_subtreemass[model.body_rootid[body]]) * _GRAVITY
        is_slider = model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE
        weights.append(weight * (1.0 if is_slider else reach[body] + norm(model.jnt_pos[joint])))
    return np.array(weights)


def _reaches(model: mujoco.MjModel) -> list[float]:
    """Return the largest distance from the frame of each body to any point of the body or its descendants [m]."""
    body_reaches = np.linalg.norm(model.body_ipos, axis=1)
    # a body without geoms has no shape, so the radius of gyration of its inertia is its size
    gyration = np.sqrt(model.body_inertia.max(axis=1) / np.maximum(model.body_mass, mujoco.mjMINVAL))
    body_reaches += np.where(model.body_geomnum == 0, gyration, 0.0)
    np.maximum.at(body_reaches, model.geom_bodyid, np.linalg.norm(model.geom_pos, axis=1) + model.geom_rbound)
    reach, shifts, parents = (
        body_reaches.tolist(),
        np.linalg.norm(model.body_pos, axis=1).tolist(),
        model.body_parentid.tolist(),
    )
    for body in range(model.nbody - 1, 0, -1):  # MuJoCo sorts each body after its parent
        reach[parents[body]] = max(reach[parents[body]], shifts[body] + reach[body])
    return reach  # type: ignore[no-any-return]
