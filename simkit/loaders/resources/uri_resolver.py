"""Resolver of URIs in input files to paths on this machine. Nothing is downloaded here."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import replace
from itertools import chain
from pathlib import Path
from urllib.parse import unquote

from simkit.diagnostics import Diagnostic, Diagnostics, Where, did_you_mean
from simkit.errors import InputError
from simkit.home_folder import expand_home
from simkit.linked_files import SEARCH_VARIABLES, choose_folders
from simkit.loaders.resources.bundled_models import bundled_folders, is_bare_name
from simkit.loaders.resources.fuel_cache import parse_fuel_url
from simkit.loaders.resources.uri_candidates import UriCandidates
from simkit.loaders.resources.uris import (
    absolute_path,
    format_searched,
    is_existing,
    is_file,
    is_folder,
    is_path_of_other_machine,
    is_relocated,
    other_case_hint,
    package_uri,
    path_of_file_uri,
    sibling_names,
    split_rest,
)
from simkit.run_files import PackagePaths, split_package_paths
from simkit.trusted_folders import OutsideError, join_below, join_within

_SCHEMES = ("model", "package", "file")
NOT_FOUND_CODES = frozenset(("SK-URI-001", "SK-URI-002", "SK-URI-009"))
_PATH_HINT = "add its folder with --resource-path or SIMKIT_RESOURCE_PATH"


class Resolver(UriCandidates):
    """Finder of files and folders by URI.

    Only files in folders that the user chose are found: a URI can neither leave them, nor follow a link out of them.

    Args:
        paths: folders for `model://`, `package://` and relative URIs, searched before those of environment variables.
        base: folder of the loaded file; searched last.
        missing_meshes: reports any unusable mesh as a warning only, even if its URI is refused. This setting allows
            inspecting a file without its meshes.
        package_paths: folder of each ROS package that the caller knows, or workspaces with such packages; searched
            before all other folders.

    Attributes:
        variables_read: environment variables that a xacro file has read, with the place of the first expression.
    """

    def __init__(
        self,
        paths: Sequence[str | os.PathLike[str]] = (),
        *,
        base: Path | None = None,
        missing_meshes: bool = False,
        package_paths: PackagePaths | None = None,
    ) -> None:
        found = [expand_home(p) for p in paths]
        for variable in SEARCH_VARIABLES:
            found += [Path(p) for p in os.environ.get(variable, "").split(os.pathsep) if p]
        found += [Path(p) / "share" for p in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
        named, workspaces = split_package_paths(package_paths)
        for folder in (*workspaces, *named.values()):
            if not Path(folder).is_dir():
                message = f"SK-CLI-018 package path: found {str(folder)!r}; expected NAME=DIR or a folder that exists"
                raise InputError(message, "SK-CLI-018")
        folders = {name: absolute_path(p) for name, p in named.items()}
        searched = tuple(dict.fromkeys(absolute_path(p) for p in found))
        choose_folders((*searched, *folders.values(), *map(absolute_path, workspaces)))
        super().__init__(searched, folders, [absolute_path(p) for p in workspaces], base)
        self.missing_meshes = missing_meshes
        self.variables_read: dict[str, Where] = {}
        self._reported: set[str] = set()

    def around(self, folder: Path | None) -> Resolver:
        """Return a resolver with the folder of the loaded file as its base, unless this resolver already has a base."""
        if self.base is not None or folder is None:
            return self
        near = copy(self)
        near.base = folder
        return near

    def report_choices(self, where: Where, diagnostics: Diagnostics) -> None:
        """Record a note for each package that was found under another name or more than once, once per package.

        An invalid lock file, which could not choose a version, is an error.
        """
        diagnostics.extend(self._lock_problems)
        hint = "choose another one with --package-path NAME=DIR"
        for name, reason in self.packages.notes.items():
            if name not in self._reported:
                diagnostics.note("SK-URI-011", reason, where, hint)
        self._reported.update(self.packages.notes)

    # ------------------------------------------------------------------ URIs

    def mesh(self, uri: str, where: Where, relative_to: Path | None) -> tuple[Path | None, list[Diagnostic]]:
        """Return the mesh file that `uri` names, and the diagnostics about it.

        A missing mesh is a warning, because Gazebo also continues without it. An absolute path of another machine,
        which does not exist here, counts as a missing mesh. A refused URI, which leaves the resource folders or has
        an unknown scheme, is an error unless `missing_meshes` is set.
        """
        found = Diagnostics()
        path = self.resolve(uri, where, found, relative_to)
        if path is not None and path.is_dir():
            found.error("SK-URI-001", f"{uri} is a folder ({path}), not a mesh file", where)
            path = None
        reported = []
        for problem in found:
            is_missing = self.missing_meshes or problem.code in NOT_FOUND_CODES or is_path_of_other_machine(uri)
            if problem.severity == "error" and is_missing:
                effect = "; the shape is left out of drawing and contacts"
                problem = replace(problem, severity="warning", message=problem.message + effect)
            reported.append(problem)
        return path, reported

    def resolve(self, uri: str, where: Where, diagnostics: Diagnostics, relative_to: Path | None) -> Path | None:
        """Return the existing file or folder that `uri` names; None, with one error recorded, if there is none.

        Args:
            uri: `model://`, `package://`, `file://`, `https://` (local caches only), or a path.
            where: file and line of the URI, for messages.
            diagnostics: receives the problems.
            relative_to: folder of the file that contains the URI.
        """
        found, places = self.search(uri, relative_to)
        if found is not None:
            if self._is_elsewhere(uri, found):
                message = f"{uri} does not exist; {found} is used instead"
                diagnostics.note("SK-URI-010", message, where)
            return found
        uri = package_uri(uri)
        scheme, _, rest = uri.partition("://")
        if self.refused is not None:
            self.report_refused(uri, self.refused, where, diagnostics)
        elif uri.startswith(("http://", "https://")):
            message = f"{uri} is not on this machine and nothing is downloaded{format_searched(places)}"
            hint = f"{download_hint(uri, where)}, or {_PATH_HINT}"
            diagnostics.error("SK-URI-002", message, where, hint)
        elif places is None:
            diagnostics.error("SK-URI-003", f"{uri} is outside the resource folders", where, _PATH_HINT)
        elif "://" in uri and scheme not in _SCHEMES:
            message = f"{uri}: unknown scheme; known are model, package, file, https"
            diagnostics.error("SK-URI-004", message, where, did_you_mean(scheme, (*_SCHEMES, "https")))
        else:
            name = rest.split("/")[0]
            near = did_you_mean(name, self._nearby_names(relative_to)) if scheme in ("model", "package") else ""
            folder, tried = self.find_package(name, relative_to) if scheme == "package" else (None, [])
            if scheme == "package" and folder is None:
                message = f"{uri}: the package {name!r} is not found{self.format_searched_packages(tried)}"
                hint = f"give its folder, --package-path {name}=DIR, or its workspace, --package-path DIR"
                diagnostics.error("SK-URI-009", message, where, f"{near} or {hint}" if near else hint)
            else:
                message = f"{uri} is not found{format_searched(places)}"
                diagnostics.error("SK-URI-001", message, where, near or other_case_hint(places) or _PATH_HINT)
        return None

    def report_refused(self, uri: str, path: Path, where: Where, diagnostics: Diagnostics) -> None:
        """Record the error that a file exists, but that a symbolic link leads to it out of the folders of the user."""
        diagnostics.error("SK-URI-003", f"{uri}: {self.trusted.refusal(path)}", where, self.trusted.help(path))

    def format_searched_packages(self, places: list[Path]) -> str:
        """Format the searched paths for a message about a package, and the searches that stopped at a limit."""
        unfinished = ", ".join(str(place) for place in self.packages.unfinished())
        return format_searched(places) + (f"; the search below {unfinished} ended at its limit" if unfinished else "")

    def _is_elsewhere(self, uri: str, found: Path) -> bool:
        """Check whether a file was found in another folder than its URI names, for a reason that is not yet noted."""
        scheme, _, rest = package_uri(uri).partition("://")
        name = rest.strip("/").split("/")[0]
        if scheme in ("package", "model") and self.packages.confirm(name, found):
            return False
        return name not in found.parts if scheme == "package" else is_relocated(uri, found)

    def find_package(self, name: str, relative_to: Path | None) -> tuple[Path | None, list[Path]]:
        """Return the folder of a ROS package, and every searched path.

        After the call, files in the folder of the found package may also be read.
        """
        if not is_bare_name(name):
            return None, []
        bundled = (path for assets in bundled_folders("assets") for path in (assets / name, *assets.glob(f"*/{name}")))
        tried: dict[Path, None] = {}
        for folder in chain(self.packages.candidates(name, self._around(relative_to)), bundled):
            tried[folder] = None
            if is_folder(folder) and self.allows(self.trust_plain(folder), relative_to):
                self._found[name] = folder
                self.packages.confirm(name, folder)
                return folder, list(tried)
        return None, list(tried)

    def search(self, uri: str, relative_to: Path | None) -> tuple[Path | None, list[Path] | None]:
        """Return the path that `resolve` finds, and all searched paths (None for a URI outside the folders)."""
        self.refused = None
        if len(uri) > 4096 or "\0" in uri or any(len(part.encode(errors="replace")) > 255 for part in uri.split("/")):
            return None, []  # no file can have such a name
        try:
            return self._search(uri, relative_to)
        except OutsideError:
            return None, None

    def _search(self, uri: str, relative_to: Path | None) -> tuple[Path | None, list[Path] | None]:
        """Search a URI.

        Raises:
            OutsideError: the URI leaves the folders.
        """
        if uri.startswith(("http://", "https://")):
            return self.first_allowed(self.fuel_candidates(uri), relative_to)
        uri = package_uri(uri)
        scheme, separator, rest = uri.partition("://")
        if not separator:
            found, places = self._search_path(unquote(uri) if not self._exists(uri, relative_to) else uri, relative_to)
            if found is None and places is not None and is_bare_name(uri):  # gz reads a name as model://NAME
                return self.first_allowed(chain(places, self.all_models(uri, "", relative_to)), relative_to)
            return found, places
        rest = unquote(rest)
        if scheme == "file":
            return self._search_path(path_of_file_uri(rest), relative_to)
        if scheme not in ("model", "package"):
            return None, []
        name, inside = split_rest(rest)
        if not name:
            return None, []
        candidates = self.all_models if scheme == "model" else self.all_packages
        return self.first_allowed(candidates(name, inside, relative_to), relative_to)

    def _exists(self, text: str, relative_to: Path | None) -> bool:
        return relative_to is not None and is_existing(relative_to / text)

    def _find_relocated(self, path: Path, relative_to: Path | None) -> Path | None:
        """Search the last components of an absolute path from another machine, in packages that exist here."""
        parts = path.parts
        for position in range(len(parts) - 2, 0, -1):
            name = parts[position]
            if name not in ("share", "src", "install", "home", "opt", "meshes", "models"):
                folder, _ = self.find_package(name, relative_to)
                file = None if folder is None else join_below(folder, "/".join(parts[position + 1 :]))
                if file is not None and is_file(file) and self.allows(file, relative_to):
                    return file
        return None

    def _search_path(self, text: str, relative_to: Path | None) -> tuple[Path | None, list[Path] | None]:
        """Search a plain path: absolute, or relative to the file's folder, then to each resource folder.

        An absolute path that does not exist here is searched for in its package, because `$(find pkg)` leaves absolute
        paths of the machine that expanded the file.
        """
        folders = self._around(relative_to) or [Path.cwd()]
        limits = self.limits(folders)
        is_absolute = Path(text).is_absolute()
        places = [Path(os.sep)] if is_absolute else dict.fromkeys((*folders, *self.paths))
        inside = [path for place in places if (path := join_within(limits, place, text)) is not None]
        if is_absolute and ".." not in Path(text).parts and not any(map(is_existing, inside)):
            moved = self._find_relocated(Path(text), relative_to)
            if moved is not None:
                return moved, [moved]
        if not inside:
            return None, None
        media = () if is_absolute else self.media_candidates(text, relative_to)
        found, searched = self.first_allowed(chain(inside, media), relative_to)
        return found, inside if found is None else searched

    def _nearby_names(self, relative_to: Path | None) -> Iterable[str]:
        for root in (*self.paths, *([relative_to.parent] if relative_to else [])):
            yield from (name for name in sibling_names(root / "any") if is_folder(root / name))


def download_hint(uri: str, where: Where) -> str:
    """Return how to get the file of a URL that is not on this machine; empty for any other URI."""
    if not uri.startswith(("http://", "https://")):
        return ""
    world = shlex.quote(where.file) if where.file and is_file(Path(where.file)) else "WORLD"
    return f"download it with `simkit fetch {world}`" if parse_fuel_url(uri) else "download it by hand"
