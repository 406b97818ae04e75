"""Files of values that plugins read (controllers, motions), as leaves: a comment in one is no difference."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_SUFFIXES: Final = frozenset((".yaml", ".yml"))
_MOST: Final = 100_000  # values of one file
_DEEPEST: Final = 60
_LONGEST: Final = 8 << 20  # bytes
_PLAIN: Final = re.compile(r"[\w/*:-]+")


def files_read(sim: Simulation) -> list[Path]:
    """The files that plugins have found, each once."""
    return list(dict.fromkeys(path.resolve() for path in sim.structure.builder.files_read))


def leaves_of_files(paths: Iterable[Path]) -> tuple[dict[str, Any], dict[str, str], set[Path]]:
    """What is in files of values.

    Args:
        paths: files; those of another kind are left out.

    Returns:
        Path of a leaf (`files[controllers.yaml].arm.gains.p`) -> value, `file:line`, and the files that were read.
    """
    leaves: dict[str, Any] = {}
    places: dict[str, str] = {}
    read = set()
    for path in sorted(set(paths)):
        root = _root(path)
        if root is None:
            continue
        taken = any(key.startswith(f"files[{path.name}]") for key in leaves)
        name = f"{path.parent.name}/{path.name}" if taken else path.name
        found: dict[str, tuple[Any, int]] = {}
        if _walk(root, f"files[{name.replace('%', '%25').replace(']', '%5D')}]", found, 0):
            leaves.update({key: value for key, (value, _) in found.items()})
            places.update({key: f"{path}:{line}" for key, (_, line) in found.items()})
            read.add(path)
    return leaves, places, read


def _root(path: Path) -> Any:
    """The document of a file; None where it is not one of values."""
    if path.suffix.lower() not in _SUFFIXES:
        return None
    import yaml

    from simkit.sinks.yaml_text import loader

    try:
        if path.stat().st_size > _LONGEST:
            return None
        return yaml.compose(path.read_text(encoding="utf-8"), Loader=loader())
    except (OSError, UnicodeDecodeError, yaml.YAMLError, RecursionError):
        return None


def _walk(node: Any, path: str, found: dict[str, tuple[Any, int]], depth: int) -> bool:
    """Goes through a document; False where it is too large, or holds itself."""
    if depth > _DEEPEST or len(found) > _MOST:
        return False
    line = node.start_mark.line + 1
    if node.id == "mapping":
        for key, value in node.value:
            name = str(key.value) if key.id == "scalar" else "?"
            step = f".{name}" if _PLAIN.fullmatch(name) else f".of[{name.replace('%', '%25').replace(']', '%5D')}]"
            if not _walk(value, path + step, found, depth + 1):
                return False
        return True
    if node.id == "sequence":
        if all(item.id == "scalar" for item in node.value):
            found[path] = ([_value(item) for item in node.value], line)
            return True
        return all(_walk(item, f"{path}.item[{n}]", found, depth + 1) for n, item in enumerate(node.value))
    found[path] = (_value(node), line)
    return True


def _value(node: Any) -> Any:
    """A scalar: the number that it is, or its text."""
    try:
        return float(node.value) if not node.style else node.value
    except ValueError:
        return {"true": True, "false": False}.get(node.value.lower(), node.value) if not node.style else node.value
