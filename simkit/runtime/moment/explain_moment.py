"""Function that reads a `Moment` from a simulation; it changes no bit of the simulation."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.float_sum import float_sum
from simkit.linear_algebra import norm
from simkit.runtime.contact.collision_contacts import collision_table, find_contacts, slip_velocities
from simkit.runtime.contact.rim_slip import list_wheel_slips
from simkit.runtime.handles.handle import UnknownName, look_up
from simkit.runtime.moment.moment import Moment
from simkit.runtime.moment.moment_contents import (
    SATURATED,
    ConstraintError,
    JointLoad,
    Numbers,
    TouchingPair,
)

if TYPE_CHECKING:
    from simkit.pose import Vector
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.runtime.handles.joint import Joint

_EQUALITY: Final = int(mujoco.mjtConstraint.mjCNSTR_EQUALITY)
_LIMIT: Final = int(mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT)
_OF_JOINT: Final = int(mujoco.mjtTrn.mjTRN_JOINT)
_PYRAMID: Final = int(mujoco.mjtCone.mjCONE_PYRAMIDAL)


def explain_moment(engine: Engine, handles: EntityHandles, model: str | None, joint: str | None) -> Moment:
    """Read contacts, joints, constraints and wheels at the present time.

    Args:
        engine: engine of the simulation.
        handles: models and joints of the simulation.
        model: scoped name of a model; None for all models.
        joint: scoped name of a joint, or its last name if only one joint has it: only this joint, its constraints, its
            wheel and the contacts of its child link. None for all joints.

    Raises:
        KeyError: no such model or joint; the message suggests the closest name.
    """
    scoped = None if model is None else handles.model(model).scoped
    prefix = "" if scoped is None else f"{scoped}::"
    joints = {name: handle for name, handle in handles.tables["joint"].items() if name.startswith(prefix)}
    names: set[str] | None = None
    if joint is not None:
        found = _find_joint(joints, joint)
        joints, prefix, names = {found.scoped: found}, f"{found.scene.child_link}::", {found.scoped}
    slips = list_wheel_slips(engine.compiled, engine.physics.awake_data(), scoped)
    wheels = [wheel for wheel in slips if names is None or wheel.joint in names]
    constraints = _constraints(engine, scoped, names)
    return Moment(
        engine.world.name,
        engine.time,
        engine.physics.tick,
        scoped or "",
        tuple(_pairs(engine, prefix)),
        tuple(_loads(engine, joints.values())),
        tuple(sorted(constraints, key=lambda constraint: -constraint.error)),
        tuple(wheels),
    )


def _find_joint(joints: dict[str, Joint], name: str) -> Joint:
    matching = [scoped for scoped in joints if scoped.rpartition("::")[2] == name]
    if name not in joints and len(matching) > 1:
        raise UnknownName(f"{len(matching)} joints have the name {name!r}: {', '.join(matching)}")
    return joints[matching[0]] if name not in joints and matching else look_up(joints, name, "joint")


# ---------------------------------------------------------------------- contacts


def _pairs(engine: Engine, prefix: str) -> Iterable[TouchingPair]:
    """Return the pairs of collisions that touch, with one whose scoped name has a prefix, in the engine's order."""
    compiled, data = engine.compiled, engine.physics.awake_data()
    model, table = compiled.model, collision_table(compiled)
    selected = table.mask([name for name in table.names if name.startswith(prefix)])
    contacts = find_contacts(model, data, selected)
    if contacts is None:
        return
    speeds = np.hypot(*slip_velocities(model, data, contacts)[:, 1:].T)
    places: dict[tuple[int, int], list[int]] = {}
    for place, (first, second) in enumerate(table.of_geom[contacts.geoms].tolist()):
        places.setdefault((first, second), []).append(place)
    coefficients = data.contact.friction[contacts.numbers, :2]
    forces = contacts.wrenches[:, :3]
    for (first, second), rows in places.items():
        limits = coefficients[rows] * forces[rows, :1]
        shares = np.abs(forces[rows, 1:]) / np.maximum(limits, 1e-12)
        used = shares.sum(axis=1) if model.opt.cone == _PYRAMID else np.hypot(shares[:, 0], shares[:, 1])
        normal = float_sum(forces[rows, 0].tolist())
        world = [forces[row, 1] * contacts.frames[row, 1] + forces[row, 2] * contacts.frames[row, 2] for row in rows]
        loaded = [speeds.item(row) for row in rows if forces.item(row, 0) > 0.0]
        weighted = float_sum((used * forces[rows, 0]).tolist())
        if model.body_weldid[model.geom_bodyid[contacts.geoms[rows[0], 0]]] == 0:  # the moving one is first
            first, second = second, first
        yield TouchingPair(
            table.names[first],
            table.names[second],
            len(rows),
            max(contacts.depths[rows].tolist()),
            normal,
            norm(np.add.reduce(world)),
            float_sum(limits[:, 0].tolist()),
            min(1.0, weighted / normal) if normal > 0.0 and limits.any() else 0.0,
            max(loaded, default=0.0),
        )


# ---------------------------------------------------------------------- joints


