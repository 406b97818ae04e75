"""What is known only of the compiled model: decay of velocities, joints that move nothing, where followers begin."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import mujoco
import numpy as np

from simkit.compiler.names import JointBinding, ModelRecord
from simkit.diagnostics import Diagnostics

_NOTHING: Final = 1e-9
"""Inertia [kg·m² or kg] that a joint feels below which it moves nothing; ten times less is what a frame is given."""


def damp(model: mujoco.MjModel, records: Iterable[ModelRecord]) -> None:
    """Damping of free joints for `velocity_decay`: mass, or moment about each axis of the link, times the rate."""
    for record in records:
        for name, (linear, angular) in record.damped.items():
            joint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
            dof, body = int(model.jnt_dofadr[joint]), int(model.jnt_bodyid[joint])
            rotation = np.zeros(9)
            mujoco.mju_quat2Mat(rotation, model.body_iquat[body])
            turned = rotation.reshape(3, 3)
            moments = np.diag(turned @ np.diag(model.body_inertia[body]) @ turned.T)
            model.dof_damping[dof : dof + 3] = linear * model.body_mass[body]
            model.dof_damping[dof + 3 : dof + 6] = angular * moments


def report_idle(model: mujoco.MjModel, records: Iterable[ModelRecord], diagnostics: Diagnostics) -> None:
    """An error for each joint that moves nothing but a link without mass, where all else stays: 1 / (M⁻¹)_jj ≈ 0."""
    suspects = [(r, link, joint) for r in records for link, joint in r.massless.items()]
    if not suspects:
        return
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_makeM(model, data)
    mujoco.mj_factorM(model, data)
    for record, link, joint in suspects:
        binding = record.links[link]
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, binding.body_name)
        first = int(model.body_dofadr[body])
        dofs = range(first, first + int(model.body_dofnum[body]))
        if any(_felt(model, data, dof) < _NOTHING for dof in dofs):
            scene = record.joints[joint].scene if joint else None
            how = f"moves on joint {joint} ({scene.type})" if scene else "moves freely"
            diagnostics.error(
                "SK-JOINT-010",
                f"link {link} {how} and has no mass; what it carries turns by itself and does not weigh on it",
                scene.where if scene and scene.where.line else binding.scene.where,
                "give the link an <inertial>, or fix it",
            )


def _felt(model: mujoco.MjModel, data: mujoco.MjData, dof: int) -> float:
    unit, solved = np.zeros((1, model.nv)), np.zeros((1, model.nv))
    unit[0, dof] = 1.0
    mujoco.mj_solveM(model, data, solved, unit)
    inverse = float(solved[0, dof])
    return 1.0 / inverse if inverse > 0.0 else 0.0


def place_followers(data: mujoco.MjData, joints: Iterable[JointBinding]) -> None:
    """Puts what follows a joint with an offset where the law says at the start, so that nothing jerks."""
    for joint in joints:
        for follower in joint.followers:
            if follower.offset and follower.qpos >= 0:
                data.qpos[follower.qpos] = follower.offset
