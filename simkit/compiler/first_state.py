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

IDLE_ROTARY: Final = 1e-4
"""[kg·m²] that a hinge is given which moves nothing with mass: a finger's, so that 1 ms steps and contacts are calm."""

IDLE_LINEAR: Final = 1e-2
"""[kg] that a slider is given which moves nothing with mass."""


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


def steady_idle(
    spec: mujoco.MjSpec, model: mujoco.MjModel, records: Iterable[ModelRecord], diagnostics: Diagnostics
) -> None:
    """Gives each joint that moves nothing but links without mass an armature, in the model and in the spec.

    Such a joint is one below which nothing has mass, or one that feels nothing where all else stays: 1 / (M⁻¹)_jj ≈ 0.
    What it carries then moves without pushing back on the rest. A link that hangs on no joint is an error.
    """
    suspects = [(r, link, joint) for r in records for link, joint in r.massless.items()]
    if not suspects:
        return
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_makeM(model, data)
    mujoco.mj_factorM(model, data)
    steadied = False
    for record, link, joint in suspects:
        binding = record.links[link]
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, binding.body_name)
        first = int(model.body_dofadr[body])
        dofs = range(first, first + int(model.body_dofnum[body]))
        if link not in record.unladen and all(_felt(model, data, dof) >= _NOTHING for dof in dofs):
            continue
        if not joint:
            diagnostics.error(
                "SK-JOINT-010",
                f"link {link} moves freely and has no mass; what it carries turns by itself and does not weigh on it",
                binding.scene.where,
                "give the link an <inertial>, or fix it",
            )
            continue
        given = _give_armature(spec, model, body)
        steadied = steadied or bool(given)
        if given:
            scene = record.joints[joint].scene
            diagnostics.warning(
                "SK-JOINT-016",
                f"link {link} moves on joint {joint} ({scene.type}) and nothing that it carries weighs on that joint: "
                f"the joint gets an armature of {given}",
                scene.where if scene.where.line else binding.scene.where,
                "give the link an <inertial>, or fix it",
            )
    if steadied:
        mujoco.mj_setConst(model, data)


def _give_armature(spec: mujoco.MjSpec, model: mujoco.MjModel, body: int) -> str:
    """Sets the least armature on a body's joints that have less; says what they got, nothing where all had enough."""
    given = ""
    for joint in range(int(model.body_jntadr[body]), int(model.body_jntadr[body] + model.body_jntnum[body])):
        is_slide = int(model.jnt_type[joint]) == mujoco.mjtJoint.mjJNT_SLIDE
        least, unit = (IDLE_LINEAR, "kg") if is_slide else (IDLE_ROTARY, "kg m²")
        first = int(model.jnt_dofadr[joint])
        count = 3 if int(model.jnt_type[joint]) == mujoco.mjtJoint.mjJNT_BALL else 1
        if model.dof_armature[first] >= least:
            continue
        model.dof_armature[first : first + count] = least
        spec.joint(mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint)).armature = least
        given = f"{least:g} {unit}"
    return given


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
