"""State of one load, and drafts: elements with names, frames and files, before any pose is resolved."""

from __future__ import annotations

import abc
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

from simkit.diagnostics import Diagnostic, Diagnostics, Where, did_you_mean
from simkit.loaders.resources.loader import Loader, LoadRequest, MeshReader, MjcfParser
from simkit.loaders.resources.model_folder import NEWEST_SDF, sdf_version
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.xml_reader import Document, parse_file, report_template_texts
from simkit.loaders.sdf.entity_names import Repeated, named_elements
from simkit.loaders.sdf.frames import Frame, Scope, pose_base
from simkit.loaders.sdf.version_upgrade import modernise, nest_flattened_models
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene import SceneModel

MAX_INCLUDE_DEPTH = 32
MAX_MODELS = 20_000
_SHAPES = ("collision", "visual")


class IncludedModel(abc.ABC):
    """Model of another format that an SDF file includes.

    Attributes:
        version: SDF version of `frames`.
        frames: an `<sdf>` with the model's links, joints and frames, to which the including file can refer.
        fixed_content: error (code, reason, hint) to report if an `<include>` merges or changes a model of this format.
    """

    version: ClassVar[tuple[int, int]]
    fixed_content: ClassVar[tuple[str, str, str]]
    frames: Params

    @abc.abstractmethod
    def build(self, draft: ModelDraft, static: bool, workspace: Workspace, base: str) -> SceneModel:
        """Return the model with the name and the pose from the including file.

        Args:
            draft: the model with its name and frame.
            static: true if the model, or a model around it, is static.
            workspace: state of the load.
            base: "auto", "fixed" or "floating".
        """


class IncludableLoader(Loader):
    """Loader of another format whose models can be included in an SDF file."""

    @abc.abstractmethod
    def open_included(self, document: Document, workspace: Workspace) -> IncludedModel | None:
        """Return the model of an included file; None, with errors recorded, if the file has no usable model."""


@dataclass(frozen=True, slots=True)
class SdfFile:
    """SDF file (or text): its root, version and folder.

    Attributes:
        chain: files that include one another, from the outermost file to this one.
        included: model of another format that the root describes.
        arguments: values of the arguments of a xacro file.
    """

    root: Params
    version: tuple[int, int]
    folder: Path | None
    chain: tuple[str, ...] = ()
    included: IncludedModel | None = None
    arguments: Mapping[str, str] = field(default_factory=dict)


@dataclass
class Workspace:
    """State of one load.

    Attributes:
        roots: root element of every file that was read, for the report on unused elements.
        reported: names of missing textures and meshes that have been reported, because each is reported once.
        changed: models that an include has changed, for the report on unused elements.
        places: files found so far, by URI and by the folder of the file that names them.
        missing: URIs of includes that are not found, each with its error.
        has_found: True if an include was found.
        loaders, mjcf_parser: the same as in the `LoadRequest`.
    """

    resolver: Resolver
    diagnostics: Diagnostics
    roots: dict[str, Params] = field(default_factory=dict)
    changed: list[Params] = field(default_factory=list)
    mesh_reader: MeshReader | None = None
    places: dict[tuple[str, Path | None], Path] = field(default_factory=dict)
    missing: list[tuple[str, Diagnostic]] = field(default_factory=list)
    has_found: bool = False
    models: int = 0
    unknown_materials: set[str] = field(default_factory=set)
    reported: set[str] = field(default_factory=set)
    loaders: Mapping[str, type[Loader]] = field(default_factory=dict)
    mjcf_parser: Callable[[], MjcfParser] | None = None
    _documents: dict[Path, Document | None] = field(default_factory=dict)
    _included: dict[Path, IncludedModel | None] = field(default_factory=dict)

    @classmethod
    def of(cls, request: LoadRequest, resolver: Resolver) -> Workspace:
        """Create the workspace for a new load."""
        return cls(
            resolver,
            request.diagnostics,
            mesh_reader=request.mesh_reader,
            loaders=request.loaders,
            mjcf_parser=request.mjcf_parser,
        )

    def quiet(self) -> Workspace:
        """Return a workspace for a preliminary read, whose diagnostics are discarded."""
        return Workspace(self.resolver, Diagnostics(), loaders=self.loaders, mjcf_parser=self.mjcf_parser)

    def open(self, path: Path, where: Where, chain: tuple[str, ...]) -> SdfFile | None:
        """Read an included file; a file that is included repeatedly is parsed once.

        Returns:
            The file, or None, with an error recorded, if the file is unusable.
        """
        key = str(path.resolve())
        if key in chain:
            trail = " -> ".join(Path(p).name for p in (*chain[chain.index(key) :], key))
            self.diagnostics.error("SK-SDF-016", f"the files include one another in a circle: {trail}", where)
            return None
        if len(chain) >= MAX_INCLUDE_DEPTH:
            self.diagnostics.error("SK-SDF-016", f"includes are nested deeper than {MAX_INCLUDE_DEPTH}", where)
            return None
        if path not in self._documents:
            self._documents[path] = document = parse_file(path, self.diagnostics)
            if document is not None:
                report_template_texts(document, self.diagnostics)
        document = self._documents[path]
        if document is None:
            return None
        if document.root.name in ("sdf", "gazebo"):
            return self.file(document.root, path.parent, (*chain, key))
        loader = self.loaders.get(document.root.name)
        if loader is None or not issubclass(loader, IncludableLoader):
            message = f"{path} begins with <{document.root.name}>; an included file must begin with <sdf>"
            self.diagnostics.error("SK-SDF-016", message, where)
            return None
        if path not in self._included:
            self._included[path] = loader().open_included(document, self)
        included = self._included[path]
        if included is None:
            return None
        return SdfFile(included.frames, included.version, path.parent, (*chain, key), included)

    def file(self, root: Params, folder: Path | None, chain: tuple[str, ...]) -> SdfFile:
        """Register a root element for the final report and read its version."""
        text = root.attribute("version")
        version = sdf_version(text)
        if version is None:
            description = f"the invalid version {text!r}" if text else "no version"
            text = "1.6"
            self.diagnostics.warning("SK-LOAD-004", f"<{root.name}> has {description}; it is read as 1.6", root.where)
            version = (1, 6)
        elif version > NEWEST_SDF:
            newest = ".".join(str(n) for n in NEWEST_SDF)
            message = f"SDF {text} is newer than {newest}, the newest supported version"
            self.diagnostics.warning("SK-LOAD-004", message, root.where)
        key = chain[-1] if chain else ""
        if version < (1, 2) and key not in self.roots:
            message = f"SDF {text} is from 2012; it is converted to the current spelling"
            self.diagnostics.warning("SK-LOAD-004", message, root.where)
        if key not in self.roots:
            self.roots[key] = nest_flattened_models(modernise(root, version), version)
        root = self.roots[key]
        return SdfFile(root, version, folder, chain)

    def count_model(self, where: Where) -> bool:
        """Count one more model; return false above `MAX_MODELS`, with one error for the whole load."""
        self.models += 1
        if self.models == MAX_MODELS + 1:
            self.diagnostics.error("SK-SDF-016", f"more than {MAX_MODELS} models", where)
        return self.models <= MAX_MODELS


