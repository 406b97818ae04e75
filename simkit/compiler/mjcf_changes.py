"""Changes of a scene, for example by overrides, in the specification of a model in MuJoCo's own format."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np

from simkit.compiler.contact_friction import MU_MOST
from simkit.compiler.refused_inertias import inertia_matrix
from simkit.diagnostics import Diagnostics
from simkit.linear_algebra import det
from simkit.matrix_decompositions import eigh
from simkit.pose import IDENTITY, Pose
from simkit.scene import SceneCollision, SceneJoint, SceneLight, SceneLink, SceneModel, SceneVisual, SceneWorld
from simkit.scene import geometry as shapes
from simkit.scene.differences import EntityChange, entity_changes
from simkit.scene.mjcf_source import Mass, MjcfSource

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


_SAME_PLACE: Final = 1e-9
"""Largest difference of two equal poses [m, and components of a quaternion]; moved models have rounding errors."""

_SIZES: Final[dict[type, Callable[[Any], Sequence[float]]]] = {
    shapes.Sphere: lambda s: (s.radius, 0.0, 0.0),
    shapes.Capsule: lambda s: (s.radius, s.length / 2, 0.0),
    shapes.Cylinder: lambda s: (s.radius, s.length / 2, 0.0),
    shapes.Ellipsoid: lambda s: s.radii,
    shapes.Box: lambda s: tuple(edge / 2 for edge in s.size),
}
_SURFACE: Final = frozenset({"mu", "mu2", "torsional"})
_AXIS: Final = frozenset({"lower", "upper", "effort", "damping", "friction", "stiffness", "spring_ref"})


def changed_source(model: SceneModel) -> MjcfSource | None:
    """Return the source of a model with the masses of changed links; None if no mass has changed."""
    source, read = model.mjcf, _as_read(model)
    if source is None or read is None:
        return None
    before = {link.scoped: link.inertial for link in read.links}
    changed = {
        source.bodies[link.scoped]: _mass(link)
        for link in model.links
        if link.inertial != before.get(link.scoped, link.inertial) and source.bodies[link.scoped] in source.masses
    }
    return replace(source, masses={**source.masses, **changed}) if changed else None


def _mass(link: SceneLink) -> Mass:
    """Return mass, centre of mass, axes of inertia and principal moments."""
    values, axes = eigh(inertia_matrix(link.inertial.inertia))
    if det(axes) < 0.0:
        axes[:, 0] = -axes[:, 0]
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, axes.flatten())
    return link.inertial.mass, link.inertial.com, tuple(quat.tolist()), tuple(values.tolist())


def _as_read(model: SceneModel) -> SceneModel | None:
    """Return the model as its file describes it; None if nothing has changed since."""
    read = model.mjcf.as_read.get("") if model.mjcf is not None else None
    return None if read is model else read


def write_changes(child: mujoco.MjSpec, model: SceneModel, diagnostics: Diagnostics) -> None:
    """Write the differences between a model and its file to the specification of the file.

    Masses are written by `mjcf_adaptation.write_masses`.

    Args:
        child: specification of the file.
        model: the model.
        diagnostics: collection for changes that the format cannot express.
    """
    source, read = model.mjcf, _as_read(model)
    if source is None or read is None or read.mjcf is None:
        return
    original = read.mjcf
    read = replace(read, scoped=model.scoped, name=model.name)
    frames = {link.scoped: _in_file(source, link) for link in model.links}
    before = {link.scoped: _in_file(original, link) for link in read.links}
    parents = {joint.child_link: joint.parent_link for joint in model.joints}
    for scoped, body in source.bodies.items():
        parent = parents.get(scoped, "")
        old = before.get(parent, IDENTITY).inverse() @ before[scoped]
        new = frames.get(parent, IDENTITY).inverse() @ frames[scoped]
        if body != "world" and not _is_same(old, new):
            _move(child.body(body), new, f"link {scoped}", model, diagnostics)
    for change in _changes(read, model):
        _write(child, source, change, model, diagnostics)


def _in_file(source: MjcfSource, link: SceneLink) -> Pose:
    """Return the pose of a link in the world of its file."""
    return source.place.inverse() @ link.pose_world if source.prefix else link.pose_world


def _is_same(pose: Pose, other: Pose) -> bool:
    turned = min(np.abs(pose.quaternion - other.quaternion).max(), np.abs(pose.quaternion + other.quaternion).max())
    return bool(np.abs(pose.position - other.position).max() <= _SAME_PLACE and turned <= _SAME_PLACE)


def _changes(read: SceneModel, model: SceneModel) -> Iterable[EntityChange]:
    changes = entity_changes(SceneWorld(models=(read,)), SceneWorld(models=(model,)))
    return changes or ()


def _write(
    child: mujoco.MjSpec, source: MjcfSource, change: EntityChange, model: SceneModel, diagnostics: Diagnostics
) -> None:
    new = change.new
    match new:
        case SceneLink() if "gravity" in change.fields:
            child.body(source.bodies[new.scoped]).gravcomp = 0.0 if new.gravity else 1.0
        case SceneCollision() | SceneVisual():
            for name, geom in source.geoms.items():
                if geom.shape == new.scoped:
                    _write_geom(child.geom(name), change, model, diagnostics)
        case SceneJoint() if source.joints.get(new.scoped):
            _write_joint(child.joint(source.joints[new.scoped]), child, change, model, diagnostics)
        case SceneLight() if new.scoped in source.lights:
            write_lights(child, [new], source)


def _refuse(what: str, model: SceneModel, diagnostics: Diagnostics) -> None:
    text = f"{what} cannot be set: model {model.scoped!r} is in MuJoCo's own format, which has it in another form"
    diagnostics.error("SK-CLI-014", text, model.where, "change the file")


def _move(
    element: mujoco.MjsBody | mujoco.MjsGeom, pose: Pose, what: str, model: SceneModel, diagnostics: Diagnostics
) -> None:
    """Give a body or geom another pose in its parent body's frame."""
    if element.frame is not None and element.frame.name != "world":
        _refuse(f"the pose of {what}, which is in a <frame>,", model, diagnostics)
        return
    element.pos, element.quat = pose.position, pose.quaternion
    element.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT
    if hasattr(element, "fromto"):
        element.fromto = np.full(6, np.nan)


