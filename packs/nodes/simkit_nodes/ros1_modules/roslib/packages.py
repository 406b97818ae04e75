"""Folders of ROS packages."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from simkit_nodes.packages import package_name
from simkit_nodes.ros_modules.rospkg import ResourceNotFound, RosPack

__all__ = ["InvalidROSPkgException", "find_node", "find_resource", "get_dir_pkg", "get_pkg_dir", "list_pkgs"]


class InvalidROSPkgException(Exception):
    """There is no such package."""


def get_pkg_dir(
    package: str, required: bool = True, ros_root: object = None, ros_package_path: object = None
) -> str | None:
    """Return the folder of a package.

    Args:
        package: name of the package.
        required: True for an error instead of None for an unknown package.
        ros_root: accepted as in ROS.
        ros_package_path: accepted as in ROS.

    Raises:
        InvalidROSPkgException: there is no such package.
    """
    try:
        return RosPack().get_path(package)
    except ResourceNotFound:
        if required:
            raise InvalidROSPkgException(f"Cannot locate installation of package {package}") from None
        return None


def get_dir_pkg(d: str) -> tuple[str | None, str | None]:
    """Return the folder and the name of the package around a folder."""
    for folder in (Path(d), *Path(d).parents):
        if (folder / "package.xml").is_file():
            return str(folder), package_name(folder)
    return None, None


def find_resource(pkg: str, resource_name: str, filter_fn: Any = None, rospack: object = None) -> list[str]:
    """Return the files of a package with a name, sorted."""
    folder = get_pkg_dir(pkg, required=False)
    files = sorted(str(path) for path in Path(folder).rglob(resource_name)) if folder else []
    return [file for file in files if filter_fn is None or filter_fn(file)]


def find_node(pkg: str, node_type: str, rospack: object = None) -> list[str]:
    """Return the executables of a package with a name."""
    return find_resource(pkg, node_type)


def list_pkgs() -> list[str]:
    """Return the names of the packages of the workspace."""
    return RosPack().list()
