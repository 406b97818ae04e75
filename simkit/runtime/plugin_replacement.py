"""Replacement of a plugin during a run that continues from its present state."""

from __future__ import annotations

import math
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.errors import InputError, SimkitError
from simkit.runtime.engine.entity_structure import AttachedPlugin, SensorsAndPlugins, WorldStructure
from simkit.runtime.engine.snapshot import Snapshot

if TYPE_CHECKING:
    from simkit.compiler import ActuatorRef, SpecBuilder
    from simkit.runtime.communication.parameter_server import ParameterState
    from simkit.runtime.simulation import Simulation

PluginState = dict[str, Any]
"""Attributes of a plugin, as returned by `get_state`."""

_CODE = "SK-PLUGIN-075"


class IncompatiblePlugin(InputError):
    """Error for a new plugin that needs other physics elements than the old plugin has added."""

    def __init__(self, change: str) -> None:
        super().__init__(_CODE, f"{change}; restart the run to apply this change")


def replace_plugin(sim: Simulation, old: AttachedPlugin, new: AttachedPlugin, scene: object) -> None:
    """Replace an active plugin. Time, physics and everything else stay as they are.

    `prepare` and `load` of the new plugin are called. Its attributes are those that its `load` set. Attributes that the
    old plugin had changed since its own `load` are carried over, as are live parameters that were set.

    Args:
        sim: simulation, between two steps.
        old: plugin to replace.
        new: unused instance with `source` and `order` of the old plugin.
        scene: resolved parent entity.

    Raises:
        IncompatiblePlugin: `prepare` adds servos or sites that do not exist, or leaves some out. The old plugin stays
            active.
        LoadError: the new plugin has errors. The old plugin stays active.
        PluginError: the new plugin raised. The old plugin stays active.
    """
    snapshots = sim.contents.spawner.snapshots
    before = snapshots.take()
    parameters = sim.communication.live_parameters.entries()
    try:
        _prepare(sim, old, new, scene)
        new.join_simulation(sim)
        snapshots.restore(_swap_in_snapshot(before, old, new, new.get_state()))
        _load(sim, new)
        loaded, first = new.get_state(), _parameter_values(sim, new)
        old_state = next(state for plugin, state in before.plugins if plugin is old)
        state = _carried_state(new, loaded, old_state, _loaded_state(sim, old))
        _take_over_parameters(sim, old, new)
        values = sim.communication.live_parameters.get_state()
        snapshots.restore(_swap_in_snapshot(before, old, new, state))
        sim.communication.live_parameters.set_state(values)
    except Exception:
        close_endpoints(sim, new)
        sim.communication.live_parameters.replace_entries(parameters)
        snapshots.restore(before)
        sim.engine.reschedule()
        raise
    sim.communication.actions.hand_over(old, new, f"plugin {new.name!r} was reloaded without this action")
    if sim.engine.faults.is_disabled(old):
        _restore_servo_gains(sim, new)
    close_endpoints(sim, old)
    sim.loaded.change(_add_parameter_values(sim, _swap_in_snapshot(sim.loaded.snapshot, old, new, loaded), first))
    loaded_plugins = sim.contents.spawner.loaded_plugins
    loaded_plugins[:] = [plugin for plugin in loaded_plugins if plugin is not old]
    sim.engine.reschedule()
    sim.engine.faults.task(old, "close")(0)


def _prepare(sim: Simulation, old: AttachedPlugin, new: AttachedPlugin, scene: object) -> None:
    actuators = _actuators_of(sim, old)
    if not new.has_hook("prepare"):
        if actuators:
            raise IncompatiblePlugin(f"{new.name!r} no longer drives {_list_actuators(actuators)}")
        return
    builder = _CompiledBuilder(sim.engine.structure.builder, old.name, actuators)
    new.prepare(scene, new.params, builder)
    new.params.diagnostics.raise_if_errors()
    if builder.left:
        raise IncompatiblePlugin(f"{new.name!r} no longer drives {_list_actuators(builder.left)}")


def _actuators_of(sim: Simulation, plugin: AttachedPlugin) -> tuple[ActuatorRef, ...]:
    entry = sim.engine.structure.entry_of(plugin)
    return () if entry is None else entry.actuators


def _load(sim: Simulation, new: AttachedPlugin) -> None:
    entry = sim.engine.structure.entry_of(new)
    assert entry is not None
    with sim.communication.bus.owned_by(new):
        sim.contents.spawner.load_plugin(entry)
    new.params.diagnostics.raise_if_errors()


