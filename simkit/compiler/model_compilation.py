"""Compile a world's specification, and adjust and check the model that comes of it in its first state."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Final

import mujoco
import numpy as np

from simkit.compiler.engine_options import apply_size, choose_islands, set_extent
from simkit.compiler.first_state import first_mass_matrix, first_state, inverse_inertia
from simkit.compiler.lights import refine_for_lamps
from simkit.compiler.mjcf_attachment import assign_geom_groups, silence_engine_warnings
from simkit.compiler.name_map import JointBinding, ModelRecord, NameMap
from simkit.compiler.refused_inertias import restore_file_inertias
from simkit.compiler.servo_gains import tune_servos
from simkit.diagnostics import Diagnostics, Where
from simkit.scene import SceneWorld

_NO_INERTIA: Final = 1e-9
"""Inertia [kg·m² or kg] that a joint feels below which it moves nothing; ten times less is what a frame is given."""

IDLE_ROTARY: Final = 1e-4
"""[kg·m²] that a hinge is given which moves nothing with mass: a finger's, so that 1 ms steps and contacts are calm."""

IDLE_LINEAR: Final = 1e-2
"""[kg] that a slider is given which moves nothing with mass."""


def apply_velocity_decay(model: mujoco.MjModel, records: Iterable[ModelRecord]) -> None:
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


def add_idle_armature(
    spec: mujoco.MjSpec, model: mujoco.MjModel, records: Iterable[ModelRecord], diagnostics: Diagnostics
) -> None:
    """Gives each joint that moves nothing but links without mass an armature, in the model and in the spec.

    Such a joint is one below which nothing has mass, or one that feels nothing where all else stays: 1 / (M⁻¹)_jj ≈ 0.
    What it carries then moves without pushing back on the rest. A link that hangs on no joint is an error.
    """
    suspects = [(r, link, joint) for r in records for link, joint in r.massless.items()]
    if not suspects:
        return
    data = first_mass_matrix(model)
    steadied = False
    for record, link, joint in suspects:
        binding = record.links[link]
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, binding.body_name)
        first = int(model.body_dofadr[body])
        dofs = range(first, first + int(model.body_dofnum[body]))
        if link not in record.unladen and all(_joint_inertia(model, data, dof) >= _NO_INERTIA for dof in dofs):
            continue
        if not joint:
            text = f"link {link} moves freely and has no mass; what it carries turns by itself and does not weigh on it"
            diagnostics.error("SK-JOINT-010", text, binding.scene.where, "give the link an <inertial>, or fix it")
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


def _joint_inertia(model: mujoco.MjModel, data: mujoco.MjData, dof: int) -> float:
    inverse = inverse_inertia(model, data, dof)
    return 1.0 / inverse if inverse > 0.0 else 0.0


def place_followers(data: mujoco.MjData, joints: Iterable[JointBinding]) -> None:
    """Puts what follows a joint with an offset where the law says at the start, so that nothing jerks."""
    for joint in joints:
        for follower in joint.followers:
            if follower.offset and follower.qpos >= 0:
                data.qpos[follower.qpos] = follower.offset


REPORTED_DEPTH: Final = 0.005
"""Overlaps up to this depth [m] at the start are ordinary and push things apart gently."""

_REPORTED_MOST: Final = 20


def report_overlaps(model: mujoco.MjModel, names: NameMap, diagnostics: Diagnostics, where: Where) -> None:
    """Warns of each pair of collisions that overlap deeply in the first state; the deepest contact of a pair counts."""
    data = first_state(model)
    mujoco.mj_collision(model, data)
    deepest: dict[tuple[str, str], float] = {}
    for i in (data.contact.dist < -REPORTED_DEPTH).nonzero()[0] if data.ncon else ():
        first, second = (names.geom_owner(g)[1] for g in data.contact.geom[i])
        if not (first and second):  # a cloth or the like, of a file of the engine's own
            continue
        pair = (first, second)
        deepest[pair] = max(deepest.get(pair, 0.0), -float(data.contact.dist[i]))
    for (first, second), depth in sorted(deepest.items(), key=lambda item: -item[1])[:_REPORTED_MOST]:
        diagnostics.warning(
            "SK-PHYS-024",
            f"{second} starts {depth * 1e3:.0f} mm inside {first}: contact moves them apart, slowly",
            names.link(names.geom_owner_link(second)).scene.where if names.geom_owner_link(second) else where,
            "move one of them in the file",
        )


