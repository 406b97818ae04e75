"""Small questions about URIs and paths: what they name, whether they stay inside, which of several is there."""

from __future__ import annotations

import os
from pathlib import Path
from urllib.parse import unquote


def without_find(uri: str) -> str:
    """`$(find pkg)/...`, alone or after `file://`, as `package://pkg/...`."""
    plain = uri.removeprefix("file://")
    if not plain.startswith("$(find"):
        return uri
    name, _, rest = plain.partition(")")
    words = name.removeprefix("$(").split()
    return f"package://{words[-1]}/{rest.strip('/')}" if len(words) == 2 else uri


def is_elsewhere(uri: str, found: Path) -> bool:
    """Whether an absolute path, or a package, was found under another name."""
    scheme, _, rest = uri.partition("://")
    if scheme == "package":
        return rest.split("/")[0] not in found.parts
    plain = Path(unquote(uri.removeprefix("file://")))
    return plain.is_absolute() and normal(plain) != normal(found)


def normal(path: Path) -> Path:
    """Absolute, without `..`; links stay, because a workspace of links is a folder that the user chose."""
    return Path(os.path.abspath(path))  # noqa: PTH100 - resolve() would follow links


def escapes(rest: str) -> bool:
    """Whether what follows `scheme://name` climbs out of that name."""
    depth = 0
    for part in rest.split("/")[1:]:
        depth += {"..": -1, ".": 0, "": 0}.get(part, 1)
        if depth < 0:
            return True
    return rest.split("/")[0] in ("..", ".")


def first_of(candidates: list[Path]) -> tuple[Path | None, list[Path]]:
    """The first place that is there, and every place once."""
    unique = list(dict.fromkeys(candidates))
    return next((c for c in unique if is_there(c)), None), unique


def is_there(path: Path) -> bool:
    """Whether a file or folder is there; a name that no file could have is not."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def listed(places: list[Path] | None) -> str:
    """The places looked in, for a message."""
    if not places:
        return ""
    shown = [str(p) for p in places[:8]]
    more = f" and {len(places) - 8} more" if len(places) > 8 else ""
    return "; looked in " + ", ".join(shown) + more
