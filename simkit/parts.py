"""The sensors and plugins that a scene asks for, made of their classes; what is of no known kind is reported."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.params import Params
from simkit.scene import SceneJoint, SceneLink, SceneModel, ScenePlugin, SceneSensor, SceneWorld

if TYPE_CHECKING:
    from simkit.plugins.base import ParentKind, Plugin
    from simkit.runtime import Parts


def parts_of_model(model: SceneModel, builder: Any, diagnostics: Diagnostics, plugin_paths: Sequence[Path]) -> Parts:
    """Sensors and plugins of a model, in document order: each sensor's plugins first, then models', then visuals'."""
    from simkit.runtime import Parts
    from simkit.sensors.presets.apply import with_preset

    parts = Parts()
    for named in model.all_sensors():
        faults = diagnostics.error_count
        scene = with_preset(named, diagnostics)
        sensor = _sensor(scene, diagnostics)
        if sensor is None:
            continue
        if diagnostics.error_count == faults:
            sensor.build(builder)
        if diagnostics.error_count == faults:
            parts.sensors.append(sensor)
        for plugin in scene.plugins:
            parent = _sensor_parent(scene.scoped)
            _add_plugin(parts, plugin, "sensor", scene, builder, diagnostics, plugin_paths, parent)
    for nested in model.all_models():
        owners: list[SceneLink | SceneJoint] = [*nested.links, *nested.joints]
        below = [plugin for owner in owners for plugin in owner.plugins]
        parent = _model_parent(nested.scoped)
        for plugin in (*below, *nested.plugins):
            _add_plugin(parts, plugin, "model", nested, builder, diagnostics, plugin_paths, parent)
    for visual in (v for link in model.all_links() for v in link.visuals if v.plugins):
        parent = _visual_parent(visual.scoped)
        for plugin in visual.plugins:
            _add_plugin(parts, plugin, "visual", visual, builder, diagnostics, plugin_paths, parent)
    return parts


def parts_of_world(
    world: SceneWorld, builder: Any, diagnostics: Diagnostics, plugin_paths: Sequence[Path], made: Sequence[Plugin]
) -> Parts:
    from simkit.plugins.clock import ClockPublisher
    from simkit.plugins.tf import StaticTransforms
    from simkit.runtime import Parts
    from simkit.sensors.known import report_homeless

    parts = Parts()
    report_homeless(world, diagnostics)
    for plugin in world.plugins:
        _add_plugin(parts, plugin, "world", world, builder, diagnostics, plugin_paths, lambda sim: sim)
    for instance in (ClockPublisher(), StaticTransforms(), *made):
        instance.source = None
        instance.prepare(world, Params("plugin"), builder)
        parts.plugins.append((instance, lambda sim: sim))
    return parts


def _sensor(scene: SceneSensor, diagnostics: Diagnostics) -> Any | None:
    from simkit.sensors import sensor_kinds
    from simkit.sensors.known import report_known

    kinds = sensor_kinds()
    if scene.kind not in kinds:
        if report_known(scene, diagnostics):
            return None
        hint = did_you_mean(scene.kind, kinds) or "kinds: " + ", ".join(kinds)
        message = f"sensor {scene.scoped!r}: kind {scene.kind!r} is not simulated"
        diagnostics.warning("SK-SENSOR-001", message, scene.where, hint)
        return None
    cls, place = kinds[scene.kind], "joint" if scene.on_joint else "link"
    if place not in cls.belongs_to:
        places = " or a ".join(cls.belongs_to)
        message = f"sensor {scene.scoped!r}: {scene.kind} belongs to a {places}, not to a {place}"
        hint = f"move it from the {place} {scene.parent!r} into a <{cls.belongs_to[0]}>"
        diagnostics.warning("SK-SENSOR-024", f"{message}; it is left out, as in Gazebo", scene.where, hint)
        return None
    return cls(scene, diagnostics)


def _add_plugin(
    parts: Parts,
    plugin: ScenePlugin,
    parent_kind: ParentKind,
    scene: Any,
    builder: Any,
    diagnostics: Diagnostics,
    plugin_paths: Sequence[Path],
    parent: Callable[[Any], Any],
) -> None:
    from simkit.plugins import find_plugin

    cls = find_plugin(plugin, plugin_paths, diagnostics, parent_kind)
    if cls is None:
        return
    if cls.drives and getattr(scene, "static", False):
        message = f"plugin {plugin.name!r} drives joints of {scene.scoped!r}, which is static; it is left out"
        diagnostics.warning("SK-PLUGIN-010", message, plugin.where, "nothing moves in a static model")
        return
    instance = cls()
    instance.source = plugin
    faults = diagnostics.error_count
    instance.prepare(scene, plugin.params, builder)
    if diagnostics.error_count == faults:  # a faulty one would only say more of the same when it is loaded
        parts.plugins.append((instance, parent))


def _sensor_parent(scoped: str) -> Callable[[Any], Any]:
    return lambda sim: sim.sensor(scoped)


def _model_parent(scoped: str) -> Callable[[Any], Any]:
    return lambda sim: sim.model(scoped)


def _visual_parent(scoped: str) -> Callable[[Any], Any]:
    return lambda sim: sim.visual(scoped)


def report_unread(parts: Iterable[Parts]) -> None:
    """Warns about each parameter that its plugin or sensor did not read."""
    for part in parts:
        for sensor in part.sensors:
            sensor.scene.params.report_unread("SK-PARAM-003", f"sensor {sensor.scoped!r}")
        for plugin, _ in part.plugins:
            if plugin.source is not None:
                plugin.params.report_unread("SK-PARAM-003", f"plugin {plugin.name!r}")
