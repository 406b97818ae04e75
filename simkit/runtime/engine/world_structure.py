"""What is in the world: models, and the sensors and plugins on them, whose classes this room does not know."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from simkit.scene import SceneModel


@dataclass
class SensorsAndPlugins:
    """The sensors and plugins of one model (or of the world), in document order.

    Attributes:
        plugins: each with a function that gives its parent once the handles exist.
    """

    sensors: list[Any] = field(default_factory=list)
    plugins: list[tuple[Any, Callable[[Any], Any]]] = field(default_factory=list)


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

    builder: Any
    compiled: Any
    models: Mapping[str, SceneModel]
    movable: frozenset[str]
    parts: Mapping[str, SensorsAndPlugins]

    def all_sensors(self) -> list[Any]:
        return [s for p in self.parts.values() for s in p.sensors]

    def all_plugins(self) -> list[Any]:
        """Every plugin, in the order in which they are loaded and called."""
        return [plugin for plugin, _ in plugins_in_order(self.parts.values())]


FROM_FILE, FROM_PYTHON, FROM_SPAWN = range(3)
"""Plugins of the file come first, in document order; then those made in Python; then those of spawned models."""


def plugins_in_order(parts: Iterable[SensorsAndPlugins]) -> list[tuple[Any, Callable[[Any], Any]]]:
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
