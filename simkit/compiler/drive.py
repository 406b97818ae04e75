"""Geared drives of joints: how heavy their rotors are, and gains that are stiff at every pose and calm in saturation.

Gains are chosen once, from the smallest and the largest inertia that a joint feels over the poses of the model:

* kv·dt stays below the smallest inertia: a servo that saturates is explicit there, and rings beyond twice that;
* kp gives the whole effort at `WHOLE_EFFORT_ROTARY` (`_LINEAR`), or less where the damping would not do for the largest
  inertia (ζ = 1 there);
* a drive cannot reach its top speed within less than `RISE_TIME` at full effort, since its rotor turns with it: joints
  that are lighter get that rotor as armature.
"""

from __future__ import annotations

import math
from typing import Any, Final

import mujoco
import numpy as np

from simkit.diagnostics import Diagnostics, Where
from simkit.pose import Vector

WHOLE_EFFORT_ROTARY: Final = 0.01
"""[rad] off its reference a drive gives all that it may."""

WHOLE_EFFORT_LINEAR: Final = 0.001
"""[m] for a slider."""

RISE_TIME: Final = 0.01
"""[s] from standstill to the velocity limit at the effort limit, at least."""

ROTOR_ROTARY: Final = 2e-3
"""[kg·m²] at least."""

ROTOR_LINEAR: Final = 2e-2
"""[kg] at least."""

ROTOR_LINEAR_MOST: Final = 1.0
"""[kg]; a slow slider with much force (a lift) is heavy anyway."""

_POSES: Final = 16
_STRIDES: Final = np.sqrt(np.array((2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53), float))


def add_rotor(
    joint: Any, max_effort: float, max_velocity: float, scoped: str, diagnostics: Diagnostics, where: Where
) -> None:
    """Gives a joint the armature that its drive has, and reports it.

    Args:
        max_effort: [N·m or N]; infinite where there is no limit.
        max_velocity: [rad/s or m/s]; likewise.
    """
    is_slide = joint.type == mujoco.mjtJoint.mjJNT_SLIDE
    rotor = ROTOR_LINEAR if is_slide else ROTOR_ROTARY
    if math.isfinite(max_effort) and 0.0 < max_velocity < math.inf:
        rotor = max(rotor, RISE_TIME * max_effort / max_velocity)
    if is_slide:
        rotor = min(rotor, ROTOR_LINEAR_MOST)
    if joint.armature < rotor:
        joint.armature = rotor
        diagnostics.note(
            "SK-PHYS-010",
            f"joint {scoped} gets an armature of {rotor:.3g} {'kg' if is_slide else 'kg m²'}, the rotor of its drive",
            where,
        )


def drive_gains(
    max_effort: Vector, is_slide: Any, least: Vector, most: Vector, timestep: float
) -> tuple[Vector, Vector]:
    """(kp, kv) of position drives on joints that feel inertias from `least` to `most` [kg·m² or kg], armature included.

    Args:
        max_effort: [N·m or N]; infinite where there is no limit.
        is_slide: which of the joints slide.
        timestep: [s].
    """
    stable_kv = least / timestep
    stable_kp = np.minimum(0.25 * least / timestep**2, stable_kv**2 / (4.0 * most))
    span = np.where(is_slide, WHOLE_EFFORT_LINEAR, WHOLE_EFFORT_ROTARY)
    kp = np.minimum(max_effort / span, stable_kp)
    return kp, np.minimum(2.0 * np.sqrt(kp * most), stable_kv)


def felt_inertias(model: mujoco.MjModel, joints: Any) -> tuple[Vector, Vector]:
    """Smallest and largest inertia at each of some one-axis joints, over poses spread through the joints' ranges.

    The smallest is felt with all else free to move, 1 / (M⁻¹)_jj, the largest with all else held, M_jj.
    """
    joints = np.asarray(joints, np.intp)
    data = mujoco.MjData(model)
    dofs, places = model.jnt_dofadr[joints], model.jnt_qposadr[joints]
    is_open = ~model.jnt_limited[joints].astype(bool)
    turn = np.where(model.jnt_type[joints] == mujoco.mjtJoint.mjJNT_HINGE, np.pi, 0.0)
    low = np.where(is_open, model.qpos0[places] - turn, model.jnt_range[joints, 0])
    high = np.where(is_open, model.qpos0[places] + turn, model.jnt_range[joints, 1])
    strides = np.resize(_STRIDES, len(joints)) % 1.0
    units, solved = np.zeros((len(joints), model.nv)), np.zeros((len(joints), model.nv))
    units[np.arange(len(joints)), dofs] = 1.0
    diagonal = model.M_rowadr[dofs] + model.M_rownnz[dofs] - 1
    least, most = np.full(len(joints), np.inf), np.zeros(len(joints))
    for pose in range(_POSES):
        share = (0.5 + pose * strides) % 1.0
        data.qpos[:] = model.qpos0
        if pose:  # the first is the file's own
            data.qpos[places] = low + share * (high - low)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_makeM(model, data)
        mujoco.mj_factorM(model, data)
        mujoco.mj_solveM(model, data, solved, units)
        least = np.minimum(least, 1.0 / np.einsum("ij,ij->i", solved, units))
        most = np.maximum(most, data.M[diagonal])
    return least, most
