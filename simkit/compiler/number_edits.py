"""Changes of a compiled world that need no compilation, because only numbers differ.

Each change is written to the specification and to the compiled model. The model then has the same bits as a model that
is compiled from the changed world.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import mujoco

from simkit.compiler.bodies import add_body, is_massless
from simkit.compiler.contact_friction import STIFF_KP, contact_properties, has_directional_friction
from simkit.compiler.engine_options import apply_options
from simkit.compiler.first_state import first_state
from simkit.compiler.geometry_edits import SpecEdit, is_plain_obstacle, plan_light, plan_moved_link, plan_shape
from simkit.compiler.joints import is_valid_axis, write_dynamics
from simkit.compiler.model_compilation import apply_velocity_decay
from simkit.compiler.moved_models import SHAPE_FIELDS, moved_models, other_changes, plan_moved_model
from simkit.compiler.name_map import ModelRecord
from simkit.compiler.refused_inertias import BodyInertia, repair_inertia
from simkit.compiler.servo_gains import tune_servos
from simkit.compiler.spec_builder import Compiled
from simkit.diagnostics import Diagnostics
from simkit.float_sum import float_sum
from simkit.pose import IDENTITY
from simkit.scene import (
    Inertial,
    SceneCollision,
    SceneJoint,
    SceneLight,
    SceneLink,
    SceneModel,
    SceneVisual,
    SceneWorld,
    Surface,
)
from simkit.scene.differences import EntityChange
from simkit.scene.model import Axis

Edit = Callable[[], None]
"""Function that writes one change to the specification and to the compiled model."""

_EDITABLE_AXIS: Final = frozenset({"lower", "upper", "damping", "friction", "stiffness", "spring_ref"})
_BODY_FIELDS: Final = ("body_mass", "body_inertia", "body_ipos", "body_iquat")
_BASIC_FIELDS: Final = frozenset({"inertial", "axes"})
"""Fields of the scene from which numbers of the compiled model are derived."""

DERIVED_FIELDS: Final = (
    *("body_subtreemass", "body_invweight0", "dof_M0", "dof_invweight0", "tendon_invweight0", "actuator_acc0"),
    *("cam_poscom0", "light_poscom0"),
)
"""Fields that the engine derives from masses, inertias and armatures."""

_SURFACE_FIELDS: Final = ("friction", "condim", "priority", "solref", "solimp", "solmix", "contype", "conaffinity")


@dataclass(frozen=True, slots=True)
class NumberEdits:
    """Changes of a compiled world.

    Attributes:
        numbers: functions that write numbers to the specification and to the compiled model.
        shapes: functions that write poses and sizes to the specification, which must then be compiled.
        are_derived: True if other numbers follow from the changed ones.
    """

    numbers: tuple[Edit, ...] = ()
    shapes: tuple[SpecEdit, ...] = ()
    are_derived: bool = True

    def apply(self, compiled: Compiled) -> Compiled:
        """Write all changes, and return the compiled model with all numbers that follow from them."""
        for write in self.numbers:
            write()
        if self.shapes:
            for write_shape in self.shapes:
                write_shape(compiled.builder.spec)
            return compiled.builder.compile()
        if self.are_derived:
            refresh_derived_numbers(compiled)
        return compiled


def plan_number_edits(compiled: Compiled, world: SceneWorld, changes: Sequence[EntityChange]) -> NumberEdits | None:
    """Return the changes as functions; None if the world must be built anew. Nothing is written yet.

    Args:
        compiled: compiled model with its builder.
        world: the changed world.
        changes: the entities that differ.
    """
    numbers: list[Edit] = []
    shapes: list[SpecEdit] = []
    moved, rest = moved_models(changes), []
    for model in moved.values():
        of_model = [change for change in changes if change.owner is model]
        edits = plan_moved_model(compiled.builder, world, model, of_model)
        if edits is None:
            return None
        shapes += edits
        rest += other_changes(of_model)
    rest += [change for change in changes if change.owner is None or change.owner.scoped not in moved]
    for change in rest:
        is_light = isinstance(change.new, SceneLight)
        is_shape = is_light or change.fields <= SHAPE_FIELDS
        if is_light:
            planned: Any = plan_light(world, change)
        else:
            planned = _plan_shape(compiled, change) if is_shape else _plan(compiled, world, change)
        if planned is None:
            return None
        (shapes if is_shape else numbers).extend(planned)
    are_derived = any(change.fields & _BASIC_FIELDS for change in changes)
    return NumberEdits(tuple(numbers), tuple(shapes), are_derived)


def _plan_shape(compiled: Compiled, change: EntityChange) -> list[SpecEdit] | None:
    builder, owner = compiled.builder, change.owner
    record = builder.records.get(owner.scoped) if owner is not None else None
    if owner is None or record is None or record.movable:
        return None
    match change.new:
        case SceneModel() if change.fields == {"pose_world"}:
            return [] if is_plain_obstacle(change.new) and not builder.world.joints else None
        case SceneLink() if change.fields == {"pose_world"}:
            return plan_moved_link(builder.spec, record, change.old, change.new)
        case SceneCollision() | SceneVisual():
            shape = change.new.scoped
            link = next(li for li in owner.all_links() if li.scoped == shape.rpartition("::")[0])
            return plan_shape(builder.spec, record, link, change.old)
    return None


def refresh_derived_numbers(compiled: Compiled) -> None:
    """Compute the numbers that the compiler derives from masses, inertias, joints and gains."""
    model, records = compiled.model, list(compiled.builder.records.values())
    centre, extent = model.stat.center.copy(), model.stat.extent  # they follow from shapes alone
    data = mujoco.MjData(model)
    mujoco.mj_setConst(model, data)
    model.stat.center[:], model.stat.extent = centre, extent
    set_mean_values(compiled)
    apply_velocity_decay(model, records)
    refs = [ref for record in records for ref in record.actuators]
    tune_servos(compiled.builder.spec, model, refs, first_state(model, data))


def set_mean_values(compiled: Compiled) -> None:
    """Set the mean mass and inertia, which scale the tolerance of the engine's solver, by the compiler's formula."""
    model, statistics = compiled.model, compiled.builder.spec.stat
    if math.isnan(statistics.meaninertia) and model.nv:
        model.stat.meaninertia = max(mujoco.mjMINVAL, float_sum(model.dof_M0.tolist()) / model.nv)
    if math.isnan(statistics.meanmass) and model.nbody > 1:
        model.stat.meanmass = max(mujoco.mjMINVAL, float_sum(model.body_mass.tolist()[1:]) / (model.nbody - 1))


def _plan(compiled: Compiled, world: SceneWorld, change: EntityChange) -> list[Edit] | None:
    if change.owner is not None and change.owner.scoped not in compiled.builder.records:
        return None
    record = compiled.builder.records[change.owner.scoped if change.owner is not None else ""]
    match change.new:
        case SceneWorld() if change.fields == {"gravity"}:
            return [lambda: _write_options(compiled, world)]
        case SceneLink() if change.fields == {"inertial"}:
            return _plan_inertial(compiled, world, record, change.old, change.new)
        case SceneCollision() if change.fields == {"surface"}:
            return _plan_surface(compiled, record, change.old, change.new)
        case SceneJoint() if change.fields == {"axes"}:
            return _plan_axes(compiled, record, change.old, change.new)
    return None


def _write_options(compiled: Compiled, world: SceneWorld) -> None:
    for option in (compiled.model.opt, compiled.builder.spec.option):
        option.gravity, option.magnetic = world.gravity, world.magnetic_field


# ---------------------------------------------------------------------- masses


def _plan_inertial(
    compiled: Compiled, world: SceneWorld, record: ModelRecord, old: SceneLink, new: SceneLink
) -> list[Edit] | None:
    binding = record.links.get(new.scoped)
    if binding is not None and binding.static:
        return []
    of_body = body_numbers(compiled, world, old, new.inertial)
    if binding is None or of_body is None:
        return None
    body, numbers = of_body

    def write() -> None:
        for field, values in numbers.items():
            getattr(compiled.model, field)[body] = values
        made = compiled.builder.spec.body(binding.body_name)
        made.mass, made.ipos, made.fullinertia = new.inertial.mass, new.inertial.com, new.inertial.inertia

    return [write]


def body_numbers(
    compiled: Compiled, world: SceneWorld, link: SceneLink, inertial: Inertial
) -> tuple[int, dict[str, object]] | None:
    """Return the body of a link, and the rows of model fields that the compiler writes for another mass and inertia.

    Returns:
        None if the world must be compiled anew.
    """
    binding = compiled.names.links.get(link.scoped)
    record = compiled.builder.records.get(binding.model) if binding is not None else None
    if binding is None or record is None or binding.static or is_massless(link.inertial) or inertial.mass <= 0.0:
        return None
    if not _is_plain_body(compiled, record) or repair_inertia(inertial).inertial is not inertial:
        return None
    row = _compiled_body(world, replace(link, inertial=inertial))
    if int(row.body_sameframe[1]) != int(compiled.model.body_sameframe[binding.body]):
        return None  # the engine would choose another algorithm for this body
    return int(binding.body), {field: getattr(row, field)[1].copy() for field in _BODY_FIELDS}


def _is_plain_body(compiled: Compiled, record: ModelRecord) -> bool:
    """Check whether the numbers of a model's bodies depend on no link but their own.

    This is false for loops, which share the mass of a link, for inertias that MuJoCo refuses, and for soft contacts,
    whose damping depends on the mass.
    """
    if record.attached or record.massless or any(r.exact for r in compiled.builder.records.values()):
        return False
    if any(joint.is_loop for r in compiled.builder.records.values() for joint in r.joints.values()):
        return False
    links = [link.scene for link in record.links.values() if not link.static]
    if any(
        repair_inertia(link.inertial).inertial is not link.inertial for link in links if not is_massless(link.inertial)
    ):
        return False
    return not any(_is_soft(collision.surface) for link in links for collision in link.collisions)


def _is_soft(surface: Surface) -> bool:
    return surface.kp is not None and 0.0 < surface.kp < STIFF_KP and surface.restitution <= 0.0


def _compiled_body(world: SceneWorld, link: SceneLink) -> mujoco.MjModel:
    """Return a compiled model whose only body has the mass and the inertia of a link."""
    spec, inertial = mujoco.MjSpec(), link.inertial
    apply_options(spec, world, Diagnostics())
    add_body(spec.worldbody, link, IDENTITY, BodyInertia(inertial.mass, inertial.com, inertial.inertia))
    return spec.compile()


# ---------------------------------------------------------------------- contacts


def _plan_surface(
    compiled: Compiled, record: ModelRecord, old: SceneCollision, new: SceneCollision
) -> list[Edit] | None:
    if record.attached or record.own_bit or _is_soft(old.surface) or _is_soft(new.surface):
        return None
    if has_directional_friction(old.surface) or has_directional_friction(new.surface):
        return None
    problems = Diagnostics()
    contact = surface_numbers(compiled, new.surface, problems)
    if list(problems):
        return None  # a new load reports the problems
    geoms = [n for n, o in record.geoms.items() if o.scoped == new.scoped and not o.is_visual]
    model, spec = compiled.model, compiled.builder.spec

    def write() -> None:
        for name in geoms:
            number = int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, name))
            if not (model.geom_contype[number] or model.geom_conaffinity[number]):
                continue  # the surface of a mesh for rays, which makes no contacts
            made = spec.geom(name)
            for field in _SURFACE_FIELDS:
                setattr(made, field, contact[field])
                getattr(model, f"geom_{field}")[number] = contact[field]

    return [write]


def surface_numbers(compiled: Compiled, surface: Surface, diagnostics: Diagnostics | None = None) -> dict[str, object]:
    """Return the contact properties of a rigid surface as the compiler writes them."""
    timestep = float(compiled.model.opt.timestep)
    problems = Diagnostics() if diagnostics is None else diagnostics  # an empty collection counts as False
    return contact_properties(surface, timestep, 0.0, problems)._asdict()


# ---------------------------------------------------------------------- joints


def _plan_axes(compiled: Compiled, record: ModelRecord, old: SceneJoint, new: SceneJoint) -> list[Edit] | None:
    binding = record.joints.get(new.scoped)
    if binding is None or record.attached or len(old.axes) != len(new.axes):
        return None
    if any(not _only_differs(a, b) for a, b in zip(old.axes, new.axes, strict=True)):
        return None
    problems = Diagnostics()
    if not all(is_valid_axis(new, axis, problems) for axis in new.axes) or list(problems):
        return None  # a new load reports the problems
    return [lambda: _write_axes(compiled, binding.joint_names, new)]


def _only_differs(old: Axis, new: Axis) -> bool:
    """Check whether two axes differ in editable fields only."""
    return all(
        name in _EDITABLE_AXIS or getattr(old, name) == getattr(new, name) for name in type(old).__dataclass_fields__
    )


def _write_axes(compiled: Compiled, names: Sequence[str], joint: SceneJoint) -> None:
    model = compiled.model
    axes = [*joint.axes, *joint.axes, *joint.axes] if joint.type == "planar" and len(joint.axes) == 1 else joint.axes
    for name, axis in zip(names, axes, strict=False):
        made = compiled.builder.spec.joint(name)
        write_dynamics(made, axis)
        number = int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name))
        first = int(model.jnt_dofadr[number])
        count = 3 if made.type == mujoco.mjtJoint.mjJNT_BALL else 1
        model.dof_damping[first : first + count] = made.damping[0]
        model.dof_frictionloss[first : first + count] = made.frictionloss
        model.jnt_stiffness[number] = made.stiffness[0]
        if count == 1:
            model.qpos_spring[int(model.jnt_qposadr[number])] = made.springref
        model.jnt_limited[number] = made.limited == mujoco.mjtLimited.mjLIMITED_TRUE
        model.jnt_range[number] = made.range
