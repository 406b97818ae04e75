"""Resolver of URIs in input files to paths on this machine. Nothing is downloaded here."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import replace
from itertools import chain, islice
from pathlib import Path
from urllib.parse import unquote

from simkit.diagnostics import Diagnostic, Diagnostics, Where, closest, did_you_mean
from simkit.errors import InputError
from simkit.home_folder import expand_home
from simkit.linked_files import SEARCH_VARIABLES, choose_folders
from simkit.loaders.resources.bundled_models import bundled_folders, bundled_models, is_bare_name
from simkit.loaders.resources.fuel_cache import parse_fuel_url
from simkit.loaders.resources.install_rules import installed_sources
from simkit.loaders.resources.ros_packages import enclosing_package
from simkit.loaders.resources.uri_candidates import UriCandidates
from simkit.loaders.resources.uris import (
    absolute_path,
    folder_of_name,
    format_searched,
    is_existing,
    is_file,
    is_folder,
    is_path_of_other_machine,
    is_relocated,
    package_uri,
    path_of_file_uri,
    sibling_names,
    similar_name_hint,
    split_rest,
)
from simkit.project_folder import is_top_folder
from simkit.run_files import PackagePaths, split_package_paths
from simkit.trusted_folders import OutsideError, join_below, join_within

_SCHEMES = ("model", "package", "file")
NOT_FOUND_CODES = frozenset(("SK-URI-001", "SK-URI-002", "SK-URI-009"))
_MISSING_MESH_CODES = NOT_FOUND_CODES | {"SK-URI-004"}
_HINT_LEVELS = 4  # folders above a file that a hint may name
_PATH_HINT = "add its folder with --resource-path or SIMKIT_RESOURCE_PATH"


def with_known_scheme(uri: str) -> str:
    """Return a URI with the closest known scheme, such as `model://` for `models://`; unchanged if none is close."""
    scheme, separator, rest = uri.partition("://")
    if not separator or scheme in (*_SCHEMES, "http", "https"):
        return uri
    near = closest(scheme.lower(), _SCHEMES, least=0.8)
    return uri if near is None else f"{near}://{rest}"


class Resolver(UriCandidates):
    """Finder of files and folders by URI.

    Only files in folders that the user chose are found: a URI can neither leave them, nor follow a link out of them.

    Args:
        paths: folders for `model://`, `package://` and relative URIs, searched before those of environment variables.
        base: folder of the loaded file; searched last.
        missing_meshes: reports any unusable mesh as a warning only, even if its URI is refused. This setting allows
            inspecting a file without its meshes.
        missing_includes: leaves out files that a xacro file includes and that are not found, and calls of their macros,
            with warnings. The rest of the robot remains.
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
        missing_includes: bool = False,
        package_paths: PackagePaths | None = None,
    ) -> None:
        unresolved = [expand_home(p) for p in paths]
        for variable in SEARCH_VARIABLES:
            unresolved += [Path(p) for p in os.environ.get(variable, "").split(os.pathsep) if p]
        unresolved += [Path(p) / "share" for p in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
        named, workspaces = split_package_paths(package_paths)
        for folder in (*workspaces, *named.values()):
            if not Path(folder).is_dir():
                message = f"package path: found {str(folder)!r}; expected NAME=DIR or a folder that exists"
                raise InputError("SK-CLI-018", message)
        folders = {name: absolute_path(p) for name, p in named.items()}
        searched = tuple(dict.fromkeys(absolute_path(p) for p in unresolved))
        choose_folders((*searched, *folders.values(), *map(absolute_path, workspaces)))
        super().__init__(searched, folders, [absolute_path(p) for p in workspaces], base)
        self.missing_meshes, self.missing_includes = missing_meshes, missing_includes
        self.variables_read: dict[str, Where] = {}
        self._reported: set[str] = set()
        self._failures: dict[tuple[str, Path | None, int], list[Path] | None] = {}
        self._errors: dict[tuple[str, Path | None, int], tuple[str, str, str]] = {}

    def begin_load(self) -> None:
        """Forget the failed searches: files can be created between two loads."""
        self._failures.clear()
        self._errors.clear()
        self._subfolders.clear()
        self._groups.clear()

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
        which does not exist here, and a URI with an unknown scheme count as missing meshes. A refused URI, which leaves
        the resource folders, is an error unless `missing_meshes` is set.
        """
        problems = Diagnostics()
        path = self.resolve(uri, where, problems, relative_to)
        if path is not None and path.is_dir():
            problems.error("SK-URI-001", f"{uri} is a folder ({path}), not a mesh file", where)
            path = None
        reported = []
        for problem in problems:
            is_missing = self.missing_meshes or problem.code in _MISSING_MESH_CODES or is_path_of_other_machine(uri)
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
        path, places = self.search(uri, relative_to)
        if path is not None:
            known = with_known_scheme(uri)
            if known != uri:
                unknown, used = (text.partition("://")[0] for text in (uri, known))
                diagnostics.warning("SK-URI-004", f"unknown scheme {unknown}://; {used}:// is used instead", where)
            if self._is_elsewhere(known, path, relative_to):
                message = f"{uri} does not exist; {path} is used instead"
                diagnostics.note("SK-URI-010", message, where)
            return path
        uri = package_uri(uri)
        if self.refused is not None:
            self.report_refused(uri, self.refused, where, diagnostics)
        elif uri.startswith(("http://", "https://")):
            message = f"{uri} is not on this machine and nothing is downloaded{format_searched(places)}"
            hint = f"{download_hint(uri, where)}, or {_PATH_HINT}"
            diagnostics.error("SK-URI-002", message, where, hint)
        else:
            key = uri, relative_to, len(self._found)
            if key not in self._errors:
                self._errors[key] = self._describe_failure(uri, relative_to, places)
            code, message, hint = self._errors[key]
            diagnostics.error(code, message, where, hint)
        return None

    def _describe_failure(self, uri: str, relative_to: Path | None, places: list[Path] | None) -> tuple[str, str, str]:
        """Return the code, the message and the help for a URI that names no file on this machine."""
        scheme, _, rest = uri.partition("://")
        if places is None:
            return "SK-URI-003", f"{uri} is outside the resource folders", _PATH_HINT
        if "://" in uri and scheme not in _SCHEMES:
            message = f"{uri}: unknown scheme; known are model, package, file, https"
            return "SK-URI-004", message, did_you_mean(scheme, (*_SCHEMES, "https"))
        name = rest.split("/")[0]
        is_unknown = scheme in ("model", "package") and folder_of_name(places, rest) is None
        near = did_you_mean(name, self._nearby_names(relative_to)) if is_unknown else ""
        if scheme == "model" and is_unknown and not near:
            near = did_you_mean(name, bundled_models())
        above = self._hint_above(uri, relative_to)
        folder, tried = self.find_package(name, relative_to) if scheme == "package" else (None, [])
        if scheme == "package" and folder is None:
            message = f"{uri}: the package {name!r} is not found{self.format_searched_packages(tried, relative_to)}"
            hint = above or f"give its folder, --package-path {name}=DIR, or its workspace, --package-path DIR"
            return "SK-URI-009", message, f"{near} or {hint}" if near and not above else hint
        message = f"{uri} is not found{format_searched(places)}"
        return "SK-URI-001", message, above or near or similar_name_hint(places) or _PATH_HINT

    def _hint_above(self, uri: str, relative_to: Path | None) -> str:
        """Suggest the folder above the file of a URI in which its file or folder exists; empty if there is none."""
        text = unquote(uri.partition("://")[2] or uri).strip("/")
        if not text or Path(uri).is_absolute() or ".." in Path(text).parts:
            return ""
        for folder in self._around(relative_to):
            for parent in islice(folder.parents, _HINT_LEVELS):
                for place in (parent, parent / "models") if not is_top_folder(parent) else ():
                    if is_existing(place / text):
                        return f"it is in {place}: add --resource-path {shlex.quote(str(place))}"
        return ""

    def report_refused(self, uri: str, path: Path, where: Where, diagnostics: Diagnostics) -> None:
        """Record the error that a file exists, but that a symbolic link leads to it out of the folders of the user."""
        diagnostics.error("SK-URI-003", f"{uri}: {self.trusted.refusal(path)}", where, self.trusted.help(path))

    def format_searched_packages(self, places: list[Path], relative_to: Path | None) -> str:
        """Format the searched paths for a message about a package, and the searches that stopped at a limit."""
        unfinished = ", ".join(str(place) for place in self.packages.unfinished())
        roots = [f"below {root}" for root in self.packages.roots(self._around(relative_to))]
        return format_searched([*roots, *places]) + (
            f"; the search below {unfinished} ended at its limit" if unfinished else ""
        )

    def _is_elsewhere(self, uri: str, file: Path, relative_to: Path | None) -> bool:
        """Check whether a file was found in another folder than its URI names, for a reason that is not yet noted."""
        scheme, _, rest = package_uri(uri).partition("://")
        name = rest.strip("/").split("/")[0]
        text = path_of_file_uri(unquote(rest))
        if scheme == "file" and not Path(text).is_absolute():
            return file not in [absolute_path(folder / text) for folder in (*self._around(relative_to), *self.paths)]
        if scheme in ("package", "model") and self.packages.confirm(name, file):
            return False
        return name not in file.parts if scheme == "package" else is_relocated(uri, file)

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
        key = uri, relative_to, len(self._found)  # a found package is one more folder that a path may name
        if key in self._failures:
            return None, self._failures[key]
        try:
            path, places = self._search(uri, relative_to)
        except OutsideError:
            path, places = None, None
        if path is None and self.refused is None:  # a candidate that does not exist depends on no permission
            self._failures[key] = places
        return path, places

    def _search(self, uri: str, relative_to: Path | None) -> tuple[Path | None, list[Path] | None]:
        """Search a URI.

        Raises:
            OutsideError: the URI leaves the folders.
        """
        if uri.startswith(("http://", "https://")):
            return self.first_allowed(self.fuel_candidates(uri), relative_to)
        uri = with_known_scheme(package_uri(uri))
        scheme, separator, rest = uri.partition("://")
        if not separator:
            path, places = self._search_path(unquote(uri) if not self._exists(uri, relative_to) else uri, relative_to)
            if path is None and places is not None and is_bare_name(uri):  # gz reads a name as model://NAME
                return self.first_allowed(chain(places, self.all_models(uri, "", relative_to)), relative_to)
            return path, places
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

    def _find_source(self, path: Path, relative_to: Path | None) -> Path | None:
        """Search the file or folder that the package around an absolute path would install at this path."""
        package = enclosing_package(path.parent)
        sources = installed_sources(package, path.relative_to(package).as_posix()) if package is not None else ()
        files = (join_below(package, source) for source in sources if package is not None)
        return next((file for file in files if is_existing(file) and self.allows(file, relative_to)), None)

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
        # Gazebo is started in the folder of a package, so `file://models/…` names a file in it
        packages = (place for folder in folders for place in self._trust_around(folder)[1:])
        places = [Path(os.sep)] if is_absolute else dict.fromkeys((*folders, *self.paths, *packages))
        inside = [path for place in places if (path := join_within(limits, place, text)) is not None]
        if is_absolute and ".." not in Path(text).parts and not any(map(is_existing, inside)):
            moved = self._find_source(Path(text), relative_to) or self._find_relocated(Path(text), relative_to)
            if moved is not None:
                return moved, [moved]
        if not inside:
            return None, None
        media = () if is_absolute else self.media_candidates(text, relative_to)
        file, searched = self.first_allowed(chain(inside, media), relative_to)
        return file, inside if file is None else searched

    def _nearby_names(self, relative_to: Path | None) -> Iterable[str]:
        for root in (*self.paths, *([relative_to.parent] if relative_to else [])):
            yield from (name for name in sibling_names(root / "any") if is_folder(root / name))


def download_hint(uri: str, where: Where) -> str:
    """Return how to get the file of a URL that is not on this machine; empty for any other URI."""
    if not uri.startswith(("http://", "https://")):
        return ""
    world = shlex.quote(where.file) if where.file and is_file(Path(where.file)) else "WORLD"
    return f"download it with `simkit fetch {world}`" if parse_fuel_url(uri) else "download it by hand"
