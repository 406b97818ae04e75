"""Actuators and drives of joints: stable gains, armature, and the effective inertia of a joint."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.first_state import first_mass_matrix, first_state, inverse_inertia
from simkit.compiler.name_map import ActuatorRef
from simkit.diagnostics import Diagnostics, Where
from simkit.pose import Vector

FULL_EFFORT_ERROR_ROTARY: Final = 0.01
"""Position error [rad] at which a drive gives its full effort."""

FULL_EFFORT_ERROR_LINEAR: Final = 0.001
"""Position error [m] at which a drive on a slider gives its full effort."""

RISE_TIME: Final = 0.01
"""Least time [s] that a drive at its effort limit needs from rest to its velocity limit."""

DRIVE_ARMATURE_ROTARY: Final = 2e-3
"""Least armature of a drive on a hinge [kg·m²]."""

DRIVE_ARMATURE_LINEAR: Final = 2e-2
"""Least armature of a drive on a slider [kg]."""

DRIVE_ARMATURE_LINEAR_MAX: Final = 1.0
"""Largest armature of a drive on a slider [kg].

A slow slider with a large force, such as a lift, moves a heavy load anyway and needs no large armature.
"""

_POSES: Final = 16
_STRIDES: Final = np.sqrt(np.array((2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53), float))


def add_drive_armature(
    joint: mujoco.MjsJoint, max_effort: float, max_velocity: float, scoped: str, diagnostics: Diagnostics, where: Where
) -> None:
    """Set the armature of a joint's drive and report it.

    Args:
        joint: MuJoCo joint.
        max_effort: effort limit [N·m or N]; infinite without one.
        max_velocity: velocity limit [rad/s or m/s]; infinite without one.
        scoped: scoped name of the joint.
        diagnostics: collection for the report.
        where: file position of the joint.
    """
    is_slide = joint.type == mujoco.mjtJoint.mjJNT_SLIDE
    rotor = DRIVE_ARMATURE_LINEAR if is_slide else DRIVE_ARMATURE_ROTARY
    if math.isfinite(max_effort) and 0.0 < max_velocity < math.inf:
        rotor = max(rotor, RISE_TIME * max_effort / max_velocity)
    if is_slide:
        rotor = min(rotor, DRIVE_ARMATURE_LINEAR_MAX)
    if joint.armature < rotor:
        joint.armature = rotor
        text = f"joint {scoped} gets an armature of {rotor:.3g} {'kg' if is_slide else 'kg m²'}, the rotor of its drive"
        diagnostics.note("SK-PHYS-010", text, where)


def drive_gains(
    max_effort: Vector, is_slide: npt.NDArray[np.bool_], least: Vector, most: Vector, timestep: float
) -> tuple[Vector, Vector]:
    """Return (kp, kv) of position drives on joints with effective inertias from `least` to `most` [kg·m² or kg].

    Args:
        max_effort: effort limits [N·m or N]; infinite without one.
        is_slide: mask of the sliding joints.
        least: smallest inertias, including armature.
        most: largest inertias, including armature.
        timestep: length of a step [s].
    """
    stable_kv = least / timestep
    stable_kp = np.minimum(0.25 * least / timestep**2, stable_kv**2 / (4.0 * most))
    span = np.where(is_slide, FULL_EFFORT_ERROR_LINEAR, FULL_EFFORT_ERROR_ROTARY)
    kp = np.minimum(max_effort / span, stable_kp)
    return kp, np.minimum(2.0 * np.sqrt(kp * most), stable_kv)


def effective_inertias(model: mujoco.MjModel, joints: npt.ArrayLike) -> tuple[Vector, Vector]:
    """Return the smallest and largest effective inertia of one-axis joints, over poses in the joints' ranges.

    The inertia is smallest with all other joints free to move, 1 / (M⁻¹)_jj. It is largest with all other joints fixed,
    M_jj.
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
        if pose:  # the first pose is the pose in the file
            data.qpos[places] = low + share * (high - low)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_makeM(model, data)
        mujoco.mj_factorM(model, data)
        mujoco.mj_solveM(model, data, solved, units)
        least = np.minimum(least, 1.0 / np.einsum("ij,ij->i", solved, units))
        most = np.maximum(most, data.M[diagonal])
    return least, most


