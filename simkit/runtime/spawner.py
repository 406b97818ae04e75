"""Spawning and removal of models, and the sensors and plugins of a simulation."""

from __future__ import annotations

import math
import weakref
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from simkit.compiler.start_positions import report_starts
from simkit.compiler.state_transfer import copy_fields_by_name, restore_compiled_fields
from simkit.diagnostics import MOST_ERRORS, Diagnostic, Diagnostics
from simkit.errors import InputError, LoadError, SimkitError
from simkit.pose import Pose
from simkit.runtime import sensor_attachment
from simkit.runtime.communication.topic_conflicts import report_topic_conflicts
from simkit.runtime.engine.entity_structure import (
    FROM_SPAWN,
    AttachedPlugin,
    AttachedSensor,
    AttachedState,
    PluginEntry,
    SensorsAndPlugins,
    WorldStructure,
    entries_in_order,
)
from simkit.runtime.engine.plugin_faults import call_plugin
from simkit.runtime.engine.snapshot import Snapshot, Snapshots
from simkit.runtime.world_source import WorldSource
from simkit.scene import SceneJoint, SceneModel

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime.communication.communication import Communication
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.handles.entity_handles import EntityHandles

MOST_SPAWN_REPORTS: Final = 1000
"""Largest number of diagnostics of spawned models; the oldest ones are dropped."""

SpawnRequest = tuple[object, str | None, Pose | None]
"""Source of a model (or a model), new name and new pose; None keeps the name or the pose of the source."""


