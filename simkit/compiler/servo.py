"""Actuators that plugins ask for, with gains that cannot ring.

A force-limited velocity servo rings whenever kv·dt/(I + armature) > 2, implicit integration included: where the
force saturates it is applied explicitly. So kv stays below 1.5·(I + armature)/dt, with the inertia that the compiled
model has at that joint, and light joints get an armature.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import mujoco
import numpy as np

from simkit.compiler.names import ActuatorRef
from simkit.diagnostics import Diagnostics, Where

ARMATURE_ROTARY: Final = 2e-3
"""[kg·m²] at least, on a hinge that a servo drives."""

ARMATURE_LINEAR: Final = 2e-2
"""[kg] at least, on a slider that a servo drives."""

GAIN: Final = 1.5

_GRAVITY: Final = 9.81
_FREE: Final = int(mujoco.mjtJoint.mjJNT_FREE)
_SLIDE: Final = int(mujoco.mjtJoint.mjJNT_SLIDE)


@dataclass(frozen=True, slots=True)
class ServoTraits:
    """What the integral action of a velocity servo goes by (SI units of a hinge; N and m for a slider).

    Attributes:
        gain: kv [N·m·s/rad].
        max_effort: [N·m]; infinite where there is no limit.
        largest_load: greatest constant load that is worth a correction [N·m].
        response_time: time constant of the servo when it moves all of the robot [s].
    """

    gain: float
    max_effort: float
    largest_load: float
    response_time: float


def add_actuator(spec: mujoco.MjSpec, ref: ActuatorRef, joint_name: str) -> None:
    """Adds the actuator; its gains come from `tune` after the compile."""
    actuator = spec.add_actuator(name=ref.name)
    actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
    actuator.target = joint_name
    actuator.ctrllimited = mujoco.mjtLimited.mjLIMITED_FALSE
    actuator.gaintype = mujoco.mjtGain.mjGAIN_FIXED
    actuator.biastype = mujoco.mjtBias.mjBIAS_NONE if ref.kind == "motor" else mujoco.mjtBias.mjBIAS_AFFINE
    if ref.kind == "drive":
        actuator.dyntype = mujoco.mjtDyn.mjDYN_INTEGRATOR
    actuator.gainprm[0] = 1.0 if ref.kind in ("motor", "drive") else 0.0
    limited = math.isfinite(ref.max_effort)
    actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE if limited else mujoco.mjtLimited.mjLIMITED_FALSE
    if limited:
        most = max(ref.max_effort, 1e-12)
        actuator.forcerange = (-most, most)


def add_armature(joint: Any, scoped: str, diagnostics: Diagnostics, where: Where) -> None:
    """Gives a driven joint the armature that its servo needs, and reports it."""
    is_slide = joint.type == mujoco.mjtJoint.mjJNT_SLIDE
    least = ARMATURE_LINEAR if is_slide else ARMATURE_ROTARY
    if joint.armature < least:
        joint.armature = least
        unit = "kg" if is_slide else "kg m²"
        diagnostics.note(
            "SK-PHYS-010", f"joint {scoped} gets an armature of {least:g} {unit}, because a plugin drives it", where
        )


def tune(spec: mujoco.MjSpec, model: mujoco.MjModel, refs: Iterable[ActuatorRef]) -> None:
    """Sets the gains of all servos in the model and in the spec."""
    refs = [r for r in refs if r.kind in ("position", "velocity")]
    if not refs:
        return
    inertia = _felt_inertia(model, refs)
    step = float(model.opt.timestep)
    for ref, felt in zip(refs, inertia, strict=True):
        kp, kv = gains(ref, felt, step)
        i = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_ACTUATOR, ref.name)
        actuator = spec.actuator(ref.name)
        gain, bias = (kv, (0.0, 0.0, -kv)) if ref.kind == "velocity" else (kp, (0.0, -kp, -kv))
        model.actuator_gainprm[i, 0] = actuator.gainprm[0] = gain
        model.actuator_biasprm[i, :3] = bias
        for k, value in enumerate(bias):
            actuator.biasprm[k] = value


def gains(ref: ActuatorRef, inertia: float, timestep: float) -> tuple[float, float]:
    """(kp, kv) of a servo on a joint that feels `inertia` (armature included): as wanted, but never ringing."""
    most = GAIN * inertia / timestep
    kv = most if ref.kv is None else min(ref.kv, most)
    if ref.kind == "velocity":
        return 0.0, kv
    stiffest = kv * kv / (4.0 * inertia) if ref.kv is None else 0.25 * inertia / timestep**2
    return (stiffest if ref.kp is None else min(ref.kp, 0.25 * inertia / timestep**2)), kv


def servo_traits(
    model: mujoco.MjModel, refs: Sequence[ActuatorRef], compiled: Mapping[str, Any] | None = None
) -> list[ServoTraits]:
    """Return the traits of the velocity servos of a model, in its first pose.

    A wheel on the ground moves the robot's mass at its radius, shared with the other servos of the robot. The largest
    load is twice the robot's weight at that radius: no tyre transmits more. On a fixed base it is ten times the weight
    of what the joint moves.

    Args:
        model: of the engine.
        refs: the servos.
        compiled: as they were compiled, the fields of the model that were written to since, by name.
    """
    names = "actuator_gainprm", "actuator_forcerange", "actuator_forcelimited"
    strengths, ranges, limited = ((compiled or {}).get(name, getattr(model, name)) for name in names)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_makeM(model, data)
    ids = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_ACTUATOR, ref.name) for ref in refs]
    joints = [int(model.actuator_trnid[i, 0]) for i in ids]
    trees = [int(model.dof_treeid[model.jnt_dofadr[joint]]) for joint in joints]
    found = []
    for i, joint, tree in zip(ids, joints, trees, strict=True):
        dof, first = int(model.jnt_dofadr[joint]), int(model.tree_dofadr[tree])
        mass = float(model.body_subtreemass[model.dof_bodyid[first]])
        reach = 1.0 if model.jnt_type[joint] == _SLIDE else _reach(model, data, joint)
        locked = float(data.M[model.M_rowadr[dof] + model.M_rownnz[dof] - 1])
        inertia = max(locked, mass * reach**2 / trees.count(tree))
        gain = float(strengths[i, 0])
        weights = 2.0 if model.jnt_type[model.dof_jntid[first]] == _FREE else 10.0
        most = float(ranges[i, 1]) if limited[i] else math.inf
        response = inertia / gain if gain > 0.0 else math.inf
        found.append(ServoTraits(gain, most, min(most, weights * mass * _GRAVITY * reach), response))
    return found


def _reach(model: mujoco.MjModel, data: mujoco.MjData, joint: int) -> float:
    """Return how far what a hinge moves reaches from its axis [m]: the radius of a wheel."""
    first, axis = int(model.jnt_bodyid[joint]), data.xaxis[joint]
    moved = {first}
    for body in range(first + 1, model.nbody):
        if int(model.body_parentid[body]) in moved:
            moved.add(body)
    geoms = [g for g in range(model.ngeom) if int(model.geom_bodyid[g]) in moved]
    geoms = [g for g in geoms if model.geom_contype[g] or model.geom_conaffinity[g]] or geoms
    if not geoms:
        return 0.1
    arms = data.geom_xpos[geoms] - data.xanchor[joint]
    return float((np.linalg.norm(np.cross(arms, axis), axis=1) + model.geom_rbound[geoms]).max())


def _felt_inertia(model: mujoco.MjModel, refs: list[ActuatorRef]) -> list[float]:
    """Inertia at each driven degree of freedom, all else free to move: 1 / (M⁻¹)_jj at the start."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_makeM(model, data)
    mujoco.mj_factorM(model, data)
    felt = []
    unit, solved = np.zeros((1, model.nv)), np.zeros((1, model.nv))
    for ref in refs:
        i = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_ACTUATOR, ref.name)
        dof = int(model.jnt_dofadr[model.actuator_trnid[i, 0]])
        unit[:] = 0.0
        unit[0, dof] = 1.0
        mujoco.mj_solveM(model, data, solved, unit)
        felt.append(float(1.0 / solved[0, dof]))
    return felt
