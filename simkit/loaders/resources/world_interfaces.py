"""Definitions of messages, services and actions in the folders that the user gives, and near a world."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from simkit.diagnostics import Diagnostics
from simkit.errors import InterfaceError
from simkit.home_folder import expand_home
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.uris import is_file
from simkit.msgs import own_interfaces
from simkit.project_folder import enclosing_project
from simkit.trusted_folders import join_below


def read_interfaces(
    folders: Iterable[str | os.PathLike[str]],
    source: str | os.PathLike[str],
    resolver: Resolver,
    diagnostics: Diagnostics,
) -> None:
    """Define the interfaces in folders, and search other types near the world when they are needed.

    A package near the world is found as for `package://`: around the world's file, in the workspaces of `package_paths`
    and in the folders of `ROS_PACKAGE_PATH`. Beside the world's file, and in its project, a folder with the package's
    name is enough.

    Args:
        folders: folders of the user, in addition to those of `SIMKIT_INTERFACES`.
        source: argument `source` of `simkit.load`.
        resolver: search for packages.
        diagnostics: receives all problems of the definitions in the folders.
    """
    try:
        own_interfaces.read_environment()
        diagnostics.extend(own_interfaces.untold(own_interfaces.add_folders(folders)))
    except InterfaceError as error:
        diagnostics.extend(error.diagnostics)
    is_text = isinstance(source, str) and "<" in source
    home = (Path.cwd() if is_text else expand_home(source).absolute().parent).resolve()
    nearby = dict.fromkeys((home, enclosing_project(home) or home))
    near_world = resolver.around(home)

    def find(package: str, file: str) -> Path | None:
        beside = (join_below(folder, package) for folder in nearby)
        named = (folder for folder in nearby if folder.name == package)
        packages = map(near_world.trust_plain, resolver.packages.named_exactly(package, (home,)))
        for place in (*beside, *named, *packages):
            path = join_below(place, file)
            if is_file(path) and near_world.allows(path):
                return path
        return None

    own_interfaces.set_finder(find)
