"""State that one load shares, and drafts: elements with their names, frames and files, before any pose is resolved."""

from __future__ import annotations

import abc
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.resources.loader import Loader, LoadRequest, MeshReader, MjcfParser
from simkit.loaders.resources.model_folder import NEWEST_SDF, sdf_version
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.xml_reader import Document, parse_file
from simkit.loaders.sdf.entity_names import named_elements
from simkit.loaders.sdf.frames import Frame, Scope, pose_base
from simkit.loaders.sdf.version_upgrade import modernise, nest_flattened_models
from simkit.params import Params
from simkit.pose import IDENTITY, Pose
from simkit.scene import SceneModel

MAX_INCLUDE_DEPTH = 32
MAX_MODELS = 20_000


class IncludedModel(abc.ABC):
    """A model of another format that an SDF file includes.

    Attributes:
        version: of SDF, in which `frames` is written.
        frames: an `<sdf>` with the model's links, joints and frames, which poses and joints of the including file use.
        fixed_content: code, reason and hint of the error that such a model can be neither merged nor changed.
    """

    version: ClassVar[tuple[int, int]]
    fixed_content: ClassVar[tuple[str, str, str]]
    frames: Params

    @abc.abstractmethod
    def build(self, draft: ModelDraft, static: bool, workspace: Workspace, base: str) -> SceneModel:
        """The model as the including file has named and placed it.

        Args:
            static: whether it, or what it lies in, is static.
            base: "auto", "fixed" or "floating".
        """


class IncludableLoader(Loader):
    """A loader of another format whose models an SDF file may include."""

    @abc.abstractmethod
    def open_included(self, document: Document, workspace: Workspace) -> IncludedModel | None:
        """The model of an included file; None, with errors recorded, where it is none."""


@dataclass(frozen=True, slots=True)
class SdfFile:
    """One SDF file (or text): its root, version and folder.

    Attributes:
        chain: the files that include one another down to this one.
        included: the model of another format that the root stands for.
    """

    root: Params
    version: tuple[int, int]
    folder: Path | None
    chain: tuple[str, ...] = ()
    included: IncludedModel | None = None


