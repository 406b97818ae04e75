"""Base class of the loaders, and what a load is asked for."""

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
    """A part of a mesh in metres: vertices of shape (n, 3) and the three vertex indices of each face."""

    @property
    def vertices(self) -> npt.NDArray[np.float64]: ...

    @property
    def faces(self) -> npt.NDArray[np.int32]: ...


MeshReader = Callable[[Mesh, Diagnostics, Where], Sequence[Triangles]]


@dataclass(frozen=True, slots=True, eq=False)
class MjcfText:
    """An MJCF file with everything that it includes and names, in memory, as MuJoCo reads it.

    Attributes:
        root: the outermost element with every include in place.
        text: what MuJoCo reads.
        models: the models that it attaches, by the names that the text uses.
        assets: its other files, likewise.
        lines: the place in the user's files of every line of the text (and of the models it attaches).
        origins: top-level body -> name of the model whose file it was included from.
        files: name among the assets -> (file, as written).
        file: the outermost file, or None for text.
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
        """The place of a line of the text."""
        return self.lines[line - 1] if 0 < line <= len(self.lines) else self.root.where


class CompiledMjcf(Protocol):
    """What MuJoCo makes of one MJCF file; loaders do not know MuJoCo's own types.

    Attributes:
        spec: the `mujoco.MjSpec`, in which every element has a name.
        model: the `mujoco.MjModel` that it compiles to.
        data: a `mujoco.MjData` as the file stands, with the poses of all bodies.
        document: makes a fresh `mujoco.MjSpec` of the same content.
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
        """Whether compiling turns a free body into the axes of its inertia."""
        ...

    @property
    def has_gravity(self) -> bool:
        """Whether the file's flags leave gravity on."""
        ...

    @property
    def allows_sleep(self) -> bool:
        """Whether the file's flags let sleep what rests."""
        ...

    def name(self, kind: str, number: int) -> str:
        """The name of an element; `kind` is MuJoCo's word (`BODY`, `JOINT`, ...)."""
        ...


class MjcfParser(Protocol):
    """MuJoCo's own parser and compiler: they alone can say what an MJCF file means."""

    def compile(self, file: MjcfText, diagnostics: Diagnostics, in_axes_of_file: bool = False) -> CompiledMjcf | None:
        """What a file compiles to on its own; None, with an error recorded, where it does not.

        Args:
            in_axes_of_file: bodies with a free joint keep the frame that the file gives them, whatever it says of
                aligning them with their inertia.
        """
        ...

    def schema_text(self) -> str:
        """MuJoCo's own table of elements and attributes."""
        ...


@dataclass(frozen=True, slots=True)
class LoadRequest:
    """What the caller wants beside the file itself.

    Attributes:
        base: "auto", "fixed" or "floating", for a bare model.
        name, pose: replace those of a bare model.
        as_model: one model is wanted, where a file could be a world as well.
        mesh_reader: gives the triangles of a mesh, for automatic inertia; without it meshes have no volume.
        mjcf_parser: gives MuJoCo's parser, which MJCF files need; it is called when there is such a file.
        loaders: the loader of every root element, for what a file includes.
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
    """Turns one format into a `Scene`; `roots` are the names of its outermost element."""

    roots: ClassVar[tuple[str, ...]] = ()

    @abc.abstractmethod
    def load(self, document: Document, request: LoadRequest) -> Scene:
        """Reads the document; a mistake in it is a diagnostic, never an exception."""
