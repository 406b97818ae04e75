"""Self-contained folder with a world and every file that it uses."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from html import escape
from pathlib import Path, PurePosixPath
from typing import Any, cast
from urllib.parse import unquote

from simkit import progress
from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.errors import InputError
from simkit.loaders import Document, Resolver, find_document
from simkit.loaders.resources.bundled_models import turtlebot3_uri
from simkit.loaders.resources.model_folder import model_file
from simkit.loaders.resources.uris import absolute_path
from simkit.loaders.resources.xml_reader import parse_file
from simkit.number_text import counted
from simkit.params import Params
from simkit.run_spec import NamedValues, PackagePaths
from simkit.writers.asset_folder import companion_files
from simkit.writers.mjcf_files import mjcf_files
from simkit.writers.xml_text import document as xml_text

MOST_FILES = 50_000
MOST_BYTES = 8 << 30
_COPIED_FILES = ("model.config", "manifest.xml", "package.xml")
_LICENCES = re.compile(r"^(licen[cs]e|copying|notice|credits|attribution|authors)", re.IGNORECASE)
_MANIFESTS = ("model.config", "package.xml", "manifest.xml")
_PACKAGE_FOLDERS = {
    "meshes", "mesh", "urdf", "xacro", "materials", "textures", "scripts", "config", "worlds", "sdf", "media",
}  # fmt: skip
_FILE_SUFFIX = re.compile(r"\.[A-Za-z0-9]{2,8}$")


class WorldCollector:
    """Collector of the files that one world uses.

    Args:
        resolver: resolver of the URIs.
        folder: folder to write; must be new.
        diagnostics: collector of warnings.
    """

    def __init__(self, resolver: Resolver, folder: Path, diagnostics: Diagnostics) -> None:
        self.resolver, self.folder, self.diagnostics = resolver, folder, diagnostics
        self.home = Path()
        self.count = self.size = 0
        self._roots: dict[Path, PurePosixPath] = {}
        self._done: dict[Path, PurePosixPath] = {}

    def collect(self, document: Document, expanded: bool) -> PurePosixPath:
        """Collect the outermost file; return its path in the folder.

        Args:
            document: outermost file.
            expanded: True if the tree differs from the file (xacro); the file is then written from the tree.
        """
        assert document.path is not None
        path = absolute_path(document.path)
        self.home = path.parent
        name = f"{path.name.removesuffix('.xacro').removesuffix('.urdf')}.urdf" if expanded else path.name
        self.resolver = self.resolver.around(self.home)
        levels = self._levels_above(document, path.parent)
        self.home = path.parents[levels]
        target = PurePosixPath(path.parent.relative_to(self.home).as_posix()) / name
        self._done[path] = target
        self._copy_licences(self.home, PurePosixPath())
        if levels and not any((self.folder / name).exists() for name in _MANIFESTS):
            manifest = f"<model><name>{escape(path.stem)}</name><sdf>{escape(target.as_posix())}</sdf></model>\n"
            self._write_bytes(PurePosixPath("model.config"), manifest.encode())
        self._write_document(target, document, path, expanded)
        return target

    def _levels_above(self, document: Document, folder: Path) -> int:
        """Return how many levels above its folder an MJCF file refers to; its text keeps these references."""
        sources = mjcf_files(document.root, folder, self.resolver) if document.root.name == "mujoco" else {}
        return max((_relative(source, folder).split("/").count("..") for source in sources), default=0)

    # ------------------------------------------------------------------ files

    def _write_document(self, target: PurePosixPath, document: Document, path: Path, expanded: bool = False) -> None:
        """Write a file with adapted URIs."""
        if document.root.name == "mujoco":
            self._mjcf_files(document.root, path.parent, target.parent)
            self._write_bytes(target, document.text)
            return
        changes = dict(self._uri_changes(document.root, path.parent, target.parent))
        if expanded:
            self._write_bytes(target, xml_text(_replace_in_tree(document.root, changes)).encode())
        else:
            self._write_bytes(target, replace_uris(document.text, changes))

    def _collect_file(self, path: Path) -> PurePosixPath:
        """Collect a file of any kind with the files that it names; return its path in the folder."""
        path = absolute_path(path)
        if path in self._done:
            return self._done[path]
        target = self._target_path(path)
        self._done[path] = target
        if path.suffix.lower() in (".sdf", ".world", ".urdf", ".xml", ".model"):
            document = parse_file(path, Diagnostics())
            if document is not None:
                self._write_document(target, document, path)
                return target
        self._copy(path, target)
        for companion in companion_files(path):
            self._copy(companion, target.parent / _relative(companion, path.parent))
        return target

    def _collect_model(self, folder: Path, file: Path) -> PurePosixPath:
        """Collect a model's folder: its file, manifest and licence; return the folder's path."""
        self._collect_file(file)
        folder = absolute_path(folder)
        place = self._target_path(folder / file.name).parent
        self._copy_licences(folder, place)
        return place

    def _collect_folder(self, path: Path) -> PurePosixPath:
        """Collect a whole folder, such as a folder of material scripts."""
        path = absolute_path(path)
        target = self._target_path(path)
        for source in sorted(p for p in path.rglob("*") if p.is_file() and self.resolver.allows(p)):
            self._copy(source, target / source.relative_to(path).as_posix())
        return target

    def _copy_licences(self, folder: Path, target: PurePosixPath) -> None:
        for source in sorted(folder.iterdir()) if folder.is_dir() else ():
            is_copied = source.name in _COPIED_FILES or _LICENCES.match(source.name)
            if is_copied and source.is_file() and self.resolver.allows(source):
                self._copy(source, target / source.name)

    def _target_path(self, path: Path) -> PurePosixPath:
        """Return the target path of a file: the same path as below the world's folder, else a path below `models`."""
        if path.is_relative_to(self.home):
            return PurePosixPath(path.relative_to(self.home).as_posix())
        known = next((root for root in self._roots if path.is_relative_to(root)), None)
        if known is None:
            known = _root_of(path)
            self._add_root(known, known.name)
        return self._roots[known] / path.relative_to(known).as_posix()

    def _register_root(self, uri: str, path: Path) -> None:
        """Register the folder of a `model://NAME/...` or `package://NAME/...` URI under its name."""
        scheme, _, rest = uri.partition("://")
        name, _, inside = rest.strip("/").partition("/")
        if scheme not in ("model", "package") or path.is_relative_to(self.home):
            return
        parts = [p for p in unquote(inside).split("/") if p]
        root = path.parents[len(parts) - 1] if parts else path
        if not any(path.is_relative_to(known) for known in self._roots) and not self.home.is_relative_to(root):
            self._add_root(root, name)

    def _add_root(self, root: Path, name: str) -> None:
        stem, k = re.sub(r"[^\w.-]+", "_", name) or "files", 1
        while PurePosixPath("models", stem if k == 1 else f"{stem}_{k}") in self._roots.values():
            k += 1
        self._roots[root] = PurePosixPath("models", stem if k == 1 else f"{stem}_{k}")
        self._copy_licences(root, self._roots[root])

    def _copy(self, source: Path, target: PurePosixPath) -> None:
        if not (self.folder / target).exists():
            self._count(source.stat().st_size)
            shutil.copyfile(source, self._prepare_target(target))

    def _write_bytes(self, target: PurePosixPath, content: bytes) -> None:
        self._count(len(content))
        self._prepare_target(target).write_bytes(content)

    def _prepare_target(self, target: PurePosixPath) -> Path:
        path = Path(os.path.abspath(self.folder / target))  # noqa: PTH100 - without `..`
        if not path.is_relative_to(self.folder):
            raise OSError(f"{target} would be outside the folder")
        path.parent.mkdir(parents=True, exist_ok=True)
        return path

    def _count(self, size: int) -> None:
        self.count, self.size = self.count + 1, self.size + size
        progress.set_item(f"{counted(self.count, 'file')}, {self.size / 1e6:.0f} MB")
        if self.count > MOST_FILES or self.size > MOST_BYTES:
            raise OSError(f"more than {MOST_FILES} files or {MOST_BYTES >> 30} GiB")

    # ------------------------------------------------------------------ URIs in a file

    def _uri_changes(self, root: Params, folder: Path, here: PurePosixPath) -> Iterator[tuple[str, str]]:
        """Yield each URI of a file with its new path, relative to `here`."""
        seen: set[str] = set()
        for element, parent in file_elements(root):
            for reference in file_references(element, parent):
                if reference in seen:
                    continue
                collected = self._collected_path(reference, element, parent, folder)
                if collected is not None:
                    seen.add(reference)
                    new = _relative(collected, here)
                    if new != reference:
                        yield reference, new

    def _collected_path(self, reference: str, element: Params, parent: str, folder: Path) -> PurePosixPath | None:
        """Collect the file of a URI and return its path; None if the URI names no existing file."""
        uri = turtlebot3_uri(reference, element.where, Diagnostics()) or reference
        path, _ = self.resolver.search(uri, folder)
        if path is None:
            return None
        self._register_root(uri, absolute_path(path))
        if not path.is_dir():
            return self._collect_file(path)
        if parent == "include" or element.name == "include":
            file = model_file(path, element.where, self.diagnostics, self.resolver.allows)
            return None if file is None else self._collect_model(path, file)
        return self._collect_folder(path) if "://" in reference or "/" in reference else None

    def _mjcf_files(self, root: Params, folder: Path, here: PurePosixPath) -> None:
        """Collect the files of an MJCF file; they keep their relative positions."""
        for source, document in mjcf_files(root, folder, self.resolver).items():
            target = here / _relative(source, folder)
            if document is None:
                self._copy(source, target)
            else:
                self._write_bytes(target, document.text)


