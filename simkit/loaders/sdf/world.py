"""Reader of `<world>`: its models, lights, frames, joints and surroundings."""

from __future__ import annotations

from dataclasses import dataclass, field

from simkit.loaders.sdf.actor import read_actor
from simkit.loaders.sdf.entity_names import named_elements, read_name
from simkit.loaders.sdf.frames import WORLD, Frame, Scope, world_pose
from simkit.loaders.sdf.include import entity_source
from simkit.loaders.sdf.joint import read_joints
from simkit.loaders.sdf.light import read_light
from simkit.loaders.sdf.load_context import EntitySource, ModelDraft, NamedElement, SdfFile, Workspace
from simkit.loaders.sdf.model import (
    build_model,
    declare_elements,
    declare_model,
    merge_model,
    model_sources,
    place_model,
    read_frames,
    register_frame,
    rename_repeated,
)
from simkit.loaders.sdf.plugin import read_plugins
from simkit.loaders.sdf.population import population_sources
from simkit.loaders.sdf.saved_state import (
    apply_saved_poses,
    deleted_names,
    inserted_blocks,
    report_unapplied,
    saved_light_poses,
    saved_states,
)
from simkit.loaders.sdf.world_settings import (
    read_atmosphere,
    read_physics,
    read_quality,
    read_renderer,
    read_spherical_coordinates,
    read_surroundings,
)
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import SceneFrame, SceneLight, SceneWorld
from simkit.scene.world import ENTITY_SERVICES

_MAGNETIC = (5.5645e-6, 22.8758e-6, -42.3884e-6)


def world_scope(workspace: Workspace) -> Scope:
    """Return the scope of an empty world."""
    return Scope(Frame(WORLD, WORLD, WORLD), workspace.diagnostics)


@dataclass
class _WorldContent:
    """Content of a world, before any pose is resolved."""

    scope: Scope
    drafts: list[ModelDraft] = field(default_factory=list)
    lights: list[EntitySource] = field(default_factory=list)
    actors: list[EntitySource] = field(default_factory=list)
    frames: list[NamedElement] = field(default_factory=list)
    joints: list[NamedElement] = field(default_factory=list)
    proxies: list[Frame] = field(default_factory=list)
    plugins: list[Params] = field(default_factory=list)


def read_world(element: Params, file: SdfFile, workspace: Workspace) -> SceneWorld:
    """Return a world with all its content resolved."""
    diagnostics = workspace.diagnostics
    name = read_name(element, diagnostics, file.version) or "default"
    states = saved_states(element, name)
    content = _WorldContent(world_scope(workspace))
    content.plugins.extend(element.all("plugin"))
    for source in _entity_sources(element, name, states, file, workspace):
        _add_entity(source, content, workspace)
    content.frames += declare_elements(element, "frame", "the world", "", file, content.scope)
    content.joints += declare_elements(element, "joint", "the world", "", file, content.scope)
    apply_saved_poses(states, content.drafts)
    for draft in content.drafts:
        place_model(draft)
        report_unapplied(draft)
    physics, gravity = read_physics(element)
    light_poses = saved_light_poses(states)
    owner = element.choice("entity_services", ENTITY_SERVICES, "auto")
    return SceneWorld(
        name=name,
        gravity=gravity,
        magnetic_field=element.vector3("magnetic_field", _MAGNETIC),
        physics=physics,
        models=tuple(build_model(draft, False, workspace) for draft in content.drafts),
        lights=tuple(_light(source, content.scope, light_poses.get(source.name)) for source in content.lights),
        frames=(*read_frames(content.frames), *(_proxy_frame(p, content.scope) for p in content.proxies)),
        joints=read_joints(content.joints, ""),
        plugins=read_plugins(content.plugins, ""),
        surroundings=read_surroundings(element),
        spherical_coordinates=read_spherical_coordinates(element),
        quality=read_quality(element),
        renderer=read_renderer(element),
        gazebo_quirks=element.boolean("gazebo_quirks", False),
        entity_services=None if owner == "auto" else owner,
        where=element.where,
        wind=element.block("wind").vector3("linear_velocity", (0.0, 0.0, 0.0)),
        atmosphere=read_atmosphere(element),
        actors=tuple(
            read_actor(s, _pose_of(s, "actor", content.scope), content.scope, workspace) for s in content.actors
        ),
    )