@dataclass
class Workspace:
    """State of one load.

    Attributes:
        roots: the root element of every file read, for the report on unused elements.
        reported: what is said once however often it is met: missing pictures and meshes.
        changed: models that an include has changed, for the same report.
        places: the files that URIs named so far, by the folder of the file that names them.
        loaders, mjcf_parser: as in the `LoadRequest`.
    """

    resolver: Resolver
    diagnostics: Diagnostics
    roots: dict[str, Params] = field(default_factory=dict)
    changed: list[Params] = field(default_factory=list)
    mesh_reader: MeshReader | None = None
    places: dict[tuple[str, Path | None], Path] = field(default_factory=dict)
    models: int = 0
    unknown_materials: set[str] = field(default_factory=set)
    reported: set[str] = field(default_factory=set)
    loaders: Mapping[str, type[Loader]] = field(default_factory=dict)
    mjcf_parser: Callable[[], MjcfParser] | None = None
    _documents: dict[Path, Document | None] = field(default_factory=dict)
    _included: dict[Path, IncludedModel | None] = field(default_factory=dict)

    @classmethod
    def of(cls, request: LoadRequest, resolver: Resolver) -> Workspace:
        """The workspace of a load that begins."""
        return cls(
            resolver,
            request.diagnostics,
            mesh_reader=request.mesh_reader,
            loaders=request.loaders,
            mjcf_parser=request.mjcf_parser,
        )

    def quiet(self) -> Workspace:
        """A workspace to look ahead in: what it finds is said when the same is read in earnest."""
        return Workspace(self.resolver, Diagnostics(), loaders=self.loaders, mjcf_parser=self.mjcf_parser)

    def open(self, path: Path, where: Where, chain: tuple[str, ...]) -> SdfFile | None:
        """Reads an included SDF file, once however often it is included; None with an error recorded."""
        key = str(path.resolve())
        if key in chain:
            trail = " -> ".join(Path(p).name for p in (*chain[chain.index(key) :], key))
            self.diagnostics.error("SK-SDF-016", f"the include goes round in a circle: {trail}", where)
            return None
        if len(chain) >= MAX_INCLUDE_DEPTH:
            self.diagnostics.error("SK-SDF-016", f"includes are nested deeper than {MAX_INCLUDE_DEPTH}", where)
            return None
        if path not in self._documents:
            self._documents[path] = parse_file(path, self.diagnostics)
        document = self._documents[path]
        if document is None:
            return None
        if document.root.name in ("sdf", "gazebo"):
            return self.file(document.root, path.parent, (*chain, key))
        loader = self.loaders.get(document.root.name)
        if loader is None or not issubclass(loader, IncludableLoader):
            message = f"{path} begins with <{document.root.name}>, an included file begins with <sdf>"
            self.diagnostics.error("SK-SDF-016", message, where)
            return None
        if path not in self._included:
            self._included[path] = loader().open_included(document, self)
        included = self._included[path]
        if included is None:
            return None
        return SdfFile(included.frames, included.version, path.parent, (*chain, key), included)

    def file(self, root: Params, folder: Path | None, chain: tuple[str, ...]) -> SdfFile:
        """Notes a root element for the final report and reads its version."""
        text = root.attribute("version")
        version = sdf_version(text)
        if version is None:
            said = f"version {text!r}" if text else "no version"
            text = "1.6"
            self.diagnostics.warning("SK-LOAD-004", f"<{root.name}> has {said}; it is read as 1.6", root.where)
            version = (1, 6)
        elif version > NEWEST_SDF:
            newest = ".".join(str(n) for n in NEWEST_SDF)
            self.diagnostics.warning("SK-LOAD-004", f"SDF {text} is newer than {newest}, the newest known", root.where)
        key = chain[-1] if chain else ""
        if version < (1, 2) and key not in self.roots:
            message = f"SDF {text} is from 2012; it is read in today's spelling"
            self.diagnostics.warning("SK-LOAD-004", message, root.where)
        if key not in self.roots:
            self.roots[key] = nest_flattened_models(modernise(root, version), version)
        root = self.roots[key]
        return SdfFile(root, version, folder, chain)

    def count_model(self, where: Where) -> bool:
        """Whether one more model is within bounds."""
        self.models += 1
        if self.models == MAX_MODELS + 1:
            self.diagnostics.error("SK-SDF-016", f"more than {MAX_MODELS} models", where)
        return self.models <= MAX_MODELS


@dataclass(frozen=True)
class NamedElement:
    """One named element of a model: `scope` is where the names it uses are looked up."""

    name: str
    element: Params
    frame: Frame
    scope: Scope
    file: SdfFile

    def named(self, kind: str) -> list[tuple[str, Params]]:
        """The elements of a kind in it, with their names; a bad or a repeated name is an error."""
        owner = f"{self.frame.kind} {self.name!r}"
        return named_elements(self.element.all(kind), owner, self.element.diagnostics, self.file.version)

    def pose_of(self, inner: Params, what: str) -> Pose:
        """The pose of something inside a link (or joint) in that link's frame; `relative_to` may name another frame."""
        pose, base = read_pose(inner)
        if not base:
            return pose
        if self.scope.chain(base) is None:
            self.scope.report_unknown(base, f"{what}: the frame", pose_location(inner))
            return pose
        return self.scope.resolve(self.frame).inverse() @ self.scope.pose_of(base) @ pose


@dataclass(frozen=True)
class EntitySource:
    """A model or light, written in place or included.

    Attributes:
        pose, relative_to: where it stands, as written by whoever has the last word.
        static: forced by an include; None where it says nothing.
        placement: frame of the model that the pose speaks of; empty for the model frame.
        plugins: those that the include adds.
        merge: whether its content becomes part of the including model.
        where: the place of the model, or of the include.
        pose_where: the place of its pose.
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
    """A model whose names are known and whose poses are not resolved yet.

    Attributes:
        saved_links: what a saved state of the world says of its links.
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
    """The `<pose>` of an element and the frame it speaks of (empty for the default)."""
    return element.pose(name), pose_base(element.child(name))


def pose_location(element: Params) -> Where:
    """The line of an element's pose, or its own."""
    return element.child_or_self("pose").where
