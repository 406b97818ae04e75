"""`<world>`: its models, lights, frames, joints and surroundings."""

from __future__ import annotations

from simkit.loaders.sdf.frames import WORLD, Frame, Scope, world_pose
from simkit.loaders.sdf.joint import end_name, read_joint
from simkit.loaders.sdf.light import read_light
from simkit.loaders.sdf.model import build_model, declare_model, enter, model_sources, place, read_frames
from simkit.loaders.sdf.names import named, read_name
from simkit.loaders.sdf.parts import Draft, Part, Source, read_pose
from simkit.loaders.sdf.physics import read_physics, read_quality, read_spherical_coordinates, read_surroundings
from simkit.loaders.sdf.plugin import read_plugins
from simkit.loaders.sdf.workspace import SdfFile, Workspace
from simkit.params import Params
from simkit.scene import SceneLight, SceneWorld


def world_scope(workspace: Workspace) -> Scope:
    """An empty world's names."""
    return Scope(Frame(WORLD, WORLD, WORLD), workspace.diagnostics)


def read_world(element: Params, file: SdfFile, workspace: Workspace) -> SceneWorld:
    """A world with everything in it resolved."""
    diagnostics = workspace.diagnostics
    name = read_name(element, diagnostics, file.version)
    scope = world_scope(workspace)
    drafts, lights = _entities(element, file, scope, workspace)
    frames = _parts(element, "frame", file, scope, workspace)
    joints = _parts(element, "joint", file, scope, workspace)
    for draft in drafts:
        place(draft)
    physics, gravity = read_physics(element, diagnostics)
    return SceneWorld(
        name=name or "default",
        gravity=gravity,
        magnetic_field=element.vector3("magnetic_field", (5.5645e-6, 22.8758e-6, -42.3884e-6)),
        physics=physics,
        models=tuple(build_model(draft, False, workspace) for draft in drafts),
        lights=tuple(_light(source, scope, workspace) for source in lights),
        frames=read_frames(frames),
        joints=tuple(j for part in joints if (j := read_joint(part, "", workspace)) is not None),
        plugins=read_plugins(element.all("plugin"), ""),
        surroundings=read_surroundings(element),
        spherical_coordinates=read_spherical_coordinates(element, diagnostics),
        quality=read_quality(element),
        where=element.where,
    )


def _entities(element: Params, file: SdfFile, scope: Scope, workspace: Workspace) -> tuple[list[Draft], list[Source]]:
    """Models entered in the world's names, and lights, in document order."""
    drafts: list[Draft] = []
    lights = [
        _light_source(e, name, file)
        for name, e in named(element.all("light"), "the world", workspace.diagnostics, file.version)
    ]
    for source in model_sources(element, file, workspace):
        if source.element.name == "light":
            if any(light.name == source.name for light in lights):
                workspace.diagnostics.error(
                    "SK-SDF-002", f"the world has two lights named {source.name!r}", source.where
                )
            else:
                lights.append(source)
        elif source.merge:
            workspace.diagnostics.error("SK-SDF-016", "a model cannot be merged into a world", source.where)
        else:
            draft = declare_model(source, scope, "", workspace)
            if draft is not None:
                before = scope.names.get(source.name)
                enter(draft.frame, scope, file.version, workspace.diagnostics)
                if before is None:
                    drafts.append(draft)
    return drafts, lights


def _parts(element: Params, kind: str, file: SdfFile, scope: Scope, workspace: Workspace) -> list[Part]:
    parts = []
    for name, found in named(element.all(kind), "the world", workspace.diagnostics, file.version):
        pose, base = read_pose(found)
        attached = end_name(found, "child") if kind == "joint" else found.attribute("attached_to")
        frame = Frame(name, kind, name, scope, pose, base, attached, where=found.where)
        enter(frame, scope, file.version, workspace.diagnostics)
        parts.append(Part(name, found, frame, scope, file))
    return parts


def _light_source(element: Params, name: str, file: SdfFile) -> Source:
    pose, base = read_pose(element)
    return Source(name, element, file, pose, base, where=element.where)


def _light(source: Source, scope: Scope, workspace: Workspace) -> SceneLight:
    frame = Frame(source.name, "light", source.name, scope, source.pose, source.relative_to, where=source.where)
    return read_light(source.element, source.name, source.name, world_pose(frame), "", workspace.diagnostics)
