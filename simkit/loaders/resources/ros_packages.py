"""Index of ROS packages without ROS: in folders given by the user, around a file, and below the search paths."""

from __future__ import annotations

import os
import re
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import Path
from typing import Final

from simkit.input_file import read_input
from simkit.loaders.resources.bundled_models import bundle_around
from simkit.loaders.resources.uris import is_file, is_folder, is_link, is_private
from simkit.project_folder import enclosing_project, is_top_folder
from simkit.trusted_folders import TrustedFolders, built_workspace, is_link_entry, join_below

_PARENT_LEVELS: Final = 6  # folders above a file that are searched for its package.xml
_SEARCH_DEPTH: Final = 5  # levels of folders below a search path: workspace/src/repository/group/package
_MAX_FOLDERS: Final = 20_000
_MAX_SECONDS: Final = 5.0
_OTHER_FOLDERS: Final = frozenset(("build", "log", "node_modules", "__pycache__", "site-packages", "dist-packages"))
_INSTALLED_FOLDERS: Final = frozenset(("bin", "include", "lib", "lib64", "libexec"))  # have no packages beside `share`
_IGNORE_MARKERS: Final = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
_NAME = re.compile(rb"<name>\s*([A-Za-z0-9_.-]+)\s*</name>")


def enclosing_package(folder: Path) -> Path | None:
    """Return the package that contains a folder: the nearest folder upwards with a `package.xml`."""
    for ancestor in (folder, *folder.parents[:_PARENT_LEVELS]):
        if is_file(ancestor / "package.xml"):
            return ancestor
    return None


@dataclass
class _Area:
    """Packages below one folder.

    Attributes:
        by_name: name in `package.xml` -> folders, sources before installed copies, then the nearest to the top.
        is_complete: false if the search ended at a limit.
    """

    by_name: dict[str, list[Path]] = field(default_factory=dict)
    is_complete: bool = True

    @property
    def folders(self) -> Iterator[Path]:
        """All packages."""
        return (folder for folders in self.by_name.values() for folder in folders)


