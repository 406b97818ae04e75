"""Load the world of an extracted bundle, and hash a compiled model independently of where its files lie."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.build import load
from simkit.loaders.spawned_models import SpawnedModel
from simkit.run_spec import LoadOptions, RunSpec
from simkit.testing.bundles.manifest import PackedModel

if TYPE_CHECKING:
    import mujoco

    from simkit.runtime import Simulation


_SEARCH_VARIABLES: Final = (
    "SIMKIT_RESOURCE_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH", "GAZEBO_MODEL_PATH",
    "ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH",
)  # fmt: skip


def packed_run_spec(
    folder: Path,
    world: str,
    spawn: Sequence[PackedModel],
    params: Sequence[tuple[str, str]],
    original: RunSpec,
    code: Sequence[Path] = (),
) -> RunSpec:
    """Return the description of a run whose files lie in a folder.

    Args:
        folder: where the files lie.
        world, spawn, params: as the manifest has them.
        original: seed, overrides and options of the run.
        code: folders of plugins whose code may run.
    """

    options: LoadOptions = {
        "base": original.options.get("base", "auto"),
        "sleep": original.options.get("sleep", True),
        "on_error": original.options.get("on_error"),
        "plugin_paths": tuple(code),
        "params_files": tuple((model, folder / file) for model, file in params),
    }
    return RunSpec(
        str(folder / world),
        seed=original.seed,
        overrides=original.overrides,
        spawn=tuple(SpawnedModel(folder / one.file, one.place, one.name) for one in spawn),
        options=options,
    )


def load_packed_world(spec: RunSpec) -> Simulation:
    """Load the world of a bundle at t = 0; nothing outside of its folder is searched.

    Raises:
        LoadError, PluginError: as `simkit.load`.
    """

    with _without_user_folders():
        return load(spec.world, **spec.load_arguments())


@contextmanager
def _without_user_folders() -> Iterator[None]:
    """Leaves the user's own folders out of a search: a file of the same name there is another one."""
    before = {name: os.environ.pop(name) for name in _SEARCH_VARIABLES if name in os.environ}
    try:
        yield
    finally:
        os.environ.update(before)


def model_hash(model: mujoco.MjModel, originals: Mapping[str, object]) -> str:
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
