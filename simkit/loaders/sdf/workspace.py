"""What every part of one load shares: resolver, diagnostics, the files read so far, and the bounds on includes."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.resolver import NEWEST_SDF, Resolver, sdf_version
from simkit.loaders.sdf.old import modern
from simkit.loaders.xml import Document, parse_file
from simkit.params import Params

MAX_INCLUDE_DEPTH = 32
MAX_MODELS = 50_000


@dataclass(frozen=True, slots=True)
class SdfFile:
    """One SDF file (or text): its root, version and folder.

    Attributes:
        chain: the files that include one another down to this one.
    """

    root: Params
    version: tuple[int, int]
    folder: Path | None
    chain: tuple[str, ...] = ()


@dataclass
class Workspace:
    """State of one load.

    Attributes:
        roots: the root element of every file read, for the report on unused elements.
    """

    resolver: Resolver
    diagnostics: Diagnostics
    roots: dict[str, Params] = field(default_factory=dict)
    models: int = 0
    unknown_materials: set[str] = field(default_factory=set)
    _documents: dict[Path, Document | None] = field(default_factory=dict)

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
        if document.root.name not in ("sdf", "gazebo"):
            self.diagnostics.error(
                "SK-SDF-016", f"{path} begins with <{document.root.name}>, an included file begins with <sdf>", where
            )
            return None
        return self.file(document.root, path.parent, (*chain, key))

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
        root = self.roots.setdefault(key, modern(root, version))
        return SdfFile(root, version, folder, chain)

    def count_model(self, where: Where) -> bool:
        """Whether one more model is within bounds."""
        self.models += 1
        if self.models == MAX_MODELS + 1:
            self.diagnostics.error("SK-SDF-016", f"more than {MAX_MODELS} models", where)
        return self.models <= MAX_MODELS
