"""Entries of the index in which packages are installed; packages of source trees are entries of the type `packages`."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from simkit.input_file import read_input_text
from simkit_nodes.host import current_program
from simkit_nodes.ros_modules.ament_index_python.constants import RESOURCE_INDEX_SUBFOLDER
from simkit_nodes.ros_modules.ament_index_python.packages import get_packages_with_prefixes, prefix_of
from simkit_nodes.ros_modules.ament_index_python.search_paths import get_search_paths

__all__ = [
    "InvalidResourceNameError",
    "InvalidResourceTypeNameError",
    "get_resource",
    "get_resource_types",
    "get_resources",
    "has_resource",
]


class InvalidResourceTypeNameError(ValueError):
    """The name of a type has a slash."""


class InvalidResourceNameError(ValueError):
    """The name of an entry has a slash."""


def _check(resource_type: str, resource_name: str | None = None) -> None:
    if not resource_type:
        raise AssertionError("The resource type must not be empty")
    if resource_name == "":
        raise AssertionError("The resource name must not be empty")
    if "/" in resource_type or "\\" in resource_type:
        raise InvalidResourceTypeNameError(f"Resource type '{resource_type}' is invalid")
    if resource_name is not None and ("/" in resource_name or "\\" in resource_name):
        raise InvalidResourceNameError(f"Resource name '{resource_name}' is invalid")


def _folders(resource_type: str = "") -> dict[str, Path]:
    """Return the folders of the index that exist, by the folder in which packages are installed."""
    places = {path: Path(path, RESOURCE_INDEX_SUBFOLDER, resource_type) for path in get_search_paths()}
    return {path: place for path, place in places.items() if place.is_dir()}


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """Return the text of an entry, and the folder in which its package is installed.

    Raises:
        LookupError: there is no such entry.
    """
    _check(resource_type, resource_name)
    for path, place in _folders(resource_type).items():
        if (place / resource_name).is_file():
            return read_input_text(place / resource_name), path
    folder = current_program().workspace.package(resource_name) if resource_type == "packages" else None
    if folder is None:
        raise LookupError(f"Could not find the resource '{resource_name}' of type '{resource_type}'")
    return "", prefix_of(folder)


def get_resources(resource_type: str) -> dict[str, str]:
    """Return the folder in which the package of each entry of a type is installed, by the name of the entry."""
    _check(resource_type)
    prefixes: dict[str, str] = {}
    for path, place in _folders(resource_type).items():
        for entry in sorted(place.iterdir()):
            if entry.is_file() and not entry.name.startswith("."):
                prefixes.setdefault(entry.name, path)
    return {**get_packages_with_prefixes(), **prefixes} if resource_type == "packages" else prefixes


def get_resource_types() -> set[str]:
    """Return the types of all entries."""
    folders = (entry for place in _folders().values() for entry in place.iterdir())
    return {"packages", *(entry.name for entry in folders if entry.is_dir() and not entry.name.startswith("."))}


def has_resource(resource_type: str, resource_name: str) -> str | Literal[False]:
    """Return the folder in which the package of an entry is installed; False if there is no such entry."""
    _check(resource_type, resource_name)
    try:
        return get_resource(resource_type, resource_name)[1]
    except LookupError:
        return False
