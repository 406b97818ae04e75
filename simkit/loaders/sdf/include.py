"""Reader of `<include>`: a model, light or actor of another file, with its own name and pose."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.loaders.resources.bundled_models import builtin_model, turtlebot3_uri
from simkit.loaders.resources.model_folder import CLASSIC_SDF, model_file
from simkit.loaders.resources.uri_resolver import NOT_FOUND_CODES, with_known_scheme
from simkit.loaders.resources.xml_reader import parse_text
from simkit.loaders.sdf.entity_names import read_name
from simkit.loaders.sdf.experimental_params import BLOCK, apply_changes
from simkit.loaders.sdf.load_context import EntitySource, SdfFile, Workspace, pose_location, read_pose
from simkit.params import Params

_ENTITIES = ("model", "light", "actor")
_MOST_LISTED = 30


def read_inline_entity(element: Params, file: SdfFile, workspace: Workspace) -> EntitySource | None:
    """Return a `<model>` or `<light>` that the file itself contains; None if it has no name."""
    name = read_name(element, workspace.diagnostics, file.version)
    if not name:
        return None
    placement = element.attribute("placement_frame") if element.name == "model" else ""
    return replace(entity_source(element, name, file), placement=placement, pose_where=pose_location(element))


def entity_source(element: Params, name: str, file: SdfFile) -> EntitySource:
    """Return a named element of a file with its pose."""
    pose, base = read_pose(element)
    return EntitySource(name, element, file, pose, base, where=element.where)


def read_include(include: Params, file: SdfFile, workspace: Workspace) -> EntitySource | None:
    """Return the entity that an `<include>` loads; None, with an error recorded, if it is unusable."""
    uri = include.text("uri", required=True)
    name = include.text("name", "")
    fixed = include.boolean("static", False) if include.has("static") else None
    placement = include.text("placement_frame", "")
    plugins = tuple(include.all("plugin"))
    placed = include.has("pose")
    pose, base = read_pose(include)
    document = _open_include(uri, include, file, workspace) if uri else None
    element = None if document is None else _only_entity(document, uri, include, workspace)
    if document is None or element is None:
        return None
    merge = include.attribute("merge", "false").lower() in ("true", "1")
    if document.included is not None and (merge or include.has(BLOCK)):
        code, reason, hint = document.included.fixed_content
        include.error(code, f"{uri} is {reason}: it cannot be merged or changed by its include", hint=hint)
        include.all(BLOCK)
        return None
    element = _with_changes(include, element, document, workspace)
    file_pose, own_base = read_pose(element)
    own_name = name or read_name(element, workspace.diagnostics, document.version)
    if not own_name:
        return None
    if placement and not placed:
        include.error("SK-SDF-016", "<placement_frame> of an include needs a <pose> in the same include")
    if merge and element.name != "model":
        include.error("SK-SDF-016", f"only a model can be merged, but {uri} contains a <{element.name}>")
        return None
    return EntitySource(
        name=own_name,
        element=element,
        file=document,
        pose=pose if placed else file_pose,
        relative_to=base if placed else own_base,
        static=fixed,
        placement=placement or (element.attribute("placement_frame") if element.name == "model" else ""),
        plugins=plugins,
        merge=merge,
        where=include.where,
        pose_where=pose_location(include if placed else element),
    )


def _with_changes(include: Params, element: Params, file: SdfFile, workspace: Workspace) -> Params:
    """Return a copy of the included model with the include's changes; without changes, the model itself."""
    blocks = include.all(BLOCK)
    if not blocks:
        return element
    element.mark_all_read()
    changed = element.copied()
    workspace.changed.append(changed)
    for block in blocks:
        apply_changes(block, changed, partial(_included_name, file=file, workspace=workspace))
    return changed


def _included_name(include: Params, file: SdfFile, workspace: Workspace) -> str:
    """Return the name of an include's model.

    Problems are not reported here, because simkit reads the include again later and reports them then.
    """
    name = include.text("name", "")
    uri = include.text("uri", "")
    if name or not uri:
        return name
    preliminary = workspace.quiet()
    document = _open_include(uri, include, file, preliminary)
    element = None if document is None else _only_entity(document, uri, include, preliminary)
    return "" if element is None else element.attribute("name").strip()


