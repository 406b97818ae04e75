"""Base class of the loaders, and what a load is asked for."""

from __future__ import annotations

import abc
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Protocol

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.resources.resolver import Resolver
from simkit.loaders.resources.xml_reader import Document
from simkit.pose import Pose
from simkit.scene import Mesh, Scene


class Triangles(Protocol):
    """A part of a mesh in metres: vertices of shape (n, 3) and the three vertex indices of each face."""

    @property
    def vertices(self) -> Any: ...

    @property
    def faces(self) -> Any: ...


MeshReader = Callable[[Mesh, Diagnostics, Where], Sequence[Triangles]]


@dataclass(frozen=True, slots=True)
class LoadRequest:
    """What the caller wants beside the file itself.

    Attributes:
        base: "auto", "fixed" or "floating", for a bare model.
        name, pose: replace those of a bare model.
        as_model: one model is wanted, where a file could be a world as well.
        mesh_reader: gives the triangles of a mesh, for automatic inertia; without it meshes have no volume.
    """

    resolver: Resolver
    diagnostics: Diagnostics
    xacro_args: Mapping[str, str] = field(default_factory=dict)
    base: str = "auto"
    name: str | None = None
    pose: Pose | None = None
    as_model: bool = False
    mesh_reader: MeshReader | None = None


class Loader(abc.ABC):
    """Turns one format into a `Scene`; `roots` are the names of its outermost element."""

    roots: ClassVar[tuple[str, ...]] = ()

    @abc.abstractmethod
    def load(self, document: Document, request: LoadRequest) -> Scene:
        """Reads the document; a mistake in it is a diagnostic, never an exception."""
