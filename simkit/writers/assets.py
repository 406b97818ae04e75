"""Copies of the meshes and pictures that a written file names, in a folder beside it."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

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
            beside = companions(file)
            root = Path(os.path.commonpath([file.parent, *(c.parent for c in beside)]))
            if any(root in c.parents and len(c.relative_to(root).parts) > 4 for c in (file, *beside)):
                root, beside = file.parent, []
            slot = self._slot(root)
            for source in (file, *beside):
                self._copy(source, self.folder / slot / source.relative_to(root))
            self._placed[file] = f"{self.folder.name}/{slot}/{file.relative_to(root).as_posix()}"
        return self._placed[file]

    def _slot(self, root: Path) -> str:
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


def companions(file: Path) -> list[Path]:
    """Files that a mesh names and that are there: materials, buffers, pictures; none for other files."""
    from simkit.compiler.meshes.mesh import SUFFIXES, convert_file
    from simkit.compiler.meshes.part import MeshFileError

    if file.suffix.lower() not in SUFFIXES:
        return []
    try:
        read = convert_file(file).companions
    except MeshFileError:
        return []
    return [path for name in sorted(read) if (path := Path(name)).is_file()]
