"""Packs: packages beside the core that bring plugins, sensors, messages, worlds, commands and more.

A pack is found by its one entry point in the group `simkit.packs`: `fleet = simkit_fleet`. Its package has the folders
of the core: `simkit_fleet/plugins` is for plugins, as `simkit/plugins` is. Their contents are found by name, without
an import of the pack. Shipped packs are those in simkit's own distribution.
"""

from __future__ import annotations

import importlib.util
import json
import logging
import os
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from typing import Final

from simkit.install_command import install_command

GROUP: Final = "simkit.packs"
_CORE: Final = "simkit"
_DISTRIBUTION: Final = "simkit_robotics"
_SECTION: Final = f"[{GROUP}]"
_LEFT_OUT: Final = "left_out_packs.json"
"""File in a wheel without packs (`SIMKIT_PACKS=none`): names of plugins, sensors, commands and demo steps of packs."""


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
def _pack_folders(packs: tuple[Pack, ...], part: str) -> tuple[str, ...]:
    folders = (os.path.join(pack.folder, part) for pack in packs)  # noqa: PTH118 (pathlib takes 3 ms to import)
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


@cache
def left_out_names(*attributes: str) -> Mapping[str, str]:
    """Return the pack of each name of a plugin, sensor, command or demo step; empty if simkit was built with its packs.

    Args:
        attributes: class attributes with the names, such as `filenames` or `kinds`; or `commands`, `demo_steps`.
    """
    try:
        tables = json.loads(Path(__file__).with_name(_LEFT_OUT).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    return {name: pack for attribute in attributes for name, pack in tables[attribute].items()}


def missing_pack_text(pack: str) -> tuple[str, str]:
    """Return the end of a message about something that needs a missing pack, and the advice."""
    return f"needs the pack {pack}, which is not installed", f"install simkit with its packs: {install_command()}"


@cache
def warn_of_pack(package: str, text: str) -> None:
    """Report, once, a fault in a package of another distribution, without which simkit continues.

    Args:
        package: name of the package.
        text: file, line and fault.
    """
    logging.getLogger("simkit").warning("package %s: %s", package, text)


def fault_text(error: BaseException, folder: str) -> str:
    """Return place and text of an exception that code in a folder caused: `file:line: class: text`."""
    text = f"{type(error).__name__}: {error.msg if isinstance(error, SyntaxError) else error}"
    places = [place for place in _places_of(error) if place[0].startswith(folder)]
    return f"{places[-1][0]}:{places[-1][1]}: {text}" if places else text


def foreign_pack_of(error: BaseException) -> Pack | None:
    """Return the pack of another distribution whose code caused an exception; None if simkit's code caused it."""
    files = [file for file, _ in _places_of(error)]
    packs = foreign_packs()
    owners = [pack for file in reversed(files) for pack in packs if file.startswith(f"{pack.folder}{os.sep}")]
    return next(iter(owners), None)


def _places_of(error: BaseException) -> Iterator[tuple[str, int]]:
    """Yield file and line of each call that an exception ended, and of a syntax error."""
    trace = error.__traceback__
    while trace is not None:
        yield trace.tb_frame.f_code.co_filename, trace.tb_lineno
        trace = trace.tb_next
    if isinstance(error, SyntaxError) and error.filename:
        yield error.filename, error.lineno or 1


@lru_cache(maxsize=8)
def _packs_in(path: tuple[str, ...]) -> tuple[Pack, ...]:
    """Return the packs in the folders of an import path; of two with one package, the first one counts."""
    packs: dict[str, Pack] = {}
    for name, package, is_own in _pack_entry_points(path):
        if package not in packs:
            folder = _folder_of(name, package)
            if folder is not None:
                packs[package] = Pack(name, package, folder, is_own)
    return tuple(sorted(packs.values(), key=lambda pack: (not pack.is_shipped, pack.name, pack.package)))


def _pack_entry_points(path: tuple[str, ...]) -> Iterator[tuple[str, str, bool]]:
    """Yield name and package of the entry point of each pack, and whether it is in simkit's own distribution.

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
                with open(os.path.join(info, "entry_points.txt"), encoding="utf-8") as file:  # noqa: PTH118
                    _, _, text = file.read().partition(_SECTION)
            except (OSError, UnicodeDecodeError):
                continue
            distribution = os.path.basename(info).partition("-")[0]  # noqa: PTH119
            is_own = distribution.lower().replace("-", "_") == _DISTRIBUTION
            for line in text.partition("\n[")[0].splitlines():
                name, equals, package = (word.strip() for word in line.partition("="))
                if equals and not name.startswith("#"):
                    yield name, package, is_own


def _folder_of(name: str, package: str) -> str | None:
    """Return the folder of a pack's package; None, with a warning, if the package is missing."""
    try:
        spec = importlib.util.find_spec(package)
    except (ImportError, ValueError):
        spec = None
    if spec is None or not spec.submodule_search_locations:
        logging.getLogger("simkit").warning(
            "pack %s: the package %s is missing; install its distribution again", name, package
        )
        return None
    return next(iter(spec.submodule_search_locations))
