"""Opens the world of a bundle whose files lie in a folder."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simkit.bundle.manifest import Placed

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_SEARCHED: Final = (
    "SIMKIT_RESOURCE_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH", "GAZEBO_MODEL_PATH",
    "ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "GZ_FUEL_CACHE_PATH", "IGN_FUEL_CACHE_PATH",
)  # fmt: skip


def load_packed(
    folder: Path,
    world: str,
    spawn: Sequence[Placed],
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
    from simkit.spawning import Spawn

    with _nothing_else_searched():
        return load(
            folder / world,
            seed=options["seed"],
            base=options["base"],
            overrides=tuple(options["overrides"]),
            sleep=options["sleep"],
            on_error=options["on_error"],
            plugin_paths=code,
            spawn=[Spawn(folder / one.file, one.place, one.name) for one in spawn],
            params_files=[(model, folder / file) for model, file in params],
        )


@contextmanager
def _nothing_else_searched() -> Iterator[None]:
    """Leaves the user's own folders out of a search: a file of the same name there is another one."""
    before = {name: os.environ.pop(name) for name in _SEARCHED if name in os.environ}
    try:
        yield
    finally:
        os.environ.update(before)
