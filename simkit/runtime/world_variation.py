"""Change of a loaded world to other overrides without loading it again, where only numbers differ."""

from __future__ import annotations

import copy
from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import mujoco

from simkit.compiler.name_map import NameMap
from simkit.compiler.number_edits import plan_number_edits, replace_scenes
from simkit.compiler.spec_builder import Compiled
from simkit.diagnostics import Diagnostics
from simkit.scene import SceneLight
from simkit.scene.differences import EntityChange, entity_changes
from simkit.scene.overrides import Overrides, override_texts, xacro_overrides

if TYPE_CHECKING:
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.simulation import Simulation
    from simkit.scene import SceneWorld

_OWN_PACKAGE: Final = "simkit."


def apply_overrides(sim: Simulation, overrides: Overrides, seed: int | None = None) -> bool:
    """Reset a simulation to the start of its world with exactly these overrides, if only numbers differ.

    The result has the same bits as a simulation that is loaded with the overrides. Later resets return to this state.
    Overrides of an earlier call do not add up. Snapshots from before the call can no longer be restored.

    Args:
        sim: simulation from `simkit.load`.
        overrides: `PATH=VALUE` texts or values by path, in place of those of `simkit.load`.
        seed: seed of all random streams; None keeps the present seed.

    Returns:
        False if the world must be loaded anew; the simulation is then unchanged.

    Raises:
        InputError: an override has no such path, or an invalid value.
    """
    overrides = override_texts(overrides)
    if sim.control.resolve_world is None:
        return False
    arguments = xacro_overrides(overrides)
    if arguments.items() - sim.control.file_arguments.items() or sim.control.xacro_overrides.keys() - arguments.keys():
        return False
    found = Diagnostics()
    world = sim.control.resolve_world(tuple(overrides), found)
    is_strict = sim.run_spec is not None and sim.run_spec.options.get("strict", False)
    if found.has_errors or (is_strict and any(item.severity == "warning" for item in found)):
        return False  # a new load reports the problems
    changes = entity_changes(sim.control.loaded_world, world)
    if changes is None or any(_is_read(sim.engine, change) for change in changes):
        return False
    if changes:
        loaded = sim._loaded_state()
        compiled = _copied(loaded.structure.compiled)
        edits = plan_number_edits(compiled, world, changes)
        if edits is None:
            return False
        sim._restore(loaded)
        _switch_world(sim, world, edits.apply(compiled))
        sim._loaded = sim.snapshot()
    if sim.run_spec is not None:
        sim.run_spec = replace(sim.run_spec, overrides=tuple(overrides))
    sim.reset(seed)
    return True


_SHAPE_FIELDS: Final = frozenset({"geometry", "pose_link", "pose_world"})


def _is_read(engine: Engine, change: EntityChange) -> bool:
    """Check whether a plugin or sensor may have computed with a number while it was loaded.

    Plugins of simkit name such numbers in `reads_at_load`. They read the shapes of their own model too. Other plugins
    may read anything, unless they have the attribute too.
    """
    structure = engine.structure
    parts = structure.parts.get(change.owner.scoped) if change.owner is not None else None
    if change.fields & _SHAPE_FIELDS and parts is not None and (parts.sensors or parts.plugins):
        return True
    for item in (*structure.all_plugins(), *structure.all_sensors()):
        if isinstance(change.new, SceneLight) and getattr(item, "is_gz_system", False):
            return True  # its components have copies of the lights
        read: Iterable[str] | None = getattr(item, "reads_at_load", None)
        if read is None and not type(item).__module__.startswith(_OWN_PACKAGE):
            return True
        if change.fields & set(read or ()):
            return True
    return False


def _copied(compiled: Compiled) -> Compiled:
    """Return a copy of a compiled model; code that keeps values of a model recognises another model by its identity."""
    model = copy.copy(compiled.model)
    return Compiled(model, mujoco.MjData(model), compiled.names, compiled.builder)


def _switch_world(sim: Simulation, world: SceneWorld, compiled: Compiled) -> None:
    """Make the simulation refer to the entities of the changed world and to its compiled model."""
    engine, structure = sim.engine, sim.engine.structure
    builder = structure.builder
    mujoco.mj_copyData(compiled.data, compiled.model, engine.mj_data)
    models = {model.name: model for model in world.models if structure.models.get(model.name) is not model}
    for model in models.values():
        replace_scenes(builder.records[model.scoped], model)
    sim.contents.spawner.snapshots.variant += 1
    builder.world = engine.world = sim.control.loaded_world = world
    names = NameMap.of(builder.records.values(), compiled.model)
    sim.contents.handles.replace_scenes(structure.models, models)
    sim.contents.handles.replace_lights(world.lights)
    sim.contents.spawner.adopt(
        replace(
            structure,
            compiled=Compiled(compiled.model, compiled.data, names, builder),
            models={name: models.get(name, model) for name, model in structure.models.items()},
        )
    )
