"""Files that a description of a run may name: a scenario, a golden run, a sweep or an exercise read from a file.

A description can come from a stranger. It names files in its own folder, in its project, and in the folders that the
user chose. A `RunSpec` that is made in Python is not checked.
"""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final
from urllib.parse import unquote

from simkit.diagnostics import shorten
from simkit.errors import InputError
from simkit.home_folder import expand_home
from simkit.project_folder import enclosing_project, is_top_folder
from simkit.run_files import FileName, split_spawn
from simkit.run_spec import FilePath, RunSpec
from simkit.trusted_folders import TrustedFolders

OUTSIDE: Final = "SK-URI-003"
"""Code of the error about a file that a description may not name."""
HELP: Final = "to allow it, add "
"""Begin of the help of this error; an option follows."""
Refusal = tuple[str, str]
"""Problem and help of a file that a description may not name."""


class ReadableFiles:
    """Check of the files that one description names.

    They may be in the folder of the description, in its project, in the working directory if the description is below
    it, in the folders of the user, and in simkit's own folders.

    Args:
        file: file of the description, or a file in the folder of a golden run.
        folders: folders of the user's options (`--resource-path`); those of environment variables are added.
        container: folder that contains a golden run or the results of a sweep, which name files beside their folder.
    """

    def __init__(self, file: FilePath, folders: Sequence[FilePath] = (), container: Path | None = None) -> None:
        from simkit.loaders import Resolver
        from simkit.loaders.resources.bundled_models import bundled_folders
        from simkit.loaders.resources.uris import absolute_path

        self.folders = tuple(folders)
        folder = absolute_path(Path(file)).parent
        working = Path.cwd()
        chosen = [folder, *filter(None, [enclosing_project(folder)])]
        if folder.is_relative_to(working) and not is_top_folder(working):
            chosen.append(working)
        self._files_of = None if container is None else absolute_path(container)
        if self._files_of is not None and not is_top_folder(self._files_of):
            chosen += [self._files_of, *filter(None, [enclosing_project(self._files_of)])]
            self._files_of = None
        chosen += [bundle for kind in ("assets", "worlds", "labs") for bundle in bundled_folders(kind)]
        self._trusted = TrustedFolders(chosen, Resolver(folders).paths)

    def allows(self, path: Path) -> bool:
        """Check whether the description may name a file or folder; it need not exist."""
        expanded = expand_home(path)  # as the readers of folders do
        return self._allows(path) and (expanded == path or self._allows(expanded))

    def refusal(self, path: Path) -> Refusal | None:
        """Return the problem and the help of a file that the description may not name; None for a file that it may."""
        if self.allows(path):
            return None
        if not any(part == ".." for part in path.parts) and self._allows(path.parent) and path.is_symlink():
            problem = f"{path} is a symbolic link that leads outside the folders of this file"
        else:
            problem = f"{shorten(str(path), 200)} is outside the folders of this file"
        return problem, f"{HELP}--resource-path {shlex.quote(str(self.folder_to_allow(path)))}"

    def folder_to_allow(self, path: Path) -> Path:
        """Return the folder that the user must choose, so that a path is allowed."""
        try:
            real = Path(os.path.realpath(expand_home(path)))
            return real if real.is_dir() else real.parent
        except (OSError, ValueError):  # no file can have this name
            return path.parent

    def source_refusal(self, source: str, folder: Path) -> Refusal | None:
        """Return the refusal of a world or model: a path, bare name, URI or XML text; see `refusal`.

        Args:
            source: source, as for `simkit.load`.
            folder: folder of the description.
        """
        if "<" in source:
            return None
        if source.startswith("file://"):
            return self.refusal(Path(unquote(source.removeprefix("file://"))))
        if "://" in source:
            return None  # the resolver checks URIs
        path = folder / source
        if not _exists(path):
            path = Path(source)  # in the working directory
            if not path.is_absolute() and ".." not in path.parts and not path.is_file():
                return None  # a bundled name, or no file
        return self.refusal(path)

    def spawn_refusal(self, spawn: str, folder: Path) -> Refusal | None:
        """Return the refusal of a text `MODEL:x,y,yaw[:name[:namespace]]`; see `refusal`."""
        return self.source_refusal(split_spawn(spawn)[0], folder)

    def refused(self, spec: RunSpec) -> Iterator[tuple[tuple[object, ...], Refusal]]:
        """Yield the keys and the refusal of each file of a specification that its description may not name."""
        for keys, refusal in self._refusals(spec):
            if refusal is not None:
                yield keys, refusal

    def check(self, spec: RunSpec) -> None:
        """Raise an error if a specification names a file that its description may not name.

        Raises:
            InputError: SK-URI-003, with a line for each file.
        """
        lines = [f"{label(keys)}: {text}\n    help: {hint}" for keys, (text, hint) in self.refused(spec)]
        if lines:
            raise InputError(OUTSIDE, f"\n{OUTSIDE} ".join(lines))

    # ------------------------------------------------------------------ parts of a specification

    def _refusals(self, spec: RunSpec) -> Iterator[tuple[tuple[object, ...], Refusal | None]]:
        yield ("world",), self.source_refusal(spec.world, spec.folder)
        for name in spec.files():
            if name.keys[0] != "plugin_paths" and name.role != "program":  # code needs a permission of its own
                yield name.keys, self._refusal_of(name, spec.folder)

    def _refusal_of(self, name: FileName, folder: Path) -> Refusal | None:
        if name.role in ("world", "model"):
            return self.source_refusal(name.text, folder)
        return self.refusal(folder / name.text if name.role == "bag" else Path(name.text))

    def _allows(self, path: Path) -> bool:
        if self._trusted.allows(path):
            return True
        if self._files_of is None:
            return False
        real = Path(os.path.realpath(path))
        # the home folder has many private folders; only the files that lie directly in it are beside a golden run
        return real.parent == Path(os.path.realpath(self._files_of)) and not real.name.startswith(".")


def _exists(path: Path) -> bool:
    return os.path.exists(path)  # noqa: PTH110 (a long name is no error)


def label(keys: Sequence[object]) -> str:
    """Return the keys of a value as one name: `spawn.0`."""
    return ".".join(map(str, keys))