def _loads(engine: Engine, joints: Iterable[Joint]) -> Iterable[JointLoad]:
    model, data = engine.mj_model, engine.physics.awake_data()
    stops, needed = _stops(data), _steady_efforts(model, data)
    for handle in joints:
        if not handle.dof or handle.type == "floating":
            continue
        limits, saturated = _effort_limits(model, data, handle)
        effort = _numbers(handle.effort)
        own = _numbers(handle.effort_limit)
        limits = tuple(min(pair) for pair in zip(limits, (*own, *own * len(limits)), strict=False))
        joint_ids = engine.names.joint(handle.scoped).joint_ids
        stop, stop_effort = "", 0.0
        for number in joint_ids:
            if number in stops:
                low, high = model.jnt_range[number].tolist()
                position = data.qpos.item(model.jnt_qposadr[number])
                is_ball = model.jnt_type[number] == mujoco.mjtJoint.mjJNT_BALL.value
                stop = "limit" if is_ball else "lower" if position - low < high - position else "upper"
                stop_effort = stops[number]
        yield JointLoad(
            handle.scoped,
            handle.type,
            _numbers(handle.position),
            _numbers(handle.velocity),
            effort,
            tuple(needed[list(handle.mj_dofs)].tolist()),
            limits,
            saturated or any(abs(e) >= SATURATED * limit > 0.0 for e, limit in zip(effort, limits, strict=False)),
            handle.least_velocity_limit,
            stop,
            stop_effort,
        )


def _steady_efforts(model: mujoco.MjModel, data: mujoco.MjData) -> Vector:
    """Return the efforts that would keep the velocities of all joints under the present contacts, shape (nv,)."""
    acceleration, inertial = np.zeros(model.nv), np.zeros(model.nv)
    of_base = model.jnt_type[model.dof_jntid] == mujoco.mjtJoint.mjJNT_FREE.value
    acceleration[of_base] = data.qacc[of_base]
    mujoco.mj_mulM(model, data, inertial, acceleration)
    needed: Vector = inertial + data.qfrc_bias - data.qfrc_passive - data.qfrc_constraint
    return needed


def _numbers(value: object) -> Numbers:
    numbers: list[float] = np.ravel(value).tolist()  # type: ignore[call-overload]  # a number or an array
    return tuple(numbers)


def _stops(data: mujoco.MjData) -> dict[int, float]:
    """Return the effort of each position limit that acts [N·m or N], by MuJoCo's joint."""
    rows = np.flatnonzero(data.efc_type == _LIMIT)
    forces = zip(data.efc_id[rows].tolist(), data.efc_force[rows].tolist(), strict=True)
    return {joint: abs(force) for joint, force in forces if force}


def _effort_limits(model: mujoco.MjModel, data: mujoco.MjData, handle: Joint) -> tuple[Numbers, bool]:
    """Return the effort limit of the actuators of each axis, infinite for none, and True if one has its limit."""
    limits, saturated = [math.inf] * handle.dof, False
    for place, dof in enumerate(handle.mj_dofs):
        joint = int(model.dof_jntid[dof])
        actuators = np.flatnonzero((model.actuator_trntype == _OF_JOINT) & (model.actuator_trnid[:, 0] == joint))
        sides = [
            max(abs(x) for x in model.actuator_forcerange[i].tolist()) * abs(model.actuator_gear.item(i, 0))
            if model.actuator_forcelimited[i]
            else math.inf
            for i in actuators.tolist()
        ]
        forces = np.abs(data.actuator_force[actuators] * model.actuator_gear[actuators, 0]).tolist()
        saturated |= any(force >= SATURATED * side > 0.0 for force, side in zip(forces, sides, strict=True))
        if sides:
            limits[place] = float_sum(sides)
        if model.jnt_actfrclimited[joint]:
            limits[place] = min(limits[place], max(abs(x) for x in model.jnt_actfrcrange[joint].tolist()))
    return tuple(limits), saturated


# ---------------------------------------------------------------------- constraints


def _constraints(engine: Engine, model_name: str | None, joints: set[str] | None) -> Iterable[ConstraintError]:
    model, data = engine.mj_model, engine.physics.awake_data()
    scoped_of = {n: name for name, binding in engine.names.joints.items() for n in binding.joint_ids}
    rows_of: dict[int, list[int]] = {}
    for row in np.flatnonzero(data.efc_type == _EQUALITY).tolist():
        rows_of.setdefault(int(data.efc_id[row]), []).append(row)
    for number, rows in rows_of.items():
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_EQUALITY, number) or f"equality{number}"
        kind = mujoco.mjtEq(int(model.eq_type[number])).name.removeprefix("mjEQ_").lower()
        ends = {int(model.eq_obj1id[number]), int(model.eq_obj2id[number])} if kind == "joint" else set()
        of_joints = {scoped_of[end] for end in ends if end in scoped_of} | {name.partition("#")[0]}
        if model_name is not None and not any(each.startswith(f"{model_name}::") for each in of_joints):
            continue
        if joints is not None and not joints & of_joints:
            continue
        is_turn = kind == "joint" and model.jnt_type[model.eq_obj1id[number]] == mujoco.mjtJoint.mjJNT_HINGE.value
        rows = rows[:3]  # the position; a weld has three rows of the orientation, too
        yield ConstraintError(
            name, kind, norm(data.efc_pos[rows]), "rad" if is_turn else "m", norm(data.efc_force[rows])
        )