class PackageIndex:
    """Packages by the name in their `package.xml`. Each folder is searched once, when a name requires it.

    Args:
        named: folders given by the user, by package name.
        workspaces: folders given by the user whose packages are searched before all others.
        paths: folders that are searched last.
        trusted: folders that a link to a package may lead to, besides the folder that is searched.

    Attributes:
        notes: description of each decision that was made for a file that was found, by package name.
    """

    def __init__(
        self, named: Mapping[str, Path], workspaces: Iterable[Path], paths: Iterable[Path], trusted: TrustedFolders
    ) -> None:
        self.named, self.workspaces, self.paths = dict(named), tuple(workspaces), tuple(dict.fromkeys(paths))
        self.trusted = trusted
        self.notes: dict[str, str] = {}
        self._areas: dict[Path, _Area] = {}
        self._names: dict[Path, str] = {}
        self._places: dict[Path, tuple[Path, ...]] = {}
        self._fallbacks: dict[tuple[str, tuple[Path, ...]], tuple[Path, ...]] = {}
        self._searched_count, self._searched_seconds = 0, 0.0  # of all folders that the user did not give
        self._reasons: dict[str, dict[Path, str]] = {}  # package name -> folder that was offered -> reason to tell

    # ------------------------------------------------------------------ search

    def candidates(self, name: str, around: Iterable[Path]) -> Iterator[Path]:
        """Yield folders that can be the package, the most likely first; they need not exist.

        The name in `package.xml` counts. Only if no package has this name, the name of a folder counts, then a name in
        other capital letters, then the only package whose name has the same end.

        Args:
            name: name of the package.
            around: folders of the files that refer to the package.
        """
        if not name or "/" in name or name in (".", ".."):
            return
        around = tuple(dict.fromkeys(around))
        is_found = False
        for folder in self._exact(name, around):
            is_found = is_found or is_folder(folder)
            yield folder
        if not is_found:
            if (name, around) not in self._fallbacks:
                folders = dict.fromkeys((*self._folders_of_that_name(name, around), *self._similar(name, around)))
                self._fallbacks[name, around] = tuple(folders)
            yield from self._fallbacks[name, around]

    def named_exactly(self, name: str, around: Iterable[Path]) -> Iterator[Path]:
        """Yield folders that can be the package with exactly this name, nearest first; they need not exist."""
        return self._exact(name, tuple(dict.fromkeys(around)))

    def members(self, name: str, member: str, around: Iterable[Path]) -> Iterator[Path]:
        """Yield the package `name_member`: `package://moveit_resources/panda_description` was once a folder."""
        for folder in self._exact(f"{name}_{member}", tuple(dict.fromkeys(around))):
            self._offer(name, folder, f"the package {name} has no {member}; {self._shown(folder)} is used")
            yield folder

    def packages(self, around: Iterable[Path]) -> Iterator[Path]:
        """Yield all packages in the workspaces given by the user, around the files, and below the search paths."""
        for place in self._all_places(tuple(dict.fromkeys(around))):
            yield from self._area(place).folders

    def confirm(self, name: str, file: Path) -> bool:
        """Record the decision that led to a file; return false if the file is in no folder that was offered."""
        for folder, reason in self._reasons.get(name, {}).items():
            if folder == file or folder in file.parents:
                if reason:
                    self.notes.setdefault(name, reason)
                return True
        return False

    def roots(self, around: Iterable[Path]) -> list[Path]:
        """Return the folders below which all packages are searched, without folders that are in another one."""
        places = list(self._all_places(tuple(dict.fromkeys(around))))
        return [place for place in places if not any(other in place.parents for other in places)]

    def unfinished(self) -> list[Path]:
        """Return the folders whose search ended at a limit."""
        return [place for place, area in self._areas.items() if not area.is_complete]

    # ------------------------------------------------------------------ candidates

    def _exact(self, name: str, around: tuple[Path, ...]) -> Iterator[Path]:
        """Yield the packages with this name, nearest first."""
        if name in self.named:
            yield self._offer(name, self.named[name])
        places = [*self.workspaces, *(place for folder in around for place in self._around(folder))]
        for place in dict.fromkeys(places):
            yield from self._same_name(name, place, around)
        for path in self.paths:
            direct = join_below(path, name)
            if self._name_of(direct) in ("", name):
                yield self._offer(name, direct)
            if name in (self._name_of(path), path.name) and self._name_of(path) in ("", name):
                yield self._offer(name, path)
        for path in self.paths:
            yield from self._same_name(name, path, around)

    def _same_name(self, name: str, place: Path, around: tuple[Path, ...]) -> Iterator[Path]:
        """Yield the packages of one name below a folder; the one nearest to the file is first, with a note."""
        folders = self._area(place).by_name.get(name, ())
        home = around[0] if around else place
        ordered = sorted(folders, key=lambda folder: (_is_copy(folder), -_common_levels(folder, home)))
        others = ""
        if len(ordered) > 1:
            sources = {folder.resolve(): folder for folder in reversed(ordered) if not _is_copy(folder)}
            others = ", ".join(str(folder) for folder in [*reversed(sources.values())][1:4])
        reason = f"several packages are named {name}: {ordered[0]} is used, not {others}" if others else ""
        for folder in ordered:
            yield self._offer(name, folder, reason)

    def _folders_of_that_name(self, name: str, around: tuple[Path, ...]) -> Iterator[Path]:
        """Yield packages in a folder of this name; such folders beside the file's package and in those of the user."""
        for folder in self.packages(around):
            if folder.name == name:
                yield self._offer(name, folder, f"no package is named {name}; {self._shown(folder)} is used")
        for folder in around:
            yield from (self._offer(name, package_folder) for package_folder in _own_folders(name, folder))
            home = enclosing_package(folder)
            if home is not None and not is_private(join_below(home.parent, name)):
                yield self._offer(name, join_below(home.parent, name))
        for path in (*self.workspaces, *self.paths):
            yield self._offer(name, join_below(path, name))

    def _similar(self, name: str, around: tuple[Path, ...]) -> Iterator[Path]:
        """Yield the only package with this name in other capital letters, else the only one with the same end."""
        packages = list(dict.fromkeys(self.packages(around)))
        folded = [f for f in packages if name.casefold() in (self._name_of(f).casefold(), f.name.casefold())]
        similar = folded or [f for f in packages if self._has_same_end(name, f)]
        if len({self._name_of(folder) for folder in similar}) == 1:
            for folder in similar:
                yield self._offer(name, folder, f"no package is named {name}; {self._shown(folder)} is used")

    def _has_same_end(self, name: str, folder: Path) -> bool:
        """Check whether a name has the prefix of a group, such as `moveit_resources_`, and the other name lacks it."""
        package = self._name_of(folder)
        if "_" in name and package.endswith(f"_{name}"):
            return True
        groups = (parent.name for parent in folder.parents[:2])
        return any(name == f"{group}_{package}" for group in groups)

    def _offer(self, name: str, folder: Path, reason: str = "") -> Path:
        self._reasons.setdefault(name, {}).setdefault(folder, reason)
        return folder

    def _shown(self, folder: Path) -> str:
        return f"the package {self._name_of(folder)} in {folder}"

    # ------------------------------------------------------------------ folders

    def _all_places(self, around: tuple[Path, ...]) -> Iterator[Path]:
        nearby = (place for folder in around for place in self._around(folder))
        yield from dict.fromkeys((*self.workspaces, *nearby, *self.paths))

    def _around(self, folder: Path) -> tuple[Path, ...]:
        """Return the folders around a file to search: its package, then the workspace or the folders above.

        A file outside a package and outside a repository has only its own folder. A file that simkit ships finds only
        shipped packages, so that it loads in the same way from a checkout, in any workspace, and from an installation.
        """
        if folder not in self._places:
            shipped = bundle_around(folder)
            if shipped is not None:
                self._places[folder] = (shipped,)
                return self._places[folder]
            home = enclosing_package(folder) or enclosing_project(folder)
            above = [] if home is None else list(takewhile(_can_be_workspace, home.parents[:4]))
            source = next((number for number, parent in enumerate(above) if parent.name == "src"), None)
            above = above[:3] if source is None else above[source : source + 2]
            self._places[folder] = (home or folder, *above)
        return self._places[folder]

    def _area(self, place: Path) -> _Area:
        if place not in self._areas:
            self._areas[place] = self._search(place)
        return self._areas[place]

    def _search(self, place: Path) -> _Area:
        """Search the packages in and below a folder, level by level.

        Each folder of the user has the full limits; all folders around the files share them.
        """
        area, level = _Area(), [place]
        inside = TrustedFolders((place, *built_workspace(place)))
        is_given = place in self.workspaces or place in self.paths
        count, seconds = (0, 0.0) if is_given else (self._searched_count, self._searched_seconds)
        begin = time.monotonic() - seconds
        for _ in range(_SEARCH_DEPTH + 1):
            below: list[Path] = []
            for folder in level:
                name = self._name_of(folder, inside)
                if name:
                    area.by_name.setdefault(name, []).append(folder)
                elif folder in self._areas:  # a folder of a file that was searched before
                    for package, folders in self._areas[folder].by_name.items():
                        area.by_name.setdefault(package, []).extend(folders)
                    continue
                subfolders = _subfolders(folder)
                children = [name for name, leads in subfolders if not leads or self._follows(folder / name, inside)]
                count += len(children)
                area.is_complete = count <= _MAX_FOLDERS and time.monotonic() - begin <= _MAX_SECONDS
                if not area.is_complete:
                    break
                # a package can hold packages beside its own folders, which are not searched further
                below += [folder / child for child in children if not name or _has_manifest(f"{folder}/{child}")]
            level = below if area.is_complete else []
        if not is_given:
            self._searched_count, self._searched_seconds = count, time.monotonic() - begin
        return area

    def _follows(self, link: Path, inside: TrustedFolders) -> bool:
        """Check whether a link to a folder leads to a trusted folder.

        After the call, the files of a package that the link leads to may also be read.
        """
        if not self.trusted.allows(link) and not inside.allows(link):
            return False
        if _has_manifest(str(link)):
            self.trusted.add(link)
        return True

    def _name_of(self, folder: Path, inside: TrustedFolders | None = None) -> str:
        """Return the name in a folder's `package.xml`, its folder's name if there is none in it, else an empty text.

        A file `package.xml` that is a link out of the trusted folders is not read.
        """
        if folder not in self._names:
            file = folder / "package.xml"
            may_read = not is_link(file) or self.trusted.allows(file) or (inside is not None and inside.allows(file))
            self._names[folder] = _read_name(folder, may_read=may_read)
        return self._names[folder]