_DERIVED: Final[tuple[tuple[str, Callable[[mujoco.MjModel, int], str]], ...]] = (
    ("body_mass", lambda m, i: f"body {m.body(i).name}"),
    ("body_inertia", lambda m, i: f"body {m.body(i).name}"),
    ("body_invweight0", lambda m, i: f"body {m.body(i).name}"),
    ("dof_invweight0", lambda m, i: f"joint {m.jnt(int(m.dof_jntid[i])).name}"),
    ("dof_M0", lambda m, i: f"joint {m.jnt(int(m.dof_jntid[i])).name}"),
    ("geom_rbound", lambda m, i: f"a shape of body {m.body(int(m.geom_bodyid[i])).name}"),
    ("qpos0", lambda _model, _at: "the first positions"),
)


def check_derived_numbers(model: mujoco.MjModel, diagnostics: Diagnostics, where: Where) -> None:
    """Raises LoadError (SK-PHYS-028) where masses, inertias or distances are so far apart that sums leave the numbers.

    Each number of the file is sound by itself by now; but a mass matrix of 1e-9 kg on a lever of 1e8 m has no inverse
    in double precision, and everything that the engine computes with it would be NaN.
    """
    for name, owner in _DERIVED:
        values = np.asarray(getattr(model, name), float)
        rows = values.reshape(max(1, len(values)), -1)
        bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
        if bad.size:
            text = f"{owner(model, int(bad[0]))}: its masses, inertias and distances are too far apart to compute with"
            diagnostics.error("SK-PHYS-028", text, where, "check the units: metres, kilograms and kg·m²")
            diagnostics.raise_if_errors()


MOST_MOVING: Final = 10_000
"""Links; the engine's compiler takes time in proportion to their square, 7 s for 4000 that are free."""


def compile_spec(
    spec: mujoco.MjSpec, world: SceneWorld, records: Sequence[ModelRecord], diagnostics: Diagnostics
) -> mujoco.MjModel:
    """The model that a specification compiles to.

    Raises:
        LoadError: there are too many moving links, or MuJoCo refuses the model.
    """
    moving = sum(not link.static for r in records for link in r.links.values())
    if moving > MOST_MOVING:
        text = f"there are {moving} moving links; at most {MOST_MOVING} are compiled, which takes the engine a minute"
        diagnostics.error("SK-PHYS-029", text, world.where, "make what never moves <static>")
        diagnostics.raise_if_errors()
    apply_size(spec, sum(not o.is_visual for r in records for o in r.geoms.values()))
    if world.mjcf is None:
        choose_islands(spec, sum(len(r.root_bodies) for r in records))
    try:
        with silence_engine_warnings():
            return spec.compile()
    except ValueError as problem:
        diagnostics.error("SK-PHYS-023", f"MuJoCo refuses the model: {problem}", world.where)
        diagnostics.raise_if_errors()
        raise AssertionError("unreachable") from problem


def finish_model(
    spec: mujoco.MjSpec, model: mujoco.MjModel, world: SceneWorld, records: list[ModelRecord], diagnostics: Diagnostics
) -> None:
    """Sets what only the compiled model tells: inertias, groups, damping, gains. Raises LoadError (SK-PHYS-028)."""
    restore_file_inertias(model, {name: exact for r in records for name, exact in r.exact.items()})
    check_derived_numbers(model, diagnostics, world.where)
    set_extent(model)
    if world.mjcf is None:
        refine_for_lamps(model)
    assign_geom_groups(model, records)
    apply_velocity_decay(model, records)
    add_idle_armature(spec, model, records, diagnostics)
    tune_servos(spec, model, [ref for r in records for ref in r.actuators])
