"""Decision which installed packages a program gets as its own copies.

A package in pure Python that waits or starts threads must use the program's `time` and `threading`, so it is executed
again for each program. A package with compiled parts is shared: it cannot be loaded twice.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from functools import cache
from importlib.machinery import EXTENSION_SUFFIXES, ModuleSpec, PathFinder
from pathlib import Path
from typing import Final

from simkit.packs import is_shipped_module
from simkit_nodes.python_modules import EXECUTED_AGAIN

_MAX_FILES: Final = 400
"""Largest number of files of a package that is executed again; larger packages compute, and hardly wait."""

_WAITING: Final = EXECUTED_AGAIN - {"logging", "random", "uuid", "secrets", "_threading_local"} | {
    "time",
    "select",
    "signal",
}
_ROS: Final = frozenset(("rclpy", "rospy", "tf2_ros", "message_filters"))
_IMPORT: Final = re.compile(r"^[ \t]*(?:from[ \t]+([A-Za-z_]\w*)|import[ \t]+([^#\n;]+))", re.MULTILINE)


def is_private(name: str, spec: ModuleSpec) -> bool:
    """Check whether an installed top-level module is executed again for each program.

    Args:
        name: name of the module.
        spec: specification of the module.
    """
    if is_shipped_module(name) or spec.origin is None or not spec.origin.endswith(".py"):
        return False
    return _waits(name, spec.origin, tuple(sorted(spec.submodule_search_locations or ())))


@cache
def _waits(name: str, origin: str, folders: tuple[str, ...]) -> bool:
    files = [Path(origin)]
    for folder in folders:
        for parent, _, names in os.walk(folder):
            if any(file.endswith(tuple(EXTENSION_SUFFIXES)) for file in names):
                return False
            files += [Path(parent, file) for file in names if file.endswith(".py")]
            if len(files) > _MAX_FILES:
                return False
    imported = {top for file in files for top in _imported_names(file)}
    if imported & (_WAITING | _ROS):
        return True
    return any(_is_private_by_name(other) for other in sorted(imported - {name}))


_SEARCHED: Final[list[str]] = []  # names whose imports are being followed; packages may import each other


def _is_private_by_name(name: str) -> bool:
    spec = None if name in _SEARCHED else PathFinder.find_spec(name)
    if spec is None or not is_installed(spec.origin):
        return False
    _SEARCHED.append(name)
    try:
        return is_private(name, spec)
    finally:
        _SEARCHED.pop()


def _imported_names(file: Path) -> Iterator[str]:
    for match in _IMPORT.finditer(file.read_text(encoding="utf-8", errors="replace")):
        for name in (match[1] or match[2]).split(","):
            yield name.strip().partition(" ")[0].partition(".")[0]


def is_installed(origin: str | None) -> bool:
    """Check whether a file is in a folder of installed packages."""
    return origin is not None and any(part in ("site-packages", "dist-packages") for part in Path(origin).parts)
