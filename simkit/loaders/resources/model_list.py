"""List of the models that can be spawned by name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import Final

from simkit.loaders.resources.bundled_models import bundled_folders
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.uris import is_file

_MOST_MODELS: Final = 1000
_MOST_FOLDERS: Final = 5000  # folders that are looked into
_FILES: Final = ("model.config", "model.sdf", "model.urdf", "{name}.sdf", "{name}.urdf")


def spawnable_models(resolver: Resolver) -> dict[str, str]:
    """Return the source of each model by its name: those in the search paths and packages, then those of simkit.

    Args:
        resolver: finder of the files, whose search paths are listed.
    """
    near = [] if resolver.base is None else [resolver.base, resolver.base / "models", resolver.base.parent / "models"]
    packages = (package / "models" for package in resolver.packages.packages(near[:1]))
    found: dict[str, str] = {}
    folders = (folder for folder in _model_folders((*resolver.paths, *near, *packages)) if resolver.allows(folder))
    for folder in islice(folders, _MOST_MODELS):
        found.setdefault(folder.name, str(folder))
    for bundle in bundled_folders("assets"):
        for folder in _model_folders((bundle, *sorted(bundle.glob("*/")), *sorted(bundle.glob("*/models/")))):
            found.setdefault(folder.name, folder.name)
    return dict(sorted(found.items()))


def _model_folders(roots: Iterable[Path]) -> Iterator[Path]:
    """Yield the folders with a model directly below some folders; a folder that cannot be read has none."""
    left = _MOST_FOLDERS
    for root in dict.fromkeys(roots):
        try:
            folders = sorted(folder for folder in islice(root.iterdir(), left) if folder.is_dir())
        except OSError:
            continue
        left -= len(folders)
        for folder in folders:
            if any(is_file(folder / name.format(name=folder.name)) for name in _FILES):
                yield folder
