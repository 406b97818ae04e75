"""Search for the model file of a folder: the file that `model.config` lists, or the one robot in the folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders.resources.uris import is_file, is_small_integer
from simkit.loaders.resources.xml_reader import parse_file
from simkit.params import Params
from simkit.trusted_folders import OutsideError, join_below

NEWEST_SDF = (1, 12)
CLASSIC_SDF = (1, 7)
"""Newest version of SDF that Gazebo Classic reads."""
_MANIFESTS = ("model.config", "manifest.xml")


def model_file(folder: Path, where: Where, diagnostics: Diagnostics, allows: Callable[[Path], bool]) -> Path | None:
    """Return the file of a model folder: the highest version up to 1.12 listed in `model.config`, else `model.sdf`.

    A folder without these two files is searched for one robot in URDF, or one model in MJCF.

    Args:
        folder: folder of the model.
        where: place of the URI that names the folder, for messages.
        diagnostics: receives the problems.
        allows: checks whether a file may be read; a file behind a link out of the user's folders may not.
    """

    def is_readable(file: Path) -> bool:
        return is_file(file) and allows(file)

    for manifest in (folder / name for name in _MANIFESTS):
        if not is_readable(manifest):
            continue
        document = parse_file(manifest, diagnostics)
        if document is None:
            return None
        listed = _listed_files(document.root)
        for _, name in sorted(listed, key=lambda item: item[0], reverse=True):
            file = _file_below(folder, name)
            if file is not None and is_readable(file):
                return file
        names = ", ".join(name for _, name in listed) or "none"
        if is_readable(folder / "model.sdf"):
            return folder / "model.sdf"
        diagnostics.error("SK-URI-005", f"{manifest} lists no SDF file that exists (listed: {names})", where)
        return None
    for name in _file_names(folder)[len(_MANIFESTS) :]:
        if is_readable(folder / name):
            return folder / name
    models = [file for file in _mjcf_models(folder) if allows(file)]
    if len(models) == 1:
        return models[0]
    unnamed = f"; none of {', '.join(m.name for m in models[:8])} is named {folder.name}.xml" if models else ""
    diagnostics.error("SK-URI-005", f"the folder {folder} has neither model.config nor model.sdf{unnamed}", where)
    return None


def holds_model(folder: Path) -> bool:
    """Check whether `model_file` would look into a file of this folder."""
    return any(is_file(folder / name) for name in _file_names(folder)) or bool(_mjcf_models(folder))


def _file_names(folder: Path) -> tuple[str, ...]:
    return (*_MANIFESTS, "model.sdf", f"{folder.name}.sdf", "model.urdf", f"{folder.name}.urdf")


def _file_below(folder: Path, name: str) -> Path | None:
    """Return the path of a listed file; None if it is outside of the model's folder."""
    try:
        return join_below(folder, name)
    except OutsideError:
        return None


def sdf_version(text: str) -> tuple[int, int] | None:
    """Parse a version: `"1.6"` becomes (1, 6), and an invalid text becomes None."""
    parts = text.strip().split(".")
    if len(parts) < 2 or not all(is_small_integer(p) for p in parts[:2]):
        return None
    return int(parts[0]), int(parts[1])


def _listed_files(root: Params) -> list[tuple[tuple[int, int], str]]:
    versions = []
    for element in root.all("sdf"):
        version = sdf_version(element.attribute("version", "1.0")) or (1, 0)
        if version <= NEWEST_SDF and element.value:
            versions.append((version, element.value))
    return versions + [((0, 0), element.value) for element in root.all("urdf") if element.value]


def _mjcf_models(folder: Path) -> list[Path]:
    """Return the MJCF files that can be a folder's model: the file with its name, else all except `scene*.xml`."""
    try:
        files = sorted(f for f in folder.glob("*.xml") if f.name not in ("package.xml", "manifest.xml") and is_file(f))
    except OSError:
        return []
    named = [f for f in files if f.stem in (folder.name, "model")]
    return named[:1] or [f for f in files if not f.stem.startswith("scene")] or files
