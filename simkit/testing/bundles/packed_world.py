"""Load the world of an extracted bundle, and hash a compiled model independently of where its files lie."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.testing.bundles.manifest import PackedModel

if TYPE_CHECKING:
    from simkit.runtime import Simulation


_SEARCH_VARIABLES: Final = (
    "SIMKIT_RESOURCE_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH", "GAZEBO_MODEL_PATH",
    "ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH",
)  # fmt: skip


def load_packed_world(
    folder: Path,
    world: str,
    spawn: Sequence[PackedModel],
    params: Sequence[tuple[str, str]],
    code: Sequence[Path],
    options: Mapping[str, Any],
) -> Simulation:
    """The world of a bundle at t = 0; nothing outside of its folder is searched.

    Args:
        folder: where the files lie.
        world, spawn, params: as the manifest has them.
        code: folders of plugins whose code may run.
        options: `seed`, `overrides`, `base`, `sleep`, `on_error`.

    Raises:
        LoadError, PluginError: as `simkit.load`.
    """
    from simkit.build import load
    from simkit.loaders.spawn_option import SpawnedModel

    with _without_user_folders():
        return load(
            folder / world,
            seed=options["seed"],
            base=options["base"],
            overrides=tuple(options["overrides"]),
            sleep=options["sleep"],
            on_error=options["on_error"],
            plugin_paths=code,
            spawn=[SpawnedModel(folder / one.file, one.place, one.name) for one in spawn],
            params_files=[(model, folder / file) for model, file in params],
        )


@contextmanager
def _without_user_folders() -> Iterator[None]:
    """Leaves the user's own folders out of a search: a file of the same name there is another one."""
    before = {name: os.environ.pop(name) for name in _SEARCH_VARIABLES if name in os.environ}
    try:
        yield
    finally:
        os.environ.update(before)


def model_hash(model: Any, originals: Mapping[str, Any]) -> str:
    """SHA-256 of all arrays of an `MjModel` and of its options but gravity.

    Args:
        originals: arrays as they were compiled, of those that were changed since.
    """
    digest = hashlib.sha256()
    for name in sorted(dir(model)):
        if name.startswith("_") or name == "paths" or name.endswith("pathadr"):
            continue
        value = originals.get(name)
        value = getattr(model, name) if value is None else value
        if isinstance(value, np.ndarray):
            digest.update(name.encode())
            digest.update(np.ascontiguousarray(value).tobytes())
    digest.update(bytes(model.names))
    for name in ("timestep", "integrator", "solver", "iterations", "cone", "disableflags", "enableflags"):
        digest.update(repr(getattr(model.opt, name)).encode())
    return digest.hexdigest()
