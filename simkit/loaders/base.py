"""What a format's loader is."""

from __future__ import annotations

import abc
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

from simkit.diagnostics import Diagnostics
from simkit.loaders.resolver import Resolver
from simkit.loaders.xml import Document
from simkit.pose import Pose
from simkit.scene import Scene


@dataclass(frozen=True, slots=True)
class LoadRequest:
    """What the caller wants beside the file itself.

    Attributes:
        base: "auto", "fixed" or "floating", for a bare model.
        name, pose: replace those of a bare model.
    """

    resolver: Resolver
    diagnostics: Diagnostics
    xacro_args: Mapping[str, str] = field(default_factory=dict)
    base: str = "auto"
    name: str | None = None
    pose: Pose | None = None


class Loader(abc.ABC):
    """Turns one format into a `Scene`; `roots` are the names of its outermost element."""

    roots: ClassVar[tuple[str, ...]] = ()

    @abc.abstractmethod
    def load(self, document: Document, request: LoadRequest) -> Scene:
        """Reads the document; a mistake in it is a diagnostic, never an exception."""
