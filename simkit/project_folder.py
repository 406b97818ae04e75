"""Search for the project around a file: the folder whose files may refer to each other with `..`."""

from __future__ import annotations

import os
from functools import lru_cache
from pathlib import Path
from typing import Final

from simkit.home_folder import home_folder

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
        if any(os.path.exists(ancestor / name) for name in _MARKERS):  # noqa: PTH110 (a long name is no error)
            return ancestor
        if os.path.isfile(ancestor / "__init__.py"):  # noqa: PTH113
            python_package = ancestor
    return python_package


@lru_cache(maxsize=4)
def _real_folder(folder: Path) -> Path:
    """Return a home folder with its links resolved; the home folder is asked for thousands of times in a load."""
    return folder.resolve()


def is_top_folder(folder: Path) -> bool:
    """Check for the home folder and the two highest levels of the file system, which are never searched."""
    home = home_folder()
    return len(folder.parts) < 3 or folder in (home, _real_folder(home))
