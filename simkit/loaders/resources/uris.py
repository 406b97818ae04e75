"""Checks and conversions of URIs and paths: the names in them, their folders, and their existence."""

from __future__ import annotations

import os
import stat
from collections.abc import Sequence
from itertools import islice
from pathlib import Path
from urllib.parse import unquote

from simkit.diagnostics import did_you_mean
from simkit.project_folder import is_top_folder
from simkit.trusted_folders import OutsideError, join_below

_MOST_LISTED = 1000  # searched paths, and names of a folder, that are compared for a hint
_MANIFESTS = ("model.config", "model.sdf", "package.xml", "manifest.xml")
_ASSETS = ("assets", "materials", "media", "mesh", "meshes", "stl", "stls", "textures")


def package_uri(uri: str) -> str:
    """Convert `$(find pkg)/...`, alone or after `file://`, to `package://pkg/...`."""
    plain = uri.removeprefix("file://")
    if not plain.startswith("$(find"):
        return uri
    name, _, rest = plain.partition(")")
    words = name.removeprefix("$(").split()
    return f"package://{words[-1]}/{rest.strip('/')}" if len(words) == 2 else uri


def path_of_file_uri(rest: str, has_drives: bool = os.name == "nt") -> str:
    """Return the path that the part of a URI after `file://` names.

    Args:
        rest: the part, without quoted characters.
        has_drives: True on Windows, where `/C:/world.sdf` names `C:/world.sdf`.
    """
    is_drive = has_drives and rest[:1] == "/" and rest[1:2].isalpha() and rest[2:3] == ":"
    return rest[1:] if is_drive else rest


def is_relocated(uri: str, file: Path) -> bool:
    """Check whether the file of an absolute path was found in another folder than the path names."""
    plain = Path(path_of_file_uri(unquote(uri.removeprefix("file://"))))
    return plain.is_absolute() and absolute_path(plain) != absolute_path(file)


def absolute_path(path: Path) -> Path:
    """Return the absolute path without `..`; symbolic links stay, because a workspace can consist of links."""
    return Path(os.path.abspath(path))  # noqa: PTH100 - resolve() would follow links


def split_rest(rest: str) -> tuple[str, str]:
    """Return the name and the path below it in the part of a URI after `model://` or `package://`, without quotes.

    Doubled slashes are dropped. An empty name names nothing.

    Raises:
        OutsideError: the path leaves the folder of that name.
    """
    name, _, inside = rest.lstrip("/").partition("/")
    if len(join_below(Path(), name).parts) != 1 and name:
        raise OutsideError(f"{rest!r} has no name")
    return name, join_below(Path(), inside, in_uri=True).as_posix()


def is_private(folder: Path) -> bool:
    """Check whether a folder exists, but a file near it must not read it by its name.

    A model, a package, and a folder with meshes or textures may be read. The home folder and the two highest levels of
    the file system are always private.
    """
    if is_top_folder(folder):
        return True
    is_open = any(is_file(folder / name) for name in _MANIFESTS) or any(is_folder(folder / name) for name in _ASSETS)
    return not is_open and is_existing(folder)


def is_existing(path: Path) -> bool:
    """Check whether a file or folder exists; a device, a pipe or an invalid name does not count."""
    try:
        mode = path.stat().st_mode
        return stat.S_ISREG(mode) or stat.S_ISDIR(mode)
    except (OSError, ValueError):
        return False


def format_searched(places: Sequence[Path | str] | None) -> str:
    """Format the searched paths for a message."""
    if not places:
        return ""
    shown = [str(p) for p in places[:8]]
    more = f" and {len(places) - 8} more" if len(places) > 8 else ""
    return "; searched " + ", ".join(shown) + more


def similar_name_hint(places: list[Path] | None) -> str:
    """Suggest a file beside a searched path with a similar name; empty if there is none.

    A name that differs only in upper and lower case comes first.
    """
    similar = ""
    for place in (places or [])[:_MOST_LISTED]:
        try:
            with os.scandir(place.parent) as entries:
                names = [entry.name for entry in islice(entries, _MOST_LISTED)]
        except OSError:
            continue
        for name in names:
            if name.casefold() == place.name.casefold():
                return f"did you mean {name!r}? Upper and lower case differ"
        similar = similar or did_you_mean(place.name, names)
    return similar


def folder_of_name(places: list[Path] | None, rest: str) -> Path | None:
    """Return the folder of the model or package in a URI, if one of the searched paths is in it.

    Args:
        places: searched paths.
        rest: the part of the URI after `model://` or `package://`.
    """
    name, *inside = [part for part in unquote(rest).split("/") if part] or [""]
    depth = len(inside)
    folders = (place.parents[depth - 1] for place in places or [] if 0 < depth <= len(place.parents))
    return next((folder for folder in folders if folder.name == name and is_folder(folder)), None)


def access_problem(path: Path) -> str:
    """Describe the error that prevents access to a path; empty if there is none or if nothing exists there."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return ""
    except OSError as problem:
        return problem.strerror or str(problem)
    except ValueError:
        return "no file can have such a name"
    return ""


def sibling_names(path: Path) -> list[str]:
    """Return at most 1000 names in the folder of a path, or none if the folder cannot be listed."""
    try:
        return [p.name for p in islice(path.parent.iterdir(), 1000)]
    except OSError:
        return []


def is_file(path: Path) -> bool:
    """Check whether a file exists and is visible; `Path.is_file` raises an error in a folder without permission."""
    return os.path.isfile(path)  # noqa: PTH113


def is_folder(path: Path) -> bool:
    """Check whether a folder exists and is visible."""
    return os.path.isdir(path)  # noqa: PTH112


def is_link(path: Path) -> bool:
    """Check whether the last name of a path is a symbolic link, or a junction of Windows."""
    if os.name == "nt":
        return os.path.realpath(path) != str(Path(os.path.realpath(path.parent)) / path.name)
    return os.path.islink(path)  # noqa: PTH114 - `Path.is_symlink` raises an error for an invalid name


def is_small_integer(text: str) -> bool:
    """Check whether a text is an integer of fewer than 10 digits; `int` fails for `²` and for 5000 digits."""
    return text.isascii() and text.isdigit() and len(text) < 10


def is_path_of_other_machine(uri: str) -> bool:
    """Check whether a URI is an absolute path that does not exist here; mesh exporters write such paths."""
    path = Path(path_of_file_uri(unquote(uri.removeprefix("file://"))))
    return path.is_absolute() and not os.path.lexists(path)
