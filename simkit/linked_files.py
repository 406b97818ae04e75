"""Check of the symbolic links on the way to a file that the user names, or that is in a folder that the user names."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

from simkit import hidden_text
from simkit.project_folder import enclosing_project, is_top_folder
from simkit.trusted_folders import TrustedFolders, built_workspace

SEARCH_VARIABLES: Final = (
    "SIMKIT_RESOURCE_PATH",
    "GZ_SIM_RESOURCE_PATH",
    "SDF_PATH",
    "GAZEBO_MODEL_PATH",
    "GAZEBO_RESOURCE_PATH",
    "ROS_PACKAGE_PATH",
)
"""Environment variables with search paths of the user."""
_PREFIX_VARIABLES: Final = ("AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "CMAKE_PREFIX_PATH")
_OPEN_FILES: Final = ("/dev/fd/", "/proc/self/fd/")  # files that the user's shell opened: `<(command)`
_chosen: dict[Path, None] = {}


def choose_folders(folders: Iterable[Path]) -> None:
    """Note search paths that the user gave by an option; links may lead to files in them."""
    _chosen.update(dict.fromkeys(folders))


def leads_outside(path: str) -> bool:
    """Check whether a link on the way to a file leads out of the folder and the project that the link is in.

    Links in the home folder and in the two highest levels of the file system belong to the user or the system.
    """
    if path.startswith(_OPEN_FILES):
        return False
    if os.path.realpath(path) == os.path.abspath(path):  # noqa: PTH100 - resolve() would follow links
        return False
    place = Path.cwd()
    for name in Path(path).parts:
        if name == "..":  # the folder above the folder that a link leads to
            place = Path(os.path.realpath(place)).parent
            continue
        place /= name
        if place.is_symlink() and _leaves(place):
            return True
    return False


def hide_linked_text(path: str | Path, inside: Path | None = None) -> None:
    """Hide the text of a file in messages, if a link on the way to what the user names leads outside.

    Args:
        path: file that is read.
        inside: folder that the user names, in which the file is; None if the user names the file.
    """
    if leads_outside(str(path if inside is None else inside)):
        hidden_text.hide(str(path), os.path.dirname(os.path.realpath(path)))  # noqa: PTH120
    elif hidden_text.is_hiding():
        hidden_text.show(str(path))


def is_below(path: str | Path, folder: Path) -> bool:
    """Check whether a file that was found in a folder is in this folder, in its project or in a folder of the user."""
    lexical = os.path.abspath(path)  # noqa: PTH100
    if os.path.realpath(lexical) == lexical:
        return True
    place = Path(os.path.abspath(folder))  # noqa: PTH100
    return TrustedFolders(_around(place), _search_paths()).allows(Path(lexical))


def _leaves(link: Path) -> bool:
    if is_top_folder(link.parent):
        return False
    return not TrustedFolders(_around(link.parent), _search_paths()).allows(link)


def _around(folder: Path) -> Iterator[Path]:
    """Yield a folder, the projects that contain it, and the workspace that it was built in."""
    yield folder
    project = enclosing_project(folder)
    while project is not None:
        yield project
        project = enclosing_project(project.parent)
    yield from built_workspace(folder)


def _search_paths() -> Iterator[Path]:
    yield from _chosen
    for variable in (*SEARCH_VARIABLES, *_PREFIX_VARIABLES):
        yield from (Path(part) for part in os.environ.get(variable, "").split(os.pathsep) if part)
