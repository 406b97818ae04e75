"""Models in MuJoCo's own format: the file's specification is attached unchanged, with a prefix for its names.

The model therefore keeps tendons, actuators, equalities, sensors, keyframes, contact pairs and other elements without a
scene type. `mjcf_adaptation` makes the changes that another world needs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Final

import mujoco

from simkit.compiler import mjcf_adaptation as adaptation
from simkit.compiler import mjcf_changes as changes
from simkit.compiler.engine_options import CONTACT_LAW
from simkit.compiler.geom_groups import COLLISION, COLLISION_CONTACT, DRAWN_COLLISION, VISUAL
from simkit.compiler.kinematic_tree import WORLD
from simkit.compiler.name_map import GeomOwner, JointBinding, LightBinding, LinkBinding, ModelRecord
from simkit.diagnostics import Diagnostics
from simkit.mujoco_import import ignore_warning
from simkit.pose import IDENTITY
from simkit.scene import SceneJoint, SceneModel, SceneWorld
from simkit.scene.mjcf_source import MjcfSource

_HIDDEN: Final = COLLISION_CONTACT
_MARK: Final = "#mjcf"
"""Suffix of the frames and bodies that represent a file's world; no name in a file can end with it."""


def adopt_settings(spec: mujoco.MjSpec, world: SceneWorld) -> None:
    """Copy the engine settings of the world's file to its specification.

    Step, gravity and magnetic field are those of the scene.
    """
    if world.mjcf is None:
        return
    source = world.mjcf()
    adaptation.copy_settings(source, spec)
    option = spec.option
    for name in adaptation.OPTIONS:
        setattr(option, name, getattr(source.option, name))
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    option.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)  # the runtime decides whether bodies may sleep
    option.timestep, option.gravity, option.magnetic = (
        world.physics.max_step_size,
        world.gravity,
        world.magnetic_field,
    )
    if spec.text(CONTACT_LAW) is not None and source.text(CONTACT_LAW) is not None:
        spec.delete(spec.text(CONTACT_LAW))  # the attached file brings its own text
    for name in ("center", "extent", "meansize", "meanmass", "meaninertia"):
        setattr(spec.stat, name, getattr(source.stat, name))


def models_of_own_file(world: SceneWorld) -> list[SceneModel]:
    """Return the models of the world's own file."""
    return [m for m in world.models if m.mjcf is not None and not m.mjcf.prefix]


def attach_world(
    spec: mujoco.MjSpec, records: Iterable[ModelRecord], world: SceneWorld, diagnostics: Diagnostics
) -> None:
    """Attach the file of the world itself, once for all its models, without a prefix for its names."""
    records = list(records)
    child = _mjcf_source(records[0].scene).document()
    changes.write_lights(child, world.lights)
    # before the loop, because write_masses clears the total mass
    writes_masses = child.compiler.settotalmass > 0.0 or any(changes.changed_source(r.scene) for r in records)
    for record in records:
        source = _mjcf_source(record.scene)
        changes.write_changes(child, record.scene, diagnostics)
        adaptation.rename_lights(child, source)
        if writes_masses:
            adaptation.write_masses(child, changes.changed_source(record.scene) or source)
        record.root_bodies += source.roots
        _bind_elements(record, record.scene, "", "")
    child.compiler.settotalmass = -1.0
    adaptation.match_settings(child, spec)
    with silence_engine_warnings():
        spec.attach(child, prefix="", frame=spec.worldbody.add_frame(name=f"world{_MARK}"))


