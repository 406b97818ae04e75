"""Questions about URIs and paths: what they name, whether they stay inside a folder, whether they exist."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable
from itertools import islice
from pathlib import Path
from urllib.parse import unquote


def package_uri(uri: str) -> str:
    """`$(find pkg)/...`, alone or after `file://`, as `package://pkg/...`."""
    plain = uri.removeprefix("file://")
    if not plain.startswith("$(find"):
        return uri
    name, _, rest = plain.partition(")")
    words = name.removeprefix("$(").split()
    return f"package://{words[-1]}/{rest.strip('/')}" if len(words) == 2 else uri


def is_relocated(uri: str, found: Path) -> bool:
    """Whether an absolute path, or a package, was found under another name."""
    scheme, _, rest = uri.partition("://")
    if scheme == "package":
        return rest.split("/")[0] not in found.parts
    plain = Path(unquote(uri.removeprefix("file://")))
    return plain.is_absolute() and absolute_path(plain) != absolute_path(found)


def absolute_path(path: Path) -> Path:
    """Absolute, without `..`; links stay, because a workspace of links is a folder that the user chose."""
    return Path(os.path.abspath(path))  # noqa: PTH100 - resolve() would follow links


def leaves_folder(rest: str) -> bool:
    """Whether what follows `scheme://name` climbs out of that name."""
    depth = 0
    for part in rest.split("/")[1:]:
        depth += {"..": -1, ".": 0, "": 0}.get(part, 1)
        if depth < 0:
            return True
    return rest.split("/")[0] in ("..", ".")


def first_existing(candidates: Iterable[Path]) -> tuple[Path | None, list[Path]]:
    """The first place that is there, and every place looked at, once; none is thought of after the first."""
    looked: dict[Path, None] = {}
    for candidate in candidates:
        if candidate not in looked:
            looked[candidate] = None
            if is_existing(candidate):
                return candidate, list(looked)
    return None, list(looked)


def is_existing(path: Path) -> bool:
    """Whether a file or folder is there; a device or a pipe is neither, nor has a name that no file could have one."""
    try:
        mode = path.stat().st_mode
        return stat.S_ISREG(mode) or stat.S_ISDIR(mode)
    except (OSError, ValueError):
        return False


def format_searched(places: list[Path] | None) -> str:
    """The places looked in, for a message."""
    if not places:
        return ""
    shown = [str(p) for p in places[:8]]
    more = f" and {len(places) - 8} more" if len(places) > 8 else ""
    return "; looked in " + ", ".join(shown) + more


def access_problem(path: Path) -> str:
    """What keeps a path from being looked at, in words; empty where nothing does, or nothing is there."""
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
    """Names in the folder of a path, as far as it may be listed, of a thousand at most."""
    try:
        return [p.name for p in islice(path.parent.iterdir(), 1000)]
    except OSError:
        return []


def is_file(path: Path) -> bool:
    """Whether a file is there and may be seen; `Path.is_file` raises for one in a folder that is closed to us."""
    return os.path.isfile(path)  # noqa: PTH113


def is_folder(path: Path) -> bool:
    """The same for a folder."""
    return os.path.isdir(path)  # noqa: PTH112


def is_small_integer(text: str) -> bool:
    """Whether a text is a whole number of a few digits (`int` takes neither `²` nor thousands of digits)."""
    return text.isascii() and text.isdigit() and len(text) < 10


def is_path_of_other_machine(uri: str) -> bool:
    """Whether a URI is an absolute path that leads nowhere on this machine, as tools that export meshes write them."""
    path = Path(unquote(uri.removeprefix("file://")))
    return path.is_absolute() and not os.path.lexists(path)
