"""Places where the file or folder of a URI can be, in the order of the search, and the folders that may be read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from pathlib import Path

from simkit.diagnostics import Diagnostic
from simkit.errors import LoadError
from simkit.loaders.resources.bundled_models import builtin_model, bundled_folders
from simkit.loaders.resources.fuel_cache import (
    LOCK_NAME,
    LockEntry,
    cached_versions,
    fuel_caches,
    parse_fuel_url,
    read_lock,
)
from simkit.loaders.resources.install_rules import installed_sources
from simkit.loaders.resources.model_folder import holds_model
from simkit.loaders.resources.project_folder import readable_folder
from simkit.loaders.resources.ros_packages import PackageIndex, enclosing_package
from simkit.loaders.resources.uris import (
    absolute_path,
    is_existing,
    is_file,
    is_folder,
    is_link,
    is_private,
    sibling_names,
)
from simkit.project_folder import enclosing_project, is_top_folder
from simkit.trusted_folders import TrustedFolders, built_workspace, join_below

_MEDIA = ("Media/models", "media/models", "Media", "media")  # folders of a package that Gazebo Classic searches


class UriCandidates:
    """Generator of the candidates for a URI. A candidate need not exist, and a link in it can lead to any place.

    Args:
        paths: folders of the user for `model://`, `package://` and relative URIs.
        named: folder of each ROS package that the user gives.
        workspaces: folders of the user with ROS packages.
        base: folder of the loaded file; searched last.
    """

    def __init__(
        self, paths: Sequence[Path], named: dict[str, Path], workspaces: Sequence[Path], base: Path | None
    ) -> None:
        self.paths, self.base = tuple(paths), base
        chosen = (*self.paths, *workspaces, *named.values())
        built = tuple(place for folder in chosen for place in built_workspace(folder))
        shipped = (folder for kind in ("assets", "worlds", "labs") for folder in bundled_folders(kind))
        self.trusted = TrustedFolders((*shipped, *fuel_caches()), search_paths=(*chosen, *built))
        self.packages = PackageIndex(named, workspaces, self.paths, self.trusted)
        self.refused: Path | None = None
        self._found: dict[str, Path] = {}
        self._projects: dict[Path, list[Path]] = {}  # folder of a file -> folder, project and package
        self._locks: dict[Path | None, dict[str, LockEntry]] = {}
        self._lock_problems: list[Diagnostic] = []
        self._groups: dict[Path, list[Path]] = {}  # project -> its folders of models
        self._subfolders: dict[tuple[str, Path], bool] = {}  # name of a folder, folder above it -> it exists

    # ------------------------------------------------------------------ access

    def allows(self, path: Path, relative_to: Path | None = None) -> bool:
        """Check whether a file or folder is in a folder that may be read, also if symbolic links lead to it.

        Args:
            path: the file or folder.
            relative_to: folder of the file that refers to it.
        """
        for folder in self._around(relative_to) or [Path.cwd()]:
            self._trust_around(folder)
        return self.trusted.allows(path)

    def _trust_around(self, folder: Path) -> list[Path]:
        """Trust the project and the workspace of a file; return its folder, its project and its package."""
        if folder not in self._projects:
            package = enclosing_package(folder)
            self._projects[folder] = [folder, readable_folder(folder), *([package] if package else [])]
            for place in (*self._projects[folder], *built_workspace(folder)):
                self.trusted.add(place)
        return self._projects[folder]

    def trust_plain(self, folder: Path) -> Path:
        """Trust a model or package near a file, unless it is a link, which can lead to any place."""
        if not is_link(folder):
            self.trusted.add(folder)
        return folder

    def limits(self, folders: Iterable[Path]) -> list[Path]:
        """Return the folders that a path in a file may name, for a file in certain folders."""
        of_files = [place for folder in folders for place in self._trust_around(folder)]
        of_packages = [*self.packages.named.values(), *self.packages.workspaces, *self._found.values()]
        return [*of_files, *self.paths, *bundled_folders("assets"), *of_packages]

    def first_allowed(self, candidates: Iterable[Path], relative_to: Path | None) -> tuple[Path | None, list[Path]]:
        """Return the first candidate that exists and may be read, and all candidates up to it.

        The attribute `refused` is the first candidate that exists, but is behind a link to another folder.
        """
        looked: dict[Path, None] = {}
        for candidate in candidates:
            if candidate not in looked:
                looked[candidate] = None
                if is_existing(candidate):
                    if self.allows(candidate, relative_to):
                        return candidate, list(looked)
                    self.refused = self.refused or candidate
        return None, list(looked)

    def _around(self, relative_to: Path | None) -> list[Path]:
        """Return the folder of the file that contains a URI, and that of the loaded file."""
        return [absolute_path(f) for f in (relative_to, self.base) if f is not None]

    # ------------------------------------------------------------------ candidates

    def all_models(self, name: str, inside: str, relative_to: Path | None) -> Iterator[Path]:
        """Yield all candidates for `model://name/inside`.

        If the URI names the model itself, a folder without a model, such as a package with that name, comes last.
        """
        without_model = []
        for candidate in chain(
            self._model_candidates(name, inside, relative_to),
            self._package_candidates(name, inside, relative_to),
            self._models_of_project(name, inside, relative_to),
            self._models_of_packages(name, inside, relative_to),
        ):
            if inside in ("", ".") and is_folder(candidate) and not holds_model(candidate):
                without_model.append(candidate)
            else:
                yield candidate
        yield from without_model

    def all_packages(self, name: str, inside: str, relative_to: Path | None) -> Iterator[Path]:
        """Yield all candidates for `package://name/inside`."""
        yield from self._package_candidates(name, inside, relative_to)
        yield from self._model_candidates(name, inside, relative_to)
        yield from self._renamed_checkout_candidates(inside, relative_to)

    def _model_candidates(self, name: str, inside: str, relative_to: Path | None) -> Iterator[Path]:
        """Yield candidates for `model://name/...`: below each folder, and in a folder that itself has that name."""
        below = f"{name}/{inside}"
        for root in self.paths:
            yield join_below(root, below)
        for root in self.paths:
            if root.name == name:
                yield join_below(root, inside)
        for folder in self._around(relative_to):
            for ancestor in (folder, *folder.parents[:3]):
                if ancestor.name == name and not is_private(ancestor):
                    yield join_below(self.trust_plain(ancestor), inside)
            yield join_below(folder, below)
            for start, group in ((folder, "models"), (folder.parent, "."), (folder.parent, "models")):
                near = join_below(start / group, name)
                if not is_private(near):
                    if TrustedFolders([start]).allows(near):
                        self.trusted.add(near)
                    yield join_below(near, inside)
                elif self.allows(near, relative_to):  # a folder of models in the project or package of the file
                    yield join_below(near, inside)
        for bundle in bundled_folders("assets"):
            yield join_below(bundle, below)
            groups = sorted(bundle.glob(f"*/{name}/")) if name.replace("_", "").isalnum() else ()
            yield from (join_below(model, inside) for model in groups)

    def _package_candidates(self, name: str, inside: str, relative_to: Path | None) -> Iterator[Path]:
        """Yield candidates for `package://name/...` in the package of that name, then in a package of its group."""
        around = self._around(relative_to)
        for folder in self.packages.candidates(name, around):
            yield join_below(self.trust_plain(folder), inside)
            yield from (join_below(folder, source) for source in installed_sources(folder, inside))
        member, _, inside = inside.partition("/")
        for folder in self.packages.members(name, member, around) if inside else ():
            yield join_below(self.trust_plain(folder), inside)

    def _models_of_packages(self, name: str, inside: str, relative_to: Path | None) -> Iterator[Path]:
        """Yield candidates for `model://name/...` in the folders `models` of packages, which packages export.

        A model that simkit has, such as `ground_plane`, is not taken from packages elsewhere.
        """
        beside = {self._trust_around(folder)[1].parent for folder in self._around(relative_to)}
        is_own = builtin_model(f"model://{name}") is not None
        for package in self.packages.packages(self._around(relative_to)):
            if not self._has_subfolder(package, "models") or (is_own and package.parent not in beside):
                continue
            folder = join_below(package / "models", name)
            if is_folder(folder) and not is_private(folder):
                self.trust_plain(package)
                yield join_below(folder, inside)

    def _models_of_project(self, name: str, inside: str, relative_to: Path | None) -> Iterator[Path]:
        """Yield candidates for `model://name/...` in the folders `models` of the project and of the folders in it.

        The launch files or the README of such a project add these folders to GAZEBO_MODEL_PATH.
        """
        for project in dict.fromkeys(self._trust_around(folder)[1] for folder in self._around(relative_to)):
            for place in self._model_groups(project):
                if is_folder(folder := join_below(place, name)):
                    yield join_below(folder, inside)

    def _model_groups(self, project: Path) -> list[Path]:
        """Return the folders `models` of a project and of its folders, and the groups of models in the first."""
        if project not in self._groups:
            top = project / "models"
            below = sorted(top / name for name in sibling_names(top / "any"))
            groups = [folder for folder in below if is_folder(folder) and not is_file(folder / "model.config")]
            is_project = enclosing_project(project) == project  # not just the folder above a file
            others = sorted(project / name / "models" for name in sibling_names(project / "any") if is_project)
            others = [folder for folder in others if not is_link(folder.parent) and is_folder(folder)]
            self._groups[project] = [*([top, *groups] if below else []), *others]
        return self._groups[project]

    def media_candidates(self, text: str, relative_to: Path | None) -> Iterator[Path]:
        """Yield candidates for a relative path in the folders `Media`: of search paths, near the file, of packages."""
        if ".." not in Path(text).parts:
            around = self._around(relative_to)
            near = (folder for start in around for folder in (start, start.parent) if not is_top_folder(folder))
            packages = map(self.trust_plain, self.packages.packages(around))
            roots = ((root, media) for root in chain(self.paths, near, packages) for media in _MEDIA)
            yield from (join_below(root / media, text) for root, media in roots if self._has_subfolder(root, media))

    def _has_subfolder(self, folder: Path, name: str) -> bool:
        """Check once whether a package or a search path has a folder of this name: few of thousands have."""
        key = name, folder
        if key not in self._subfolders:
            self._subfolders[key] = is_folder(folder / name)
        return self._subfolders[key]

    def _renamed_checkout_candidates(self, inside: str, relative_to: Path | None) -> Iterator[Path]:
        """Yield candidates for `package://name/a/b`: the path `a/b` in the folders above the file.

        This finds a package in a folder with another name, such as a renamed checkout.
        """
        if relative_to is None or "/" not in inside or enclosing_package(absolute_path(relative_to)) is not None:
            return  # the enclosing package already defines the name
        folder = absolute_path(relative_to)
        for ancestor in (folder, *folder.parents[:2]):
            if not is_private(ancestor):
                yield join_below(self.trust_plain(ancestor), inside)

    def fuel_candidates(self, uri: str) -> Iterator[Path]:
        """Yield candidates for a Fuel URL in Gazebo's caches, then a folder of that name in the resource folders."""
        url = parse_fuel_url(uri)
        if url is None:
            return
        locked = self._lock().get(url.key)
        for folder in cached_versions(url, locked.version if locked else None):
            yield join_below(folder, url.inside)
        for root in self.paths:
            for name in dict.fromkeys((url.name, url.name.replace(" ", "_").lower())):
                yield join_below(root, f"{name}/{url.inside}")

    def _lock(self) -> dict[str, LockEntry]:
        """Return the entries of the file `simkit.lock` beside the loaded file."""
        if self.base is not None and self.base not in self._locks:
            self._locks[self.base] = {}
            try:
                if self.allows(self.base / LOCK_NAME):
                    self._locks[self.base] = read_lock(self.base / LOCK_NAME)
            except LoadError as error:
                self._lock_problems += error.diagnostics
        return self._locks.get(self.base, {})