def attach_model(
    spec: mujoco.MjSpec, record: ModelRecord, model: SceneModel, diagnostics: Diagnostics, joints: Iterable[SceneJoint]
) -> list[SceneJoint]:
    """Attach one model at its pose, or as a child of the link to which a fixed joint connects the model.

    Args:
        spec: MuJoCo's specification.
        record: record of the top-level model.
        model: model to attach.
        diagnostics: collection for problems.
        joints: joints of outer models, some of which may connect this model.

    Returns:
        Joints that need no constraint any more, because the attachment fixes their links to each other.
    """
    source = _mjcf_source(model)
    child = source.document()
    changes.write_changes(child, model, diagnostics)
    prefix = source.prefix or f"{model.scoped}::"
    if not source.prefix:  # a part of the world's own file that was removed and is added again
        adaptation.keep_only_model(child, source)
    else:
        adaptation.report_settings(child, spec, model, diagnostics)
        adaptation.drop_lights(child, model, diagnostics)
        adaptation.rank_friction(child, model, diagnostics)
    holder = None if model.static or record.movable else _holding_joint(record, model, source, joints)
    adaptation.rename_lights(child, source, prefix)
    adaptation.write_masses(child, changes.changed_source(model) or source)
    if model.static:
        adaptation.make_static(child, model, diagnostics)
    adaptation.set_base(child, source, fixed=holder is not None)
    adaptation.match_settings(child, spec)
    wrapper = f"{model.scoped}{_MARK}" if record.movable and WORLD in source.bodies.values() else ""
    with silence_engine_warnings():
        spec.attach(child, prefix=prefix, frame=_attachment_frame(spec, record, source, prefix, wrapper, holder))
    for skin in spec.skins:  # MuJoCo renames the files in memory, but not their users among the skins
        if skin.name.startswith(prefix) and f"{prefix}{skin.file}" in spec.assets:
            skin.file = f"{prefix}{skin.file}"
    if record.movable and not wrapper:
        for root in source.roots:
            spec.body(f"{prefix}{root}").mocap = True
    _bind_elements(record, model, prefix, wrapper, free=holder is None)
    if holder is None:
        return []
    record.joints[holder.scoped] = _joint_binding(record, holder, "")
    return [holder]


def _mjcf_source(model: SceneModel) -> MjcfSource:
    if model.mjcf is None:
        raise ValueError(f"model {model.scoped!r} has no specification of its own")
    return model.mjcf


def _holding_joint(
    record: ModelRecord, model: SceneModel, source: MjcfSource, joints: Iterable[SceneJoint]
) -> SceneJoint | None:
    """Return the fixed joint that connects the only, free root of a model to a recorded link; None if there is none."""
    roots = [scoped for scoped, body in source.bodies.items() if body in source.roots]
    jointed = {j.child_link for j in model.joints if source.joints.get(j.scoped)}
    if len(roots) != 1 or roots[0] in jointed or WORLD in source.bodies.values():
        return None
    return next(
        (j for j in joints if j.type == "fixed" and j.child_link == roots[0] and j.parent_link in record.links), None
    )


def _attachment_frame(
    spec: mujoco.MjSpec, record: ModelRecord, source: MjcfSource, prefix: str, wrapper: str, holder: SceneJoint | None
) -> mujoco.MjsFrame:
    """Return the frame that represents the file's world: in the world body, in a movable body, or in a link's body."""
    pose, body = source.place, spec.worldbody
    if wrapper:
        body = spec.worldbody.add_body(name=wrapper, pos=pose.position, quat=pose.quaternion, mocap=True)
        record.root_bodies.append(wrapper)
        pose = IDENTITY
    elif holder is not None:
        link = record.links[holder.parent_link]
        body = spec.body(link.body_name)
        pose = link.offset @ link.scene.pose_world.inverse() @ pose
        if link.body_name == WORLD:
            record.root_bodies += [f"{prefix}{root}" for root in source.roots]
    else:
        record.root_bodies += [f"{prefix}{root}" for root in source.roots]
    return body.add_frame(name=f"{prefix}{_MARK}", pos=pose.position, quat=pose.quaternion)


def detach_model(spec: mujoco.MjSpec, record: ModelRecord) -> None:
    """Remove the elements that a model's files added besides their bodies, which must be removed first."""
    for prefix in record.attached.values():
        if prefix:
            _delete_elements(spec, prefix)


def _delete_elements(spec: mujoco.MjSpec, prefix: str) -> None:
    for frame in list(spec.frames):
        if frame.name == f"{prefix}{_MARK}":
            spec.delete(frame)
    for kind in (
        "keys", "sensors", "actuators", "tendons", "equalities", "excludes", "pairs", "tuples", "numerics", "texts",
        "skins", "flexes", "materials", "textures", "meshes", "hfields",
    ):  # fmt: skip
        for element in list(getattr(spec, kind)):
            if element.name.startswith(prefix):
                spec.delete(element)
    default = spec.find_default(f"{prefix}main")
    if default is not None:
        spec.delete(default)
    for name in [n for n in spec.assets if n.startswith(prefix)]:
        del spec.assets[name]


