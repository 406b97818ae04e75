"""List of the models that can be spawned by name, and check of the sources that a client may spawn."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import Final
from urllib.parse import unquote

from simkit.loaders.resources.bundled_models import bundled_folders, is_bare_name
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.uris import absolute_path, is_existing, is_file
from simkit.trusted_folders import OutsideError

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
    models: dict[str, str] = {}
    folders = (folder for folder in _model_folders((*resolver.paths, *near, *packages)) if resolver.allows(folder))
    for folder in islice(folders, _MOST_MODELS):
        models.setdefault(folder.name, str(folder))
    for bundle in bundled_folders("assets"):
        for folder in _model_folders((bundle, *sorted(bundle.glob("*/")), *sorted(bundle.glob("*/models/")))):
            models.setdefault(folder.name, folder.name)
    return dict(sorted(models.items()))


def client_models(
    resolver: Resolver, world: str | os.PathLike[str]
) -> tuple[Callable[[], dict[str, str]], Callable[[str], None]]:
    """Return the functions behind the services that spawn models: the list of the models, and the check of a source.

    Args:
        resolver: finder of the files of a simulation.
        world: source of its world, as for `simkit.load`.
    """
    is_in_file = "<" not in str(world) and os.path.exists(world)  # noqa: PTH110 (a long name is no error)
    folder = absolute_path(Path(world)).parent if is_in_file else None

    def check_source(source: str) -> None:
        if "<" in source or ("://" in source and not source.startswith("file://")):
            return  # XML text, or a URI that the resolver checks
        path = Path(unquote(source.removeprefix("file://")))
        is_name = is_bare_name(source) and not is_existing(path)
        if not is_name and not resolver.allows(absolute_path(path), folder):
            message = f"a client may not spawn {source[:200]}: it is outside the folders of the run"
            hint = "start the run with --resource-path FOLDER, or send the model as text"
            raise OutsideError(OutsideError.code, message, help=hint)

    return lambda: spawnable_models(resolver), check_source


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