@dataclass(frozen=True)
class NamedElement:
    """Named element of a model; `scope` is the scope in which its references are looked up."""

    name: str
    element: Params
    frame: Frame
    scope: Scope
    file: SdfFile

    def named(self, kind: str) -> list[tuple[str, Params]]:
        """Return the children of a kind with their names; an invalid name is an error.

        A repeated name is a warning: a shape gets another name, anything else is left out, as in Gazebo Classic.
        """
        owner = f"{self.frame.kind} {self.name!r}"
        repeated: Repeated = "renamed" if kind in _SHAPES else "left out"
        return named_elements(self.element.all(kind), owner, self.element.diagnostics, self.file.version, repeated)

    def pose_of(self, inner: Params, what: str) -> Pose:
        """Return the pose of an element inside a link (or joint) in that link's frame.

        The element's `relative_to` can name another frame. For an unknown frame, Gazebo uses the frame of the link.
        """
        pose, base = read_pose(inner)
        if not base:
            return pose
        if self.scope.chain(base) is None:
            message = f"{what}: the frame {base!r} does not exist here; the pose is used in the frame of {self.name!r}"
            hint = did_you_mean(base, self.scope.all_names())
            inner.diagnostics.warning("SK-SDF-040", message, pose_location(inner), hint)
            return pose
        return self.scope.resolve(self.frame).inverse() @ self.scope.pose_of(base) @ pose


@dataclass(frozen=True)
class EntitySource:
    """Model or light, written in the file or included.

    Attributes:
        pose, relative_to: pose and its base frame, as written in the include or else in the element itself.
        static: `<static>` of the include; None if the include has no such element.
        placement: frame of the model that the pose applies to; empty for the model frame.
        plugins: plugins that the include adds.
        merge: true if its content becomes part of the including model.
        where: place of the model or of the include.
        pose_where: place of its pose.
    """

    name: str
    element: Params
    file: SdfFile
    pose: Pose = IDENTITY
    relative_to: str = ""
    static: bool | None = None
    placement: str = ""
    plugins: tuple[Params, ...] = ()
    merge: bool = False
    where: Where = field(default_factory=Where)
    pose_where: Where | None = None


@dataclass
class ModelDraft:
    """Model whose names are known and whose poses are not yet resolved.

    Attributes:
        saved_links: elements of its links in a saved state of the world.
    """

    source: EntitySource
    scoped: str
    frame: Frame
    scope: Scope
    links: list[NamedElement] = field(default_factory=list)
    joints: list[NamedElement] = field(default_factory=list)
    frames: list[NamedElement] = field(default_factory=list)
    proxies: list[Frame] = field(default_factory=list)
    merged: list[Scope] = field(default_factory=list)
    models: list[ModelDraft] = field(default_factory=list)
    plugins: list[Params] = field(default_factory=list)
    saved_links: list[Params] = field(default_factory=list)


def read_pose(element: Params, name: str = "pose") -> tuple[Pose, str]:
    """Return the `<pose>` of an element and its base frame (empty for the default)."""
    return element.pose(name), pose_base(element.child(name))


def pose_location(element: Params) -> Where:
    """Return the line of an element's pose, or of the element itself."""
    return element.child_or_self("pose").where