ARMATURE_ROTARY: Final = 2e-3
"""Least armature of a hinge with a servo [kg·m²]."""

ARMATURE_LINEAR: Final = 2e-2
"""Least armature of a slider with a servo [kg]."""

GAIN: Final = 1.5

_GRAVITY: Final = 9.81
_FREE: Final = int(mujoco.mjtJoint.mjJNT_FREE)
_SLIDE: Final = int(mujoco.mjtJoint.mjJNT_SLIDE)


@dataclass(frozen=True, slots=True)
class ServoTraits:
    """Constants for the integral action of a velocity servo (SI units of a hinge; N and m for a slider).

    Attributes:
        gain: kv [N·m·s/rad].
        max_effort: effort limit [N·m]; infinite without one.
        largest_load: largest constant load that is corrected, with the joint's own friction [N·m].
        damping: damping of the joint, a load that is known at any velocity [N·m·s/rad].
        friction: friction of the joint, a load that is known while the joint turns [N·m].
        response_time: time constant of the servo when it moves the whole robot [s].
    """

    gain: float
    max_effort: float
    largest_load: float
    damping: float
    friction: float
    response_time: float


def add_actuator(spec: mujoco.MjSpec, ref: ActuatorRef, joint_name: str) -> None:
    """Add an actuator; `tune_servos` sets its gains after the compile."""
    actuator = spec.add_actuator(name=ref.name)
    actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
    actuator.target = joint_name
    actuator.ctrllimited = mujoco.mjtLimited.mjLIMITED_FALSE
    actuator.gaintype = mujoco.mjtGain.mjGAIN_FIXED
    actuator.biastype = mujoco.mjtBias.mjBIAS_NONE if ref.kind == "motor" else mujoco.mjtBias.mjBIAS_AFFINE
    if ref.kind == "drive":
        actuator.dyntype = mujoco.mjtDyn.mjDYN_INTEGRATOR
    actuator.gainprm[0] = 1.0 if ref.kind in ("motor", "drive") else 0.0
    set_effort_limit(actuator, ref.max_effort)


def set_effort_limit(actuator: mujoco.MjsActuator, max_effort: float) -> None:
    """Set the effort limit of an actuator [N·m or N]; infinite for none."""
    limited = math.isfinite(max_effort)
    actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE if limited else mujoco.mjtLimited.mjLIMITED_FALSE
    most = max(max_effort, 1e-12) if limited else 0.0
    actuator.forcerange = (-most, most)


def add_armature(joint: mujoco.MjsJoint, scoped: str, diagnostics: Diagnostics, where: Where) -> None:
    """Set the armature that a driven joint's servo needs, and report it."""
    is_slide = joint.type == mujoco.mjtJoint.mjJNT_SLIDE
    least = ARMATURE_LINEAR if is_slide else ARMATURE_ROTARY
    if joint.armature < least:
        joint.armature = least
        unit = "kg" if is_slide else "kg m²"
        message = f"joint {scoped} gets an armature of {least:g} {unit}, because a plugin drives it"
        diagnostics.note("SK-PHYS-010", message, where)


def tune_servos(
    spec: mujoco.MjSpec, model: mujoco.MjModel, refs: Iterable[ActuatorRef], data: mujoco.MjData | None = None
) -> None:
    """Set the gains of all servos in the model and in the spec; `data` is the first state, if it exists already."""
    for i, gain, bias in tuned_gains(model, refs, data):
        actuator = spec.actuator(mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, i))
        model.actuator_gainprm[i, 0] = actuator.gainprm[0] = gain
        model.actuator_biasprm[i, :3] = bias
        for k, value in enumerate(bias):
            actuator.biasprm[k] = value


def tuned_gains(
    model: mujoco.MjModel, refs: Iterable[ActuatorRef], data: mujoco.MjData | None = None
) -> list[tuple[int, float, tuple[float, float, float]]]:
    """Return id, gain and bias (constant, position, velocity) of each servo among the actuators."""
    refs = [r for r in refs if r.kind in ("position", "velocity")]
    gains = []
    for ref, inertia in zip(refs, _servo_inertias(model, refs, data) if refs else (), strict=True):
        kp, kv = servo_gains(ref, inertia, float(model.opt.timestep))
        i = int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_ACTUATOR, ref.name))
        gains.append((i, kv, (0.0, 0.0, -kv)) if ref.kind == "velocity" else (i, kp, (0.0, -kp, -kv)))
    return gains


