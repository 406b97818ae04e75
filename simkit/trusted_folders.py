"""Folders that the user chose, and the paths below them that a text of an untrusted file may name.

`join_below` is the only function that joins a folder and such a text. `TrustedFolders` is the only check of symbolic
links. No other module needs its own rule.
"""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import Final
from urllib.parse import unquote

from simkit.errors import InputError
from simkit.home_folder import home_folder
from simkit.project_folder import is_top_folder

_LONGEST: Final = 4096  # characters of a path; Linux opens no longer one
_MANIFESTS: Final = ("model.config", "package.xml")
_LINK_DEPTH: Final = 3  # levels of folders below a search path with links to packages: src/repository/package
_MOST_ENTRIES: Final = 10_000  # files and folders that are looked at to find these links
_DRIVE: Final = re.compile(r"[A-Za-z]:")


class OutsideError(InputError):
    """Path in an untrusted text that is absolute or leaves the folder that it belongs to."""

    code = "SK-URI-003"


def join_below(folder: Path, text: str, *, in_uri: bool = False, is_windows: bool = os.name == "nt") -> Path:
    """Return the path of a file or folder below a trusted folder; it need not exist.

    The text is joined as it is written: the caller decodes the percent signs of a URI before. The check covers every
    decoded form of the text, also of a text that is encoded several times (`%252F`). Doubled slashes and `.` are
    dropped, and `..` removes the name before it, without a look at symbolic links. A leading `~` is a name.

    Args:
        folder: trusted folder.
        text: untrusted relative path, with slashes.
        in_uri: True for the part of a URI after the name of a package or model. Its leading slashes are dropped, as
            Gazebo and RViz do.
        is_windows: True to check backslashes, drives and streams (`name:stream`) of Windows too.

    Raises:
        OutsideError: the text is an absolute path, climbs out of the folder with `..`, or no file can have this name.
    """
    if len(text) > _LONGEST:
        raise OutsideError(f"{text[:60]!r}… is longer than {_LONGEST} characters")
    below = _names_below(text, text, in_uri=in_uri, is_windows=is_windows)
    form = text
    while (decoded := unquote(form)) != form:
        form = decoded
        _names_below(form, text, in_uri=in_uri, is_windows=is_windows)
    return folder.joinpath(*below)


def join_within(limits: Iterable[Path], folder: Path, text: str) -> Path | None:
    """Return the path that an untrusted text names from a folder: absolute, or with `..`, but inside one of the limits.

    Return None for a path outside of all limits.

    Args:
        limits: trusted folders, as absolute paths.
        folder: absolute path of the folder from which a relative path starts.
        text: untrusted path, which is joined as it is written.
    """
    if len(text) > _LONGEST or "\0" in text:
        return None
    path = Path(os.path.abspath(folder / text))  # noqa: PTH100 - resolve() would follow links
    for limit in limits:
        if path == limit or limit in path.parents:
            try:
                return join_below(limit, path.relative_to(limit).as_posix())
            except OutsideError:
                continue
    return None


def _names_below(form: str, text: str, *, in_uri: bool, is_windows: bool) -> list[str]:
    """Return the names of the folders and the file in one decoded form of a text."""
    if is_windows:
        form = form.replace("\\", "/")
    if "\0" in form:
        raise OutsideError(f"{text!r} has a zero byte")
    if (form.startswith("/") and not in_uri) or (is_windows and _DRIVE.match(form.lstrip("/"))):
        raise OutsideError(f"{text!r} is an absolute path")
    names: list[str] = []
    for name in form.split("/"):
        if is_windows and ":" in name:
            raise OutsideError(f"{text!r} names a stream of a file")
        if name == ".." or (
            is_windows and name.startswith("..") and not name.strip(". ")
        ):  # Windows drops `. ` at an end
            if not names:
                raise OutsideError(f"{text!r} leaves its folder")
            names.pop()
        elif name not in ("", "."):
            names.append(name)
    return names


