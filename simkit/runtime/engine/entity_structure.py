"""Structure of the world: its models, and interfaces of the sensors and plugins on them.

This package does not import the classes of sensors and plugins.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

from simkit.scene import SceneModel

if TYPE_CHECKING:
    from contextlib import AbstractContextManager
    from pathlib import Path

    from simkit.compiler import ActuatorRef, Compiled, SpecBuilder
    from simkit.diagnostics import Where
    from simkit.msgs import Message
    from simkit.params import Params
    from simkit.run_spec import PluginErrorPolicy
    from simkit.runtime.engine.scheduler import Timetable
    from simkit.scene import ScenePlugin, SceneSensor

AttachedState = Any
"""State of a sensor or plugin; only the sensor or plugin itself can interpret it."""


class AttachedSensor(Protocol):
    """Interface of a sensor that the runtime needs.

    Attributes:
        is_manual: True if the simulation takes no samples at the sensor's rate.
        update_rate: rate [Hz]; 0 is every step.
    """

    scene: SceneSensor
    scoped: str
    update_rate: float
    is_manual: bool

    @property
    def topics(self) -> Mapping[str, str]:
        """Topic of each product that is published."""

    def product_type(self, product: str) -> str:
        """Return the ROS type of a product."""

    def check_available(self) -> None:
        """Raise a SimkitError if this machine cannot make the readings."""

    @property
    def reads_contacts(self) -> bool:
        """True if the sensor needs the contacts of its bodies."""

    @property
    def sees_scene(self) -> bool:
        """True if scenery that moves can change a reading."""

    @property
    def topic(self) -> str:
        """Topic of the sensor's first message."""

    @property
    def truth(self) -> Message:
        """Newest message without noise; None before the first."""

    def attach(self, sim: Any) -> None:
        """Open the sensor's topics and random streams."""

    def bind(self, compiled: Compiled) -> None:
        """Look up the sensor's elements in a compiled model."""

    def timetable(self) -> Timetable | None:
        """Return the ticks at which the sensor is sampled; None for every tick."""

    def build_with_artefacts(self, builder: SpecBuilder) -> None:
        """Add what the sensor and its artefacts need to the specification, before it is compiled."""

    def scene_timetable(self) -> Timetable | None:
        """Return the ticks at which the scenery must have its pose; None for every tick."""

    def sample(self, tick: int) -> None:
        """Measure at a tick."""

    @property
    def is_silent(self) -> bool:
        """True if a sample calls no code that may read another sensor."""

    @property
    def keeps_last(self) -> bool:
        """True if only the last of several samples can be read; `skip` counts the others."""

    def skip(self, count: int) -> None:
        """Count samples that are not taken."""

    def take_held(self) -> None:
        """Measure all pending samples, before the model changes."""

    def measure_pending(self, state: AttachedState) -> None:
        """Measure the samples of a state from `get_state` that are not measured yet."""

    def reset(self) -> None:
        """Reset the sensor to its initial state."""

    def close(self) -> None:
        """Release the sensor's resources."""

    def leave(self) -> None:
        """Close the sensor's interfaces after its removal from the world."""

    def get_state(self) -> AttachedState:
        """Return the state for a snapshot."""

    def set_state(self, state: AttachedState) -> None:
        """Restore a state from `get_state`."""


class AttachedPlugin(Protocol):
    """Interface of a plugin that the runtime needs."""

    name: str
    scoped: str
    where: Where
    params: Params
    sim: Any
    before_step_rate: float | None
    after_step_rate: float | None
    on_error: PluginErrorPolicy | None
    plugin_paths: tuple[Path, ...]

    @property
    def source(self) -> ScenePlugin | None:
        """Description of the plugin in the file; None for a plugin created in Python."""

    @property
    def drives(self) -> bool:
        """True if the plugin drives joints."""

    @property
    def reads_parameter_files(self) -> bool:
        """True if the plugin reads the parameter files of the run."""

    @property
    def node_names(self) -> tuple[str, ...]:
        """Full names of the nodes whose parameters the plugin has."""

    @classmethod
    def has_hook(cls, hook: Any) -> bool:
        """Check whether the plugin's class defines a hook."""

    def prepare(self, scene: Any, params: Params, builder: Any) -> None:
        """Add the elements that the plugin needs to the specification."""

    def load(self, parent: Any, params: Params) -> None:
        """Initialise the plugin."""

    def get_state(self) -> AttachedState:
        """Return the state for a snapshot."""

    def set_state(self, state: AttachedState) -> None:
        """Restore a state from `get_state`."""

    def code_objects(self) -> tuple[object, ...]:
        """Return the objects with code of the plugin's author."""

    def importing(self) -> AbstractContextManager[None]:
        """Return a context in which the modules of the plugin's author can be imported."""

    def report_unread(self) -> None:
        """Report unused parameters."""

    def join_simulation(self, sim: Any) -> None:
        """Connect the plugin to its simulation; done before `load`."""

    def get_loaded_state(self) -> AttachedState:
        """Return the state after `load`."""


StructureChange = tuple[str, tuple[Any, ...]]
"""Name and arguments of a function of the spawner that changed the structure: "spawn", "remove", …"""