def _list_actuators(actuators: Iterable[ActuatorRef]) -> str:
    return ", ".join(f"{ref.joint!r} by {ref.kind}" for ref in actuators)


class _CompiledBuilder:
    """Builder of a model that is already compiled: every requested element must exist."""

    def __init__(self, builder: SpecBuilder, plugin: str, actuators: Iterable[ActuatorRef]) -> None:
        self._builder, self._plugin, self.left = builder, plugin, list(actuators)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._builder, name)

    def add_velocity_servo(self, joint_scoped: str, **options: Any) -> ActuatorRef:
        return self._existing("velocity", joint_scoped, **options)

    def add_position_servo(self, joint_scoped: str, **options: Any) -> ActuatorRef:
        return self._existing("position", joint_scoped, **options)

    def add_motor(
        self, joint_scoped: str, axis: int = 0, max_effort: float = math.inf, owner: str = "motor", **options: Any
    ) -> ActuatorRef:
        return self._existing("motor", joint_scoped, axis=axis, max_effort=max_effort, owner=owner, **options)

    def add_site(self, link_scoped: str, pose_link: object, name: str) -> str:
        if not any(name in record.sites for record in self._builder.records.values()):
            raise IncompatiblePlugin(f"{self._plugin!r} adds a site {name!r} to {link_scoped!r}")
        return name

    def add_weld(self, name: str, parent_link: str, child_link: str, *, active: bool = True) -> str:
        if name not in self._builder.names.joints:
            raise IncompatiblePlugin(f"{self._plugin!r} welds {child_link!r} to {parent_link!r}")
        return name

    def _existing(self, kind: str, joint: str, *, axis: int = 0, max_effort: float, **options: Any) -> ActuatorRef:
        axes = self._builder.names.joint(joint).scene.axes
        is_limited = options.get("joint_limit", True) and axis < len(axes)
        effort = min(max_effort, axes[axis].effort) if is_limited else max_effort
        gains = (options.get("kp"), options.get("kv"))
        for ref in self.left:
            if (ref.kind, ref.joint, ref.axis, ref.max_effort, (ref.kp, ref.kv)) == (kind, joint, axis, effort, gains):
                self.left.remove(ref)
                return ref
        raise IncompatiblePlugin(f"{self._plugin!r} drives {joint!r} by {kind} with at most {effort:g}")


# ---------------------------------------------------------------------- state


def _swap_in_snapshot(snapshot: Snapshot, old: AttachedPlugin, new: AttachedPlugin, state: PluginState) -> Snapshot:
    """Return a snapshot with the new plugin instead of the old one."""
    plugins = [(new, state) if plugin is old else (plugin, had) for plugin, had in snapshot.plugins]
    return replace(snapshot, structure=_swap_in_structure(snapshot.structure, old, new), plugins=plugins)


def _swap_in_structure(structure: WorldStructure, old: AttachedPlugin, new: AttachedPlugin) -> WorldStructure:
    def swapped(part: SensorsAndPlugins) -> SensorsAndPlugins:
        if all(entry.plugin is not old for entry in part.plugins):
            return part
        entries = [replace(entry, plugin=new) if entry.plugin is old else entry for entry in part.plugins]
        return replace(part, plugins=entries)

    return replace(structure, parts={name: swapped(part) for name, part in structure.parts.items()})


def _loaded_state(sim: Simulation, plugin: AttachedPlugin) -> PluginState:
    """Return a plugin's state after its `load`; empty for a plugin that was spawned later."""
    return next((state for p, state in sim.loaded.snapshot.plugins if p is plugin), {})


def _carried_state(new: Any, loaded: PluginState, old_state: PluginState, first: PluginState) -> PluginState:
    """Return the state with which the new plugin continues; of a Gazebo system, only the variables are merged."""
    if "variables" not in loaded or not getattr(new, "is_gz_system", False):
        return _merge_attributes(loaded, old_state, first, type(new).__module__)
    old_variables, first_variables = old_state.get("variables", {}), first.get("variables", {})
    variables = _merge_attributes(loaded["variables"], old_variables, first_variables, type(new.system).__module__)
    return {**loaded, "entities": old_state.get("entities"), "variables": variables}


