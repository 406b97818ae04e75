"""Search for the worlds, models and robots of a folder, and for the files that packs know how to run.

The search follows no links, opens regular files only, and reads the beginning of a file to find its root element.
A pack describes files that have a command of their own in `folder_files.toml`, in the folder of its package:

    [launch]
    title = "launch file"
    patterns = ["*.launch", "*.launch.py"]
    command = "simkit launch {file}"
    reason = "launch files are programs, and none of them is executed"
"""

from __future__ import annotations

import os
import re
import stat
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Final

from simkit.loaders import loader_kinds
from simkit.loaders.resources.xml_reader import without_comments
from simkit.packs import installed_packs, warn_of_pack
from simkit.trusted_folders import is_link_entry

FILE: Final = "folder_files.toml"
MOST_FILES: Final = 5000
"""Largest number of files that a check of a folder finds."""
_MOST_ENTRIES: Final = 500_000  # entries of folders; a search takes about 10 s then
_MOST_DEPTH: Final = 40
_HEAD: Final = 1 << 16  # bytes of a file in which its root element must begin
_SUFFIXES: Final = (".sdf", ".world", ".urdf", ".xacro", ".xml", ".mjcf")
_ONLY_OURS: Final = (".sdf", ".urdf")
"""Suffixes of files that are worlds, models or robots even if no root element can be read."""
_TEMPLATES: Final = tuple(f"{name}{end}" for name in _SUFFIXES for end in (".erb", ".em", ".jinja", ".j2", ".in"))
_SKIPPED: Final = frozenset(
    ("build", "install", "devel", "log", "node_modules", "__pycache__", "venv", "site-packages")
)
_ROOT: Final = re.compile(rb"<([A-Za-z_][\w.-]*)")
_KEYS: Final = frozenset(("title", "patterns", "command", "reason"))


@dataclass(frozen=True)
class OtherKind:
    """Files that a check of a folder lists, but does not check.

    Attributes:
        title: name of the kind, in the singular.
        reason: why the files are not checked.
        patterns: shell patterns of the names of files.
        command: command for one file, with `{file}`; empty for none.
    """

    title: str
    reason: str
    patterns: tuple[str, ...]
    command: str = ""


TEMPLATES: Final = OtherKind(
    "template", "a program must first make a world or model of it", tuple(f"*{end}" for end in _TEMPLATES)
)


@dataclass
class FolderFiles:
    """Files of a folder, as paths relative to it.

    Attributes:
        files: worlds, models and robots in the order of their paths.
        others: files that are listed only, by their kind.
        unreadable: folders that this user may not read.
        is_complete: False if the folder has too many entries, so that the search stopped.
    """

    files: list[str] = field(default_factory=list)
    others: dict[OtherKind, list[str]] = field(default_factory=dict)
    unreadable: list[str] = field(default_factory=list)
    is_complete: bool = True


def find_files(folder: Path) -> FolderFiles:
    """Find the files of a folder that can be checked.

    Hidden folders and links are skipped, and folders with the results of a build.
    """
    found, kinds, roots = FolderFiles(), other_kinds(), frozenset(loader_kinds())
    for path, is_last in _walk(folder, found.unreadable):
        if is_last or len(found.files) >= MOST_FILES:
            found.is_complete = False
            break
        name = path.rpartition("/")[2]
        kind = next((kind for kind in kinds if any(fnmatchcase(name, pattern) for pattern in kind.patterns)), None)
        if kind is not None:
            found.others.setdefault(kind, []).append(path)
        elif name.lower().endswith(_SUFFIXES):
            root = root_element(folder / path)
            if root in roots or (not root and name.lower().endswith(_ONLY_OURS)):
                found.files.append(path)
    return found


def _walk(folder: Path, unreadable: list[str]) -> Iterator[tuple[str, bool]]:
    """Yield the paths of all regular files in order, and True with the last one if there are too many entries.

    Folders that cannot be read are added to `unreadable`.
    """
    left = _MOST_ENTRIES
    waiting: list[tuple[str, int]] = [("", 0)]
    while waiting:
        below, depth = waiting.pop()
        try:
            with os.scandir(folder / below) as entries:
                listed = sorted((entry for entry in entries if not is_link_entry(entry)), key=lambda entry: entry.name)
        except OSError:
            unreadable.append(below or ".")
            continue
        left -= len(listed)
        folders = []
        for entry in listed:
            path = f"{below}/{entry.name}" if below else entry.name
            if entry.is_dir(follow_symlinks=False):
                if not entry.name.startswith(".") and entry.name not in _SKIPPED and depth < _MOST_DEPTH:
                    folders.append((path, depth + 1))
            elif entry.is_file(follow_symlinks=False):
                yield path, left < 0
        waiting.extend(reversed(folders))


def root_element(path: Path) -> str:
    """Return the name of the root element of an XML file; empty if it is not found in the beginning of the file."""
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
    try:
        handle = os.open(path, flags)
    except (OSError, ValueError):
        return ""
    try:
        head = os.read(handle, _HEAD) if stat.S_ISREG(os.fstat(handle).st_mode) else b""
    except OSError:
        return ""
    finally:
        os.close(handle)
    match = _ROOT.search(without_comments(head.replace(b"\0", b"")))
    return match[1].decode("ascii", "replace") if match else ""


def other_kinds() -> Sequence[OtherKind]:
    """Return the kinds of files that are listed only: those of the packs, then templates."""
    kinds: list[OtherKind] = []
    for pack in installed_packs():
        path = Path(pack.folder, FILE)
        try:
            table = tomllib.loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            continue
        except (OSError, ValueError) as error:
            if pack.is_shipped:
                raise
            warn_of_pack(pack.package, f"{path}: {error}")
            continue
        for name, entry in table.items():
            if fault := _fault(entry):
                warn_of_pack(pack.package, f"{path}: {name}: {fault}; it is left out")
            else:
                kinds.append(OtherKind(entry["title"], entry["reason"], tuple(entry["patterns"]), entry["command"]))
    return [*kinds, TEMPLATES]


def _fault(entry: object) -> str:
    """Return what is wrong in the description of a kind of files; empty if nothing is."""
    if not isinstance(entry, dict) or entry.keys() != _KEYS:
        return f"expected a table with {', '.join(sorted(_KEYS))}"
    patterns = entry["patterns"]
    if not isinstance(patterns, list) or not all(isinstance(pattern, str) for pattern in patterns):
        return "patterns: expected a list of texts"
    wrong = next((key for key in sorted(_KEYS - {"patterns"}) if not isinstance(entry[key], str)), "")
    return f"{wrong}: expected a text" if wrong else ""
