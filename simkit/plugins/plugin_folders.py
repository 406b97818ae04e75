"""Search for the file of a Python plugin in folders, and help for a file that is in no allowed folder."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from simkit.diagnostics import Where, did_you_mean

_MODULE: Final = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")
_LIBRARIES: Final = (".so", ".dylib", ".dll")
_MOST_FILES = 1000  # files of a folder whose names are compared with a misspelled name


def split_python_name(filename: str) -> tuple[str, str] | None:
    """Return module or file, and class (may be empty), of `file.py`, `file.py:Class` or `package.module:Class`.

    Returns:
        None for any other name, such as that of a library or of a Gazebo class.
    """
    module, _, name = filename.partition(":")
    if module.endswith(".py"):
        return module, name
    is_module = _MODULE.fullmatch(module) is not None and not module.endswith(_LIBRARIES)
    return (module, name) if is_module and name.isidentifier() else None


def module_files(module: str) -> tuple[Path, ...]:
    """Return the possible files of a module, relative to a folder."""
    if module.endswith(".py"):
        return (Path(module),)
    relative = Path(*module.split("."))
    return relative / "__init__.py", relative.with_suffix(".py")  # the order of Python's own import


def find_module(module: str, folders: Sequence[Path]) -> tuple[Path, Path] | None:
    """Return the file of a module and its search folder; a file outside the folder, also behind a link, is ignored."""
    for folder in folders:
        for relative in module_files(module):
            if is_inside(folder / relative, folder):
                return folder / relative, folder
    return None


def is_inside(file: Path, folder: Path) -> bool:
    """Check whether a file exists in a folder or in its subfolders; symbolic links are followed."""
    return file.is_file() and file.resolve().is_relative_to(folder.resolve())


def folder_help(module: str, where: Where, searched: Sequence[Path]) -> str:
    """Return what to do about a module that is in no allowed folder.

    Args:
        module: module, or file with the suffix `.py`.
        where: place that names the module; a module beside this file gives an exact answer.
        searched: allowed folders.
    """
    beside = [Path(where.file).absolute().parent] if where.file else []
    nearby = [*beside, Path.cwd()]
    if module.partition(".")[0] not in sys.stdlib_module_names:  # a module of Python has no plugins
        nearby += [Path(folder).absolute() for folder in sys.path]
    if module.endswith(".py") and Path(module).is_absolute():
        nearby, module = [Path(module).parent], Path(module).name
    module_file = find_module(module, nearby)
    if module_file is not None:
        shown = _short(module_file[1])
        return f"allow its folder: add `--plugin-path {shown}`, or plugin_paths=[{shown!r}] in Python"
    suffix = ".py" if module.endswith(".py") else ""
    folders = dict.fromkeys((*searched, *beside))
    stems = [file.name.removesuffix(".py") + suffix for folder in folders for file in _python_files(folder)]
    near = did_you_mean(module, stems)
    listed = f" (searched: {', '.join(map(_short, searched))})" if searched else ""
    return near or f"allow the folder of the file with --plugin-path DIR, or plugin_paths=['DIR'] in Python{listed}"


def _python_files(folder: Path) -> list[Path]:
    try:
        return sorted(folder.glob("*.py"))[:_MOST_FILES]
    except OSError:
        return []


def _short(folder: Path) -> str:
    """Return a folder relative to the working directory, or absolute if that is shorter."""
    return min(os.path.relpath(folder), str(folder.resolve()), key=len)
