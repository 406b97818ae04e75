"""Compilation of a world's specification, and changes to and checks of the compiled model in its first state."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterable, Sequence
from typing import Final

import mujoco
import numpy as np

from simkit import progress
from simkit.compiler.assets import mesh_bytes
from simkit.compiler.engine_options import apply_size, choose_islands, set_extent
from simkit.compiler.first_state import first_mass_matrix, first_state, inverse_inertia
from simkit.compiler.lights import refine_for_lamps
from simkit.compiler.mjcf_attachment import assign_geom_groups, silence_engine_warnings
from simkit.compiler.name_map import GeomOwner, ModelRecord, NameMap
from simkit.compiler.refused_inertias import restore_file_inertias
from simkit.compiler.servo_gains import tune_servos
from simkit.diagnostics import Diagnostics, Where
from simkit.linear_algebra import matmul
from simkit.memory_error import find_memory_error
from simkit.scene import SceneCollision, SceneVisual, SceneWorld

_ASSET: Final = re.compile(r"\b(mesh|texture|material|heights)[#_][0-9a-f]{6,}(#textured)?(\.\w+)?")
_GEOM_NUMBER: Final = re.compile(r"#v?\d+(?=')")
_ENGINE_NUMBER: Final = re.compile(r",? (at )?id -?\d+")


def user_message(text: str, spec: mujoco.MjSpec, records: Sequence[ModelRecord], where: Where) -> tuple[str, Where]:
    """Return an engine's message with the names of the user's file, and the place of the element that it concerns.

    A mesh, material or height map has an internal name such as `mesh#f7af`. The message names its file and the
    collision or visual instead. Numbers of the engine's elements are removed.

    Args:
        text: message of the engine.
        spec: specification that the engine refused.
        records: elements of the models in the specification.
        where: place for a message that concerns no collision or visual.
    """
    place = where
    for match in dict.fromkeys(m.group() for m in _ASSET.finditer(text)):
        shape = _shape_with_asset(match, spec, records)
        name = "an asset of simkit"
        if shape is not None:
            name, place = f"{getattr(shape.geometry, 'uri', '') or 'the shape'} of {shape.scoped}", shape.where
        text = text.replace(f"'{match}'", name).replace(match, name)
    return _ENGINE_NUMBER.sub("", _GEOM_NUMBER.sub("", text)), place


def _shape_with_asset(
    name: str, spec: mujoco.MjSpec, records: Sequence[ModelRecord]
) -> SceneCollision | SceneVisual | None:
    """Return the first collision or visual whose geoms use an asset; None if there is none."""
    owners = {geom: owner for record in records for geom, owner in record.geoms.items()}
    links = {scoped: binding.scene for record in records for scoped, binding in record.links.items()}
    for geom in spec.geoms:
        owner: GeomOwner | None = owners.get(geom.name)
        names = (geom.meshname, geom.hfieldname, geom.material)
        if owner is None or not any(n and (n == name or name.startswith(n.replace("#", "_"))) for n in names):
            continue
        link = links.get(owner.link)
        shapes: Sequence[SceneCollision | SceneVisual] = () if link is None else (*link.collisions, *link.visuals)
        return next((shape for shape in shapes if shape.scoped == owner.scoped), None)
    return None


_NO_INERTIA: Final = 1e-9
"""Least effective inertia [kg·m² or kg] of a joint that moves a mass; massless frames have a tenth of it."""

IDLE_ROTARY: Final = 1e-4
"""Armature [kg·m²] of a hinge that moves no mass, as of a finger joint. Steps of 1 ms and contacts are then stable."""

IDLE_LINEAR: Final = 1e-2
"""Armature [kg] of a slider that moves no mass."""


def apply_velocity_decay(model: mujoco.MjModel, records: Iterable[ModelRecord]) -> None:
    """Set the damping of free joints for `velocity_decay`.

    The damping is the decay rate times the mass for linear motion, and times the moment of inertia about each axis of
    the link for rotation.
    """
    for record in records:
        for name, (linear, angular) in record.damped.items():
            joint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
            dof, body = int(model.jnt_dofadr[joint]), int(model.jnt_bodyid[joint])
            rotation = np.zeros(9)
            mujoco.mju_quat2Mat(rotation, model.body_iquat[body])
            turned = rotation.reshape(3, 3)
            moments = np.diag(matmul(turned, np.diag(model.body_inertia[body]), turned.T))
            model.dof_damping[dof : dof + 3] = linear * model.body_mass[body]
            model.dof_damping[dof + 3 : dof + 6] = angular * moments


def add_idle_armature(
    spec: mujoco.MjSpec, model: mujoco.MjModel, records: Iterable[ModelRecord], diagnostics: Diagnostics
) -> None:
    """Give an armature to each joint that moves only links without mass, in the model and in the spec.

    Such a joint has no mass below it, or no effective inertia while all other joints are free to move: 1 / (M⁻¹)_jj ≈
    0. A free link without effective inertia is an error.
    """
    suspects = [(r, link, joint) for r in records for link, joint in r.massless.items()]
    if not suspects:
        return
    data = first_mass_matrix(model)
    is_changed = False
    for record, link, joint in suspects:
        binding = record.links[link]
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, binding.body_name)
        first = int(model.body_dofadr[body])
        dofs = range(first, first + int(model.body_dofnum[body]))
        if link not in record.unladen and all(_joint_inertia(model, data, dof) >= _NO_INERTIA for dof in dofs):
            continue
        if not joint:
            text = f"link {link} moves freely without mass, and the links on its joints do not give it any inertia"
            hint = "give the link an <inertial>, or fix the model: <static>, or --base fixed for a robot alone"
            diagnostics.error("SK-JOINT-010", text, binding.scene.where, hint)
            continue
        armature = _give_armature(spec, model, body)
        is_changed = is_changed or bool(armature)
        if armature:
            scene = record.joints[joint].scene
            diagnostics.warning(
                "SK-JOINT-016",
                f"joint {joint} ({scene.type}) of link {link} moves no mass: the joint gets an armature of {armature}",
                scene.where if scene.where.line else binding.scene.where,
                "give the link an <inertial>, or make the joint fixed",
            )
    if is_changed:
        mujoco.mj_setConst(model, data)


def _give_armature(spec: mujoco.MjSpec, model: mujoco.MjModel, body: int) -> str:
    """Set the least armature on a body's joints that have less.

    Returns:
        Text of the armature; empty if nothing changed.
    """
    armature = ""
    for joint in range(int(model.body_jntadr[body]), int(model.body_jntadr[body] + model.body_jntnum[body])):
        is_slide = int(model.jnt_type[joint]) == mujoco.mjtJoint.mjJNT_SLIDE
        least, unit = (IDLE_LINEAR, "kg") if is_slide else (IDLE_ROTARY, "kg m²")
        first = int(model.jnt_dofadr[joint])
        count = 3 if int(model.jnt_type[joint]) == mujoco.mjtJoint.mjJNT_BALL else 1
        if model.dof_armature[first] >= least:
            continue
        model.dof_armature[first : first + count] = least
        spec.joint(mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint)).armature = least
        armature = f"{least:g} {unit}"
    return armature


def _joint_inertia(model: mujoco.MjModel, data: mujoco.MjData, dof: int) -> float:
    inverse = inverse_inertia(model, data, dof)
    return 1.0 / inverse if inverse > 0.0 else 0.0


REPORTED_DEPTH: Final = 0.005
"""Depth [m] up to which initial overlaps are common and not reported; the contact separates the bodies gently."""

_REPORTED_MOST: Final = 20


def report_overlaps(
    model: mujoco.MjModel, data: mujoco.MjData, names: NameMap, diagnostics: Diagnostics, where: Where
) -> None:
    """Warn of each pair of collisions that overlap deeply in the first state, with the depth of the overlap.

    Call this after the plugins are loaded, because a plugin may move joints before the first step.
    """
    present, data = data, mujoco.MjData(model)  # the state of a run stays as it is
    data.qpos[:], data.mocap_pos[:], data.mocap_quat[:] = present.qpos, present.mocap_pos, present.mocap_quat
    with warnings.catch_warnings(record=True) as engine_warnings:
        warnings.simplefilter("always")
        for compute in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_flex, mujoco.mj_collision):
            compute(model, data)
    for text in dict.fromkeys(str(w.message) for w in engine_warnings):
        diagnostics.warning("SK-PHYS-025", f"the engine warns: {text}", where)
    deepest: dict[tuple[str, str], float] = {}
    for i in (data.contact.dist < -REPORTED_DEPTH).nonzero()[0] if data.ncon else ():
        first, second = (names.geom_owner(g)[1] for g in data.contact.geom[i])
        if not (first and second):  # a flexible body of an MJCF file
            continue
        pair = (first, second)
        deepest[pair] = max(deepest.get(pair, 0.0), -float(data.contact.dist[i]))
    for (first, second), depth in sorted(deepest.items(), key=lambda item: -item[1])[:_REPORTED_MOST]:
        diagnostics.warning(
            "SK-PHYS-024",
            f"{second} starts {depth * 1e3:.0f} mm inside {first}: the contact separates them slowly",
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
    """Raise LoadError (SK-PHYS-028) if masses, inertias or distances differ too much for the engine.

    Each number of the file may be valid by itself. But the mass matrix for 1e-9 kg on a lever of 1e8 m has no inverse
    in double precision, and the engine would compute NaN.
    """
    for name, owner in _DERIVED:
        values = np.asarray(getattr(model, name), float)
        rows = values.reshape(max(1, len(values)), -1)
        bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
        if bad.size:
            text = f"{owner(model, int(bad[0]))}: its masses, inertias and distances differ too much in size"
            diagnostics.error("SK-PHYS-028", text, where, "check the units: metres, kilograms and kg·m²")
            diagnostics.raise_if_errors()


MOST_MOVING: Final = 10_000
"""Largest number of moving links; the engine's compile time is quadratic, 7 s for 4000 free links."""
_COMPILE_SECONDS: Final = 7.0 / 4000**2


