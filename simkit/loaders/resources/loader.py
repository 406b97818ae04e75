"""Base class of the loaders, with the options of a load and the interfaces that the caller implements."""

from __future__ import annotations

import abc
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.xml_reader import Document
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import Mesh, Scene

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

MujocoObject = Any
"""A specification, model or data of MuJoCo, which loaders do not import."""


class Triangles(Protocol):
    """Part of a mesh in metres: vertices of shape (n, 3) and the three vertex indices of each face."""

    @property
    def vertices(self) -> npt.NDArray[np.float64]: ...

    @property
    def faces(self) -> npt.NDArray[np.int32]: ...


MeshReader = Callable[[Mesh, Diagnostics, Where], Sequence[Triangles]]


@dataclass(frozen=True, slots=True, eq=False)
class MjcfText:
    """MJCF file in memory, with all the files that it includes or refers to, in the form that MuJoCo reads.

    Attributes:
        root: the outermost element, with the content of every include.
        text: the XML text for MuJoCo.
        models: attached models, by the names that the text uses.
        assets: all other files, by the names that the text uses.
        lines: file and line in the user's files, first for each line of the attached models, then of the text.
        origins: top-level body -> name of the model whose file the body was included from.
        files: name in `assets` -> (path of the file, URI as written).
        file: the outermost file, or None for XML given as text.
    """

    root: Params
    text: str
    models: Mapping[str, bytes]
    assets: Mapping[str, bytes]
    lines: tuple[Where, ...]
    origins: Mapping[str, str]
    files: Mapping[str, tuple[Path, str]]
    file: str | None

    def where(self, line: int) -> Where:
        """Return the user's file and line for a line number of the text."""
        return self.lines[line - 1] if 0 < line <= len(self.lines) else self.root.where


class CompiledMjcf(Protocol):
    """Result of compiling one MJCF file with MuJoCo; loaders do not import MuJoCo's own types.

    Attributes:
        spec: the `mujoco.MjSpec`, in which every element has a name.
        model: the compiled `mujoco.MjModel`.
        data: a `mujoco.MjData` in the initial state of the file, with the poses of all bodies.
        document: returns a new `mujoco.MjSpec` of the same content.
    """

    @property
    def spec(self) -> MujocoObject: ...

    @property
    def model(self) -> MujocoObject: ...

    @property
    def data(self) -> MujocoObject: ...

    @property
    def document(self) -> Callable[[], MujocoObject]: ...

    @property
    def is_aligned(self) -> bool:
        """True if compiling rotates the frame of a free body into its axes of inertia."""
        ...

    @property
    def has_gravity(self) -> bool:
        """True if the file's flags keep gravity enabled."""
        ...

    @property
    def allows_sleep(self) -> bool:
        """True if the file's flags let bodies at rest sleep."""
        ...

    def name(self, kind: str, number: int) -> str:
        """Return the name of an element; `kind` is MuJoCo's object type (`BODY`, `JOINT`, ...)."""
        ...


class MjcfParser(Protocol):
    """MuJoCo's own parser and compiler, which alone define the meaning of an MJCF file."""

    def compile(self, file: MjcfText, diagnostics: Diagnostics, in_axes_of_file: bool = False) -> CompiledMjcf | None:
        """Compile a file on its own; return None, with an error recorded, if MuJoCo refuses the file.

        Args:
            file: the file and everything that it refers to.
            diagnostics: receives every problem.
            in_axes_of_file: true to keep the frames of free bodies as the file gives them, even if the file requests
                frames that are aligned with the inertia.
        """
        ...

    def schema_text(self) -> str:
        """Return MuJoCo's own table of elements and attributes."""
        ...


@dataclass(frozen=True, slots=True)
class LoadRequest:
    """Options of a load, besides the file itself.

    Attributes:
        base: "auto", "fixed" or "floating", for a bare model.
        name, pose: replacements for the name and the pose of a bare model.
        as_model: true to read the file as one model, even if the file could also be a world.
        mesh_reader: returns the triangles of a mesh, to compute its inertia; without a reader, meshes have no volume.
        mjcf_parser: returns MuJoCo's parser, which MJCF files need; called only for such a file.
        loaders: loader of every root element, for included files.
    """

    resolver: Resolver
    diagnostics: Diagnostics
    xacro_args: Mapping[str, str] = field(default_factory=dict)
    base: str = "auto"
    name: str | None = None
    pose: Pose | None = None
    as_model: bool = False
    mesh_reader: MeshReader | None = None
    mjcf_parser: Callable[[], MjcfParser] | None = None
    loaders: Mapping[str, type[Loader]] = field(default_factory=dict)


class Loader(abc.ABC):
    """Loader of one format, which returns a `Scene`; `roots` lists the names of the root elements that it reads."""

    roots: ClassVar[tuple[str, ...]] = ()

    @abc.abstractmethod
    def load(self, document: Document, request: LoadRequest) -> Scene:
        """Read the document; a mistake in the document is a diagnostic, never an exception."""