# ---------------------------------------------------------------------- bindings


def _bind_elements(record: ModelRecord, model: SceneModel, prefix: str, wrapper: str, free: bool = True) -> None:
    """Record the owner of each body, joint, geom and light.

    Args:
        record: record of the top-level model.
        model: attached model.
        prefix: prefix of its names.
        wrapper: body that represents the file's world body; empty for the world itself.
        free: True if the model keeps the free joints of its file.
    """
    source = _mjcf_source(model)
    record.attached[model.scoped] = prefix
    links = {link.scoped: link for link in model.links}
    for scoped, body in source.bodies.items():
        is_world = body == WORLD
        name = source.free.get(scoped, "") if free and not model.static else ""
        record.links[scoped] = LinkBinding(
            scoped=scoped,
            body_name=(wrapper or WORLD) if is_world else f"{prefix}{body}",
            offset=links[scoped].pose_world if is_world and not wrapper else IDENTITY,
            scene=links[scoped],
            model=record.scene.scoped,
            static=model.static or is_world,
            free_joint=f"{prefix}{name}" if name else "",
        )
    for joint in model.joints:
        name = "" if model.static else source.joints.get(joint.scoped, "")
        record.joints[joint.scoped] = _joint_binding(record, joint, f"{prefix}{name}" if name else "")
    for name, geom in source.geoms.items():
        if geom.collides or geom.drawn:
            record.geoms[f"{prefix}{name}"] = GeomOwner(geom.link, geom.shape, not geom.collides)
    for link in model.links:
        for light in link.lights:
            body = record.links[link.scoped].body_name
            record.lights[light.scoped] = LightBinding(light.scoped, light, record.scene.scoped, body)


def _joint_binding(record: ModelRecord, joint: SceneJoint, name: str) -> JointBinding:
    parent = record.links.get(joint.parent_link)
    in_child = record.links[joint.child_link].scene.pose_world.inverse() @ joint.pose_world
    return JointBinding(
        scoped=joint.scoped,
        type=joint.type,
        scene=joint,
        model=record.scene.scoped,
        joint_names=(name,) if name else (),
        pose_child=in_child,
        pose_parent=parent.scene.pose_world.inverse() @ joint.pose_world if parent else joint.pose_world,
        carried=joint.child_link,
        pose_moved=in_child,
    )


def assign_geom_groups(model: mujoco.MjModel, records: Iterable[ModelRecord]) -> None:
    """Assign the geoms of attached files to the groups that cameras and rays use.

    The groups are set in the compiled model, because before the compile a group may decide which geoms have mass.
    """
    for record in records:
        for nested in record.scene.all_models() if record.attached else ():
            for name, geom in nested.mjcf.geoms.items() if nested.mjcf is not None else ():
                full = f"{record.attached[nested.scoped]}{name}"
                number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, full)
                if geom.collides:
                    model.geom_group[number] = DRAWN_COLLISION if geom.drawn else COLLISION
                else:
                    model.geom_group[number] = VISUAL if geom.drawn else _HIDDEN


# ---------------------------------------------------------------------- warnings of the engine


@contextmanager
def silence_engine_warnings() -> Iterator[None]:
    """Keep the engine's warnings of a compile off the terminal and out of a log file; Python warnings still appear."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(ignore_warning)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


def is_expected_warning(text: str) -> bool:
    """Check whether the engine only warns that a world's own file keeps its names, which is intended."""
    return text.startswith("Attaching a spec with an empty prefix")


def without_attached(model: SceneModel) -> SceneModel:
    """Return a model without nested models that have a specification of their own."""
    if all(nested.mjcf is None for nested in model.all_models()[1:]):
        return model
    models = tuple(without_attached(nested) for nested in model.models if nested.mjcf is None)
    return replace(model, models=models)