def servo_gains(ref: ActuatorRef, inertia: float, timestep: float) -> tuple[float, float]:
    """Return (kp, kv) of a servo: the requested gains, limited to stable ones.

    Args:
        ref: actuator of the servo.
        inertia: effective inertia of the joint [kg·m² or kg], including armature.
        timestep: length of a step [s].
    """
    most = GAIN * inertia / timestep
    kv = most if ref.kv is None else min(ref.kv, most)
    if ref.kind == "velocity":
        return 0.0, kv
    stiffest = kv * kv / (4.0 * inertia) if ref.kv is None else 0.25 * inertia / timestep**2
    return (stiffest if ref.kp is None else min(ref.kp, 0.25 * inertia / timestep**2)), kv


def servo_traits(
    model: mujoco.MjModel, refs: Sequence[ActuatorRef], compiled: Mapping[str, npt.NDArray[np.float64]] | None = None
) -> list[ServoTraits]:
    """Return the constants of the velocity servos of a model, computed in its first pose.

    A wheel on the ground moves the mass of the robot at the radius of the wheel. All servos of the robot share this
    mass. The largest load is twice the weight of the robot at that radius, because a tyre cannot transmit more. On a
    fixed base it is ten times the weight of the links that the joint moves. The friction of the joint adds to it.

    Args:
        model: MuJoCo's model.
        refs: actuators of the servos.
        compiled: compiled values of the model fields that were changed after the compile, by name.
    """
    if not refs:
        return []
    names = "actuator_gainprm", "actuator_forcerange", "actuator_forcelimited", "dof_damping", "dof_frictionloss"
    strengths, ranges, limited, damping, friction = ((compiled or {}).get(name, getattr(model, name)) for name in names)
    data = first_state(model)
    mujoco.mj_makeM(model, data)
    ids = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_ACTUATOR, ref.name) for ref in refs]
    joints = [int(model.actuator_trnid[i, 0]) for i in ids]
    trees = [int(model.dof_treeid[model.jnt_dofadr[joint]]) for joint in joints]
    traits = []
    for i, joint, tree in zip(ids, joints, trees, strict=True):
        dof, first = int(model.jnt_dofadr[joint]), int(model.tree_dofadr[tree])
        mass = float(model.body_subtreemass[model.dof_bodyid[first]])
        reach = 1.0 if model.jnt_type[joint] == _SLIDE else _joint_reach(model, data, joint)
        locked = float(data.M[model.M_rowadr[dof] + model.M_rownnz[dof] - 1])
        inertia = max(locked, mass * reach**2 / trees.count(tree))
        gain = float(strengths[i, 0])
        weights = 2.0 if model.jnt_type[model.dof_jntid[first]] == _FREE else 10.0
        most = float(ranges[i, 1]) if limited[i] else math.inf
        response = inertia / gain if gain > 0.0 else math.inf
        load = weights * mass * _GRAVITY * reach + float(friction[dof])
        traits.append(ServoTraits(gain, most, min(most, load), float(damping[dof]), float(friction[dof]), response))
    return traits


def _joint_reach(model: mujoco.MjModel, data: mujoco.MjData, joint: int) -> float:
    """Return the largest distance [m] of the moved links from the axis of a hinge: the radius of a wheel."""
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


def _servo_inertias(model: mujoco.MjModel, refs: list[ActuatorRef], data: mujoco.MjData | None = None) -> list[float]:
    """Return the inertia at each driven degree of freedom in the first state, with all others free: 1 / (M⁻¹)_jj."""
    data, inertias = first_mass_matrix(model, data), []
    for ref in refs:
        i = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_ACTUATOR, ref.name)
        dof = int(model.jnt_dofadr[model.actuator_trnid[i, 0]])
        inertias.append(1.0 / max(inverse_inertia(model, data, dof), 1e-300))
    return inertias
