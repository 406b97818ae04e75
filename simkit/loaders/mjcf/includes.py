"""Collection of an MJCF file and all files that it includes or refers to in memory, so that MuJoCo opens no file.

Includes are replaced by their content, and asset files are read, only inside the resource folders. The text for MuJoCo
has one element per line. A line number in MuJoCo's messages can therefore be converted to the user's file and line.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Final
from xml.sax.saxutils import quoteattr  # this import also loads Python's network modules (30 ms)

from simkit.diagnostics import NOWHERE, Diagnostics, Where
from simkit.loaders.mjcf.asset_files import placeholder, read_asset
from simkit.loaders.mjcf.schema import drop_removed_attributes
from simkit.loaders.mjcf.size_limits import MOST_ELEMENTS
from simkit.loaders.resources.loader import MjcfText
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.xml_reader import parse_file
from simkit.number_text import counted
from simkit.params import Params

MAX_INCLUDE_DEPTH: Final = 32
MAX_MODEL_DEPTH: Final = 8

_FOLDER_OF: Final = {
    "mesh": "meshdir",
    "hfield": "meshdir",
    "skin": "meshdir",
    "flexcomp": "meshdir",
    "texture": "texturedir",
}
_FILES: Final = ("file", "fileright", "fileleft", "fileup", "filedown", "filefront", "fileback")


@dataclass
class _SharedFiles:
    """State that is shared by all files of one load."""

    resolver: Resolver
    diagnostics: Diagnostics
    models: dict[str, bytes] = field(default_factory=dict)
    assets: dict[str, bytes] = field(default_factory=dict)
    files: dict[str, tuple[Path, str]] = field(default_factory=dict)
    names: dict[Path, str] = field(default_factory=dict)
    lines: list[Where] = field(default_factory=list)
    count: int = 0


def gather_files(root: Params, path: Path | None, resolver: Resolver, diagnostics: Diagnostics) -> MjcfText:
    """Read a file and all files that it needs; a missing or refused file is an error in `diagnostics`."""
    return _FileGatherer(_SharedFiles(resolver, diagnostics), path).bundle(root)


class _FileGatherer:
    """Collector of the files of one model; each attached model has its own collector with the same `shared` state."""

    def __init__(self, shared: _SharedFiles, path: Path | None, chain: tuple[Path, ...] = ()) -> None:
        self.shared, self.path = shared, path
        self.folder = path.parent if path is not None else shared.resolver.base
        self.chain = (*chain, path.resolve()) if path is not None else chain
        self.included: set[Path] = {path.resolve()} if path is not None else set()
        self.origins: dict[str, str] = {}
        self.folders = {"meshdir": "", "texturedir": ""}
        self.strips = False

    def bundle(self, root: Params) -> MjcfText:
        complete = self._with_includes(root, self.folder, 0)
        drop_removed_attributes(complete)
        self._settings(complete)
        self._assets(complete)
        first = len(self.shared.lines)
        text: list[str] = []
        self._write(complete, text)
        return MjcfText(
            root=complete,
            text="\n" * first + "".join(text),
            models=self.shared.models,
            assets=self.shared.assets,
            lines=tuple(self.shared.lines),
            origins=self.origins,
            files=self.shared.files,
            file=None if self.path is None else str(self.path),
        )

    # ------------------------------------------------------------------ includes

    def _with_includes(self, element: Params, folder: Path | None, depth: int) -> Params:
        """Return a copy of an element in which every include is replaced by its content."""
        children: list[Params] = []
        for child in element.children:
            if child.name == "include":
                children += self._included(child, folder, depth)
            else:
                children.append(self._with_includes(child, folder, depth))
        self.shared.count += 1
        if self.shared.count == MOST_ELEMENTS * 10:
            self.shared.diagnostics.error(
                "SK-MJCF-005", f"more than {counted(self.shared.count, 'element')}", element.where
            )
        return Params(element.name, "", dict(element.attributes), children, element.where, self.shared.diagnostics)

    def _included(self, include: Params, folder: Path | None, depth: int) -> list[Params]:
        diagnostics = self.shared.diagnostics
        name = include.attribute("file")
        if not name:
            diagnostics.error("SK-MJCF-006", "<include> needs the attribute file='...'", include.where)
            return []
        if depth >= MAX_INCLUDE_DEPTH:
            diagnostics.error("SK-MJCF-006", f"includes are nested deeper than {MAX_INCLUDE_DEPTH}", include.where)
            return []
        path = self._search(name, include.where, (self.folder, folder))
        if path is None:
            return []
        if path.resolve() in self.included:
            hint = "use <asset><model .../></asset> and <attach .../> for several copies"
            # `include.error` would report past `diagnostics`, and the file with this error would be compiled
            message = f"{name} is included twice; MJCF allows this only once"
            diagnostics.error("SK-MJCF-006", message, include.where, hint)
            return []
        self.included.add(path.resolve())
        document = parse_file(path, diagnostics)
        if document is None:
            return []
        complete = self._with_includes(document.root, path.parent, depth + 1)
        model = document.root.attribute("model") if document.root.name == "mujoco" else ""
        if not complete.children:
            diagnostics.error("SK-MJCF-006", f"the included file {name} is empty", include.where)
        for section in complete.children if model else ():
            if section.name == "worldbody":
                self._note_origins(section, model)
        return complete.children

    def _note_origins(self, section: Params, model: str) -> None:
        for child in section.children:
            if child.name == "body":
                self.origins.setdefault(child.attribute("name"), model)
            elif child.name in ("frame", "replicate"):
                self._note_origins(child, model)

    def _search(self, name: str, where: Where, folders: tuple[Path | None, ...]) -> Path | None:
        """Find a file in the first of several folders that contains it; otherwise record an error."""
        resolver = self.shared.resolver
        for folder in folders:
            path, _ = resolver.search(name, folder)
            if path is not None and path.is_file():
                return path
        path = resolver.resolve(name, where, self.shared.diagnostics, folders[0])
        if path is not None and not path.is_file():
            self.shared.diagnostics.error("SK-MJCF-006", f"{name} is not a file", where)
            return None
        return path

    # ------------------------------------------------------------------ files

    def _settings(self, root: Params) -> None:
        """Read the asset folders from the `<compiler>` elements, and remove these attributes from the tree."""
        for element in root.children:
            if element.name != "compiler":
                continue
            both = element.attributes.pop("assetdir", None)
            for name in self.folders:
                folder = element.attributes.pop(name, None)
                self.folders[name] = folder if folder is not None else both if both is not None else self.folders[name]
            strips = element.attributes.pop("strippath", None)
            self.strips = self.strips if strips is None else strips == "true"

    def _assets(self, root: Params) -> None:
        stack = [root]
        while stack:
            element = stack.pop()
            for attribute in _FILES:
                if element.attributes.get(attribute) and element.name in (*_FOLDER_OF, "model"):
                    self._asset(element, attribute)
            stack += reversed(element.children)

    def _asset(self, element: Params, attribute: str) -> None:
        """Read the file of an attribute into memory, and set the attribute to the file's name in memory."""
        written = element.attributes[attribute]
        if element.name == "model":
            self._model(element, written)
            return
        name = written.replace("\\", "/")
        if self.strips:
            name = name.rsplit("/", 1)[-1]
        if attribute == "file" and not element.attribute("name") and element.name in ("mesh", "hfield", "texture"):
            element.attributes["name"] = PurePosixPath(name).stem
        folder = self.folders[_FOLDER_OF[element.name]]
        if folder and "://" not in name and not name.startswith("/"):
            name = f"{folder.rstrip('/')}/{name}"
        path = self._existing(element, name)
        known = self.shared.names.get(path) if path is not None else None
        if known is None:
            content = placeholder(element.name)
            if path is not None:
                content = (path.suffix, read_asset(path, element.name, element.where, self.shared.diagnostics))
            known = self._stored(path or Path(name), content, written)
            if path is not None:
                self.shared.names[path] = known
        element.attributes[attribute] = known

    def _existing(self, element: Params, name: str) -> Path | None:
        resolver, diagnostics = self.shared.resolver, self.shared.diagnostics
        path, _ = resolver.search(name, self.folder)
        if path is not None and path.is_file():
            return path
        problems = Diagnostics()
        path = resolver.resolve(name, element.where, problems, self.folder)
        if path is not None and not path.is_file():
            problems.error("SK-MJCF-006", f"{name} is not a file", element.where)
        for problem in problems:
            is_missing = resolver.missing_meshes and problem.code == "SK-URI-001"
            severity = "warning" if is_missing else problem.severity
            diagnostics.add(severity, problem.code, problem.message, element.where, problem.hint)
        return None

    def _stored(self, path: Path, content: tuple[str, bytes], written: str) -> str:
        suffix, data = content
        stem = "".join(c if c.isascii() and c.isalnum() else "_" for c in path.stem)[:40]
        name = f"{len(self.shared.assets)}_{stem}{suffix.lower()}"
        self.shared.assets[name] = data
        self.shared.files[name] = (path, written)
        return name

    def _model(self, element: Params, written: str) -> None:
        """Read an attached model like the main file, and set the attribute `file` to the model's name in memory."""
        diagnostics = self.shared.diagnostics
        element.attributes["file"] = "missing.xml"
        path = self._search(written, element.where, (self.folder,))
        if path is None:
            return
        if path.resolve() in self.chain or len(self.chain) >= MAX_MODEL_DEPTH:
            problem = f"attaches itself, or is nested in more than {MAX_MODEL_DEPTH - 1} models"
            diagnostics.error("SK-MJCF-006", f"the model {written} {problem}", element.where)
            return
        document = parse_file(path, diagnostics)
        if document is None:
            return
        if document.root.name != "mujoco":
            element.error("SK-MJCF-006", f"{written} begins with <{document.root.name}>, but must be MJCF")
            return
        below = _FileGatherer(self.shared, path, self.chain).bundle(document.root)
        if not element.attribute("name"):
            element.attributes["name"] = document.root.attribute("model") or path.stem
        name = f"{len(self.shared.models)}_model.xml"
        self.shared.models[name] = below.text.encode()
        element.attributes["file"] = name
        element.attributes.pop("content_type", None)

    # ------------------------------------------------------------------ text

    def _write(self, root: Params, text: list[str]) -> None:
        """Write the text of an element, one tag per line."""
        stack: list[Params | str] = [root]
        while stack:
            item = stack.pop()
            if isinstance(item, str):
                text.append(f"</{item}>\n")
                self.shared.lines.append(NOWHERE)
                continue
            attributes = "".join(f" {k}={quoteattr(_one_line(v))}" for k, v in item.attributes.items())
            text.append(f"<{item.name}{attributes}{'' if item.children else '/'}>\n")
            self.shared.lines.append(item.where)
            if item.children:
                stack.append(item.name)
                stack += reversed(item.children)


def _one_line(text: str) -> str:
    return text.replace("\r", " ").replace("\n", " ").replace("\t", " ")
