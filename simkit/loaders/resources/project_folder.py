"""Search for the project around a file: the folder whose files may refer to each other with `..`."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from simkit.loaders.resources.uris import is_existing, is_file, is_private, is_top_folder

_MARKERS: Final = (".git", "package.xml", "model.config", "pyproject.toml")
_LEVELS: Final = 4


def enclosing_project(folder: Path) -> Path | None:
    """Return the project that contains a folder, at most four levels up; never the home folder or one like `/tmp`.

    It is the nearest folder with `.git`, `package.xml`, `model.config` or `pyproject.toml`. An installed Python package
    has none of them: there, the outermost folder with `__init__.py` counts.
    """
    python_package: Path | None = None
    for ancestor in (folder, *folder.parents[:_LEVELS]):
        if is_top_folder(ancestor):
            break
        if any(is_existing(ancestor / name) for name in _MARKERS):
            return ancestor
        if is_file(ancestor / "__init__.py"):
            python_package = ancestor
    return python_package


def readable_folder(folder: Path) -> Path:
    """Return the outermost folder that a file in a folder may read with `..`.

    It is the project; without a project, it is the folder above if that folder is a model or has meshes or textures.
    """
    project = enclosing_project(folder)
    if project is not None:
        return project
    return folder if is_private(folder.parent) else folder.parent
