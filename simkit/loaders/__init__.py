"""Loaders: convert model and world files, or XML text, into a `Scene`.

The input is a path, a bundled name or XML text, with a `Resolver` that finds referenced files. The output is a `Scene`
and one diagnostic for every mistake. XML is used in this package only. No loader imports MuJoCo, builds a model or
raises an exception for a user's mistake. The caller passes MuJoCo's parser, which MJCF needs, and the reader of meshes.
`sdf` knows no other format. `urdf` and `mjcf` use the readers of `sdf`. All three packages use `resources`.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from urllib.parse import unquote

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.loaders.resources.bundled_models import (
    builtin_model,
    builtin_model_uri,
    bundled_models,
    bundled_names,
    bundled_worlds,
    find_bundled_model,
    find_bundled_world,
    turtlebot3_name,
)
from simkit.loaders.resources.loader import Loader, LoadRequest, MeshReader, MjcfParser
from simkit.loaders.resources.model_folder import model_file
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.uris import access_problem, sibling_names
from simkit.loaders.resources.xml_reader import (
    ALLOWED_FORMATS,
    Document,
    foreign_root_hint,
    parse_file,
    parse_text,
    report_template_texts,
)
from simkit.loaders.xacro import needs_expansion
from simkit.pose import Pose
from simkit.registry import Kinds
from simkit.run_spec import NamedValues, named_values
from simkit.scene import Scene

__all__ = ["Document", "LoadRequest", "Loader", "Resolver", "find_document", "load_scene", "loader_kinds"]


@lru_cache(maxsize=1)
def loader_kinds() -> Mapping[str, type[Loader]]:
    """Return the loader classes by the names of the root elements that they read."""
    return Kinds("simkit.loaders", "simkit.loaders", Loader, lambda cls: cls.roots, ("roots",))  # type: ignore[type-abstract]


def load_scene(
    source: str | os.PathLike[str],
    *,
    resolver: Resolver,
    diagnostics: Diagnostics,
    xacro_args: NamedValues | None = None,
    base: str = "auto",
    name: str | None = None,
    pose: Pose | None = None,
    as_model: bool = False,
    mesh_reader: MeshReader | None = None,
    mjcf_parser: Callable[[], MjcfParser] | None = None,
) -> Scene:
    """Read a file or XML text into a scene.

    Args:
        source: a path or URI, the name of a bundled model or world, or XML text (any text that contains `<`).
        resolver: finds the files that the source refers to.
        diagnostics: receives every problem; a user's mistake never raises.
        xacro_args: arguments of a xacro file.
        base: "auto", "fixed" or "floating", for a bare model (a file with one model and no world).
        name: replaces the name of a bare model.
        pose: replaces the pose of a bare model [m], in the world frame.
        as_model: reads the file as one model, even if the file could also be a world.
        mesh_reader: returns the triangles of a mesh, to compute its inertia; without a reader, meshes have no volume.
        mjcf_parser: returns MuJoCo's parser, which MJCF files need (`simkit.compiler.mjcf_parser.MjcfParser`).

    Returns:
        Everything that could be read; an empty scene if nothing could be read.
    """
    resolver.begin_load()
    document, _ = find_document(source, resolver, diagnostics, xacro_args, as_model=as_model)
    if document is None:
        return Scene()
    root = document.root
    kinds = loader_kinds()
    if root.name not in kinds:
        known = ", ".join(f"<{kind}>" for kind in kinds)
        hint = foreign_root_hint(root.name) or did_you_mean(root.name, kinds) or ALLOWED_FORMATS
        diagnostics.error("SK-LOAD-003", f"unknown root element <{root.name}>; known are {known}", root.where, hint)
        return Scene()
    request = LoadRequest(
        resolver=resolver,
        diagnostics=diagnostics,
        xacro_args=named_values(xacro_args, "xacro_args"),
        base=base,
        name=name,
        pose=pose,
        as_model=as_model,
        mesh_reader=mesh_reader,
        mjcf_parser=mjcf_parser,
        loaders=kinds,
    )
    scene = kinds[root.name]().load(document, request)
    resolver.report_choices(Where(root.where.file), diagnostics)
    return replace(scene, arguments=document.arguments) if document.arguments else scene


def find_document(
    source: str | os.PathLike[str],
    resolver: Resolver,
    diagnostics: Diagnostics,
    xacro_args: NamedValues | None = None,
    *,
    as_model: bool = False,
) -> tuple[Document | None, bool]:
    """Parse the file that a source refers to, and expand it if it is xacro.

    Args:
        source: see `load_scene`.
        resolver: see `load_scene`.
        diagnostics: see `load_scene`.
        xacro_args: see `load_scene`.
        as_model: true if the remedy for an unknown name lists models instead of worlds.

    Returns:
        The document, and true if it was expanded from xacro. The document is None, with an error recorded, if the
        source cannot be read.
    """
    is_uri = isinstance(source, str) and "://" in source and "<" not in source
    if is_uri:
        document = _document_of_uri(source, resolver, diagnostics)
    else:
        document = _document(source, resolver, diagnostics, as_model)
    if document is None:
        return None, False
    if not needs_expansion(document):
        report_template_texts(document, diagnostics)
        return document, False
    from simkit.loaders.xacro.expansion import expand  # 5 ms, and most files are not xacro

    return expand(document, resolver.around(document.folder), named_values(xacro_args, "xacro_args"), diagnostics), True


def _document_of_uri(source: str | os.PathLike[str], resolver: Resolver, diagnostics: Diagnostics) -> Document | None:
    uri = str(source)
    if uri.startswith("file://"):
        return _document(Path(unquote(uri.removeprefix("file://"))), resolver, diagnostics)  # in any folder, as a path
    text = builtin_model(uri) if resolver.search(uri, None)[0] is None else None
    if text is not None:
        return _document(text, resolver, diagnostics)
    path = resolver.resolve(uri, Where(uri), diagnostics, None)
    return None if path is None else _document(path, resolver, diagnostics)


def _document(
    source: str | os.PathLike[str], resolver: Resolver, diagnostics: Diagnostics, as_model: bool = False
) -> Document | None:
    if isinstance(source, str) and "<" in source:
        root = parse_text(source, diagnostics, builtin_model_uri(source))
        return None if root is None else Document(root, None, source.encode())
    path = Path(source)
    if not str(source):
        diagnostics.error("SK-LOAD-002", "the source is empty", hint="give a path, a bundled name or XML text")
        return None
    if problem := access_problem(path):
        shown = str(path) if len(str(path)) < 200 else f"{str(path)[:200]}..."
        diagnostics.error("SK-LOAD-002", f"cannot read the file: {problem}", Where(shown))
        return None
    if path.is_dir():
        problems = Diagnostics()
        model = model_file(path, Where(str(path)), problems, lambda file: resolver.allows(file, path))
        if model is None and (bundled := find_bundled_world(str(source)) or find_bundled_model(str(source))):
            return parse_file(bundled, diagnostics)  # the folder only has the name of a bundled file
        diagnostics.extend(problems)
        return None if model is None else parse_file(model, diagnostics)
    if not path.exists():
        name = turtlebot3_name(str(source), diagnostics)
        if name is None:
            return None
        bundled = find_bundled_world(name) or find_bundled_model(name)
        if bundled is None:
            near = sibling_names(path)
            near += bundled_names()
            hint = did_you_mean(path.name, near)
            if not hint and len(path.parts) == 1:
                kind, names = ("world", bundled_worlds())
                if as_model:
                    kind, names = ("model", sorted(filter(find_bundled_model, bundled_models())))
                hint = f"give a file, or a {kind} of simkit: {', '.join(names)}"
            diagnostics.error("SK-LOAD-002", "no such file", Where(str(path)), hint)
            return None
        path = bundled
    return parse_file(path, diagnostics)
