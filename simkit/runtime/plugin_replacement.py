"""One plugin in the place of another, while the run goes on from where it is."""

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
"""Attributes of a plugin, as `get_state` gives them."""

_CODE = "SK-PLUGIN-075"


class IncompatiblePlugin(InputError):
    """The new plugin wants something else in the physics than the old one has put there."""

    def __init__(self, what: str) -> None:
        super().__init__(f"{_CODE} {what}; the run has to begin anew for that", _CODE)


def replace_plugin(sim: Simulation, old: AttachedPlugin, new: AttachedPlugin, scene: object) -> None:
    """Puts a plugin in the place of one that is at work. Time, physics and everything else stay as they are.

    `prepare` and `load` of the new one are called. Then its attributes are what its `load` made of them, but for those
    that the old one had changed since its own `load`: these go over. So do live parameters that were set.

    Args:
        sim: between two steps.
        old: the plugin to be replaced.
        new: an instance with `source` and `order` of the old one, that nobody has called yet.
        scene: the resolved entity it hangs on.

    Raises:
        StructureChanged: `prepare` asks for servos or sites that are not there, or leaves some out.
        LoadError, PluginError: the new one cannot be loaded. In all cases the old one is at work as before.
    """
    snapshots = sim.contents.spawner.snapshots
    before = snapshots.take()
    nodes = {node: dict(found) for node, found in sim.communication.live_parameters._parameters.items()}
    try:
        _prepare(sim, old, new, scene)
        new.sim = sim
        snapshots.restore(_swap_in_snapshot(before, old, new, new.get_state()))
        _load(sim, new)
        loaded, first = new.get_state(), _parameter_values(sim, new)
        had = next(state for plugin, state in before.plugins if plugin is old)
        state = _carried_state(new, loaded, had, _loaded_state(sim, old))
        _take_over_parameters(sim, old, new)
        values = sim.communication.live_parameters.get_state()
        snapshots.restore(_swap_in_snapshot(before, old, new, state))
        sim.communication.live_parameters.set_state(values)
    except Exception:
        close_endpoints(sim, new)
        sim.communication.live_parameters._parameters = nodes
        snapshots.restore(before)
        sim.engine.reschedule()
        raise
    _hand_over_goals(sim, old, new)
    if sim.engine.faults.is_disabled(old):
        _restore_servo_gains(sim, new)
    close_endpoints(sim, old)
    sim._loaded = _add_parameter_values(sim, _swap_in_snapshot(sim._loaded, old, new, loaded), first)
    loaded_plugins = sim.contents.spawner.loaded_plugins
    loaded_plugins[:] = [plugin for plugin in loaded_plugins if plugin is not old]
    sim.engine.reschedule()
    sim.engine.faults.task(old, "close")(0)


def _prepare(sim: Simulation, old: AttachedPlugin, new: AttachedPlugin, scene: object) -> None:
    if not new.has_hook("prepare"):
        if old._actuators:
            raise IncompatiblePlugin(f"{new.name!r} does not drive {_list_actuators(old._actuators)} any more")
        return
    builder = _CompiledBuilder(sim.engine.structure.builder, old)
    new.prepare(scene, new.params, builder)
    new.params.diagnostics.raise_if_errors()
    if builder.left:
        raise IncompatiblePlugin(f"{new.name!r} does not drive {_list_actuators(builder.left)} any more")
    new._actuators = old._actuators


def _load(sim: Simulation, new: AttachedPlugin) -> None:
    parents = {id(plugin): parent for part in sim.engine.structure.parts.values() for plugin, parent in part.plugins}
    with sim.communication.bus.owned_by(new):
        sim.contents.spawner.load_plugin(new, parents[id(new)](sim))
    new.params.diagnostics.raise_if_errors()


def _list_actuators(actuators: Iterable[ActuatorRef]) -> str:
    return ", ".join(f"{ref.joint!r} by {ref.kind}" for ref in actuators)


