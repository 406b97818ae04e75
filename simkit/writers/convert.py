"""A scene as an SDF file on disk, with its meshes and pictures."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from simkit.diagnostics import Diagnostics
from simkit.scene import Scene
from simkit.writers.assets import AssetFolder
from simkit.writers.sdf import sdf_text
from simkit.writers.staging import Staging


@dataclass(frozen=True, slots=True)
class Written:
    """What was written: the file, and how many files lie in the folder beside it."""

    path: Path
    files: int = 0


def write_sdf(
    scene: Scene, path: Path, diagnostics: Diagnostics, *, keep_uris: bool = False, overwrite: bool = False
) -> Written:
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
    with Staging(path, f"{path.stem}_assets", overwrite=overwrite) as staging:
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
    return Written(path, assets.count)