def _entity_sources(
    element: Params, world: str, states: list[Params], file: SdfFile, workspace: Workspace
) -> list[EntitySource]:
    """Return models, lights and actors: written, included, populated, and added or removed by a saved state.

    A model of a repeated name gets another name, as in Gazebo Classic.
    """
    diagnostics = workspace.diagnostics
    sources: list[EntitySource] = []
    for kind in ("light", "actor"):
        named = named_elements(element.all(kind), "the world", diagnostics, file.version, "left out")
        sources += [entity_source(e, name, file) for name, e in named]
    sources += model_sources(element, file, workspace)
    for population in element.all("population"):
        sources += population_sources(population, world, file, workspace)
    for block in inserted_blocks(states):
        sources += model_sources(block, file, workspace)
        named = named_elements(block.all("light"), "the saved state", diagnostics, file.version, "left out")
        sources += [entity_source(e, name, file) for name, e in named]
    deleted = deleted_names(states)
    for source in sources:
        if source.name in deleted:
            source.element.mark_all_read()
    return rename_repeated([source for source in sources if source.name not in deleted], "the world", diagnostics)


def _add_entity(source: EntitySource, content: _WorldContent, workspace: Workspace) -> None:
    """Register one entity under its name in the world."""
    kind = source.element.name
    if kind != "model":
        entities = content.lights if kind == "light" else content.actors
        if any(entity.name == source.name for entity in entities):
            source.element.mark_all_read()
            text = f"the world has two {kind}s named {source.name!r}; this one is left out"
            workspace.diagnostics.warning("SK-SDF-002", text, source.where)
        else:
            entities.append(source)
    elif source.merge:
        _merge_into_world(source, content, workspace)
    else:
        draft = declare_model(source, content.scope, "", workspace)
        if draft is not None:
            before = content.scope.names.get(source.name)
            register_frame(draft.frame, content.scope, source.file.version)
            if before is None:
                content.drafts.append(draft)


def _merge_into_world(source: EntitySource, content: _WorldContent, workspace: Workspace) -> None:
    """Add the content of an included model to the world; a model with links or grippers is an error."""
    for kind in ("link", "gripper"):
        for part in source.element.all(kind):
            part.mark_all_read()
            text = f"<{kind} name={part.attribute('name')!r}> of {source.name!r} cannot be merged into a world"
            workspace.diagnostics.error("SK-SDF-016", text, source.where, "include it without merge")
    if any(source.element.has(kind) for kind in ("link", "gripper")):
        return
    draft = ModelDraft(source, "", content.scope.root, content.scope)
    merge_model(draft, source, content.scope, workspace, WORLD)
    content.drafts += draft.models
    content.frames += draft.frames
    content.joints += draft.joints
    content.proxies += draft.proxies
    content.plugins += draft.plugins


def _proxy_frame(frame: Frame, scope: Scope) -> SceneFrame:
    body = scope.body(frame.name, frame.where, f"frame {frame.name!r}") if frame.attached_to else None
    return SceneFrame(frame.name, frame.scoped, world_pose(frame), "" if body is None else body.scoped)


def _pose_of(source: EntitySource, kind: str, scope: Scope) -> Pose:
    frame = Frame(source.name, kind, source.name, scope, source.pose, source.relative_to, where=source.where)
    return world_pose(frame)


def _light(source: EntitySource, scope: Scope, saved: Pose | None) -> SceneLight:
    pose = saved if saved is not None else _pose_of(source, "light", scope)
    return read_light(source.element, source.name, pose)