# ---------------------------------------------------------------------- geoms


def _write_geom(geom: mujoco.MjsGeom, change: EntityChange, model: SceneModel, diagnostics: Diagnostics) -> None:
    old, new = change.old, change.new
    what = f"shape {new.scoped}"
    sizes = _SIZES.get(type(new.geometry))
    if "geometry" in change.fields:
        if sizes is None:
            _refuse(f"the size of {what}", model, diagnostics)
            return
        geom.size = sizes(new.geometry)
    if "pose_link" in change.fields or ("geometry" in change.fields and np.isfinite(geom.fromto[0])):
        if isinstance(new.geometry, (shapes.Mesh, shapes.Heightmap)):
            local = Pose(geom.pos, geom.quat)
            _move(geom, new.pose_link @ old.pose_link.inverse() @ local, what, model, diagnostics)
        else:
            _move(geom, new.pose_link, what, model, diagnostics)
    if "surface" in change.fields:
        if _differing(old.surface, new.surface) - _SURFACE:
            _refuse(f"a contact property of {what}", model, diagnostics)
        mu = min(new.surface.mu, new.surface.mu2, MU_MOST)
        geom.friction[0] = mu
        geom.condim = 1 if mu == 0.0 else max(3, int(geom.condim))
        if new.surface.torsional != old.surface.torsional:
            geom.friction[1] = new.surface.torsional or 0.0
    if "material" in change.fields and new.material is not None:
        geom.rgba = new.material.diffuse
    if "transparency" in change.fields:
        geom.rgba[3] = 1.0 - new.transparency


def _differing(old: DataclassInstance, new: object) -> set[str]:
    return {f.name for f in fields(old) if f.name != "where" and getattr(old, f.name) != getattr(new, f.name)}


# ---------------------------------------------------------------------- joints


def _write_joint(
    joint: mujoco.MjsJoint, child: mujoco.MjSpec, change: EntityChange, model: SceneModel, diagnostics: Diagnostics
) -> None:
    old, new = change.old, change.new
    links = {link.scoped: link.pose_world for link in model.links}
    read = {link.scoped: link.pose_world for link in (_as_read(model) or model).links}
    pose = links[new.child_link].inverse() @ new.pose_world
    if not _is_same(read[old.child_link].inverse() @ old.pose_world, pose):
        joint.pos = pose.position
    for before, axis in zip(old.axes, new.axes, strict=True):
        turned = links[new.child_link].inverse().rotate(axis.xyz_world)
        if np.abs(turned - read[old.child_link].inverse().rotate(before.xyz_world)).max() > _SAME_PLACE:
            joint.axis = turned
        different = _differing(before, axis) - {"xyz_world", "xyz_joint"}
        if different - _AXIS:
            _refuse(f"{' and '.join(sorted(different - _AXIS))} of joint {new.scoped}", model, diagnostics)
        is_hinge = joint.type == mujoco.mjtJoint.mjJNT_HINGE
        unit = math.degrees(1.0) if child.compiler.degree and is_hinge else 1.0
        if "damping" in different:
            joint.damping[0] = max(0.0, axis.damping)
        if "friction" in different:
            joint.frictionloss = max(0.0, axis.friction)
        if "stiffness" in different:
            joint.stiffness[0] = max(0.0, axis.stiffness)
        if "spring_ref" in different:
            joint.springref = axis.spring_ref * unit
        if different & {"lower", "upper"}:
            lower, upper = max(axis.lower, -1e10), min(axis.upper, 1e10)
            is_limited = lower > -1e10 or upper < 1e10
            joint.limited = mujoco.mjtLimited.mjLIMITED_TRUE if is_limited else mujoco.mjtLimited.mjLIMITED_FALSE
            joint.range = (lower * unit, upper * unit) if is_limited else (0.0, 0.0)
        if "effort" in different:
            is_limited = math.isfinite(axis.effort)
            joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_TRUE if is_limited else mujoco.mjtLimited.mjLIMITED_FALSE
            joint.actfrcrange = (-axis.effort, axis.effort) if is_limited else (0.0, 0.0)


# ---------------------------------------------------------------------- lights


def write_lights(child: mujoco.MjSpec, lights: Iterable[SceneLight], source: MjcfSource | None = None) -> None:
    """Write colours, direction and state of lights to the specification of a file, where they differ from the file."""
    present = {made.name for made in child.lights}
    for light in lights:
        written = source.lights[light.scoped][0] if source is not None else light.name
        if written not in present:
            continue
        made = child.light(written)
        for name in ("diffuse", "specular"):
            colour = np.float32(np.clip(np.array(getattr(light, name)[:3]) * light.intensity, 0.0, 10.0))
            if not np.array_equal(colour, np.float32(getattr(made, name))):
                setattr(made, name, colour)
        if bool(made.active) != light.on:
            made.active = light.on
        if bool(made.castshadow) != light.cast_shadows:
            made.castshadow = light.cast_shadows
