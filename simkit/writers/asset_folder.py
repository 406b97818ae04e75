"""Write a scene as an SDF file with copies of its meshes and pictures in a folder beside it."""

from __future__ import annotations

import os
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

from simkit.compiler.meshes.mesh_part import MeshFileError
from simkit.compiler.meshes.mesh_reader import SUFFIXES, convert_file
from simkit.diagnostics import Diagnostics
from simkit.scene import Scene
from simkit.writers.atomic_output import AtomicOutput
from simkit.writers.sdf_world import sdf_text

MOST_FILES = 100_000


class AssetFolder:
    """A folder that takes files together with what they name themselves, each once.

    Files that belong together keep their places to one another, so that a mesh finds its pictures.

    Args:
        folder: where they are written; made with the first.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.count = 0
        self._slots: dict[Path, str] = {}
        self._placed: dict[Path, str] = {}

    def add(self, file: Path) -> str:
        """Copies a file and its companions; returns its path from the folder's parent, with `/`.

        Raises:
            OSError: it cannot be copied.
        """
        file = Path(os.path.abspath(file))  # noqa: PTH100 - resolve() would follow links
        if file not in self._placed:
            beside = companion_files(file)
            root = Path(os.path.commonpath([file.parent, *(c.parent for c in beside)]))
            if any(root in c.parents and len(c.relative_to(root).parts) > 4 for c in (file, *beside)):
                root, beside = file.parent, []
            slot = self._free_place(root)
            for source in (file, *beside):
                self._copy(source, self.folder / slot / source.relative_to(root))
            self._placed[file] = f"{self.folder.name}/{slot}/{file.relative_to(root).as_posix()}"
        return self._placed[file]

    def _free_place(self, root: Path) -> str:
        """A folder of its own for each place that files come from, named after it."""
        if root not in self._slots:
            generic = {"meshes", "mesh", "visual", "collision", "textures", "materials"}
            names = [
                p for p in (root.name, root.parent.name, root.parent.parent.name) if p and p.lower() not in generic
            ]
            stem = re.sub(r"[^A-Za-z0-9_.-]+", "_", names[0] if names else root.name).strip("._") or "files"
            name, k = stem, 1
            while name.lower() in {s.lower() for s in self._slots.values()}:
                k += 1
                name = f"{stem}_{k}"
            self._slots[root] = name
        return self._slots[root]

    def _copy(self, source: Path, target: Path) -> None:
        if target.exists():
            return
        self.count += 1
        if self.count > MOST_FILES:
            raise OSError(f"more than {MOST_FILES} files")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)


def companion_files(file: Path) -> list[Path]:
    """Files that a mesh names and that are there: materials, buffers, pictures; none for other files."""
    if file.suffix.lower() not in SUFFIXES:
        return []
    try:
        read = convert_file(file).companions
    except MeshFileError:
        return []
    return [path for name in sorted(read) if (path := Path(name)).is_file()]


@dataclass(frozen=True, slots=True)
class WrittenFiles:
    """What was written: the file, and how many files lie in the folder beside it."""

    path: Path
    files: int = 0


def write_sdf(
    scene: Scene, path: Path, diagnostics: Diagnostics, *, keep_uris: bool = False, overwrite: bool = False
) -> WrittenFiles:
    """Writes `path`, and copies of the files that it names into `<stem>_assets` beside it; all or nothing.

    A file that lies below the folder of `path` already is not copied but named from there.

    Args:
        diagnostics: gets a warning for each thing that SDF has no word for.
        keep_uris: writes every URI as it was, and copies nothing.
        overwrite: replaces what is there.

    Raises:
        InputError: SK-CLI-016 something is there already, or it cannot be written.
    """
    here = path.absolute().parent
    with AtomicOutput(path, f"{path.stem}_assets", overwrite=overwrite) as staging:
        assets = AssetFolder(staging.folder)

        def place(file: Path, uri: str) -> str:
            if not file.is_file():
                return uri
            inside = Path(os.path.abspath(file))  # noqa: PTH100 - resolve() would follow links
            if inside.is_relative_to(here) and not inside.is_relative_to(here / staging.folder.name):
                return inside.relative_to(here).as_posix()
            return assets.add(file)

        text = sdf_text(scene, diagnostics, None if keep_uris else place)
        staging.file.write_text(text, encoding="utf-8")
    return WrittenFiles(path, assets.count)
