"""Worlds that a launch file opens, by file or by a name of Gazebo, and the folders in which models are searched."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

from simkit.build import read_scene
from simkit.errors import LoadError
from simkit.loaders.resources.bundled_models import bundled_folders, find_bundled_world
from simkit.loaders.resources.uri_resolver import NOT_FOUND_CODES
from simkit.run_files import PackagePaths
from simkit_nodes.workspace import Workspace

_WORLD_PACKAGES: Final = ("ros_gz_sim", "gazebo_ros")
"""Stand-in packages with worlds that Gazebo has of its own."""
_COMMENT: Final = re.compile(r"<!--.*?-->", re.DOTALL)
_WORLD_NAME: Final = re.compile(r"""<world\s[^>]*?\bname\s*=\s*["']([\w .-]+)["']""")
_MOST_BYTES: Final = 65536  # of a file that is searched for folders
_EXPORT: Final = re.compile(r"<gazebo_ros\s+([^>]*?)/?>")
_EXPORTED_FOLDER: Final = re.compile(r"""gazebo_(?:model|media|resource)_path\s*=\s*["']([^"']*)["']""")


def find_world(name: str, folder: Path | None, search_folders: Iterable[str]) -> Path | None:
    """Return the file of a world; None if there is none.

    Args:
        name: file, or a name of Gazebo, such as `shapes.sdf` or `worlds/empty.world`.
        folder: working directory of the simulator; None for the present one.
        search_folders: folders of models and worlds.
    """
    path = Path(name).expanduser()
    own = (Path(package, "worlds") for package in _WORLD_PACKAGES)
    shipped = [parent / worlds for parent in bundled_folders("packages") for worlds in own]
    folders = [folder or Path(), *map(Path, search_folders), *(Path(each, "worlds") for each in search_folders)]
    files = [each / path for each in folders]
    if not path.is_absolute():
        files += [each / path.name for each in shipped]
    found = next((file for file in files if file.is_file()), None)
    return found or (None if path.is_absolute() else find_bundled_world(path.stem))


def missing_models(file: Path, resource_paths: Iterable[str], package_paths: PackagePaths) -> str:
    """Return the error of a world that includes only models that are not there; empty for any other world.

    Args:
        file: file of the world.
        resource_paths: folders of models and worlds.
        package_paths: folders of ROS packages by name, or workspaces.
    """
    text = _COMMENT.sub("", _text(file))
    if "<include" not in text or re.search(r"<(model|light|actor|population)\b", text):
        return ""
    try:
        read_scene(file, resource_paths=tuple(resource_paths), package_paths=package_paths)
    except LoadError as error:
        problems = [problem for problem in error.diagnostics if problem.severity == "error"]
        if all(problem.code in NOT_FOUND_CODES for problem in problems):
            return problems[0].message
    return ""


def level_ground(file: Path) -> str:
    """Return the text of a world of level ground with the name of the world in a file."""
    name = _WORLD_NAME.search(_text(file))
    includes = "".join(f"<include><uri>model://{model}</uri></include>" for model in ("ground_plane", "sun"))
    return f'<sdf version="1.9"><world name="{name[1] if name else "empty"}">{includes}</world></sdf>'


def exported_folders(workspace: Workspace) -> Iterator[str]:
    """Yield the folders of models that the manifests of packages name: `<gazebo_ros gazebo_model_path="…"/>`."""
    for package in workspace.packages().values():
        for attributes in _EXPORT.findall(_text(package / "package.xml")):
            for paths in _EXPORTED_FOLDER.findall(attributes):
                folders = (os.path.normpath(path.replace("${prefix}", str(package))) for path in paths.split(":"))
                yield from (folder for folder in folders if Path(folder).is_dir())


def _text(file: Path) -> str:
    """Return the beginning of a file; empty for a file that cannot be read."""
    try:
        with file.open("rb") as stream:
            return stream.read(_MOST_BYTES).decode("utf-8", "replace")
    except OSError:
        return ""
