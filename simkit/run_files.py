"""Names of files in the values of a run: how they are written, and which file each one means."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

from simkit.home_folder import expand_home

FilePath = str | os.PathLike[str]
PackagePaths = Mapping[str, FilePath] | Sequence[FilePath]
"""Folders of ROS packages by name, or a list of workspaces and of texts `NAME=DIR`."""
_NUMBER: Final = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_NUMBERS: Final = rf"\s*{_NUMBER}\s*(?:,\s*{_NUMBER}\s*)*"
_NAMES: Final = r"(?::(?P<name>[^:/,]+)(?::(?P<namespace>[^:,]*))?)?"
SPAWN_TEXT: Final = re.compile(rf"(?P<model>.+?):(?P<numbers>{_NUMBERS}){_NAMES}")
"""Text of a model to spawn: `MODEL:x,y,yaw[:name[:namespace]]`."""
SPAWN_KEYS: Final = ("model", "place", "name", "namespace")
"""Keys of a model to spawn that is a mapping: the attributes of `SpawnedModel`; `model` is its source."""


def split_package_paths(paths: PackagePaths | None) -> tuple[dict[str, Path], list[Path]]:
    """Return the folders of packages by name, and the workspaces, which are folders without a name."""
    if isinstance(paths, Mapping):
        return {name: expand_home(path) for name, path in paths.items()}, []
    named: dict[str, Path] = {}
    workspaces: list[Path] = []
    for item in (paths,) if isinstance(paths, str) else paths or ():
        name, equals, path = str(item).partition("=")
        name = name.strip().removesuffix(":").strip()
        if isinstance(item, str) and equals and name and "/" not in name:
            named[name] = expand_home(path)
        else:
            workspaces.append(expand_home(item))
    return named, workspaces


def model_and_file(named: FilePath | tuple[str, FilePath]) -> tuple[str, str]:
    """Split `[MODEL=]FILE` into the name of a model and the path of a file; an empty name means all models."""
    if isinstance(named, tuple):
        return str(named[0]), os.fspath(named[1])
    text = os.fspath(named)
    model, equals, file = text.partition("=")
    if not equals or not model.strip() or "/" in model or is_there(Path(text)):
        return "", text
    return model.strip(), file


def split_spawn(text: str) -> tuple[str, str]:
    """Split `MODEL:x,y,yaw[:name[:namespace]]` into the model and the rest, which is empty for a model alone."""
    match = SPAWN_TEXT.fullmatch(text.strip())
    model = text.strip() if match is None else match["model"]
    return model, text.strip()[len(model) :]


def is_there(path: Path) -> bool:
    """Check whether a path exists; a text that cannot be the name of a file does not."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def relative_path(path: Path, folder: Path) -> str:
    """Return a path relative to a folder, with slashes; the absolute path if the two are on different drives."""
    try:
        return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
    except ValueError:
        return path.resolve().as_posix()


class FileName(NamedTuple):
    """Name of a file in the value of a field.

    Attributes:
        text: path; a world or a model can also be a bare name, a URI or XML text.
        role: what the name means. A world is a file, a model is a file or a folder. A program is a file, or the name of
            an executable of a package. A bag is relative to the folder of the run.
        keys: field and position in it, such as `("spawn", 0)`.
    """

    text: str
    role: Literal["world", "model", "program", "bag", "file", "folder"]
    keys: tuple[str | int, ...]

    def path_in(self, folder: Path) -> Path | None:
        """Return the path in a folder; None for the name of a world, model or program that is not a file there."""
        is_expanded = self.role in ("file", "folder")  # as where these are read
        path = folder / (expand_home(self.text) if is_expanded else self.text)
        if self.role in ("world", "program"):
            is_path = "<" not in self.text and os.path.isfile(path)  # noqa: PTH113 (a long name is no error)
        else:
            is_path = self.role != "model" or ("<" not in self.text and bool(self.text) and is_there(path))
        return path if is_path else None

    def used_path(self, folder: Path) -> Path | None:
        """Return the path that a run in a folder uses; None for the name of a world, model or program.

        `simkit.load` looks for models, files and folders in the working directory.

        Args:
            folder: folder of the run.
        """
        in_folder, working = self.path_in(folder), self.path_in(Path())
        if self.role in ("world", "program", "bag"):
            return in_folder or working
        if working is None or not is_there(working):
            return in_folder
        is_used = self.role != "model" or "/" in self.text or working.is_file()
        return working if is_used else in_folder


ChangeFile = Callable[[FileName], Any]
"""Function that returns another name for a file, as a text or path."""