def vendor(
    source: str,
    target: Path,
    describe: Callable[..., dict[str, object]],
    *,
    resource_paths: Sequence[str | os.PathLike[str]] = (),
    package_paths: PackagePaths | None = None,
    xacro_args: NamedValues | None = None,
    base: str = "auto",
    diagnostics: Diagnostics | None = None,
) -> tuple[PurePosixPath, int]:
    """Write a self-contained folder and verify that it has the same content.

    Args:
        source: file, or the bare name of a world or model.
        target: folder to write; must be new or empty.
        describe: `simkit.describe`.
        resource_paths: search folders for URIs.
        package_paths: ROS package -> folder, or workspaces.
        xacro_args: arguments of a xacro file.
        base: base of a bare model: fixed, floating or auto.
        diagnostics: receives the problems of the source, such as files that are missing here and in the folder.

    Returns:
        File to open, relative to the folder, and the number of files.

    Raises:
        InputError: SK-CLI-016 the folder is not empty or not writable; SK-CLI-019 its content would differ.
        LoadError: the source has errors.
    """
    if target.exists() and (not target.is_dir() or any(target.iterdir())):
        raise InputError("SK-CLI-016", f"{target} is not an empty folder; give a new or empty folder")
    options = {"resource_paths": resource_paths, "package_paths": package_paths, "base": base}
    before = describe(source, xacro_args=xacro_args, **options)
    diagnostics = Diagnostics() if diagnostics is None else diagnostics
    resolver = Resolver([Path(path) for path in resource_paths], missing_meshes=True, package_paths=package_paths)
    document, expanded = find_document(source, resolver, diagnostics, xacro_args)
    diagnostics.raise_if_errors()
    if document is None or document.path is None:
        raise InputError("SK-LOAD-002", f"{source} is not a file")
    stage: Path | None = None
    try:
        stage = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.absolute().parent))
        collector = WorldCollector(resolver, stage, diagnostics)
        with progress.task("copying the files of the world"):
            main = collector.collect(document, expanded)
        after = describe(stage / main, base=base)
        differs = _difference(before, after) or _file_outside(after, stage)
        if differs:
            raise InputError("SK-CLI-019", f"the content of the folder would differ from {source}: {differs}")
        found = [Diagnostic(**entry) for entry in cast(list[dict[str, Any]], before["diagnostics"])]
        diagnostics.extend(d for d in found if d.severity != "error")  # errors: code that is not in a search path
        if target.exists():
            target.rmdir()
        stage.chmod(0o755)
        stage.rename(target)
    except OSError as error:
        raise InputError("SK-CLI-016", f"cannot write {target}: {error.strerror or error}") from None
    finally:
        if stage is not None:
            shutil.rmtree(stage, ignore_errors=True)
    return main, collector.count


