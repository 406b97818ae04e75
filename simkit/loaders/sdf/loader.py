"""Reader of the outermost `<sdf>`: worlds, or one bare model."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

from simkit.diagnostics import did_you_mean
from simkit.loaders.resources.loader import Loader, LoadRequest
from simkit.loaders.resources.xml_reader import Document
from simkit.loaders.sdf.include import read_include, read_inline_entity, report_missing
from simkit.loaders.sdf.light import read_light
from simkit.loaders.sdf.load_context import EntitySource, SdfFile, Workspace
from simkit.loaders.sdf.model import build_model, declare_model, place_model
from simkit.loaders.sdf.unread_elements import report_unread
from simkit.loaders.sdf.world import read_world, world_scope
from simkit.scene import Scene, SceneModel


class SdfLoader(Loader):
    """Loader of Gazebo's format, versions 1.0 to 1.12."""

    roots: ClassVar[tuple[str, ...]] = ("sdf", "gazebo")

    def load(self, document: Document, request: LoadRequest) -> Scene:
        resolver = request.resolver.around(document.folder)
        workspace = Workspace.of(request, resolver)
        chain = (str(document.path.resolve()),) if document.path is not None else ("",)
        folder = document.folder or request.resolver.base
        file = workspace.file(document.root, folder, chain)
        scene = _read(file, document, request, workspace)
        report_missing(workspace, is_world=bool(scene.worlds))
        for root in workspace.roots.values():
            report_unread(root)
        for model in workspace.changed:
            report_unread(model, model.name)
        return scene


def _read(file: SdfFile, document: Document, request: LoadRequest, workspace: Workspace) -> Scene:
    root = file.root
    name = None if document.path is None else str(document.path)
    worlds = tuple(read_world(w, file, workspace) for w in root.all("world"))
    seen: set[str] = set()
    for world in worlds:
        if world.name in seen:
            workspace.diagnostics.error("SK-SDF-002", f"the file has two worlds named {world.name!r}", world.where)
        seen.add(world.name)
    if len(worlds) > 1:
        message = f"the file has {len(worlds)} worlds; only the first, {worlds[0].name!r}, runs"
        workspace.diagnostics.note("SK-SDF-031", message, worlds[1].where)
    if worlds:
        return Scene(worlds, None, name)
    source = _bare(file, workspace)
    if source is None:
        return Scene((), None, name)
    if source.element.name == "light":
        return Scene((), None, name, read_light(source.element, source.name, source.pose))
    return Scene((), _model(source, request, workspace), name)


def _bare(file: SdfFile, workspace: Workspace) -> EntitySource | None:
    """Return the one model (or light) of a file without a world."""
    root = file.root
    entities = [*root.all("model"), *root.all("light")]
    actors = root.all("actor")
    for actor in actors:
        actor.mark_all_read()
        actor.warning("SK-SDF-012", "<actor>: actors are not simulated")
    includes = root.all("include")
    if not entities and includes:
        return read_include(includes[0], file, workspace)
    if not entities:
        if not actors:
            near = next((h for c in root.children if (h := did_you_mean(c.name, ("world", "model", "light")))), "")
            root.error("SK-SDF-026", f"<{root.name}> contains neither a world nor a model", near)
        return None
    for extra in entities[1:]:
        extra.mark_all_read()
        element = f"<{extra.name} name={extra.attribute('name')!r}>"
        extra.error("SK-SDF-028", f"{element}: a file without a world can have only one model", "add a <world>")
    return read_inline_entity(entities[0], file, workspace)


def _model(source: EntitySource, request: LoadRequest, workspace: Workspace) -> SceneModel | None:
    if request.name is not None:
        source = replace(source, name=request.name)
    if request.pose is not None:
        source = replace(source, pose=request.pose, relative_to="", placement="")
    draft = declare_model(source, world_scope(workspace), "", workspace)
    if draft is None:
        return None
    place_model(draft)
    return build_model(draft, False, workspace, request.base)
