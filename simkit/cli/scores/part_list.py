"""Parts of a world that a score counts: models, links and shapes, joints, sensors and plugins."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final, Literal

from simkit.diagnostics import Where
from simkit.scene import SceneModel, ScenePlugin, SceneSensor, SceneWorld

PartKind = Literal["drives", "sensors", "plugins", "joints", "models", "shapes"]
KINDS: Final[tuple[PartKind, ...]] = ("drives", "sensors", "plugins", "joints", "models", "shapes")
"""Kinds of parts in the order of every table."""

KIND_TITLES: Final[dict[PartKind, str]] = {
    "drives": "drive plugins",
    "sensors": "sensors",
    "plugins": "other plugins",
    "joints": "joints",
    "models": "models",
    "shapes": "links and shapes",
}

ELEMENT_KINDS: Final[dict[str, PartKind]] = {
    **dict.fromkeys(("world", "model", "robot", "include", "actor", "mujoco"), "models"),
    **dict.fromkeys(("link", "collision", "visual", "light", "body", "geom"), "shapes"),
    "joint": "joints",
    "sensor": "sensors",
    "plugin": "plugins",
}
"""Kind of the part that an element of a file describes."""

IsDrive = Callable[[ScenePlugin], bool]
"""Function that checks whether a plugin moves joints or models on command."""


@dataclass(frozen=True, slots=True)
class Part:
    """One part of a world.

    Attributes:
        kind: kind of the part.
        element: name of its element in the file, such as `joint`.
        name: scoped name.
        where: place of its element.
    """

    kind: PartKind
    element: str
    name: str
    where: Where


def list_parts(world: SceneWorld, is_drive: IsDrive) -> list[Part]:
    """Return the parts of a world and of all its models, each model with its parts, in document order."""
    parts = [Part("models", "world", world.name, world.where)] if world.where.line else []
    parts += [Part("models", "actor", actor.name, actor.where) for actor in world.actors]
    parts += [Part("shapes", "light", light.scoped or light.name, light.where) for light in world.lights]
    parts += [Part("joints", "joint", joint.scoped, joint.where) for joint in world.joints]
    parts += [_plugin_part(plugin, is_drive) for plugin in world.plugins]
    for top in world.models:
        for model in top.all_models():
            parts += _model_parts(model, is_drive)
    return parts


def _model_parts(model: SceneModel, is_drive: IsDrive) -> Iterator[Part]:
    yield Part("models", "model", model.scoped, model.where)
    for link in model.links:
        yield Part("shapes", "link", link.scoped, link.where)
        yield from (Part("shapes", "collision", shape.scoped, shape.where) for shape in link.collisions)
        for visual in link.visuals:
            yield Part("shapes", "visual", visual.scoped, visual.where)
            yield from (_plugin_part(plugin, is_drive) for plugin in visual.plugins)
        yield from (Part("shapes", "light", light.scoped, light.where) for light in link.lights)
        for sensor in link.sensors:
            yield from _sensor_parts(sensor, is_drive)
        yield from (_plugin_part(plugin, is_drive) for plugin in link.plugins)
    for joint in model.joints:
        yield Part("joints", "joint", joint.scoped, joint.where)
        for sensor in joint.sensors:
            yield from _sensor_parts(sensor, is_drive)
        yield from (_plugin_part(plugin, is_drive) for plugin in joint.plugins)
    yield from (_plugin_part(plugin, is_drive) for plugin in model.plugins)


def _sensor_parts(sensor: SceneSensor, is_drive: IsDrive) -> Iterator[Part]:
    yield Part("sensors", "sensor", sensor.scoped, sensor.where)
    yield from (_plugin_part(plugin, is_drive) for plugin in sensor.plugins)


def _plugin_part(plugin: ScenePlugin, is_drive: IsDrive) -> Part:
    kind: PartKind = "drives" if is_drive(plugin) else "plugins"
    return Part(kind, "plugin", plugin.name or plugin.filename, plugin.where)