def compile_spec(
    spec: mujoco.MjSpec, world: SceneWorld, records: Sequence[ModelRecord], diagnostics: Diagnostics
) -> mujoco.MjModel:
    """Compile a specification.

    Raises:
        LoadError: there are too many moving links, or MuJoCo refuses the model.
    """
    moving = sum(not link.static for r in records for link in r.links.values())
    moving += len([joint for r in records for joint in r.joints.values() if joint.twin])  # each has an own body
    if moving > MOST_MOVING:
        text = f"the world has {moving} moving links; at most {MOST_MOVING} are supported (a minute of compile time)"
        diagnostics.error("SK-PHYS-029", text, world.where, "make models that never move <static>")
        diagnostics.raise_if_errors()
    apply_size(spec, sum(not o.is_visual for r in records for o in r.geoms.values()))
    if world.mjcf is None:
        choose_islands(spec, sum(len(r.root_bodies) for r in records))
    compiling = progress.task(f"compiling {moving} moving links", expected=1.0 + _COMPILE_SECONDS * moving**2)
    try:
        with silence_engine_warnings(), compiling:
            return _compile_with_plates(spec, world, records, diagnostics)
    except ValueError as problem:
        if too_little := find_memory_error(problem):
            raise too_little from problem
        text, where = user_message(str(problem), spec, records, world.where)
        diagnostics.error("SK-PHYS-023", f"MuJoCo refuses the model: {text}", where)
        diagnostics.raise_if_errors()
        raise AssertionError("unreachable") from problem