class Spawner:
    """Function object that adds and removes models during a run and starts their sensors and plugins.

    Args:
        sim: simulation of the sensors and plugins.
        engine: engine of the simulation.
        communication: communication of the simulation.
        handles: handles of the simulation.
        snapshots: functions that take and restore the state of the simulation.
        source: functions that read models and make their sensors and plugins.

    Attributes:
        load_model: function that reads a model to spawn.
        loaded_plugins: present plugins, and plugins that a snapshot or a reset may bring back.
        first_states: state of each plugin after its `load`, by the identity of the plugin.
        snapshots: functions that take and restore the state of the simulation.
    """

    def __init__(
        self,
        sim: object,
        engine: Engine,
        communication: Communication,
        handles: EntityHandles,
        snapshots: Snapshots,
        source: WorldSource,
    ) -> None:
        self._sim, self._engine, self._communication, self._handles = sim, engine, communication, handles
        self.load_model, self._make_parts = source.load_model, source.make_parts
        self._leave_out = source.leave_out
        self.snapshots = snapshots
        self._attached: set[AttachedSensor] = set()
        self._spawned = 0
        self._reported: list[Diagnostic] = []
        self._structures: list[weakref.ref[WorldStructure]] = []
        self.loaded_plugins: list[AttachedPlugin] = []
        self.first_states: dict[int, AttachedState] = {}

    def spawn(self, requests: Sequence[SpawnRequest]) -> list[str]:
        """Add models, compiled once for all of them; return their names. A failure undoes all changes."""
        diagnostics, taken, read = Diagnostics(), set(self._engine.structure.models), list[SceneModel]()
        diagnostics.can_leave_out = self._engine.reports.can_leave_out
        for source, name, pose in requests:
            if isinstance(source, SceneModel):
                read.append(source)  # a copy of a present model
            else:
                read.append(self.load_model(source, diagnostics, name=name, pose=pose, taken=taken))
            taken.add(read[-1].name)
        while True:
            try:
                return self._add(read, diagnostics)
            except LoadError:  # sensors and plugins with errors are left out
                if not self._leave_out(diagnostics):
                    raise

    def _add(self, read: Sequence[SceneModel], diagnostics: Diagnostics) -> list[str]:
        """Add models and start their sensors and plugins; a failure undoes all changes."""
        old = self._engine.structure
        before, builder = self.snapshots.take(), old.builder.copy()
        models, parts, names, scenes = dict(old.models), dict(old.parts), [], []
        for scene in read:
            builder.add_model(scene)
            models[scene.name], parts[scene.name] = scene, self._make(scene, builder, diagnostics)
            names.append(scene.name)
            scenes.append((scene, None, None))
        changes = old.changed("spawn", scenes)
        self.switch(replace(self._recompiled(builder), models=models, parts=parts, changes=changes))
        self._start_or_restore([parts[name] for name in names], diagnostics, before, names)
        return names

    def read(self, source: object) -> SceneModel:
        """Read a model from its file without spawning it.

        Raises:
            LoadError: the source has errors.
        """
        return self.load_model(source, Diagnostics())

    def add_sensor(self, name: str, sensor: str | Mapping[str, object]) -> str:
        """Add a sensor to a link or a joint; return its scoped name. A failure undoes all changes."""
        old = self._engine.structure
        _, owner = sensor_attachment.find_owner(old, name)
        text = sensor_attachment.sensor_model_xml(sensor_attachment.sensor_xml(sensor), isinstance(owner, SceneJoint))
        diagnostics = Diagnostics()
        read = self.load_model(text, diagnostics)
        top, shell, scoped = sensor_attachment.build_sensor_model(old, name, read)
        before = self.snapshots.take()
        builder = old.builder.copy()
        parts = self._make(shell, builder, diagnostics)
        if not parts.sensors:
            raise LoadError(tuple(diagnostics))
        present = old.parts[top]
        joined = SensorsAndPlugins([*present.sensors, *parts.sensors], [*present.plugins, *parts.plugins])
        changes = old.changed("add_sensor", name, sensor)
        self.switch(replace(self._recompiled(builder), parts={**old.parts, top: joined}, changes=changes))
        self._start_or_restore([parts], diagnostics, before)
        return scoped

    def _make(self, scene: SceneModel, builder: SpecBuilder, diagnostics: Diagnostics) -> SensorsAndPlugins:
        """Make the sensors and plugins of a spawned model; the plugins are called after all present plugins."""
        parts = self._make_parts(scene, builder, diagnostics)
        self._spawned += 1
        diagnostics.raise_if_errors()
        plugins = [replace(entry, order=(FROM_SPAWN, self._spawned, *entry.order)) for entry in parts.plugins]
        return replace(parts, plugins=plugins)

    def _start_or_restore(
        self, added: list[SensorsAndPlugins], diagnostics: Diagnostics, before: Snapshot, models: Sequence[str] = ()
    ) -> None:
        """Start added sensors and plugins, and report the first positions of added models; a failure undoes all."""
        try:
            self.start(added, diagnostics)
        except SimkitError:
            self.undo(before)
            raise
        for parts in added:
            for sensor in parts.sensors:
                sensor.scene.params.report_unread("SK-PARAM-003", f"sensor {sensor.scoped!r}")
            for entry in parts.plugins:
                entry.plugin.report_unread()
        if models:
            compiled = self._engine.structure.compiled
            report_starts(compiled.model, self._engine.mj_data, compiled.names, diagnostics, models)
        self._report(diagnostics)

    def _report(self, diagnostics: Diagnostics) -> None:
        """Add diagnostics of spawned models; only the newest ones are kept, because a run may spawn without end."""
        reports = self._engine.reports
        self._reported += [item for item in diagnostics if item not in reports]
        reports.extend(diagnostics)
        reports.drop(self._reported[:-MOST_SPAWN_REPORTS])
        del self._reported[:-MOST_SPAWN_REPORTS]

    def restore(self, snapshot: Snapshot) -> None:
        """Restore a snapshot of this simulation."""
        engine = self._engine
        has_new_structure = snapshot.structure is not engine.structure
        self.snapshots.restore(snapshot)
        engine.loop.halt()  # `simkit run` then computes its target again
        (engine.reschedule if has_new_structure else engine.loop.rewind)()
        self.forget_gone()

    def undo(self, before: Snapshot) -> None:
        """Undo a failed change, perhaps within a hook; commands for the next step stay in the queue."""
        self.snapshots.restore(before, with_inbox=False)
        self._engine.reschedule()
        self.forget_gone()

    def remove(self, name: str) -> None:
        """Remove a top-level model."""
        old = self._engine.structure
        if name not in old.models:
            text = f"{name!r} is not a top-level model; remove {name.split('::')[0]!r}"
            raise InputError("SK-NAME-003", text, shows_code=False)
        builder = old.builder.copy()
        builder.remove_model(name)
        models = {k: v for k, v in old.models.items() if k != name}
        parts = {k: v for k, v in old.parts.items() if k != name}
        movable, changes = old.movable - {name}, old.changes_without(name)
        self.switch(replace(self._recompiled(builder), models=models, movable=movable, parts=parts, changes=changes))

    def forget_gone(self) -> None:
        """Close the plugins that no restore can bring back.

        During a step, they are closed at the end of the step, because one of the plugins may be running.
        """
        if self._engine.is_stepping:
            self._engine.loop.defer(self.forget)
        else:
            self.forget()

    def forget(self) -> None:
        """Close the plugins that no present or stored structure contains.

        Raises:
            PluginError: a plugin raised; the others are closed all the same.
        """
        now = self._engine.structure
        counts = len(self.loaded_plugins), len(self._attached), self._handles.count
        if counts == (len(now.all_plugins()), len(now.all_sensors()), len(now.models)):
            return  # nothing was removed
        self._structures = [reference for reference in self._structures if reference() is not None]
        structures = [structure for reference in self._structures if (structure := reference()) is not None]
        present = {id(p) for structure in structures for p in structure.all_plugins()}
        removed = [plugin for plugin in self.loaded_plugins if id(plugin) not in present]
        for plugin in removed:
            self.first_states.pop(id(plugin), None)
        self.loaded_plugins = [plugin for plugin in self.loaded_plugins if id(plugin) in present]
        sensors = {s for structure in structures for s in structure.all_sensors()}
        owners = [*removed, *(self._attached - sensors)]
        self._attached &= sensors
        first = self._close(removed)
        self._communication.forget(owners)
        self._handles.forget([scene for structure in structures for scene in structure.models.values()])
        if first is not None:
            raise first

    def make_movable(self, name: str) -> bool:
        """Replace the links of a static model by mocap bodies, which stay at the pose that the user sets.

        Returns:
            False if the model is already movable.
        """
        old = self._engine.structure
        if name in old.movable:
            return False
        builder = old.builder.copy()
        builder.remove_model(name)
        builder.add_model(old.models[name], movable=True)
        for sensor in old.parts[name].sensors:
            sensor.build_with_artefacts(builder)
        changes = old.changed("make_movable", name)
        self.switch(replace(self._recompiled(builder), movable=old.movable | {name}, changes=changes))
        for light in self._handles.tables["light"].values():
            if light.scene.link.startswith(f"{name}::"):
                light.draw()  # the light has moved from the world's body to its link's body
        return True

    def add_weld(self, name: str, parent_link: str, child_link: str) -> None:
        """Add an open weld between two links."""
        builder = self._engine.structure.builder.copy()
        builder.add_weld(name, parent_link, child_link, active=False)
        changes = self._engine.structure.changed("add_weld", name, parent_link, child_link)
        self.switch(replace(self._recompiled(builder), changes=changes))

    def reserve_memory(self, size: int) -> None:
        """Compile again with memory for contacts [bytes]; a removed model has left more than the present ones need."""
        builder = self._engine.structure.builder.copy()
        builder.spec.memory = size
        self.switch(self._recompiled(builder))

    def _recompiled(self, builder: SpecBuilder) -> WorldStructure:
        """Return the present structure with the compiled model of a changed builder."""
        old = self._engine.structure
        return replace(old, builder=builder, compiled=builder.recompile(old.compiled, self._engine.mj_data))

    def switch(self, structure: WorldStructure) -> None:
        """Switch to another structure and carry over the changed model fields."""
        engine = self._engine
        old_model, fields = engine.mj_model, dict(engine.originals)
        new = structure.compiled.model
        engine.originals.clear()
        for field in fields:
            engine.originals[field] = getattr(new, field).copy()
        copy_fields_by_name(old_model, new, fields)
        engine.numbers.carry(old_model, new)
        new.opt.gravity[:] = old_model.opt.gravity
        for sensor in engine.structure.all_sensors():
            sensor.take_held()
        self.adopt(structure)
        restore_compiled_fields(old_model, fields)
        if engine.numbers.inertials:
            engine.numbers.derive()

    def adopt(self, structure: WorldStructure) -> None:
        """Bind handles, sensors and topics to a structure."""
        engine, handles, compiled = self._engine, self._handles, structure.compiled
        self._remember(structure)
        self._communication.bus.settle()
        staying = set(structure.all_sensors())
        for sensor in engine.structure.all_sensors() if self._attached else ():
            if sensor in self._attached and sensor not in staying:
                sensor.leave()
        engine.adopt_structure(structure)
        handles.bind(structure)
        handles.labels.bind(structure)
        handles.temperatures.bind(structure)
        engine.friction.bind(compiled, [entry.plugin for part in structure.parts.values() for entry in part.plugins])
        engine.wrenches.push(are_applied=True)
        self._communication.set_active(engine.faults.living(structure))
        for sensor in structure.all_sensors():
            if sensor in self._attached:
                sensor.bind(compiled)

    def adopt_numbers(self, structure: WorldStructure, *, are_scenes_changed: bool, are_derived: bool) -> None:
        """Switch to a structure with the same compiled model, whose numbers have changed.

        Args:
            structure: structure of the loaded models.
            are_scenes_changed: True if descriptions of models have changed.
            are_derived: True if numbers have changed that follow from masses, inertias and joints.
        """
        engine, compiled = self._engine, structure.compiled
        self._remember(structure)
        self._communication.bus.settle()
        engine.adopt_numbers(structure)
        if are_scenes_changed:
            compiled.names.replace_scenes(structure.builder.records.values())
            self._handles.bind(structure)
            plugins = [entry.plugin for part in structure.parts.values() for entry in part.plugins]
            engine.friction.bind(compiled, plugins, is_changed=True)
        if are_derived:
            engine.numbers.renew()
            for sensor in structure.all_sensors():  # a contact sensor has the centre of mass of its link
                if sensor in self._attached:
                    sensor.bind(compiled)

    def _remember(self, structure: WorldStructure) -> None:
        """Add a structure to those that a restore may bring back, and forget those that nothing refers to."""
        if not any(reference() is structure for reference in self._structures):
            self._structures = [reference for reference in self._structures if reference() is not None]
            self._structures.append(weakref.ref(structure))

    def start(self, parts: list[SensorsAndPlugins], diagnostics: Diagnostics) -> None:
        """Attach new sensors, then load new plugins, in document order.

        Raises:
            LoadError: sensors or plugins have errors.
        """
        bus = self._communication.bus
        with bus.clashes_allowed():
            for part in parts:
                for sensor in part.sensors:
                    with bus.owned_by(sensor):
                        sensor.attach(self._sim)
                    self._attached.add(sensor)
                    sensor.bind(self._engine.compiled)
            for entry in entries_in_order(parts):
                with bus.owned_by(entry.plugin):
                    self.load_plugin(entry)
        new = [*(s for part in parts for s in part.sensors), *(e.plugin for part in parts for e in part.plugins)]
        report_topic_conflicts(bus.endpoints(), diagnostics, new)
        diagnostics.raise_if_errors()

    def load_plugin(self, entry: PluginEntry) -> None:
        """Call a plugin's `load` and store its loaded state."""
        plugin, faults, parent = entry.plugin, self._engine.faults, entry.parent(self._sim)
        self.loaded_plugins.append(plugin)
        try:
            plugin.join_simulation(self._sim)
            if entry.failure is not None:  # it raised before the simulation existed
                hook, error = entry.failure
                faults.meet(plugin, hook, error)
                return
            with plugin.params.diagnostics.blame(plugin.source):
                call_plugin(plugin, "load", plugin.load, parent, plugin.params)
        except Exception as error:
            if isinstance(error, LoadError) and len(error.diagnostics) >= MOST_ERRORS:
                raise  # the parameters of the plugin have too many errors
            faults.meet(plugin, "load", error)
            return
        _check_hook_rates(plugin)
        try:
            self.first_states[id(plugin)] = call_plugin(plugin, "get_state", plugin.get_loaded_state)
        except Exception as error:  # noqa: BLE001 - as above
            faults.meet(plugin, "get_state", error)

    def close_plugins(self) -> SimkitError | None:
        """Close every plugin once; return the first error that a plugin raised."""
        first = self._close(self.loaded_plugins)
        self.loaded_plugins.clear()
        return first

    def _close(self, plugins: Iterable[AttachedPlugin]) -> SimkitError | None:
        first = None
        for plugin in plugins:
            try:
                self._engine.faults.task(plugin, "close")(0)
            except SimkitError as error:
                first = first or error
        return first


def _check_hook_rates(plugin: AttachedPlugin) -> None:
    """Report an invalid rate of a hook."""
    for name in ("before_step_rate", "after_step_rate"):
        rate = getattr(plugin, name)
        if rate is not None and not (isinstance(rate, (int, float)) and 0 <= rate < math.inf):
            message = f"plugin {plugin.name!r}: {name} is {rate!r}; expected a number of at least 0 [Hz], or None"
            plugin.params.error("SK-PLUGIN-023", message, "0 and None mean every step")
            setattr(plugin, name, None)
