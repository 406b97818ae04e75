"""Reader of `<model>` in two steps: first all names (nested and merged models included), then poses and scene."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import replace

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.sdf.entity_names import FreeNames, named_elements, scoped
from simkit.loaders.sdf.frames import MODEL, WORLD, Frame, Scope, world_pose
from simkit.loaders.sdf.include import read_include, read_inline_entity
from simkit.loaders.sdf.joint import joint_link_name, read_joints
from simkit.loaders.sdf.link import read_link
from simkit.loaders.sdf.load_context import (
    EntitySource,
    ModelDraft,
    NamedElement,
    SdfFile,
    Workspace,
    pose_location,
    read_pose,
)
from simkit.loaders.sdf.plugin import read_plugins
from simkit.params import Params
from simkit.scene import SceneFrame, SceneModel

_MODEL_SETTINGS = ("static", "self_collide", "enable_wind", "allow_auto_disable")


def declare_model(source: EntitySource, outer: Scope, outer_scoped: str, workspace: Workspace) -> ModelDraft | None:
    """Register a model and all named elements in it.

    Returns:
        None if the limit of models is exceeded, or if the model only includes models that are not found.
    """
    if not workspace.count_model(source.where):
        return None
    model_name = scoped(outer_scoped, source.name)
    scope = Scope(Frame(source.name, "model", model_name), workspace.diagnostics)
    frame = Frame(source.name, "model", model_name, outer, source.pose, source.relative_to, where=source.where)
    frame.inside, frame.placement, frame.pose_where = scope, source.placement, source.pose_where
    draft = ModelDraft(source, model_name, frame, scope)
    missing = len(workspace.missing)
    _declare_content(draft, source.element, source.file, scope, workspace)
    draft.plugins.extend(source.plugins)
    if not draft.links and not draft.models and len(workspace.missing) > missing and not _is_static(source):
        source.element.mark_all_read()  # the missing includes are reported, not the links that they would contain
        return None
    _choose_canonical(draft, source.element, workspace)
    return draft


def register_frame(frame: Frame, scope: Scope, version: tuple[int, int]) -> None:
    """Register a frame under its name; from 1.7 on, siblings of all kinds share one set of names."""
    existing = scope.names.setdefault(frame.name, frame)
    if existing is frame:
        return
    line = existing.where.line
    text = f"{frame.kind} {frame.name!r} has the same name as a {existing.kind} (line {line})"
    if existing.kind == frame.kind or version >= (1, 7):
        scope.diagnostics.error("SK-SDF-002", f"{text}; siblings need different names", frame.where)
    else:
        scope.diagnostics.warning("SK-SDF-024", f"{text}; the name refers to the {existing.kind}", frame.where)


def _declare_content(draft: ModelDraft, element: Params, file: SdfFile, scope: Scope, workspace: Workspace) -> None:
    owner, names = f"model {draft.source.name!r}", draft.scoped
    draft.links += declare_elements(element, "link", owner, names, file, scope)
    for source in rename_repeated(list(model_sources(element, file, workspace)), owner, workspace.diagnostics):
        if source.element.name != "model":
            _report_non_model(source, workspace)
        elif source.merge:
            merge_model(draft, source, scope, workspace)
        else:
            nested = declare_model(source, scope, draft.scoped, workspace)
            if nested is not None:
                draft.models.append(nested)
                register_frame(nested.frame, scope, file.version)
    draft.joints += declare_elements(element, "joint", owner, names, file, scope)
    draft.frames += declare_elements(element, "frame", owner, names, file, scope)
    draft.plugins.extend(element.all("plugin"))


def model_sources(element: Params, file: SdfFile, workspace: Workspace) -> Iterable[EntitySource]:
    """Yield the models written in an element and those that it includes, in document order."""
    written, included = set(map(id, element.all("model"))), set(map(id, element.all("include")))
    for child in element.children:
        if id(child) in written:
            source = read_inline_entity(child, file, workspace)
        elif id(child) in included:
            source = read_include(child, file, workspace)
        else:
            continue
        if source is not None:
            yield source


def rename_repeated(sources: list[EntitySource], owner: str, diagnostics: Diagnostics) -> list[EntitySource]:
    """Return the sources with another name for each model whose name an earlier model has, with a warning."""
    free = FreeNames({source.name for source in sources})
    first: dict[str, EntitySource] = {}
    renamed = []
    for source in sources:
        if source.element.name == "model" and not source.merge:
            existing = first.setdefault(source.name, source)
            if existing is not source:
                text = f"{owner} has two models named {source.name!r} (the other at {existing.where})"
                source = replace(source, name=free.next(source.name))
                diagnostics.warning("SK-SDF-002", f"{text}; this one is named {source.name!r}", source.where)
        renamed.append(source)
    return renamed


def declare_elements(
    element: Params, kind: str, owner: str, outer: str, file: SdfFile, scope: Scope
) -> list[NamedElement]:
    """Register the links, joints or frames of a model (or a world) under their names.

    Args:
        element: the `<model>` or `<world>`.
        kind: link, joint or frame.
        owner: the model or the world, for messages.
        outer: scoped name of the model; empty for a world.
        file: file of the element.
        scope: scope that receives the names.
    """
    parts = []
    named = named_elements(element.all(kind), owner, scope.diagnostics, file.version)
    siblings = {name for name, _ in named}
    for written, child_element in named:
        name = _distinct_name(written, kind, siblings, scope, child_element.where)
        pose, base = read_pose(child_element)
        attached = ""
        if kind == "joint":
            child = joint_link_name(child_element, "child")
            attached = "" if child == WORLD else child
        elif kind == "frame":
            attached = child_element.attribute("attached_to")
        frame = Frame(name, kind, scoped(outer, name), scope, pose, base, attached, where=child_element.where)
        frame.pose_where = pose_location(child_element)
        register_frame(frame, scope, file.version)
        parts.append(NamedElement(name, child_element, frame, scope, file))
    return parts


def _distinct_name(name: str, kind: str, siblings: set[str], scope: Scope, where: Where) -> str:
    """Return the name of a link, joint or frame; `name_joint` if an element of another kind has that name.

    The suffixes are those of libsdformat.
    """
    existing = scope.names.get(name)
    if existing is None or existing.kind == kind:
        return name
    numbers = itertools.chain(("",), itertools.count())
    free = next(n for i in numbers if (n := f"{name}_{kind}{i}") not in scope.names and n not in siblings)
    text = f"{kind} {name!r} has the same name as a {existing.kind} (line {existing.where.line})"
    scope.diagnostics.warning("SK-SDF-024", f"{text}; it is named {free!r}, as in Gazebo", where)
    return free


def _report_non_model(source: EntitySource, workspace: Workspace) -> None:
    kind = source.element.name
    source.element.mark_all_read()
    message = f"a {kind} ({source.name!r}) cannot be included in a model".replace("a actor", "an actor")
    hint = "include it in the world" + (", or put it in a link" if kind == "light" else "")
    workspace.diagnostics.error("SK-SDF-016", message, source.where, hint)


def merge_model(draft: ModelDraft, source: EntitySource, scope: Scope, workspace: Workspace, base: str = MODEL) -> None:
    """Add the content of an included model to `draft`. A new frame at its pose replaces its model frame.

    Args:
        draft: the including model.
        source: the included model.
        scope: scope of the including model.
        workspace: state of the load.
        base: frame that the pose is relative to if the include names no frame.
    """
    name = f"_merged__{source.name}__{MODEL}"
    pose = source.pose
    if source.placement:
        alone = declare_model(replace(source, merge=False), scope, draft.scoped, workspace.quiet())
        pose = pose if alone is None else pose @ alone.scope.pose_of(source.placement, None, source.where).inverse()
    relative_to = source.relative_to or base
    proxy = Frame(name, "frame", scoped(draft.scoped, name), scope, pose, relative_to, where=source.where)
    register_frame(proxy, scope, (1, 12))
    inner = Scope(proxy, workspace.diagnostics, scope.names)
    first, models = len(draft.links), len(draft.models)
    _declare_content(draft, source.element, source.file, inner, workspace)
    canonical = source.element.attribute("canonical_link")
    proxy.attached_to = canonical or (draft.links[first].name if len(draft.links) > first else "")
    for nested in draft.models[models:]:
        if not proxy.attached_to and nested.scope.canonical:
            proxy.attached_to = f"{nested.source.name}::{nested.scope.canonical}"
    _report_lost(source, workspace)
    draft.plugins.extend(source.plugins)
    draft.proxies.append(proxy)
    draft.merged.append(inner)


def _report_lost(source: EntitySource, workspace: Workspace) -> None:
    """Report the settings of a merged model that are lost, because the merged model no longer exists."""
    lost = [name for name in _MODEL_SETTINGS if source.element.child(name) is not None]
    if source.static is not None and "static" not in lost:
        lost.insert(0, "static")
    source.element.child("pose")
    if lost:
        listed = ", ".join(f"<{name}>" for name in lost)
        message = f"the merge drops {listed} of the merged model {source.name!r}"
        workspace.diagnostics.note("SK-SDF-035", message, source.where)


def _choose_canonical(draft: ModelDraft, element: Params, workspace: Workspace) -> None:
    """Select the canonical link: the named link, else the first link, else the canonical link of a nested model."""
    scope = draft.scope
    canonical = element.attribute("canonical_link")
    frames = scope.chain(canonical) if canonical else None
    if canonical and (not frames or frames[-1].kind != "link"):
        scope.report_unknown(canonical, f"model {draft.source.name!r}: the canonical link", element.where)
    elif canonical:
        scope.canonical = canonical
    if not scope.canonical and draft.links:
        scope.canonical = draft.links[0].name
    for nested in draft.models if not scope.canonical else ():
        if nested.scope.canonical:
            scope.canonical = f"{nested.source.name}::{nested.scope.canonical}"
            break
    static = _is_static(draft.source)
    if not draft.links and not draft.models and not static:
        contained = dict.fromkeys(c.name for c in element.children)
        hint = f"it has only <{'>, <'.join(contained)}>" if contained else "add a <link>"
        workspace.diagnostics.error("SK-SDF-006", f"model {draft.source.name!r} has no link", element.where, hint)


def _is_static(source: EntitySource) -> bool:
    is_static = source.element.boolean("static", False)
    return is_static if source.static is None else source.static


def place_model(draft: ModelDraft) -> None:
    """Set the world poses of a model and its nested models."""
    draft.scope.world = world_pose(draft.frame)
    for merged in draft.merged:
        merged.world = draft.scope.world
    for nested in draft.models:
        place_model(nested)


def build_model(draft: ModelDraft, static: bool, workspace: Workspace, base: str = "auto") -> SceneModel:
    """Return the scene of a placed model; nested models of a static model are static."""
    source, element = draft.source, draft.source.element
    declared = _is_static(source)
    is_static = declared or static
    if source.file.included is not None:
        return source.file.included.build(draft, is_static, workspace, base)
    element.child("pose")
    windy = element.boolean("enable_wind", False)
    links = tuple(read_link(part, draft.scoped, is_static, windy, workspace) for part in draft.links)
    _report_defaults(draft, [link.name for link in links if not link.inertial.given], is_static)
    joints = read_joints(draft.joints, draft.scoped)
    canonical = draft.scope.chain(draft.scope.canonical) if draft.scope.canonical else None
    return SceneModel(
        name=source.name,
        scoped=draft.scoped,
        pose_world=draft.scope.world,
        static=is_static,
        declared_static=declared,
        self_collide=element.boolean("self_collide", False),
        canonical_link=canonical[-1].scoped if canonical else "",
        base=base,
        links=links,
        joints=joints,
        frames=(*read_frames(draft.frames), *(SceneFrame(p.name, p.scoped, world_pose(p)) for p in draft.proxies)),
        models=tuple(build_model(nested, is_static, workspace) for nested in draft.models),
        plugins=read_plugins(draft.plugins, draft.scoped),
        where=source.where,
        allow_auto_disable=element.boolean("allow_auto_disable", True),
        controls=_read_controls(element),
    )


def _read_controls(element: Params) -> tuple[Params, ...]:
    """Return the `<ros2_control>` blocks of a model unchanged; gz_ros2_control reads them as those of a URDF."""
    blocks = element.all("ros2_control")
    for block in blocks:
        block.mark_all_read()
    return tuple(blocks)


def read_frames(parts: Iterable[NamedElement]) -> tuple[SceneFrame, ...]:
    """Return the frames with the link that each is attached to; a frame without a link is an error."""
    frames = []
    for part in parts:
        body = part.scope.body(part.name, part.element.where, f"frame {part.name!r}")
        part.element.child("pose")
        carrier = "" if body is None else body.scoped
        frames.append(SceneFrame(part.name, part.frame.scoped, world_pose(part.frame), carrier))
    return tuple(frames)


def _report_defaults(draft: ModelDraft, names: list[str], static: bool) -> None:
    if names and not static:
        listed = ", ".join(names[:8]) + (f" and {len(names) - 8} more" if len(names) > 8 else "")
        message = f"model {draft.scoped!r}: no <inertial> in {listed}; SDF gives each 1 kg and 1 kg m2"
        draft.source.element.note("SK-SDF-015", message)