_COPLANAR: Final = re.compile(r"mesh '([^']+)' has coplanar vertices")
_FLAT: Final = 1e-6
"""Thickness of a mesh in relation to its size below which it is made a plate."""
_PLATE: Final = 1e-3
"""Thickness of a plate in relation to its size."""


def _compile_with_plates(
    spec: mujoco.MjSpec, world: SceneWorld, records: Sequence[ModelRecord], diagnostics: Diagnostics
) -> mujoco.MjModel:
    """Compile a specification; flat convex pieces of meshes, which MuJoCo refuses, become thin plates.

    Raises:
        ValueError: MuJoCo refuses the model for another reason.
    """
    thickened: set[str] = set()
    while True:
        try:
            return spec.compile()
        except ValueError as problem:
            refused = _COPLANAR.search(str(problem))
            if refused is None or refused.group(1) in thickened:
                raise
            for mesh in spec.meshes:  # all flat pieces at once, because each attempt takes long
                if mesh.name not in thickened and _make_plate(spec, mesh, is_refused=mesh.name == refused.group(1)):
                    thickened.add(mesh.name)
                    shape = _shape_with_asset(mesh.name, spec, records)
                    name = f" of {shape.scoped}" if shape is not None else ""
                    text = f"a piece of a mesh{name} is flat: it collides as a thin plate"
                    diagnostics.note("SK-MESH-007", text, world.where if shape is None else shape.where)
            if refused.group(1) not in thickened:
                raise


def _make_plate(spec: mujoco.MjSpec, mesh: mujoco.MjsMesh, *, is_refused: bool) -> bool:
    """Give a flat mesh without own faces a thickness; return False if it is not flat, or is only a line."""
    content = spec.assets.get(mesh.file)
    if content is None:
        return False
    count, _, _, face_count = np.frombuffer(content, "<i4", 4).tolist()
    if face_count and not is_refused:
        return False
    vertices = np.frombuffer(content, "<f4", 3 * count, 16).reshape(-1, 3).astype(float)
    edges = vertices - vertices[0]
    longest = edges[int(np.argmax((edges * edges).sum(axis=1)))]
    normals = np.cross(edges, longest)
    normal = normals[int(np.argmax((normals * normals).sum(axis=1)))]
    size, height = float(np.sqrt((longest * longest).sum())), float(np.sqrt((normal * normal).sum()))
    if height <= _FLAT * size * size:
        return False
    distances = (edges * (normal / height)).sum(axis=1)
    if not is_refused and float(np.ptp(distances)) > _FLAT * size:
        return False
    shift = normal / height * (0.5 * _PLATE * size)
    mesh.file = f"plate_{mesh.file}"
    spec.assets[mesh.file] = mesh_bytes(np.vstack([vertices - shift, vertices + shift]), np.zeros((0, 3), np.int32))
    return True


def finish_model(
    spec: mujoco.MjSpec, model: mujoco.MjModel, world: SceneWorld, records: list[ModelRecord], diagnostics: Diagnostics
) -> None:
    """Set the fields that need the compiled model: inertias, groups, damping, gains.

    All functions share one first state with the poses of all bodies, because another `MjData` takes 0.5 ms.

    Raises:
        LoadError: SK-PHYS-028.
    """
    restore_file_inertias(model, {name: exact for r in records for name, exact in r.exact.items()})
    check_derived_numbers(model, diagnostics, world.where)
    data = first_state(model)
    set_extent(model, data)
    if world.mjcf is None:
        refine_for_lamps(model)
    assign_geom_groups(model, records)
    apply_velocity_decay(model, records)
    add_idle_armature(spec, model, records, diagnostics)
    tune_servos(spec, model, [ref for r in records for ref in r.actuators], data)
