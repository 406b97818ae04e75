"""Where a URI of an input file lies on this machine. Nothing is ever fetched from a network."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from copy import copy
from pathlib import Path
from urllib.parse import unquote

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.params import Params

_SEARCH_VARIABLES = (
    "SIMKIT_RESOURCE_PATH",
    "GZ_SIM_RESOURCE_PATH",
    "IGN_GAZEBO_RESOURCE_PATH",
    "SDF_PATH",
    "GAZEBO_MODEL_PATH",
    "ROS_PACKAGE_PATH",
)
_CACHE_VARIABLES = ("GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH")
_PATH_HINT = "name the folder that holds it with --resource-path or SIMKIT_RESOURCE_PATH"
NEWEST_SDF = (1, 12)


class Resolver:
    """Finds files and folders by URI.

    Args:
        paths: folders for `model://`, `package://` and relative URIs, searched before those of the environment.
        base: the folder of the file being loaded; searched last.
        missing_meshes: whether a mesh that is not found is only a warning (to inspect a file without its meshes).
        anywhere: lets absolute paths and `..` leave the folders named above.
    """

    def __init__(
        self,
        paths: Sequence[str | os.PathLike[str]] = (),
        *,
        base: Path | None = None,
        missing_meshes: bool = False,
        anywhere: bool = False,
    ) -> None:
        self.base, self.missing_meshes, self.anywhere = base, missing_meshes, anywhere
        found = [Path(p).expanduser() for p in paths]
        for variable in _SEARCH_VARIABLES:
            found += [Path(p) for p in os.environ.get(variable, "").split(os.pathsep) if p]
        found += [Path(p) / "share" for p in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
        self.paths: tuple[Path, ...] = tuple(dict.fromkeys(_normal(p) for p in found))

    def around(self, folder: Path | None) -> Resolver:
        """The same, with the folder of the file being loaded where none was given."""
        if self.base is not None or folder is None:
            return self
        near = copy(self)
        near.base = folder
        return near

    # ------------------------------------------------------------------ URIs

    def resolve(self, uri: str, where: Where, diagnostics: Diagnostics, relative_to: Path | None) -> Path | None:
        """The existing file or folder that `uri` names; None, with one error recorded, when there is none.

        Args:
            uri: `model://`, `package://`, `file://`, `https://` (local caches only), or a path.
            where: the place in the input file, for the report.
            diagnostics: where problems go.
            relative_to: the folder of the file that names it.
        """
        found, places = self.search(uri, relative_to)
        if found is not None:
            return found
        scheme, _, rest = uri.partition("://")
        if uri.startswith(("http://", "https://")):
            looked = _listed(places)
            diagnostics.error(
                "SK-URI-002",
                f"{uri} is not on this machine and nothing is downloaded{looked}",
                where,
                f"fetch it once with Gazebo (its cache is read), or {_PATH_HINT}",
            )
        elif places is None:
            diagnostics.error("SK-URI-003", f"{uri} leaves the folders it may use", where, _PATH_HINT)
        elif "://" in uri and scheme not in ("model", "package", "file"):
            diagnostics.error(
                "SK-URI-004",
                f"{uri}: schemes known are model, package, file, https",
                where,
                did_you_mean(scheme, ("model", "package", "file", "https")),
            )
        else:
            name = rest.split("/")[0]
            near = did_you_mean(name, self._siblings(relative_to)) if scheme in ("model", "package") else ""
            diagnostics.error("SK-URI-001", f"{uri} is not found{_listed(places)}", where, near or _PATH_HINT)
        return None

    def search(self, uri: str, relative_to: Path | None) -> tuple[Path | None, list[Path] | None]:
        """What `resolve` finds, and every place looked in (None where the URI leaves its folders)."""
        if uri.startswith(("http://", "https://")):
            return _first(list(self._fuel(uri)))
        scheme, separator, rest = uri.partition("://")
        if not separator:
            return self._path(unquote(uri) if not self._exists(uri, relative_to) else uri, relative_to)
        rest = unquote(rest)
        if scheme == "file":
            return self._path(rest, relative_to)
        if scheme not in ("model", "package"):
            return None, []
        if _escapes(rest):
            return None, None
        return _first(list(self._named(rest, relative_to)))

    def _exists(self, text: str, relative_to: Path | None) -> bool:
        return relative_to is not None and (relative_to / text).exists()

    def _named(self, rest: str, relative_to: Path | None) -> Iterator[Path]:
        """Candidates for `model://name/...`: in each folder, and a folder that itself has that name."""
        name, _, inside = rest.strip("/").partition("/")
        for root in self.paths:
            yield root / name / inside
        for root in self.paths:
            if root.name == name:
                yield root / inside
        for folder in (relative_to, self.base):
            if folder is None:
                continue
            folder = _normal(folder)
            for ancestor in (folder, *folder.parents[:3]):
                if ancestor.name == name:
                    yield ancestor / inside
            yield from (folder / name / inside, folder.parent / name / inside, folder.parent / "models" / name / inside)
        for bundle in bundled_folders("assets"):
            yield bundle / name / inside
            yield from sorted(bundle.glob(f"*/{name}/")) if not inside and name.replace("_", "").isalnum() else ()

    def _path(self, text: str, relative_to: Path | None) -> tuple[Path | None, list[Path] | None]:
        """A plain path: absolute, or relative to the file's folder, then to each resource folder."""
        folders = [f for f in (relative_to, self.base) if f is not None] or [Path.cwd()]
        roots = [*folders, *self.paths]
        if Path(text).is_absolute():
            candidates = [_normal(Path(text))]
        else:
            candidates = list(dict.fromkeys(_normal(root / text) for root in roots))
        if not self.anywhere:
            limits = [_normal(r) for r in (*roots, *bundled_folders("assets"))]
            limits += [package for f in folders if (package := _package_of(_normal(f))) is not None]
            kept = [c for c in candidates if any(c == limit or limit in c.parents for limit in limits)]
            if candidates and not kept:
                return None, None
            candidates = kept
        return _first(candidates)

    def _fuel(self, uri: str) -> Iterator[Path]:
        """Candidates for a Fuel URL in Gazebo's caches, then a folder of that name in the resource folders."""
        server, _, rest = unquote(uri).partition("://")[2].partition("/")
        parts = [p for p in rest.split("/") if p]
        if parts and parts[0].replace(".", "").isdigit():
            parts = parts[1:]
        if len(parts) < 3 or ".." in parts:
            return
        owner, kind, name, *tail = parts
        version = tail[0] if tail else "tip"
        inside = Path(*tail[2:]) if len(tail) > 2 and tail[1] == "files" else Path()
        for cache in _fuel_caches():
            for folder in (cache / server / owner / kind / name, cache / server / owner.lower() / kind / name.lower()):
                versions = sorted(
                    (p for p in folder.glob("*") if p.name.isdigit()), key=lambda p: int(p.name), reverse=True
                )
                yield from (v / inside for v in versions if version in ("tip", v.name))
                if not versions:
                    yield folder / version / inside
        for root in self.paths:
            yield from (root / spelt / inside for spelt in dict.fromkeys((name, name.replace(" ", "_").lower())))

    def _siblings(self, relative_to: Path | None) -> Iterable[str]:
        for root in (*self.paths, *([relative_to.parent] if relative_to else [])):
            if root.is_dir():
                yield from (p.name for p in root.iterdir() if p.is_dir())

    # ------------------------------------------------------------------ models

    def model_file(self, folder: Path, where: Where, diagnostics: Diagnostics) -> Path | None:
        """The SDF file of a model folder: the highest version up to 1.12 listed in `model.config`, else `model.sdf`."""
        from simkit.loaders.xml import parse_file

        for manifest in (folder / "model.config", folder / "manifest.xml"):
            if not manifest.is_file():
                continue
            document = parse_file(manifest, diagnostics)
            if document is None:
                return None
            listed = _listed_files(document.root)
            for _, name in sorted(listed, key=lambda item: item[0], reverse=True):
                if (folder / name).is_file() and not _escapes(name):
                    return folder / name
            names = ", ".join(name for _, name in listed) or "none"
            if (folder / "model.sdf").is_file():
                return folder / "model.sdf"
            diagnostics.error("SK-URI-005", f"{manifest} lists no SDF file that exists (listed: {names})", where)
            return None
        for name in ("model.sdf", f"{folder.name}.sdf"):
            if (folder / name).is_file():
                return folder / name
        diagnostics.error("SK-URI-005", f"the folder {folder} has neither model.config nor model.sdf", where)
        return None

    def find_model(self, name: str) -> Path | None:
        """The SDF or URDF file of a bundled model, by its bare name; None when there is none."""
        if not _bare(name):
            return None
        for bundle in bundled_folders("assets"):
            for folder in (bundle / name, *sorted(bundle.glob(f"*/{name}")), *sorted(bundle.glob(f"*/models/{name}"))):
                found = self.model_file(folder, Where(str(folder)), Diagnostics()) if folder.is_dir() else None
                if found is not None:
                    return found
            for suffix in ("sdf", "urdf", "xacro"):
                for file in (bundle / f"{name}.{suffix}", *sorted(bundle.glob(f"*/{name}.{suffix}"))):
                    if file.is_file():
                        return file
        return None

    def find_world(self, name: str) -> Path | None:
        """The file of a bundled world, by its bare name; None when there is none."""
        if not _bare(name):
            return None
        for bundle in bundled_folders("worlds"):
            for spelt in (name, f"{name}.sdf", f"{name}.world"):
                if (bundle / spelt).is_file():
                    return bundle / spelt
        return None

    def bundled_names(self) -> list[str]:
        """Bare names of the worlds and models that simkit brings."""
        worlds = [p.stem for bundle in bundled_folders("worlds") for p in bundle.glob("*.sdf")]
        models = [p.parent.name for bundle in bundled_folders("assets") for p in bundle.glob("**/model.config")]
        return sorted({*worlds, *models})


