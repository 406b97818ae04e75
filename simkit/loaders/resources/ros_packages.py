"""Search for a ROS package without ROS: in folders given by the user, around the file, and below the search paths."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from simkit.input_file import read_input
from simkit.loaders.resources.uris import is_file, is_private

_PARENT_LEVELS = 6  # folders above a file that are searched for its package.xml
_SEARCH_DEPTH = 4  # levels of folders below a search path
_MAX_FOLDERS = 20_000
_NAME = re.compile(rb"<name>\s*([A-Za-z0-9_.-]+)\s*</name>")


def package_folders(
    name: str,
    explicit: Mapping[str, Path],
    around: Iterable[Path],
    paths: Iterable[Path],
    below: dict[Path, dict[str, Path]],
    near: dict[tuple[str, Path], tuple[Path, ...]],
) -> Iterator[Path]:
    """Yield folders that can be the package, the most likely first; they need not exist.

    The order: the folder given by the user; the package that contains the file, its siblings, and packages near these
    siblings; the search paths; packages further below the search paths.

    Args:
        name: name of the package.
        explicit: folders given by the user, by package name.
        around: folders of the files that refer to the package.
        paths: folders to search.
        below: cache of the packages below each search path; this function fills it.
        near: cache of the candidates around a folder, by package name and folder; this function fills it.
    """
    if not name or "/" in name or name in (".", ".."):
        return
    if name in explicit:
        yield explicit[name]
    for folder in dict.fromkeys(around):
        if (name, folder) not in near:
            near[name, folder] = tuple(_nearby_packages(name, folder))
        yield from near[name, folder]
    paths = list(dict.fromkeys(paths))
    for path in paths:
        yield path / name
        if path.name == name or package_name(path) == name:
            yield path
    for path in paths:
        if path not in below:
            below[path] = _packages_below(path)
        if name in below[path]:
            yield below[path][name]


def enclosing_package(folder: Path) -> Path | None:
    """Return the package that contains a folder: the nearest folder upwards with a `package.xml`."""
    for ancestor in (folder, *folder.parents[:_PARENT_LEVELS]):
        if is_file(ancestor / "package.xml"):
            return ancestor
    return None


def package_name(folder: Path) -> str:
    """Return the name in a folder's `package.xml`, or an empty text if there is none."""
    file = folder / "package.xml"
    try:
        found = _NAME.search(read_input(file, 65536))
    except OSError:
        return ""
    return "" if found is None else found.group(1).decode()


def _nearby_packages(name: str, folder: Path) -> Iterator[Path]:
    """Yield candidates near a file: the package that contains it, a sibling, and packages up to three levels above."""
    home = enclosing_package(folder)
    if home is None:
        return
    if home.name == name or package_name(home) == name:
        yield home
    if not is_private(home.parent / name):
        yield home.parent / name
    for above in home.parents[:3]:
        if len(above.parts) < 3:
            return
        direct = above / name
        if is_file(direct / "package.xml"):
            yield direct
        try:
            repositories = sorted(p for p in above.iterdir() if not p.name.startswith("."))[:500]
        except OSError:
            continue
        yield from (r / name for r in repositories if is_file(r / name / "package.xml"))


def _packages_below(path: Path) -> dict[str, Path]:
    """Return every package below a folder by its name, as ROS searches `ROS_PACKAGE_PATH`.

    If several packages have the same name, the nearest one is returned.
    """
    found: dict[str, Path] = {}
    level, seen = [path], 0
    for _ in range(_SEARCH_DEPTH):
        below: list[Path] = []
        for folder in level:
            try:
                with os.scandir(folder) as entries:
                    children = sorted(e.path for e in entries if e.is_dir() and not e.name.startswith("."))
            except OSError:
                continue
            for child in map(Path, children):
                seen += 1
                if seen > _MAX_FOLDERS:
                    return found
                if is_file(child / "package.xml"):
                    for name in (package_name(child), child.name):
                        if name:
                            found.setdefault(name, child)
                else:
                    below.append(child)
        level = below
    return found
