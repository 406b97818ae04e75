"""Structure of the world: its models, and interfaces of the sensors and plugins on them.

This package does not import the classes of sensors and plugins.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

from simkit.scene import SceneModel

if TYPE_CHECKING:
    from pathlib import Path

    from simkit.compiler import ActuatorRef, Compiled, SpecBuilder
    from simkit.diagnostics import Where
    from simkit.params import Params
    from simkit.run_spec import PluginErrorPolicy
    from simkit.runtime.engine.scheduler import Timetable
    from simkit.scene import ScenePlugin, SceneSensor

AttachedState = Any
"""State of a sensor or plugin; only the sensor or plugin itself can interpret it."""


class PublishedProduct(Protocol):
    """Message that a sensor can publish."""

    @property
    def type_name(self) -> str:
        """ROS type of the message."""


class AttachedSensor(Protocol):
    """Interface of a sensor that the runtime needs.

    Attributes:
        is_manual: True if the simulation takes no samples at the sensor's rate.
    """

    scene: SceneSensor
    scoped: str
    is_manual: bool
    _topics: dict[str, str]

    def check_available(self) -> None:
        """Raise a SimkitError if this machine cannot make the readings."""

    @property
    def reads_contacts(self) -> bool:
        """True if the sensor needs the contacts of its bodies."""

    @property
    def _products(self) -> Mapping[str, PublishedProduct]: ...

    @property
    def topic(self) -> str:
        """Topic of the sensor's first message."""

    def build(self, builder: SpecBuilder) -> None:
        """Add the elements that the sensor needs to the specification."""

    def attach(self, sim: Any) -> None:
        """Open the sensor's topics and random streams."""

    def bind(self, compiled: Compiled) -> None:
        """Look up the sensor's elements in a compiled model."""

    def timetable(self) -> Timetable | None:
        """Return the ticks at which the sensor is sampled; None for every tick."""

    def sample(self, tick: int) -> None:
        """Measure at a tick."""

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
    source: ScenePlugin | None
    plugin_paths: tuple[Path, ...]
    _order: tuple[Any, ...]
    _actuators: tuple[ActuatorRef, ...]
    _failed: tuple[str, Exception] | None

    @property
    def drives(self) -> bool:
        """True if the plugin drives joints."""

    @property
    def reads_parameter_files(self) -> bool:
        """True if the plugin reads the parameter files of the run."""

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

    def report_unread(self) -> None:
        """Report unused parameters."""

    def _setup(self, sim: Any, source: ScenePlugin | None = None) -> None: ...

    def _remember_loaded(self) -> AttachedState: ...


StructureChange = tuple[str, tuple[Any, ...]]
"""Name and arguments of a function of the spawner that changed the structure: "spawn", "remove", …"""

ParentFinder = Callable[[Any], Any]
"""Function that returns a plugin's parent (a simulation, a handle, a sensor) once the handles of a simulation exist."""


@dataclass
class SensorsAndPlugins:
    """Sensors and plugins of one model (or of the world), in document order.

    Attributes:
        plugins: plugins, each with the function that returns its parent once the handles exist.
    """

    sensors: list[AttachedSensor] = field(default_factory=list)
    plugins: list[tuple[AttachedPlugin, ParentFinder]] = field(default_factory=list)


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
        kept: list[StructureChange] = []
        is_spawned = False
        for name, arguments in self.changes:
            if name == "spawn":
                requests = [request for request in arguments[0] if request[0].name != model]
                is_spawned |= len(requests) < len(arguments[0])
                if requests:
                    kept.append((name, (requests,)))
                continue
            entities = arguments[1:] if name == "add_weld" else arguments[:1]
            if not (is_spawned and any(str(entity).split("::")[0] == model for entity in entities)):
                kept.append((name, arguments))
        return tuple(kept) if is_spawned else self.changed("remove", model)

    def all_plugins(self) -> list[AttachedPlugin]:
        """Return every plugin in the order in which plugins are loaded and called."""
        return [plugin for plugin, _ in plugins_in_order(self.parts.values())]


FROM_FILE, FROM_PYTHON, FROM_SPAWN = range(3)
"""Order of plugins: from the file in document order, then made in Python, then from spawned models.
"""


def plugins_in_order(parts: Iterable[SensorsAndPlugins]) -> list[tuple[AttachedPlugin, ParentFinder]]:
    """Return the plugins with their parent finders, in the order in which plugins are loaded and called."""
    return sorted((pair for part in parts for pair in part.plugins), key=lambda pair: pair[0]._order)


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
            kept_awake = any(not getattr(plugin, "lets_sleep", False) for plugin, _ in parts.plugins)
            if kept_awake or not getattr(model, "allow_auto_disable", True):
                bodies |= {int(links[link.scoped].body) for link in model.links}
        if any(getattr(plugin, "reads_contacts", False) for plugin, _ in parts.plugins):
            own = [int(links[link.scoped].body) for link in scene.all_links()]
            if (structure.compiled.model.body_treeid[own] < 0).any():
                return {int(link.body) for link in links.values()}
        for sensor in parts.sensors:
            joint = structure.compiled.names.joints.get(sensor.scene.parent)
            link = links.get(joint.scene.child_link if joint else sensor.scene.parent)
            if link is None or (sensor.reads_contacts and structure.compiled.model.body_treeid[link.body] < 0):
                return {int(link.body) for link in links.values()}
            bodies.add(int(link.body))
    return bodies
