"""Writer of a scene as an SDF file, with copies of its meshes and textures in an asset folder."""

from __future__ import annotations

import os
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

from simkit import progress
from simkit.diagnostics import Diagnostics
from simkit.loaders.meshes.mesh_part import MeshFileError
from simkit.loaders.meshes.mesh_reader import SUFFIXES, convert_file
from simkit.scene import Scene
from simkit.writers.atomic_output import AtomicOutput
from simkit.writers.sdf_world import sdf_text

MOST_FILES = 100_000


class AssetFolder:
    """Folder with one copy of each added file, and of each file that an added file refers to.

    Files that refer to each other keep their relative positions, so that a mesh finds its textures.

    Args:
        folder: folder of the copies; created with the first copy.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.count = 0
        self._slots: dict[Path, str] = {}
        self._placed: dict[Path, str] = {}

    def add(self, file: Path) -> str:
        """Copy a file and the files that it refers to; return its path relative to the folder's parent, with `/`.

        Raises:
            OSError: a file cannot be copied.
        """
        file = Path(os.path.abspath(file))  # noqa: PTH100 - resolve() would follow links
        if file not in self._placed:
            companions = companion_files(file)
            root = Path(os.path.commonpath([file.parent, *(c.parent for c in companions)]))
            if any(root in c.parents and len(c.relative_to(root).parts) > 4 for c in (file, *companions)):
                root, companions = file.parent, []
            slot = self._slot_name(root)
            for source in (file, *companions):
                self._copy(source, self.folder / slot / source.relative_to(root))
            self._placed[file] = f"{self.folder.name}/{slot}/{file.relative_to(root).as_posix()}"
        return self._placed[file]

    def _slot_name(self, root: Path) -> str:
        """Return a unique folder name for the files from one source folder, derived from its name."""
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
        progress.set_item(source.name)
        shutil.copyfile(source, target)


def companion_files(file: Path) -> list[Path]:
    """Return the existing files that a mesh refers to: materials, buffers and textures; empty for other files."""
    if file.suffix.lower() not in SUFFIXES:
        return []
    try:
        read = convert_file(file).companions
    except MeshFileError:
        return []
    return [path for name in sorted(read) if (path := Path(name)).is_file()]


@dataclass(frozen=True, slots=True)
class WrittenFiles:
    """Written file, and the number of files in its asset folder."""

    path: Path
    files: int = 0


def write_sdf(
    scene: Scene, path: Path, diagnostics: Diagnostics, *, keep_uris: bool = False, overwrite: bool = False
) -> WrittenFiles:
    """Write an SDF file, and copies of its files to the folder `<stem>_assets`; all or nothing.

    A file below the folder of `path` is not copied; the SDF file refers to it by a relative path.

    Args:
        scene: scene to write.
        path: SDF file to write.
        diagnostics: collector of a warning for each feature that SDF does not support.
        keep_uris: keep every URI unchanged and copy nothing.
        overwrite: replace existing files.

    Raises:
        InputError: SK-CLI-016 a file exists, or is not writable.
    """
    here = path.absolute().parent
    writing = progress.task(f"writing {path.name}")
    with AtomicOutput(path, f"{path.stem}_assets", overwrite=overwrite) as staging, writing:
        assets = AssetFolder(staging.folder)

        def uri_of(file: Path, uri: str) -> str:
            if not file.is_file():
                return uri
            inside = Path(os.path.abspath(file))  # noqa: PTH100 - resolve() would follow links
            if inside.is_relative_to(here) and not inside.is_relative_to(here / staging.folder.name):
                return inside.relative_to(here).as_posix()
            return assets.add(file)

        text = sdf_text(scene, diagnostics, None if keep_uris else uri_of)
        staging.file.write_text(text, encoding="utf-8")
    return WrittenFiles(path, assets.count)