class _CompiledBuilder:
    """A builder of a model that is compiled already: what is asked for has to be there."""

    def __init__(self, builder: SpecBuilder, old: AttachedPlugin) -> None:
        self._builder, self._old = builder, old
        self.left = list(old._actuators)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._builder, name)

    def add_velocity_servo(self, joint_scoped: str, **options: Any) -> ActuatorRef:
        return self._found("velocity", joint_scoped, **options)

    def add_position_servo(self, joint_scoped: str, **options: Any) -> ActuatorRef:
        return self._found("position", joint_scoped, **options)

    def add_motor(
        self, joint_scoped: str, axis: int = 0, max_effort: float = math.inf, owner: str = "motor", **options: Any
    ) -> ActuatorRef:
        return self._found("motor", joint_scoped, axis=axis, max_effort=max_effort, owner=owner, **options)

    def add_site(self, link_scoped: str, pose_link: object, name: str) -> str:
        if not any(name in record.sites for record in self._builder.records.values()):
            raise IncompatiblePlugin(f"{self._old.name!r} adds a site {name!r} to {link_scoped!r}")
        return name

    def add_weld(self, name: str, parent_link: str, child_link: str, *, active: bool = True) -> str:
        if name not in self._builder.names.joints:
            raise IncompatiblePlugin(f"{self._old.name!r} welds {child_link!r} to {parent_link!r}")
        return name

    def _found(self, kind: str, joint: str, *, axis: int = 0, max_effort: float, **options: Any) -> ActuatorRef:
        axes = self._builder.names.joint(joint).scene.axes
        effort = min(max_effort, axes[axis].effort) if axis < len(axes) else max_effort
        gains = (options.get("kp"), options.get("kv"))
        for ref in self.left:
            if (ref.kind, ref.joint, ref.axis, ref.max_effort, (ref.kp, ref.kv)) == (kind, joint, axis, effort, gains):
                self.left.remove(ref)
                return ref
        raise IncompatiblePlugin(f"{self._old.name!r} drives {joint!r} by {kind} with at most {effort:g}")


# ---------------------------------------------------------------------- state


def _swap_in_snapshot(snapshot: Snapshot, old: AttachedPlugin, new: AttachedPlugin, state: PluginState) -> Snapshot:
    """A snapshot with the new plugin in the place of the old one."""
    plugins = [(new, state) if plugin is old else (plugin, had) for plugin, had in snapshot.plugins]
    return replace(snapshot, structure=_swap_in_structure(snapshot.structure, old, new), plugins=plugins)


def _swap_in_structure(structure: WorldStructure, old: AttachedPlugin, new: AttachedPlugin) -> WorldStructure:
    def swapped(part: SensorsAndPlugins) -> SensorsAndPlugins:
        if all(plugin is not old for plugin, _ in part.plugins):
            return part
        return replace(part, plugins=[(new if plugin is old else plugin, parent) for plugin, parent in part.plugins])

    return replace(structure, parts={name: swapped(part) for name, part in structure.parts.items()})


def _loaded_state(sim: Simulation, plugin: AttachedPlugin) -> PluginState:
    """A plugin's state after its `load`; of one that was spawned later nothing is known."""
    return next((state for p, state in sim._loaded.plugins if p is plugin), {})


def _carried_state(new: Any, loaded: PluginState, had: PluginState, first: PluginState) -> PluginState:
    """The state that the new plugin goes on with; of a system of gz it is the system's variables that count."""
    if "variables" not in loaded or not getattr(new, "is_gz_system", False):
        return _merge_attributes(loaded, had, first, type(new).__module__)
    was, at_first = had.get("variables", {}), first.get("variables", {})
    variables = _merge_attributes(loaded["variables"], was, at_first, type(new.system).__module__)
    return {**loaded, "entities": had.get("entities"), "variables": variables}


def _merge_attributes(loaded: PluginState, had: PluginState, first: PluginState, module: str) -> PluginState:
    """The new one's attributes, with what the old one had changed since it was loaded."""
    state = dict(loaded)
    for name, value in had.items():
        if name in first and _is_equal(first[name], value):
            continue
        if name not in first and name in loaded and first:
            continue  # the new one makes in `load` what the old one made later
        if name in loaded and not _is_compatible(value, loaded[name]):
            continue
        if type(value).__module__ == module and name in loaded and hasattr(value, "__dict__"):
            value.__class__ = type(loaded[name])  # an instance of a class that was reloaded as well
        state[name] = value
    return state