def _merge_attributes(loaded: PluginState, old_state: PluginState, first: PluginState, module: str) -> PluginState:
    """Return the new plugin's attributes with the changes that the old plugin made since its `load`."""
    state = dict(loaded)
    for name, value in old_state.items():
        if name in first and _is_equal(first[name], value):
            continue
        if name not in first and name in loaded and first:
            continue  # the new plugin sets in `load` an attribute that the old plugin set later
        if name in loaded and not _is_compatible(value, loaded[name]):
            continue
        if type(value).__module__ == module and name in loaded and hasattr(value, "__dict__"):
            value.__class__ = type(loaded[name])  # an instance of a class that was reloaded as well
        state[name] = value
    return state


def _is_compatible(value: object, like: object) -> bool:
    """Check whether a value may replace the new plugin's own value; None is compatible with every value."""
    number = (int, float, np.number)
    if value is None or like is None or (isinstance(value, number) and isinstance(like, number)):
        return True
    return type(value).__name__ == type(like).__name__


def _is_equal(first: Any, second: Any) -> bool:
    """Check whether two states of an attribute are equal; objects without `__eq__` are compared by their attributes."""
    if first is second:
        return True
    if type(first) is not type(second):
        return False
    if isinstance(first, np.ndarray):
        return first.shape == second.shape and bool(np.array_equal(first, second, equal_nan=first.dtype.kind == "f"))
    if isinstance(first, (list, tuple)):
        return len(first) == len(second) and all(map(_is_equal, first, second))
    if isinstance(first, dict):
        return first.keys() == second.keys() and all(_is_equal(first[key], second[key]) for key in first)
    if not any("__eq__" in vars(cls) for cls in type(first).__mro__[:-1]) and hasattr(first, "__dict__"):
        return _is_equal(vars(first), vars(second))
    try:
        return bool(first == second)
    except Exception:  # noqa: BLE001 - a foreign comparison may raise anything
        return False


# ---------------------------------------------------------------------- interfaces


def close_endpoints(sim: Simulation, owner: object) -> None:
    """Remove every topic, service, action, parameter and subscription of a plugin permanently."""
    sim.communication.forget([owner])
    for reader in sim.communication.bus.subscriptions():
        if _is_callback_of(reader.callback, owner):
            reader.close()


def _is_callback_of(callback: object, owner: object) -> bool:
    """Check whether a callback is a method of a plugin, or a wrapper of such a method by `PluginFaults.guard`."""
    if getattr(callback, "__self__", None) is owner:
        return True
    for cell in getattr(callback, "__closure__", None) or ():
        with suppress(ValueError):  # an empty cell
            if cell.cell_contents is owner:
                return True
    return False


def _take_over_parameters(sim: Simulation, old: AttachedPlugin, new: AttachedPlugin) -> None:
    """Keep the values of live parameters that were set on the old plugin, if the new plugin accepts them.

    A new parameter may hide the old parameter of the same name. The first snapshot still contains both.
    """
    table = sim.communication.live_parameters
    first = {p: value for part, state in sim.loaded.snapshot.handles if part is table for p, value in state}
    changed = {p.name: p.value for p, value in first.items() if p.owner is old and not _is_equal(p.value, value)}
    for parameter, _ in table.get_state():
        if parameter.owner is new and parameter.name in changed:
            try:
                parameter.take(parameter.checked(changed[parameter.name]))
            except SimkitError as error:
                sim.engine.log.warning("parameter %s keeps its new value: %s", parameter.name, error)


def _parameter_values(sim: Simulation, plugin: AttachedPlugin) -> ParameterState:
    """Return a plugin's live parameters with their values."""
    return tuple((p, value) for p, value in sim.communication.live_parameters.get_state() if p.owner is plugin)


def _add_parameter_values(sim: Simulation, snapshot: Snapshot, values: ParameterState) -> Snapshot:
    """Return a snapshot that contains these parameters as well."""
    table = sim.communication.live_parameters
    handles = [(h, (*state, *values)) if h is table else (h, state) for h, state in snapshot.handles]
    return replace(snapshot, handles=handles)


def _restore_servo_gains(sim: Simulation, plugin: AttachedPlugin) -> None:
    """Restore the servo gains of a plugin that was disabled."""
    if actuators := _actuators_of(sim, plugin):
        indices = [sim.engine.names.actuator(ref) for ref in actuators]
        for field in ("actuator_gainprm", "actuator_biasprm"):
            sim.engine.touch(field)[indices] = sim.engine.original(field)[indices]
