"""Change of a loaded world to other overrides without loading it again, where only numbers differ."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.moved_models import SHAPE_FIELDS
from simkit.compiler.number_edits import DERIVED_FIELDS, plan_number_edits
from simkit.compiler.start_positions import place_joints
from simkit.compiler.state_transfer import fields_on_changed_model, restore_compiled_fields
from simkit.diagnostics import Diagnostics
from simkit.packs import is_shipped
from simkit.runtime.engine.physics_state import StepWindow
from simkit.scene import SceneLight
from simkit.scene.differences import EntityChange, entity_changes
from simkit.scene.overrides import Overrides, override_texts, xacro_overrides

if TYPE_CHECKING:
    from simkit.compiler.number_edits import NumberEdits
    from simkit.compiler.spec_builder import Compiled
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.entity_structure import AttachedState
    from simkit.runtime.engine.snapshot import Snapshot, Stateful
    from simkit.runtime.simulation import Simulation
    from simkit.scene import SceneWorld


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
    source = sim.control.source
    if source.resolve_world is None:
        return False
    arguments = xacro_overrides(overrides)
    if arguments.items() - source.file_arguments.items() or source.xacro_overrides.keys() - arguments.keys():
        return False
    diagnostics = Diagnostics()
    world = source.resolve_world(tuple(overrides), diagnostics)
    is_strict = sim.run_spec is not None and sim.run_spec.options.get("strict", False)
    if diagnostics.has_errors or (is_strict and any(item.severity == "warning" for item in diagnostics)):
        return False  # a new load reports the problems
    changes = entity_changes(sim.loaded.world, world)
    if changes is None or any(_is_read(sim.engine, change) for change in changes):
        return False
    if changes:
        sim.engine.check_open()
        loaded = sim.loaded.snapshot
        edits = plan_number_edits(loaded.structure.compiled, world, changes)
        if edits is None or (edits.are_derived and loaded.fields.keys() & set(DERIVED_FIELDS)):
            return False  # a plugin changed a mass during the load, so that numbers follow from both changes
        _switch_world(sim, loaded, world, edits)
    sim.loaded.change_overrides(overrides)
    sim.reset(seed)
    return True


def _is_read(engine: Engine, change: EntityChange) -> bool:
    """Check whether a plugin or sensor may have computed with a number while it was loaded.

    Plugins of simkit name such numbers in `reads_at_load`. They read the shapes of their own model too. Other plugins
    may read anything, unless they have the attribute too.
    """
    structure = engine.structure
    parts = structure.parts.get(change.owner.scoped) if change.owner is not None else None
    if change.fields & SHAPE_FIELDS and parts is not None and (parts.sensors or parts.plugins):
        return True
    for item in (*structure.all_plugins(), *structure.all_sensors()):
        if isinstance(change.new, SceneLight) and getattr(item, "is_gz_system", False):
            return True  # its components have copies of the lights
        read: Iterable[str] | None = getattr(item, "reads_at_load", None)
        if read is None and not is_shipped(type(item)):
            return True
        if change.fields & set(read or ()):
            return True
    return False


def _switch_world(sim: Simulation, loaded: Snapshot, world: SceneWorld, edits: NumberEdits) -> None:
    """Make a changed world the loaded state of a simulation; the next reset returns to it.

    Changed numbers are written to the present compiled model. Changed shapes need another compiled model.
    """
    engine, structure, handles = sim.engine, loaded.structure, sim.contents.handles
    builder = structure.builder
    sim.communication.bus.settle()
    for sensor in engine.structure.all_sensors():
        sensor.reset()  # otherwise a camera would draw its last sample for the change of the model, which takes 50 ms
    lights = [light for light in world.lights if light not in builder.world.lights]
    if lights or engine.structure is not structure:
        sim.contents.spawner.restore(loaded)
    models = {model.name: model for model in world.models if structure.models.get(model.name) is not model}
    builder.replace_scenes(world, models.values())
    engine.change_world(world)
    handles.replace_scenes(structure.models, models)
    handles.replace_lights(lights)
    before = dict(engine.originals)
    compiled = _write_edits(engine, loaded, edits)
    structure = replace(structure, compiled=compiled, models={**structure.models, **models})
    if compiled.model is engine.mj_model:
        sim.contents.spawner.adopt_numbers(structure, are_scenes_changed=bool(models), are_derived=edits.are_derived)
        data, sleep = loaded.data, loaded.physics.sleep
    else:
        _write_first_state(loaded, compiled)
        sim.contents.spawner.adopt(structure)
        data, sleep = copy.copy(engine.mj_data), engine.physics.sleep.get_state()
    if lights:  # they have their new values
        loaded = replace(loaded, handles=[(part, part.get_state()) for part, _ in loaded.handles])
    fields = fields_on_changed_model(loaded.fields, before, compiled.model)
    fields["gravity"] = compiled.model.opt.gravity.copy()
    variant = sim.contents.spawner.snapshots.begin_variant()
    changed = replace(
        loaded, structure=structure, data=data, fields=fields,
        physics=replace(loaded.physics, sleep=sleep, window=StepWindow()),
        handles=_states_on_changed_model(engine, loaded, before), variant=variant,
    )  # fmt: skip
    sim.loaded.change(changed, world)


def _states_on_changed_model(
    engine: Engine, loaded: Snapshot, before: Mapping[str, npt.NDArray[np.float64]]
) -> list[tuple[Stateful, AttachedState]]:
    """Return the loaded states of handles for the present model; `before` has the compiled values before the change."""
    numbers, model = engine.numbers, engine.mj_model
    return [
        (part, numbers.on_changed_model(state, before, model) if part is numbers else state)
        for part, state in loaded.handles
    ]


def _write_first_state(loaded: Snapshot, compiled: Compiled) -> None:
    """Write the loaded state to the data of another compiled model, with the first positions of this model.

    Positions that plugins set while they were loaded stay.
    """
    before, data = loaded.structure.compiled, compiled.data
    positions = data.qpos.copy()
    assert isinstance(loaded.data, mujoco.MjData)  # the loaded state is not compact
    mujoco.mj_copyData(data, compiled.model, loaded.data)
    if not np.array_equal(before.model.qpos0, compiled.model.qpos0):
        first = mujoco.MjData(before.model)
        place_joints(before.model, first, before.names.joints.values())
        data.qpos[:] = np.where(data.qpos == first.qpos, positions, data.qpos)


def _write_edits(engine: Engine, loaded: Snapshot, edits: NumberEdits) -> Compiled:
    """Write changes to the compiled model without the values that a run has written to it."""
    model, written = engine.mj_model, dict(engine.originals)
    engine.originals.clear()
    restore_compiled_fields(model, written)
    model.opt.gravity[:] = loaded.fields["gravity"]
    return edits.apply(loaded.structure.compiled)
