"""Sensors and plugins of a model, replaced by those that two functions return."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TypeVar

from simkit.scene import SceneModel, SceneSensor
from simkit.scene.model import SceneJoint, SceneLink, ScenePlugin

ChangeSensor = Callable[[SceneSensor], SceneSensor]
ChangePlugin = Callable[[ScenePlugin], ScenePlugin]
_Owner = TypeVar("_Owner", SceneLink, SceneJoint)


def change_model(model: SceneModel, change_sensor: ChangeSensor, change_plugin: ChangePlugin) -> SceneModel:
    """Return a model with changed sensors and plugins, also those of its nested models.

    The model itself is returned if nothing changes.
    """

    def of_sensor(sensor: SceneSensor) -> SceneSensor:
        changed = change_sensor(sensor)
        plugins = tuple(map(change_plugin, changed.plugins))
        return changed if _is_same(plugins, changed.plugins) else replace(changed, plugins=plugins)

    def of_owner(owner: _Owner) -> _Owner:
        sensors, plugins = tuple(map(of_sensor, owner.sensors)), tuple(map(change_plugin, owner.plugins))
        if _is_same(sensors, owner.sensors) and _is_same(plugins, owner.plugins):
            return owner
        return replace(owner, sensors=sensors, plugins=plugins)

    links, joints = tuple(map(of_owner, model.links)), tuple(map(of_owner, model.joints))
    models = tuple(change_model(nested, change_sensor, change_plugin) for nested in model.models)
    plugins = tuple(map(change_plugin, model.plugins))
    pairs = (links, model.links), (joints, model.joints), (models, model.models), (plugins, model.plugins)
    if all(_is_same(new, old) for new, old in pairs):
        return model
    return replace(model, links=links, joints=joints, models=models, plugins=plugins)


def _is_same(new: Sequence[object], old: Sequence[object]) -> bool:
    return all(a is b for a, b in zip(new, old, strict=True))