class TrustedFolders:
    """Folders that the user chose. A symbolic link may lead to any place in them, and to no other place.

    The real paths of folders are kept, so an object is for one load and not for a file system that changes.

    Args:
        folders: folders that the user chose; a folder may be a link, and need not exist.
        search_paths: those folders that the user's options or environment name. A link in them to a folder that is a
            model or a package makes that folder a trusted folder too, because people link packages into a workspace.
    """

    def __init__(self, folders: Iterable[Path], search_paths: Iterable[Path] = ()) -> None:
        self._search_paths = tuple(dict.fromkeys(search_paths))
        self._added: dict[Path, None] = {}  # not yet in `_roots`: the first check looks up their real paths
        self._roots: dict[str, None] = {}
        self._real_folders: dict[str, str] = {}
        self._linked: dict[str, None] | None = None
        self._added |= dict.fromkeys((*folders, *self._search_paths))

    def add(self, folder: Path) -> None:
        """Add a trusted folder."""
        self._added[folder] = None

    def allows(self, path: Path) -> bool:
        """Check whether the file or folder that a path leads to is in a trusted folder; it need not exist."""
        try:
            real = _prefix(self._real_path(path))
        except (OSError, ValueError, RecursionError):  # an invalid name, or too many links
            return False
        if "\0" in real:
            return False
        while self._added:
            self._roots[_prefix(self._real_folder(str(self._added.popitem()[0])))] = None
        return self._is_below(real, self._roots) or self._is_below(real, self._linked_packages())

    def refusal(self, path: Path) -> str:
        """Return why a path is not allowed, for a message."""
        return f"{path} leads through a symbolic link to {_target(path)}, outside the folders that you chose"

    def help(self, path: Path) -> str:
        """Return how the user allows a path, for the help of a message."""
        target = Path(_target(path))
        return f"to allow it, use --resource-path {shlex.quote(str(target if target.is_dir() else target.parent))}"

    def _real_path(self, path: Path) -> str:
        text = os.fspath(path)
        folder, name = os.path.split(text)
        if os.name == "nt" or ".." in path.parts or not name or os.path.islink(text):  # noqa: PTH114
            return os.path.realpath(text)
        return os.path.join(self._real_folder(folder), name)  # noqa: PTH118 - a text is faster

    def _real_folder(self, folder: str) -> str:
        real = self._real_folders.get(folder)
        if real is None:
            real = self._real_folders[folder] = os.path.realpath(folder)
        return real

    @staticmethod
    def _is_below(real: str, roots: Iterable[str]) -> bool:
        return any(real.startswith(root) for root in roots)

    def _linked_packages(self) -> dict[str, None]:
        if self._linked is None:
            self._linked = {_prefix(folder): None for path in self._search_paths for folder in _links_below(path)}
        return self._linked


def built_workspace(folder: Path) -> list[Path]:
    """Return the folders of the colcon or catkin workspace whose folder `install` or `devel` contains a folder.

    They are `src`, `build` and the installed folder itself: `colcon build --symlink-install` links the files of
    packages to the first two. A folder `src` or `build` that is itself a link does not count: it can lead to any place.
    """
    for ancestor in (folder, *folder.parents):
        is_workspace = len(ancestor.parts) > 2 and ancestor.parent != home_folder()  # not /install
        if ancestor.name in ("install", "devel") and is_workspace:
            beside = [ancestor.parent / name for name in ("src", "build")]
            real = os.path.realpath(ancestor.parent)
            beside = [place for place in beside if os.path.realpath(place) == f"{real}{os.sep}{place.name}"]
            return [ancestor, *(place for place in beside if os.path.isdir(place))]  # noqa: PTH112
    return []


def _links_below(search_path: Path) -> Iterator[str]:
    """Yield the real paths of models and packages that links below a search path name.

    A link inside a model, a package or a Git repository does not count: it belongs to its author.
    """
    level = [os.fspath(search_path)]
    left = _MOST_ENTRIES
    for _ in range(_LINK_DEPTH):
        below: list[str] = []
        for folder in level:
            try:
                with os.scandir(folder) as entries:
                    listed = [entry for entry in islice(entries, max(left, 0)) if not entry.name.startswith(".")]
            except OSError:
                continue
            left -= len(listed)
            for entry in listed:
                if is_link_entry(entry):
                    target = os.path.realpath(entry.path)
                    if _has_any(target, _MANIFESTS) and not is_top_folder(Path(target)):
                        yield target
                elif entry.is_dir(follow_symlinks=False) and not _has_any(entry.path, (*_MANIFESTS, ".git")):
                    below.append(entry.path)
        level = below


def is_link_entry(entry: os.DirEntry[str]) -> bool:
    """Check whether an entry of a folder is a symbolic link, or a junction of Windows."""
    is_junction = getattr(entry, "is_junction", None)  # a link to a folder on Windows; from Python 3.12
    return entry.is_symlink() or (is_junction is not None and is_junction())


def _has_any(folder: str, names: Iterable[str]) -> bool:
    return any(os.path.exists(os.path.join(folder, name)) for name in names)  # noqa: PTH110, PTH118


def _prefix(folder: str) -> str:
    """Return a path with a separator at its end, so that `/ab` is not below `/a`; Windows ignores capital letters."""
    return os.path.normcase(folder).rstrip(os.sep) + os.sep


def _target(path: Path) -> str:
    try:
        return os.path.realpath(path)
    except (OSError, ValueError, RecursionError):
        return "no file"
