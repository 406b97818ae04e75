"""Folders of packages: installed ones, those in the workspace around the program, and those of simkit.

Nothing is built. A package in a source tree has its own folder in place of `PREFIX/share/NAME`: the files of `launch`,
`config`, `urdf` and so on have the same paths there, unless `setup.py` or CMake installs them in other folders.
"""

from __future__ import annotations

import os
import pathlib
import re
from typing import Final

from simkit_nodes.host import current_program
from simkit_nodes.ros_modules.ament_index_python.search_paths import get_search_paths

__all__ = [
    "PackageNotFoundError",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
]

_NAME: Final = re.compile("[a-zA-Z0-9][a-zA-Z0-9_-]+", re.ASCII)


class PackageNotFoundError(KeyError):
    """No package has this name."""


def _folder(package_name: str) -> pathlib.Path:
    if _NAME.fullmatch(package_name) is None:
        raise ValueError(f"'{package_name}' is not a valid package name")
    folder = current_program().package_folder(package_name)
    if folder is None:
        raise PackageNotFoundError(f"package '{package_name}' not found, searching: {get_search_paths()}")
    return folder


def prefix_of(folder: pathlib.Path) -> str:
    """Return the folder in which a package is installed; the package itself if it is in a source tree."""
    return str(folder.parents[1] if folder.parent.name == "share" else folder)


def get_packages_with_prefixes() -> dict[str, str]:
    """Return the folder in which each package is installed, by name."""
    return {name: prefix_of(folder) for name, folder in current_program().workspace.packages().items()}


def get_package_prefix(package_name: str) -> str:
    """Return the folder in which a package is installed; the package itself if it is in a source tree.

    Raises:
        PackageNotFoundError: there is no such package.
        ValueError: the name is invalid.
    """
    return prefix_of(_folder(package_name))


def get_package_share_directory(package_name: str, print_message: bool = True) -> str:
    """Return the folder with the files of a package.

    Args:
        package_name: name of the package.
        print_message: accepted; the folder always exists.

    Raises:
        PackageNotFoundError: there is no such package.
        ValueError: the name is invalid.
    """
    del print_message
    return os.fspath(_folder(package_name))


def get_package_share_path(package_name: str, print_message: bool = True) -> pathlib.Path:
    """Return the folder with the files of a package; see `get_package_share_directory`."""
    return pathlib.Path(get_package_share_directory(package_name, print_message))