def _open_include(uri: str, include: Params, file: SdfFile, workspace: Workspace) -> SdfFile | None:
    resolver, diagnostics = workspace.resolver, workspace.diagnostics
    place = include.child_or_self("uri")
    chosen = turtlebot3_uri(uri, place.where, diagnostics)
    if chosen is None:
        return None
    uri = with_known_scheme(chosen)
    if uri != chosen:
        diagnostics.warning("SK-URI-004", f"{chosen}: unknown scheme, {uri} is used", place.where)
    path = workspace.places.get((uri, file.folder)) or resolver.search(uri, file.folder)[0]
    if path is None:
        text = builtin_model(uri)
        if text is not None:
            workspace.has_found = True
            root = parse_text(text, diagnostics, uri)
            return None if root is None else workspace.file(root, None, (*file.chain, uri))
        problems = Diagnostics()
        path = resolver.resolve(uri, place.where, problems, file.folder)
        is_missing = path is None and all(problem.code in NOT_FOUND_CODES for problem in problems)
        workspace.missing += [(uri, problem) for problem in problems if is_missing]
        diagnostics.extend(() if is_missing else problems)
    if path is not None and path.is_dir():
        path = model_file(path, place.where, diagnostics, resolver.allows)
    if path is None:
        return None
    workspace.has_found = True
    workspace.places[uri, file.folder] = path
    return workspace.open(path, place.where, file.chain)


def report_missing(workspace: Workspace, is_world: bool) -> None:
    """Report the includes that are not found.

    In a world with other includes they are left out with one warning for each cause, because Gazebo continues without
    them. Otherwise each is an error.
    """
    diagnostics = workspace.diagnostics
    if not (is_world and workspace.has_found):
        diagnostics.extend(problem for _, problem in workspace.missing)
        return
    for code in dict.fromkeys(problem.code for _, problem in workspace.missing):
        same = [(uri, problem) for uri, problem in workspace.missing if problem.code == code]
        first = same[0][1]
        lines: dict[str, list[str]] = {}
        for uri, problem in same:
            place = str(problem.line) if problem.file == first.file else f"{problem.file}:{problem.line}"
            lines.setdefault(uri, []).append(place)
        message = first.message
        if len(lines) > 1:
            listed = [f"{uri} (line {', '.join(places[:5])})" for uri, places in lines.items()]
            more = f" and {len(listed) - _MOST_LISTED} more" if len(listed) > _MOST_LISTED else ""
            message = f"{len(listed)} included models are not found: {', '.join(listed[:_MOST_LISTED])}{more}"
        effect = "; the world runs without " + ("it" if len(lines) == 1 else "them")
        diagnostics.warning(code, message + effect, Where(first.file, first.line), first.hint)


def _only_entity(file: SdfFile, uri: str, include: Params, workspace: Workspace) -> Params | None:
    """Return the one model, light or actor of an included file.

    In files of Gazebo Classic, the first one is used, a model before an actor and an actor before a light, as in its
    versions of sdformat; newer versions refuse such a file.
    """
    entities = [c for name in _ENTITIES for c in file.root.all(name)]
    if len(entities) != 1:
        contained = ", ".join(f"<{e.name}>" for e in entities) or "none"
        world = "; it also contains a <world>" if file.root.has("world") else ""
        near = did_you_mean("model", [c.name for c in file.root.children]) if not entities else ""
        message = f"{uri} must contain exactly one model, light or actor; it contains {contained}{world}"
        if entities and file.version <= CLASSIC_SDF:
            entities.sort(key=lambda entity: ("model", "actor", "light").index(entity.name))
            include.warning("SK-SDF-016", f"{message}; the first <{entities[0].name}> is used, as in Gazebo Classic")
            for entity in entities[1:]:
                entity.mark_all_read()
            return entities[0]
        workspace.diagnostics.error("SK-SDF-016", message, include.where, near)
        return None
    return entities[0]
