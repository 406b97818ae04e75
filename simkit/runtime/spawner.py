"""What is in a simulation, and how that changes while it runs."""

from __future__ import annotations

import math
import weakref
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import Diagnostics
from simkit.errors import InputError, LoadError, SimkitError
from simkit.pose import Pose
from simkit.runtime import sensor_attachment
from simkit.runtime.communication.topic_conflicts import report_topic_conflicts
from simkit.runtime.engine.plugin_faults import call_plugin
from simkit.runtime.engine.snapshot import Snapshot, restore_snapshot, take_snapshot
from simkit.runtime.engine.step_loop import guarded_hook
from simkit.runtime.engine.world_structure import (
    FROM_SPAWN,
    SensorsAndPlugins,
    WorldStructure,
    bodies_kept_awake,
    plugins_in_order,
)
from simkit.runtime.handles.entity_handles import copy_fields_by_name, restore_compiled_fields
from simkit.scene import SceneJoint, SceneModel

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

ModelLoader = Callable[..., SceneModel]
SensorsAndPluginsMaker = Callable[..., SensorsAndPlugins]
SpawnRequest = tuple[Any, str | None, Pose | None]
"""What a model is read from (or a model), and the name and the pose that it gets instead of its own."""


class Spawner:
    """The structure of the moment, with its sensors and plugins at work.

    Args:
        sim: whose.
        load_model: reads a model to be spawned.
        make_parts: makes the sensors and plugins of a model and prepares a spec for them.

    Attributes:
        structure: what is there now; never changed, only replaced.
        loaded_plugins: every plugin that is there, or that a snapshot or a reset may bring back.
    """

    def __init__(self, sim: Simulation, load_model: ModelLoader, make_parts: SensorsAndPluginsMaker) -> None:
        self._sim, self._load_model, self._make_parts = sim, load_model, make_parts
        self._attached: set[Any] = set()
        self._spawned = 0
        self._structures: list[weakref.ref[WorldStructure]] = []
        self.loaded_plugins: list[Any] = []
        self.structure: WorldStructure

    def spawn(self, wanted: Sequence[SpawnRequest]) -> list[str]:
        """Adds models, compiled once for all of them; returns their names. Where one fails, all is as before."""
        sim, old = self._sim, self.structure
        before, builder, found = take_snapshot(sim), old.builder.copy(), Diagnostics()
        models, parts, names = dict(old.models), dict(old.parts), []
        for source, name, pose in wanted:
            scene = source  # a copy of what is there
            if not isinstance(source, SceneModel):
                scene = self._load_model(source, found, name=name, pose=pose, taken=models)
            builder.add_model(scene)
            models[scene.name], parts[scene.name] = scene, self._made(scene, builder, found)
            names.append(scene.name)
        compiled = builder.recompile(old.compiled, sim.mj_data)
        self.switch(WorldStructure(builder, compiled, models, old.movable, parts))
        self._start_or_restore([parts[name] for name in names], found, before)
        return names

    def read(self, source: Any) -> SceneModel:
        """A model as its own file has it, without spawning it. Raises LoadError."""
        return self._load_model(source, Diagnostics())

    def add_sensor(self, name: str, sensor: str | Mapping[str, Any]) -> str:
        """Fits a sensor to a link or a joint; returns its scoped name. Where it fails, all is as before."""
        sim, old = self._sim, self.structure
        _, owner = sensor_attachment.find_owner(old, name)
        text = sensor_attachment.sensor_model_xml(sensor_attachment.sensor_xml(sensor), isinstance(owner, SceneJoint))
        found = Diagnostics()
        read = self._load_model(text, found)
        top, shell, scoped = sensor_attachment.build_sensor_model(old, name, read)
        before = take_snapshot(sim)
        builder = old.builder.copy()
        parts = self._made(shell, builder, found)
        if not parts.sensors:
            raise LoadError(tuple(found))
        compiled = builder.recompile(old.compiled, sim.mj_data)
        there = old.parts[top]
        joined = SensorsAndPlugins([*there.sensors, *parts.sensors], [*there.plugins, *parts.plugins])
        self.switch(WorldStructure(builder, compiled, old.models, old.movable, {**old.parts, top: joined}))
        self._start_or_restore([parts], found, before)
        return scoped

    def _made(self, scene: SceneModel, builder: Any, found: Diagnostics) -> SensorsAndPlugins:
        """The parts of what comes while it runs; they are called after all that is there already."""
        parts = self._make_parts(scene, builder, found)
        self._spawned += 1
        for plugin, _ in parts.plugins:
            plugin._order = (FROM_SPAWN, self._spawned, *plugin._order)
        found.raise_if_errors()
        return parts

    def _start_or_restore(self, added: list[SensorsAndPlugins], found: Diagnostics, before: Snapshot) -> None:
        """Starts what was added; where that fails, all is as before."""
        try:
            self.start(added, found)
        except SimkitError:
            self.undo(before)
            raise
        for parts in added:
            for sensor in parts.sensors:
                sensor.scene.params.report_unread("SK-PARAM-003", f"sensor {sensor.scoped!r}")
            for plugin, _ in parts.plugins:
                plugin.report_unread()
        self._sim.reports.extend(found)

    def undo(self, before: Snapshot) -> None:
        """Takes back a change that failed, perhaps within a hook: what waits for the next step goes on waiting."""
        restore_snapshot(self._sim, before, with_inbox=False)
        self._sim.reschedule()
        self._sim.forget_gone()

    def remove(self, name: str) -> None:
        """Takes a top-level model away."""
        old = self.structure
        if name not in old.models:
            raise InputError(f"{name!r} is not a top-level model; remove {name.split('::')[0]!r}", "SK-NAME-003")
        builder = old.builder.copy()
        builder.remove_model(name)
        compiled = builder.recompile(old.compiled, self._sim.mj_data)
        models = {k: v for k, v in old.models.items() if k != name}
        parts = {k: v for k, v in old.parts.items() if k != name}
        self.switch(WorldStructure(builder, compiled, models, old.movable - {name}, parts))

    def forget(self) -> None:
        """Closes the plugins that nothing brings back any more: they are in no structure that is or that is kept.

        Raises:
            PluginError: one of them raised; the others are closed all the same.
        """
        present = self.structure.all_sensors()
        if len(self.loaded_plugins) == len(self.structure.all_plugins()) and len(self._attached) == len(present):
            return  # all are there: nothing was taken away
        self._structures = [kept for kept in self._structures if kept() is not None]
        structures = [structure for kept in self._structures if (structure := kept()) is not None]
        there = {id(p) for structure in structures for p in structure.all_plugins()}
        gone = [plugin for plugin in self.loaded_plugins if id(plugin) not in there]
        self.loaded_plugins = [plugin for plugin in self.loaded_plugins if id(plugin) in there]
        sensors = {s for structure in structures for s in structure.all_sensors()}
        owners = [*gone, *(self._attached - sensors)]
        self._attached &= sensors
        first = self._close(gone)
        self._sim.forget(owners)
        self._sim.entities.forget([scene for structure in structures for scene in structure.models.values()])
        if first is not None:
            raise first

    def make_movable(self, name: str) -> bool:
        """Makes the links of a static model bodies that follow their set pose; False where they are already."""
        old = self.structure
        if name in old.movable:
            return False
        builder = old.builder.copy()
        builder.remove_model(name)
        builder.add_model(old.models[name], movable=True)
        for sensor in old.parts[name].sensors:
            sensor.build(builder)
        compiled = builder.recompile(old.compiled, self._sim.mj_data)
        self.switch(WorldStructure(builder, compiled, old.models, old.movable | {name}, old.parts))
        for light in self._sim.lights.values():
            if light.scene.link.startswith(f"{name}::"):
                self._sim.place_light(light)  # it was drawn in the world's body, and is in its link's own now
        return True

    def add_weld(self, name: str, parent_link: str, child_link: str) -> None:
        """Adds a weld, let go at first, between two links."""
        old = self.structure
        builder = old.builder.copy()
        builder.add_weld(name, parent_link, child_link, active=False)
        compiled = builder.recompile(old.compiled, self._sim.mj_data)
        self.switch(WorldStructure(builder, compiled, old.models, old.movable, old.parts))

    def switch(self, structure: WorldStructure) -> None:
        """Goes on with another structure, the changed model fields carried over."""
        sim = self._sim
        old_model, fields = sim.mj_model, dict(sim.originals)
        new = structure.compiled.model
        sim.originals.clear()
        for field in fields:
            sim.originals[field] = getattr(new, field).copy()
        copy_fields_by_name(old_model, new, fields)
        new.opt.gravity[:] = old_model.opt.gravity
        for sensor in self.structure.all_sensors():
            sensor.take_held()
        self.adopt(structure)
        restore_compiled_fields(old_model, fields)

    def adopt(self, structure: WorldStructure) -> None:
        """Binds handles, sensors and topics to a structure."""
        sim, compiled = self._sim, structure.compiled
        if not any(kept() is structure for kept in self._structures):
            self._structures.append(weakref.ref(structure))
        sim.bus.settle()
        staying = set(structure.all_sensors())
        for sensor in self.structure.all_sensors() if self._attached else ():
            if sensor in self._attached and sensor not in staying:
                sensor.leave()
        self.structure = structure
        sim.physics.rebind(compiled.model, compiled.data)
        sim.physics.sleep.restrict(bodies_kept_awake(structure))
        sim.physics.hears_controls = any(n.mjcf for m in structure.models.values() for n in m.all_models())
        sim.entities.bind(structure)
        sim.labels.bind(structure)
        sim.temperatures.bind(structure)
        sim.friction.bind(compiled, [plugin for part in structure.parts.values() for plugin, _ in part.plugins])
        sim.fast_body_reports.names = compiled.names
        sim.physics.fast_bodies.tell = sim.fast_body_reports
        sim.stand_wrenches(are_applied=True)
        sim.set_active(sim.faults.living(structure))
        for sensor in structure.all_sensors():
            if sensor in self._attached:
                sensor.bind(compiled)

    def start(self, parts: list[SensorsAndPlugins], diagnostics: Diagnostics) -> None:
        """Attaches new sensors, then loads new plugins, in document order; raises LoadError where they found errors."""
        sim = self._sim
        sim.bus.refuses_clashes = False
        for part in parts:
            for sensor in part.sensors:
                with sim.bus.owned_by(sensor):
                    sensor.attach(sim)
                self._attached.add(sensor)
                sensor.bind(self.structure.compiled)
        for plugin, parent_of in plugins_in_order(parts):
            with sim.bus.owned_by(plugin):
                self._load_plugin(plugin, parent_of(sim))
        new = [*(s for part in parts for s in part.sensors), *(plugin for part in parts for plugin, _ in part.plugins)]
        report_topic_conflicts(sim.bus, diagnostics, new)
        sim.bus.refuses_clashes = True
        diagnostics.raise_if_errors()

    def _load_plugin(self, plugin: Any, parent: Any) -> None:
        sim = self._sim
        self.loaded_plugins.append(plugin)
        try:
            plugin._setup(sim, plugin.source)
            if plugin._failed is not None:  # before there was a simulation
                hook, error = plugin._failed
                sim.faults.meet(plugin, hook, error)
                return
            call_plugin(plugin, "load", plugin.load, parent, plugin.params)
        except Exception as error:  # noqa: BLE001 - a plugin may raise anything
            sim.faults.meet(plugin, "load", error)
            return
        _check_hook_rates(plugin)
        try:
            call_plugin(plugin, "get_state", plugin._remember_loaded)
        except Exception as error:  # noqa: BLE001 - as above
            sim.faults.meet(plugin, "get_state", error)

    def close_plugins(self) -> SimkitError | None:
        """Closes every plugin, once; gives the first error that one of them raised."""
        first = self._close(self.loaded_plugins)
        self.loaded_plugins.clear()
        return first

    def _close(self, plugins: Iterable[Any]) -> SimkitError | None:
        first = None
        for plugin in plugins:
            try:
                guarded_hook(self._sim, plugin, "close")()
            except SimkitError as error:
                first = first or error
        return first


def _check_hook_rates(plugin: Any) -> None:
    """Reports a hook's rate that is none."""
    for name in ("before_step_rate", "after_step_rate"):
        rate = getattr(plugin, name)
        if rate is not None and not (isinstance(rate, (int, float)) and 0 <= rate < math.inf):
            message = f"plugin {plugin.name!r}: {name} is {rate!r}, allowed is a number of at least 0 [Hz], or None"
            plugin.params.error("SK-PLUGIN-023", message, "0 and None are every step")
            setattr(plugin, name, None)