def bundled_folders(kind: str) -> list[Path]:
    """The folders `assets` or `worlds` that travel with simkit, beside or inside the package."""
    package = Path(__file__).resolve().parents[1]
    return [folder for folder in (package / kind, package.parent / kind) if folder.is_dir()]


def sdf_version(text: str) -> tuple[int, int] | None:
    """`"1.6"` as (1, 6); None where it is no version."""
    parts = text.strip().split(".")
    if len(parts) < 2 or not all(p.isdigit() for p in parts[:2]):
        return None
    return int(parts[0]), int(parts[1])


def _listed_files(root: Params) -> list[tuple[tuple[int, int], str]]:
    found = []
    for element in root.all("sdf"):
        version = sdf_version(element.attribute("version", "1.0")) or (1, 0)
        if version <= NEWEST_SDF and element.value:
            found.append((version, element.value))
    return found


def _bare(name: str) -> bool:
    return bool(name) and not set(name) & set("/\\*?[]<>:") and not name.startswith(".")


def _normal(path: Path) -> Path:
    """Absolute, without `..`; links stay, because a workspace of links is a folder that the user chose."""
    return Path(os.path.abspath(path))  # noqa: PTH100 - resolve() would follow links


def _escapes(rest: str) -> bool:
    depth = 0
    for part in rest.split("/")[1:]:
        depth += {"..": -1, ".": 0, "": 0}.get(part, 1)
        if depth < 0:
            return True
    return rest.split("/")[0] in ("..", ".")


def _package_of(folder: Path) -> Path | None:
    """The package that a file lies in: the nearest folder upwards with a `package.xml`."""
    for ancestor in (folder, *folder.parents[:4]):
        if (ancestor / "package.xml").is_file():
            return ancestor
    return None


def _fuel_caches() -> list[Path]:
    named = [Path(p) for v in _CACHE_VARIABLES for p in os.environ.get(v, "").split(os.pathsep) if p]
    home = Path.home()
    return [*named, home / ".gz" / "fuel", home / ".ignition" / "fuel"]


def _first(candidates: list[Path]) -> tuple[Path | None, list[Path]]:
    unique = list(dict.fromkeys(candidates))
    return next((c for c in unique if c.exists()), None), unique


def _listed(places: list[Path] | None) -> str:
    if not places:
        return ""
    shown = [str(p) for p in places[:8]]
    more = f" and {len(places) - 8} more" if len(places) > 8 else ""
    return "; looked in " + ", ".join(shown) + more
