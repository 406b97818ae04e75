"""Make the sensors and plugins of a whole world, and find what else is wrong with a world that has errors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import Diagnostics, follows_from
from simkit.errors import LoadError, SimkitError
from simkit.plugins.discovery.make_instances import (
    add_python_plugins,
    make_model_parts,
    make_world_parts,
    report_unread,
)
from simkit.scene import SceneWorld

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import SensorsAndPlugins

FileFinder = Callable[[str, Path | None], Path | None]

# what the engine says of a world that lacks its faulty parts
_ENGINE_CODES = frozenset(("SK-PHYS-023", "SK-PHYS-025", "SK-PHYS-028"))

_MAX_MODELS_SEARCHED = 5000
"""Models of a faulty world that are built to find more faults: the engine takes minutes for 20 000."""


def make_all_parts(
    world: SceneWorld,
    builder: SpecBuilder,
    diagnostics: Diagnostics,
    allowed: Sequence[Path],
    plugins: Sequence[object],
) -> dict[str, SensorsAndPlugins]:
    """The sensors and plugins of every model, of the world (under no name), and those made in Python."""
    parts: dict[str, SensorsAndPlugins] = {}
    try:
        for model in world.models:
            parts[model.name] = make_model_parts(model, builder, diagnostics, allowed)
        parts[""] = make_world_parts(world, builder, diagnostics, allowed)
        add_python_plugins(parts, plugins, world, builder, diagnostics)
    except Exception:
        # What was left out for its own fault (a joint without a direction) may be asked for here.
        diagnostics.raise_if_errors()
        raise
    if diagnostics.has_errors:
        _load_sound_parts(world, builder, parts, diagnostics)
    return parts


def find_more_problems(
    world: SceneWorld, diagnostics: Diagnostics, plugin_paths: Sequence[Path], find_file: FileFinder
) -> None:
    """What else is wrong with a file that has errors: it is built without its faulty parts, as far as that goes.

    So everything comes in one pass: meshes, inertias, and what plugins find in `prepare` and `load`. What only follows
    from an error that is said already (a plugin's joint that was left out because of its own fault) is dropped.
    """
    from simkit.compiler import SpecBuilder

    if len(world.models) > _MAX_MODELS_SEARCHED:
        return
    before = tuple(diagnostics)
    try:
        builder = SpecBuilder(world, diagnostics)
        builder.find_file = find_file
        parts = {m.name: make_model_parts(m, builder, diagnostics, plugin_paths) for m in world.models}
        parts[""] = make_world_parts(world, builder, diagnostics, plugin_paths)
        _load_sound_parts(world, builder, parts, diagnostics)
    except Exception:  # noqa: BLE001 - on a file with errors anything may be missing; what was found by then counts
        pass
    diagnostics.drop(d for d in tuple(diagnostics)[len(before) :] if d.code in _ENGINE_CODES or follows_from(d, before))


def _load_sound_parts(
    world: SceneWorld, builder: SpecBuilder, parts: dict[str, SensorsAndPlugins], diagnostics: Diagnostics
) -> None:
    """What the sound parts of a faulty world say when they are compiled and loaded; nobody steps it."""
    from simkit.runtime import Simulation, WorldStructure

    before = tuple(diagnostics)
    with suppress(SimkitError, ValueError, KeyError, AttributeError, TypeError):
        compiled = builder.compile()
        structure = WorldStructure(builder, compiled, {m.name: m for m in world.models}, frozenset(), parts)
        with suppress(LoadError), Simulation(world, structure, diagnostics, 0, _unused_callback, _unused_callback):
            pass  # what is wrong with a plugin is said once all of them have been loaded
        report_unread(parts.values())
    diagnostics.drop(d for d in tuple(diagnostics)[len(before) :] if d.code in _ENGINE_CODES)


def _unused_callback(*_: object, **__: object) -> Any:
    """Stands for what a simulation that nobody steps never asks for."""