def file_elements(root: Params) -> Iterator[tuple[Params, str]]:
    """Yield every element with the name of its parent."""
    stack = [(root, "")]
    while stack:
        element, parent = stack.pop()
        yield element, parent
        stack += [(child, element.name) for child in reversed(element.children)]


def file_references(element: Params, parent: str) -> Iterator[str]:
    """Yield the texts of an element that may be file names."""
    is_include = element.name == "uri" and parent == "include"
    is_text = bool(element.value) and not element.children and len(element.value) < 1000
    if is_text and (is_include or _may_be_file(element.value)):
        yield element.value
    for key, value in element.attributes.items():
        is_library = element.name == "plugin" and key == "filename"
        if value and key != "name" and not is_library and _may_be_file(value):
            yield value


def _may_be_file(text: str) -> bool:
    return "\n" not in text and ("://" in text or "/" in text or bool(_FILE_SUFFIX.search(text)))


def replace_uris(text: bytes, changes: Mapping[str, str]) -> bytes:
    """Replace each URI in a file's text, where it is the whole text of an element or attribute."""
    for old, new in changes.items():
        for spelling in dict.fromkeys((old, escape(old, quote=False), escape(old))):
            before, after = re.escape(spelling.encode()), escape(new).encode().replace(b"\\", rb"\\")
            text = re.sub(rb"(>\s*)" + before + rb"(\s*<)", rb"\g<1>" + after + rb"\g<2>", text)
            text = re.sub(rb"([\"'])\s*" + before + rb"\s*\1", rb"\g<1>" + after + rb"\g<1>", text)
    return text


