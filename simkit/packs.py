"""Packs: packages beside the core that bring plugins, sensors, messages, worlds, commands and more.

A pack is found by its one entry point in the group `simkit.packs`: `fleet = simkit_fleet`. Its package has the folders
of the core: `simkit_fleet/plugins` is for plugins, as `simkit/plugins` is. Their contents are found by name, without
an import of the pack. Shipped packs are those in simkit's own distribution.
"""

from __future__ import annotations

import importlib.util
import logging
import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib.metadata import EntryPoint, PathDistribution, entry_points
from pathlib import Path
from typing import Any, Final

GROUP: Final = "simkit.packs"
_CORE: Final = "simkit"
_DISTRIBUTION: Final = "simkit_robotics"
_SECTION: Final = f"[{GROUP}]".encode()


@dataclass(frozen=True, slots=True)
class Pack:
    """One installed pack.

    Attributes:
        name: name of its entry point.
        package: name of its importable package.
        folder: folder of this package.
        is_shipped: True if it belongs to simkit's own distribution.
    """

    name: str
    package: str
    folder: str
    is_shipped: bool


def installed_packs() -> tuple[Pack, ...]:
    """Return all installed packs: first those that simkit ships, then those of others, sorted by name."""
    return _packs_in(tuple(sys.path))


@cache
def shipped_packs() -> tuple[Pack, ...]:
    """Return the packs in simkit's own distribution, sorted by name."""
    return tuple(pack for pack in installed_packs() if pack.is_shipped)


def foreign_packs() -> tuple[Pack, ...]:
    """Return the packs of other distributions, sorted by name."""
    return tuple(pack for pack in installed_packs() if not pack.is_shipped)


def pack_folders(part: str) -> list[str]:
    """Return the folders of all packs for one part of the core, such as `worlds` or `cli/diagnostic_codes`."""
    return list(_pack_folders(installed_packs(), part))


@lru_cache(maxsize=32)
def _pack_folders(found: tuple[Pack, ...], part: str) -> tuple[str, ...]:
    folders = (os.path.join(pack.folder, part) for pack in found)  # noqa: PTH118 (pathlib takes 3 ms to import)
    return tuple(filter(os.path.isdir, folders))


def is_shipped(cls: type) -> bool:
    """Check whether a class is a part of simkit: of the core or of a pack in simkit's own distribution."""
    return is_shipped_module(cls.__module__)


def is_shipped_module(name: str) -> bool:
    """Check whether a module is a part of simkit: of the core or of a pack in simkit's own distribution."""
    package = name.partition(".")[0]
    return package == _CORE or any(package == pack.package for pack in shipped_packs())


def is_shipped_file(path: str) -> bool:
    """Check whether a file is in the folder of the core or of a pack in simkit's own distribution."""
    return any(path.startswith(f"{folder}{os.sep}") for folder in shipped_folders())


@cache
def shipped_folders() -> tuple[Path, ...]:
    """Return the folders with the code of simkit: the core's, then those of the packs that simkit ships."""
    core = Path(__file__).resolve().parent
    return core, *(Path(pack.folder).resolve() for pack in shipped_packs())


def entry_points_of(group: str) -> list[EntryPoint]:
    """Return the entry points of a group.

    Reading all entry points takes 20 ms, so they are cached until a folder of `sys.path` changes.
    """
    state = tuple((folder, _folder_time(Path(folder))) for folder in sys.path)
    return list(_all_entry_points(state).select(group=group))


@lru_cache(maxsize=1)
def _all_entry_points(_state: tuple[tuple[str, int], ...]) -> Any:  # its type differs between Python 3.11 and 3.12
    return entry_points()


def _folder_time(folder: Path) -> int:
    """Return the time at which an entry of a folder was last added or removed [ns]; 0 if there is no folder."""
    try:
        return folder.stat().st_mtime_ns
    except OSError:
        return 0


@lru_cache(maxsize=8)
def _packs_in(path: tuple[str, ...]) -> tuple[Pack, ...]:
    """Return the packs in the folders of an import path; of two with one package, the first one counts."""
    found: dict[str, Pack] = {}
    for distribution, is_own in _distributions_with_packs(path):
        for point in distribution.entry_points:
            if point.group == GROUP and point.value not in found:
                folder = _folder_of(point)
                if folder is not None:
                    found[point.value] = Pack(point.name, point.value, folder, is_own)
    return tuple(sorted(found.values(), key=lambda pack: (not pack.is_shipped, pack.name, pack.package)))


def _distributions_with_packs(path: tuple[str, ...]) -> Iterator[tuple[PathDistribution, bool]]:
    """Yield each distribution that has a pack, and whether it is simkit's own.

    Only the texts with entry points are read, in 1 ms for 130 distributions; `entry_points` parses them all in 16 ms.
    """
    for place in path:
        try:
            with os.scandir(place or ".") as entries:
                infos = sorted(e.path for e in entries if e.name.endswith((".dist-info", ".egg-info")))
        except OSError:
            continue
        for info in infos:
            try:
                with open(os.path.join(info, "entry_points.txt"), "rb", buffering=0) as file:  # noqa: PTH118
                    has_pack = _SECTION in file.read()
            except OSError:
                continue
            if has_pack:
                name = os.path.basename(info).partition("-")[0]  # noqa: PTH119
                yield PathDistribution(Path(info)), name.lower().replace("-", "_") == _DISTRIBUTION


def _folder_of(point: EntryPoint) -> str | None:
    """Return the folder of a pack's package; None, with a warning, if the package is missing."""
    try:
        spec = importlib.util.find_spec(point.value)
    except (ImportError, ValueError):
        spec = None
    if spec is None or not spec.submodule_search_locations:
        logging.getLogger("simkit").warning(
            "pack %s: the package %s is missing; install its distribution again", point.name, point.value
        )
        return None
    return next(iter(spec.submodule_search_locations))