ParentFinder = Callable[[Any], object]
"""Function that returns a plugin's parent (a simulation, a handle, a sensor) once the handles of a simulation exist."""


@dataclass(frozen=True, slots=True)
class PluginEntry:
    """Plugin of a model or of the world, with the facts that are known before the simulation exists.

    Attributes:
        plugin: the plugin.
        parent: function that returns the parent once the handles exist.
        order: sort key for the order of all plugins.
        actuators: servos and motors that `prepare` added.
        failure: hook that raised before the simulation existed, with its exception; None for none.
    """

    plugin: AttachedPlugin
    parent: ParentFinder
    order: tuple[Any, ...]
    actuators: tuple[ActuatorRef, ...] = ()
    failure: tuple[str, Exception] | None = None


@dataclass
class SensorsAndPlugins:
    """Sensors and plugins of one model (or of the world), in document order."""

    sensors: list[AttachedSensor] = field(default_factory=list)
    plugins: list[PluginEntry] = field(default_factory=list)


@dataclass(frozen=True)
class WorldStructure:
    """Content of the world at one time. A spawn or a removal creates a new structure; snapshots keep theirs.

    Attributes:
        builder: builder of the spec that was compiled; no longer changed.
        compiled: engine objects and names.
        models: top-level models by name, in order.
        movable: names of the static models that were made movable.
        parts: sensors and plugins by the name of their top-level model; those of the world under the empty name.
        changes: changes since the load, in order; another simulation repeats them to restore a pickled snapshot.
    """

    builder: SpecBuilder
    compiled: Compiled
    models: Mapping[str, SceneModel]
    movable: frozenset[str]
    parts: Mapping[str, SensorsAndPlugins]
    changes: tuple[StructureChange, ...] = ()

    def all_sensors(self) -> list[AttachedSensor]:
        return [s for p in self.parts.values() for s in p.sensors]

    def changed(self, name: str, *arguments: object) -> tuple[StructureChange, ...]:
        """Return the changes with a further one."""
        return (*self.changes, (name, arguments))

    def changes_without(self, model: str) -> tuple[StructureChange, ...]:
        """Return the changes with the removal of a model; the changes of a spawned model are left out."""
        remaining: list[StructureChange] = []
        is_spawned = False
        for name, arguments in self.changes:
            if name == "spawn":
                requests = [request for request in arguments[0] if request[0].name != model]
                is_spawned |= len(requests) < len(arguments[0])
                if requests:
                    remaining.append((name, (requests,)))
                continue
            entities = arguments[1:] if name == "add_weld" else arguments[:1]
            if not (is_spawned and any(str(entity).split("::")[0] == model for entity in entities)):
                remaining.append((name, arguments))
        return tuple(remaining) if is_spawned else self.changed("remove", model)

    def all_plugins(self) -> list[AttachedPlugin]:
        """Return every plugin in the order in which plugins are loaded and called."""
        return self._plugins_in_order.copy()

    @cached_property
    def _plugins_in_order(self) -> list[AttachedPlugin]:
        return [entry.plugin for entry in entries_in_order(self.parts.values())]

    def entry_of(self, plugin: AttachedPlugin) -> PluginEntry | None:
        """Return the entry of a plugin; None for a plugin that is not in the world."""
        entries = (entry for part in self.parts.values() for entry in part.plugins)
        return next((entry for entry in entries if entry.plugin is plugin), None)


FROM_FILE, FROM_PYTHON, FROM_SPAWN = range(3)
"""Order of plugins: from the file in document order, then made in Python, then from spawned models.
"""


def entries_in_order(parts: Iterable[SensorsAndPlugins]) -> list[PluginEntry]:
    """Return the entries of the plugins in the order in which plugins are loaded and called."""
    return sorted((entry for part in parts for entry in part.plugins), key=lambda entry: entry.order)


def bodies_kept_awake(structure: WorldStructure) -> set[int]:
    """Return the ids of the bodies that must never sleep: those of a model with a plugin and of a link with a sensor.

    All bodies stay awake if a sensor or plugin reads the contacts of a link that cannot move. A sleeping body has no
    contacts with such a link.
    """
    links = structure.compiled.names.links
    bodies: set[int] = set()
    for name, scene in structure.models.items():
        parts = structure.parts.get(name, SensorsAndPlugins())
        for model in scene.all_models():
            kept_awake = any(not getattr(entry.plugin, "lets_sleep", False) for entry in parts.plugins)
            if kept_awake or not getattr(model, "allow_auto_disable", True):
                bodies |= {int(links[link.scoped].body) for link in model.links}
        if any(getattr(entry.plugin, "reads_contacts", False) for entry in parts.plugins):
            body_ids = [int(links[link.scoped].body) for link in scene.all_links()]
            if (structure.compiled.model.body_treeid[body_ids] < 0).any():
                return {int(link.body) for link in links.values()}
        for sensor in parts.sensors:
            joint = structure.compiled.names.joints.get(sensor.scene.parent)
            link = links.get(joint.scene.child_link if joint else sensor.scene.parent)
            if link is None or (sensor.reads_contacts and structure.compiled.model.body_treeid[link.body] < 0):
                return {int(link.body) for link in links.values()}
            bodies.add(int(link.body))
    return bodies