def _replace_in_tree(node: Params, changes: Mapping[str, str]) -> Params:
    """Return a tree with each URI replaced."""
    attributes = {k: changes.get(v, v) for k, v in node.attributes.items()}
    children = [_replace_in_tree(c, changes) for c in node.children]
    return Params(node.name, changes.get(node.value, node.value), attributes, children)


def _root_of(path: Path) -> Path:
    """Return the outermost model or package of a file, else the folder above `meshes`, `materials` and so on."""
    root = None
    for ancestor in (path, *list(path.parents)[:8]):
        if any((ancestor / name).is_file() for name in _MANIFESTS):
            root = ancestor
    if root is not None:
        return root
    folder = path if path.is_dir() else path.parent
    while folder.name.lower() in _PACKAGE_FOLDERS and folder.parent != folder:
        folder = folder.parent
    return folder


def _relative(path: Path | PurePosixPath, here: Path | PurePosixPath) -> str:
    return Path(os.path.relpath(str(path), str(here) or ".")).as_posix()


def _file_outside(described: object, folder: Path) -> str:
    """Describe a mesh or texture that is read from outside a folder; empty if there is none."""
    stack = [described]
    while stack:
        item = stack.pop()
        if isinstance(item, dict):
            file = item.get("file")
            is_read = "uri" in item and isinstance(file, str) and not item.get("missing")
            if is_read and not Path(os.path.realpath(str(file))).is_relative_to(Path(os.path.realpath(folder))):
                return f"{item['uri']} is read from {file}"
            stack += item.values()
        elif isinstance(item, list):
            stack += item
    return ""


_PATH_KEYS: frozenset[str] = frozenset(("file", "uri", "diagnostics"))


def _difference(a: object, b: object, path: str = "") -> str:
    """Describe the first difference of two descriptions, ignoring file paths; empty if there is none."""
    if isinstance(a, dict) and isinstance(b, dict):
        parts: Iterable[tuple[str, object, object]] = (
            (f"{path}.{k}", a.get(k), b.get(k)) for k in sorted(a.keys() | b.keys()) if k not in _PATH_KEYS
        )
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        parts = ((f"{path}[{i}]", x, y) for i, (x, y) in enumerate(zip(a, b, strict=True)))
    else:
        return "" if a == b else f"{path.lstrip('.')} was {a!r}, is {b!r}"
    return next((difference for p, x, y in parts if (difference := _difference(x, y, p))), "")
