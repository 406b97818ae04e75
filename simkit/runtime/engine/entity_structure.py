"""What is in the world: models, and the sensors and plugins on them, whose classes this room does not know."""

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
"""State of a sensor or a plugin, which only itself understands."""


class PublishedProduct(Protocol):
    """Message that a sensor can publish."""

    @property
    def type_name(self) -> str:
        """Its ROS type."""


class AttachedSensor(Protocol):
    """What the runtime asks of a sensor."""

    scene: SceneSensor
    scoped: str
    _topics: dict[str, str]

    @property
    def reads_contacts(self) -> bool:
        """Whether it needs the contacts of its bodies."""

    @property
    def _products(self) -> Mapping[str, PublishedProduct]: ...

    @property
    def topic(self) -> str:
        """Topic of its first message."""

    def build(self, builder: SpecBuilder) -> None:
        """Adds what it needs to the specification."""

    def attach(self, sim: Any) -> None:
        """Opens its topics and random streams."""

    def bind(self, compiled: Compiled) -> None:
        """Finds itself in a compiled model."""

    def timetable(self) -> Timetable | None:
        """Returns the ticks at which it is sampled; None for every one."""

    def sample(self, tick: int) -> None:
        """Takes a sample."""

    def take_held(self) -> None:
        """Takes what still has to be read of the present model."""

    def reset(self) -> None:
        """Goes back to its beginning."""

    def close(self) -> None:
        """Releases what it holds."""

    def leave(self) -> None:
        """Is no longer in the world."""

    def get_state(self) -> AttachedState:
        """Returns what a snapshot keeps."""

    def set_state(self, state: AttachedState) -> None:
        """Goes back to a state from `get_state`."""


class AttachedPlugin(Protocol):
    """What the runtime asks of a plugin."""

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
    def reads_parameter_files(self) -> bool:
        """Whether it reads those that the run was given."""

    @classmethod
    def has_hook(cls, hook: Any) -> bool:
        """Checks whether its class has a hook."""

    def prepare(self, scene: Any, params: Params, builder: Any) -> None:
        """Adds what it needs to the specification."""

    def load(self, parent: Any, params: Params) -> None:
        """Begins its work."""

    def get_state(self) -> AttachedState:
        """Returns what a snapshot keeps."""

    def set_state(self, state: AttachedState) -> None:
        """Goes back to a state from `get_state`."""

    def report_unread(self) -> None:
        """Reports parameters that nobody read."""

    def _setup(self, sim: Any, source: ScenePlugin | None = None) -> None: ...

    def _remember_loaded(self) -> None: ...


ParentFinder = Callable[[Any], Any]
"""Gives a plugin's parent (a simulation, a handle, a sensor) once the handles of a simulation exist."""


@dataclass
class SensorsAndPlugins:
    """The sensors and plugins of one model (or of the world), in document order.

    Attributes:
        plugins: each with a function that gives its parent once the handles exist.
    """

    sensors: list[AttachedSensor] = field(default_factory=list)
    plugins: list[tuple[AttachedPlugin, ParentFinder]] = field(default_factory=list)


@dataclass(frozen=True)
class WorldStructure:
    """What is in the world at one time; a spawn or a removal makes another, snapshots keep theirs.

    Attributes:
        builder: the spec it was compiled from (not changed any more).
        compiled: engine objects and names.
        models: top-level models by name, in order.
        movable: names of the static models that were made movable.
        parts: sensors and plugins by the name of their top-level model; the world's under the empty name.
    """

    builder: SpecBuilder
    compiled: Compiled
    models: Mapping[str, SceneModel]
    movable: frozenset[str]
    parts: Mapping[str, SensorsAndPlugins]

    def all_sensors(self) -> list[AttachedSensor]:
        return [s for p in self.parts.values() for s in p.sensors]

    def all_plugins(self) -> list[AttachedPlugin]:
        """Every plugin, in the order in which they are loaded and called."""
        return [plugin for plugin, _ in plugins_in_order(self.parts.values())]


FROM_FILE, FROM_PYTHON, FROM_SPAWN = range(3)
"""Plugins of the file come first, in document order; then those made in Python; then those of spawned models."""


def plugins_in_order(parts: Iterable[SensorsAndPlugins]) -> list[tuple[AttachedPlugin, ParentFinder]]:
    """Plugins, each with what gives its parent, in the order in which they are loaded and called."""
    return sorted((pair for part in parts for pair in part.plugins), key=lambda pair: pair[0]._order)


def bodies_kept_awake(structure: WorldStructure) -> set[int]:
    """Ids of the bodies that must never sleep, or somebody could tell: a model with a plugin, a link with a sensor.

    Of a sensor or plugin that reads contacts of something that cannot move that is everything: the contacts of a
    sleeper with it are not there.
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