def _can_be_workspace(folder: Path) -> bool:
    """Check whether packages are searched in a folder above a package; the folder of all Python packages is huge."""
    return not is_top_folder(folder) and folder.name not in _OTHER_FOLDERS


def _has_manifest(folder: str) -> bool:
    return os.path.isfile(f"{folder}/package.xml")  # noqa: PTH113 - a path object for each folder takes as long again


def _read_name(folder: Path, *, may_read: bool) -> str:
    if not _has_manifest(str(folder)):
        return ""
    if not may_read:
        return folder.name
    try:
        match = _NAME.search(read_input(folder / "package.xml", 65536))
    except OSError:
        return ""
    return folder.name if match is None else match.group(1).decode()


def _subfolders(folder: Path) -> list[tuple[str, bool]]:
    """Return the folders in a folder that can hold packages, by name, and whether each is a link.

    The name `src` is first and `install` is last. Where packages are installed, they are in `share`: the headers of a
    distribution would be 1400 folders.
    """
    is_link = {}
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                if not entry.name.startswith(".") and entry.name not in _OTHER_FOLDERS and entry.is_dir():
                    is_link[entry.name] = is_link_entry(entry)
    except OSError:
        return []
    names = [name for name in is_link if "share" not in is_link or name not in _INSTALLED_FOLDERS]
    return [(name, is_link[name]) for name in sorted(names, key=lambda name: (name == "install", name != "src", name))]


def _own_folders(name: str, folder: Path) -> Iterator[Path]:
    """Yield the folders of this name that contain a folder, in its project or as an install without `package.xml`."""
    project = enclosing_project(folder)
    for ancestor in (folder, *folder.parents[:_PARENT_LEVELS]):
        is_inside = project is not None and ancestor.is_relative_to(project)
        if ancestor.name == name and (is_inside or ancestor.parent.name == "share"):
            yield ancestor


def _is_copy(folder: Path) -> bool:
    """Check whether a package is an installed copy (`share/NAME`), or whether colcon or catkin ignores it."""
    return folder.parent.name == "share" or any(is_file(folder / marker) for marker in _IGNORE_MARKERS)


def _common_levels(path: Path, other: Path) -> int:
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(path.parts, other.parts, strict=False)))
