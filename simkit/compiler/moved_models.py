"""Other poses and sizes of models that move, for a specification that is then compiled again without its files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import mujoco

from simkit.compiler import shape_geometry
from simkit.compiler.geometry_edits import SpecEdit
from simkit.compiler.name_map import ModelRecord
from simkit.diagnostics import Diagnostics
from simkit.scene import SceneCollision, SceneJoint, SceneModel, SceneVisual, SceneWorld
from simkit.scene.differences import EntityChange

if TYPE_CHECKING:
    from simkit.compiler.spec_builder import SpecBuilder

SHAPE_FIELDS: Final = frozenset({"pose_world", "pose_link", "geometry"})
"""Fields of the scene with poses and shapes."""

_BODY_FIELDS: Final = ("pos", "quat", "ipos", "iquat", "mass", "inertia", "fullinertia")
_BINDING_POSES: Final = ("pose_child", "pose_parent", "pose_moved")


def moved_models(changes: Sequence[EntityChange]) -> dict[str, SceneModel]:
    """Return the top-level models that move and have other poses or shapes, by scoped name."""
    owners = (change.owner for change in changes if change.fields & SHAPE_FIELDS)
    return {model.scoped: model for model in owners if model is not None and not model.static}


def plan_moved_model(
    builder: SpecBuilder, world: SceneWorld, model: SceneModel, changes: Sequence[EntityChange]
) -> list[SpecEdit] | None:
    """Return a function that writes the poses and shapes of a model; None if the world must be built anew.

    The poses of its links relative to each other have other rounding errors at another place. A specification of the
    model alone therefore gives all numbers, by the same code as a load.

    Args:
        builder: builder of the compiled world.
        world: the changed world.
        model: changed top-level model, without sensors and plugins.
        changes: all changes in this model.
    """
    record = builder.records.get(model.scoped)
    if record is None or not _is_separate(builder, record) or any(map(_has_other_shape, changes)):
        return None
    problems = Diagnostics()
    source = type(builder)(replace(world, models=(model,), joints=(), lights=(), plugins=(), actors=()), problems)
    moved = source.records[model.scoped]
    if problems.has_errors or moved.geoms.keys() != record.geoms.keys() or moved.joints.keys() != record.joints.keys():
        return None
    if any(builder.spec.geom(name).type != source.spec.geom(name).type for name in record.geoms):
        return None
    return [lambda spec: _write_model(spec, record, source.spec, moved)]


def other_changes(changes: Sequence[EntityChange]) -> list[EntityChange]:
    """Return the changes of a moved model that are not poses or shapes. The axes of its joints turn with it."""
    others = []
    for change in changes:
        fields, old = change.fields - SHAPE_FIELDS, change.old
        if isinstance(old, SceneJoint) and len(old.axes) == len(change.new.axes):
            pairs = zip(old.axes, change.new.axes, strict=True)
            old = replace(old, axes=tuple(replace(old_axis, xyz_world=other.xyz_world) for old_axis, other in pairs))
            fields -= {"axes"} if old.axes == change.new.axes else set()
        if fields:
            others.append(replace(change, old=old, fields=fields))
    return others


def _has_other_shape(change: EntityChange) -> bool:
    """Check whether a change needs another mesh or another kind of shape."""
    if not isinstance(change.new, (SceneCollision, SceneVisual)) or "geometry" not in change.fields:
        return False
    new = change.new.geometry
    is_primitive = shape_geometry.primitive_of(new, isinstance(change.new, SceneVisual)) is not None
    return not is_primitive or type(change.old.geometry) is not type(new)


def _is_separate(builder: SpecBuilder, record: ModelRecord) -> bool:
    """Check whether all elements of a model are bodies, joints and shapes that no other model is connected to."""
    if record.movable or any(link.static for link in record.links.values()) or builder.world.joints:
        return False
    others = record.equalities, record.attached, record.massless, record.exact, record.lights, record.actuators
    if any(others) or record.sites or record.world_sites or record.world_cameras:
        return False
    bodies = {link.body_name for link in record.links.values()}
    return not any({item.name1, item.name2} & bodies for item in builder.spec.equalities)


def _write_model(spec: mujoco.MjSpec, record: ModelRecord, source: mujoco.MjSpec, moved: ModelRecord) -> None:
    for link in record.links.values():
        _copy(spec.body(link.body_name), source.body(link.body_name), _BODY_FIELDS)
    for name in record.geoms:
        _copy(spec.geom(name), source.geom(name), ("pos", "quat", "size"))
    for scoped, joint in record.joints.items():
        for name in (*joint.joint_names, *(follower.name for follower in joint.followers)):
            _copy(spec.joint(name), source.joint(name), ("pos", "axis"))
        poses = {field: getattr(moved.joints[scoped], field) for field in _BINDING_POSES}
        record.joints[scoped] = replace(joint, **poses)


def _copy(target: object, source: object, names: Sequence[str]) -> None:
    for name in names:
        setattr(target, name, getattr(source, name))
