"""Outermost folder whose files a file may read with `..`."""

from __future__ import annotations

from pathlib import Path

from simkit.loaders.resources.uris import is_private
from simkit.project_folder import enclosing_project


def readable_folder(folder: Path) -> Path:
    """Return the outermost folder that a file in a folder may read with `..`.

    It is the project; without a project, it is the folder above if that folder is a model or has meshes or textures.
    """
    project = enclosing_project(folder)
    if project is not None:
        return project
    return folder if is_private(folder.parent) else folder.parent
