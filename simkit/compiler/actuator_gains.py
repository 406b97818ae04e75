"""Gains of MuJoCo's own actuators that diverge at the step with the inertia of their joint."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import mujoco

from simkit.compiler.first_state import first_mass_matrix, inverse_inertia

_EXPLICIT: Final = (int(mujoco.mjtIntegrator.mjINT_EULER),)
_IMPLICIT: Final = (int(mujoco.mjtIntegrator.mjINT_IMPLICIT), int(mujoco.mjtIntegrator.mjINT_IMPLICITFAST))
_SINGLE: Final = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


@dataclass(frozen=True, slots=True)
class UnstableGain:
    """Gain of an actuator above the limit of its integrator.

    Attributes:
        dof: degree of freedom of the joint.
        message: actuator, joint, gain, inertia and step.
        hint: largest stable gain, and other remedies.
    """

    dof: int
    message: str
    hint: str


def unstable_gains(model: mujoco.MjModel) -> Iterator[UnstableGain]:
    """Yield the gains of actuators on hinges and sliders that diverge in the first state.

    With the position gain p, the velocity gain d, the inertia I and the step dt, a joint diverges if
    p·dt² + 2·d·dt > 4·I with the integrator Euler, and if p·dt² > 4·I + 2·d·dt with an implicit one (Jury's criterion
    for the sampled joint). Other integrators are not judged.
    """
    integrator, step = int(model.opt.integrator), float(model.opt.timestep)
    if integrator not in (*_EXPLICIT, *_IMPLICIT):
        return
    data: mujoco.MjData | None = None
    for i in range(model.nu):
        joint = int(model.actuator_trnid[i, 0])
        on_joint = model.actuator_trntype[i] == mujoco.mjtTrn.mjTRN_JOINT
        is_servo = model.actuator_biastype[i] == mujoco.mjtBias.mjBIAS_AFFINE
        if not on_joint or not is_servo or int(model.jnt_type[joint]) not in _SINGLE:
            continue
        square = float(model.actuator_gear[i, 0]) ** 2
        p, d = (-float(model.actuator_biasprm[i, k]) * square for k in (1, 2))
        data = first_mass_matrix(model) if data is None else data
        dof = int(model.jnt_dofadr[joint])
        inertia = 1.0 / max(inverse_inertia(model, data, dof), 1e-300) + step * float(model.dof_damping[dof])
        position, velocity = p * step**2, 2.0 * d * step
        room = 4.0 * inertia + (velocity if integrator in _IMPLICIT else -velocity)
        if position <= room:
            continue
        is_velocity = integrator in _EXPLICIT and velocity > position
        kind, gain = ("velocity", d) if is_velocity else ("position", p)
        most = (4.0 * inertia - position) / (2.0 * step) if is_velocity else room / step**2
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, i) or str(i)
        joint_name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint)
        message = (
            f"actuator {name!r}: the {kind} gain {gain:.4g} on joint {joint_name!r} with an inertia of {inertia:.3g} "
            f"(kg m2 or kg) oscillates or diverges at a step of {step * 1e3:g} ms"
        )
        limit = f"use at most {most:.3g}, " if most > 0.0 else "use "
        if is_velocity:
            message += " with the integrator Euler"
            limit += '<option integrator="implicitfast"/>, '
        yield UnstableGain(dof, message, f"{limit}a smaller step, or armature in the joint")
