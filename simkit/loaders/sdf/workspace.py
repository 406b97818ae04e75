"""State that one load shares, and drafts: elements with their names, frames and files, before any pose is resolved."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.resources.loader import MeshReader
from simkit.loaders.resources.resolver import NEWEST_SDF, Resolver, sdf_version
from simkit.loaders.resources.xml_reader import Document, parse_file
from simkit.loaders.sdf.frames import Frame, Scope, pose_base
from simkit.loaders.sdf.older_versions import modernise, nest_flattened_models
from simkit.params import Params
from simkit.pose import IDENTITY, Pose

if TYPE_CHECKING:
    from simkit.loaders.mjcf.loader import MjcfFile


MAX_INCLUDE_DEPTH = 32
MAX_MODELS = 20_000


@dataclass(frozen=True, slots=True)
class SdfFile:
    """One SDF file (or text): its root, version and folder.

    Attributes:
        chain: the files that include one another down to this one.
        mjcf: the file in MuJoCo's own format that the root stands for.
        urdf: the `<robot>` that the root stands for.
    """

    root: Params
    version: tuple[int, int]
    folder: Path | None
    chain: tuple[str, ...] = ()
    mjcf: MjcfFile | None = None
    urdf: Params | None = None


@dataclass
class Workspace:
    """State of one load.

    Attributes:
        roots: the root element of every file read, for the report on unused elements.
        reported: what is said once however often it is met: missing pictures and meshes.
        changed: models that an include has changed, for the same report.
        places: the files that URIs named so far, by the folder of the file that names them.
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
    _documents: dict[Path, Document | None] = field(default_factory=dict)
    _robots: dict[Path, Params | None] = field(default_factory=dict)
    _mjcf_files: dict[Path, tuple[MjcfFile, Params] | None] = field(default_factory=dict)

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
        if document.root.name == "mujoco":
            return self._mjcf(document, path, (*chain, key))
        if document.root.name == "robot":
            return self._urdf(document, path, (*chain, key))
        if document.root.name not in ("sdf", "gazebo"):
            self.diagnostics.error(
                "SK-SDF-016", f"{path} begins with <{document.root.name}>, an included file begins with <sdf>", where
            )
            return None
        return self.file(document.root, path.parent, (*chain, key))

    def _urdf(self, document: Document, path: Path, chain: tuple[str, ...]) -> SdfFile | None:
        """An included robot in URDF or xacro, expanded once however often it is included."""
        from simkit.loaders.urdf.included_robot import (
            frames_document,  # it reads <gazebo> with the readers of this package
        )
        from simkit.loaders.xacro import expand, needs_expansion

        if path not in self._robots:
            expanded: Document | None = document
            if needs_expansion(document):
                expanded = expand(document, self.resolver, {}, self.diagnostics)
            self._robots[path] = None if expanded is None else expanded.root
        robot = self._robots[path]
        if robot is None:
            return None
        file = SdfFile(robot, (1, 11), path.parent, chain)
        return SdfFile(frames_document(file, self), (1, 11), path.parent, chain, urdf=robot)

    def _mjcf(self, document: Document, path: Path, chain: tuple[str, ...]) -> SdfFile | None:
        """An included file in MuJoCo's own format, read and compiled once however often it is included."""
        from simkit.loaders.mjcf.included_model import frames_document
        from simkit.loaders.mjcf.loader import open_mjcf

        if path not in self._mjcf_files:
            found = open_mjcf(document.root, document.path, self.resolver, self.diagnostics)
            root = None if found is None else frames_document(found, self.diagnostics)
            self._mjcf_files[path] = None if found is None or root is None else (found, root)
        known = self._mjcf_files[path]
        return None if known is None else SdfFile(known[1], (1, 7), path.parent, chain, known[0])

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
            self.diagnostics.warning(
                "SK-LOAD-004", f"SDF {text} is from 2012; it is read in today's spelling", root.where
            )
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
    pose = element.child("pose")
    return element.where if pose is None else pose.where


def local_pose(element: Params, scope: Scope, owner: Frame, what: str) -> Pose:
    """The pose of something inside a link (or joint) in that link's frame; `relative_to` may name another frame."""
    pose, base = read_pose(element)
    if not base:
        return pose
    frames = scope.chain(base)
    if frames is None:
        scope.unknown(base, f"{what}: the frame", pose_location(element))
        return pose
    return scope.resolve(owner).inverse() @ scope.pose_of(base) @ pose