def _is_compatible(value: object, like: object) -> bool:
    """Whether a value may stand where the new plugin has one of its own; None stands for anything."""
    number = (int, float, np.number)
    if value is None or like is None or (isinstance(value, number) and isinstance(like, number)):
        return True
    return type(value).__name__ == type(like).__name__


def _is_equal(one: Any, other: Any) -> bool:
    """Whether two states of an attribute are equal; objects that cannot tell are looked into."""
    if one is other:
        return True
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        return one.shape == other.shape and bool(np.array_equal(one, other, equal_nan=one.dtype.kind == "f"))
    if isinstance(one, (list, tuple)):
        return len(one) == len(other) and all(map(_is_equal, one, other))
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(_is_equal(one[key], other[key]) for key in one)
    if not any("__eq__" in vars(cls) for cls in type(one).__mro__[:-1]) and hasattr(one, "__dict__"):
        return _is_equal(vars(one), vars(other))
    try:
        return bool(one == other)
    except Exception:  # noqa: BLE001 - a foreign comparison may raise anything
        return False


# ---------------------------------------------------------------------- what is open to others


def close_endpoints(sim: Simulation, owner: object) -> None:
    """Takes every topic, service, action, parameter and subscription of a plugin away for good."""
    sim.communication.forget([owner])
    for reader in sim.communication.bus.subscriptions():
        if _is_callback_of(reader.callback, owner):
            reader.close()


def _is_callback_of(callback: object, owner: object) -> bool:
    """Whether a callback is a method of a plugin, or guards one."""
    if getattr(callback, "__self__", None) is owner:
        return True
    for cell in getattr(callback, "__closure__", None) or ():
        with suppress(ValueError):  # an empty one
            if cell.cell_contents is owner:
                return True
    return False


def _take_over_parameters(sim: Simulation, old: AttachedPlugin, new: AttachedPlugin) -> None:
    """Live parameters that were set while the old plugin was at work keep their values, where the new one takes them.

    The old one's may be hidden behind new ones of the same name; the first snapshot has them.
    """
    table = sim.communication.live_parameters
    first = {p: value for part, state in sim._loaded.handles if part is table for p, value in state}
    changed = {p.name: p.value for p, value in first.items() if p.owner is old and not _is_equal(p.value, value)}
    for parameter, _ in table.get_state():
        if parameter.owner is new and parameter.name in changed:
            try:
                parameter.take(parameter.checked(changed[parameter.name]))
            except SimkitError as error:
                sim.engine.log.warning("%s is not taken over: %s", parameter.name, error)


def _parameter_values(sim: Simulation, plugin: AttachedPlugin) -> ParameterState:
    """A plugin's live parameters with their values."""
    return tuple((p, value) for p, value in sim.communication.live_parameters.get_state() if p.owner is plugin)


def _add_parameter_values(sim: Simulation, snapshot: Snapshot, values: ParameterState) -> Snapshot:
    """A snapshot that has these parameters as well."""
    table = sim.communication.live_parameters
    handles = [(h, (*state, *values)) if h is table else (h, state) for h, state in snapshot.handles]
    return replace(snapshot, handles=handles)


def _hand_over_goals(sim: Simulation, old: AttachedPlugin, new: AttachedPlugin) -> None:
    """Goals that are being worked on go on with the new plugin's action of the same name, or are aborted."""
    actions = sim.communication.actions.endpoints_of(new)
    for goal in [g for g in sim.communication.actions._goals if g._action.owner is old and not g.is_done]:
        if goal._action.name in actions:
            goal._action = actions[goal._action.name]
        else:
            goal.abort(reason=f"plugin {new.name!r} was reloaded without this action")


def _restore_servo_gains(sim: Simulation, plugin: AttachedPlugin) -> None:
    """Gives the servos of a plugin that was left out their strength back."""
    if plugin._actuators:
        indices = [sim.engine.names.actuator(ref) for ref in plugin._actuators]
        for field in ("actuator_gainprm", "actuator_biasprm"):
            sim.engine.touch(field)[indices] = sim.engine.original(field)[indices]
