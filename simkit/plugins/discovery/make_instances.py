"""Make the sensors and plugins that a scene asks for; report those of unknown kinds, and add those of every world."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.errors import SimkitError
from simkit.params import Params
from simkit.plugins.classic.server_services import ClassicServices
from simkit.plugins.discovery.find_plugin_class import find_plugin
from simkit.plugins.discovery.python_plugins import Attachment, ParentGetter, SceneEntity, attach_plugins, handle_getter
from simkit.plugins.drives.robot_transforms import StaticTransforms
from simkit.plugins.world.world_statistics import ClockPublisher, WorldStats
from simkit.scene import SceneJoint, SceneLink, SceneModel, ScenePlugin, SceneSensor, SceneWorld
from simkit.sensors import sensor_kinds
from simkit.sensors.presets.preset_defaults import add_preset_defaults
from simkit.sensors.unsimulated_kinds import report_sensors_without_model, report_unsimulated

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.plugins.base import ParentKind, Plugin
    from simkit.runtime import SensorsAndPlugins
    from simkit.sensors.base import Sensor


def make_model_parts(
    model: SceneModel, builder: SpecBuilder, diagnostics: Diagnostics, plugin_paths: Sequence[Path]
) -> SensorsAndPlugins:
    """Sensors and plugins of a model, in document order."""
    from simkit.runtime import SensorsAndPlugins

    parts = SensorsAndPlugins()
    found: list[_PluginSite] = []
    places = _model_positions(model)
    for named in model.all_sensors():
        faults = diagnostics.error_count
        scene = add_preset_defaults(named, diagnostics)
        sensor = _make_sensor(scene, diagnostics)
        if sensor is None:
            continue
        if diagnostics.error_count == faults:
            sensor.build(builder)
        if diagnostics.error_count == faults:
            parts.sensors.append(sensor)
        owner = scene.parent.rpartition("::")[0]
        found += [_PluginSite(p, "sensor", scene, owner, handle_getter("sensor", scene.scoped)) for p in scene.plugins]
    for nested in model.all_models():
        owners: list[SceneLink | SceneJoint] = [*nested.links, *nested.joints]
        below = [plugin for owner in owners for plugin in owner.plugins]
        parent = handle_getter("model", nested.scoped)
        found += [_PluginSite(p, "model", nested, nested.scoped, parent) for p in (*below, *nested.plugins)]
        for visual in (v for link in nested.links for v in link.visuals if v.plugins):
            parent = handle_getter("visual", visual.scoped)
            found += [_PluginSite(p, "visual", visual, nested.scoped, parent) for p in visual.plugins]
    for one in sorted(found, key=lambda one: _document_order(one, places)):
        _add_plugin(parts, one, _document_order(one, places), builder, diagnostics, plugin_paths)
    return parts


@dataclass(frozen=True)
class _PluginSite:
    """A plugin of the file: where it hangs, the scoped name of its model, and what gives its parent."""

    plugin: ScenePlugin
    kind: ParentKind
    scene: SceneEntity
    model: str
    parent: ParentGetter


_DocumentPosition = tuple[tuple[bool, int], ...]
"""A place in a document that includes others: in the world, in the model, in the model inside it."""


def _model_positions(model: SceneModel) -> dict[str, tuple[_DocumentPosition, str | None]]:
    """Where each model below one stands, and in which file, by scoped name."""
    found: dict[str, tuple[_DocumentPosition, str | None]] = {}

    def enter(one: SceneModel, outer: _DocumentPosition, file: str | None) -> None:
        # what an include adds to the model stands in the outer file, and comes after what the model's own file says
        place = (*outer, (bool(outer) and one.where.file == file, one.where.serial))
        found[one.scoped] = place, one.where.file
        for nested in one.models:
            enter(nested, place, one.where.file)

    enter(model, (), None)
    return found


def _document_order(one: _PluginSite, places: Mapping[str, tuple[_DocumentPosition, str | None]]) -> _DocumentPosition:
    where = one.plugin.where
    place, file = places.get(one.model) or next(iter(places.values()))
    return (*place, (where.file == file, where.serial))


def make_world_parts(
    world: SceneWorld, builder: SpecBuilder, diagnostics: Diagnostics, plugin_paths: Sequence[Path]
) -> SensorsAndPlugins:
    from simkit.runtime import SensorsAndPlugins

    parts = SensorsAndPlugins()
    report_sensors_without_model(world, diagnostics)
    for plugin in world.plugins:
        one = _PluginSite(plugin, "world", world, "", lambda sim: sim)
        _add_plugin(parts, one, ((False, plugin.where.serial),), builder, diagnostics, plugin_paths)
    first, last = plugins_of_every_world(world)
    for rank, instance in (*((0, one) for one in first), *((2, one) for one in last)):
        hung = Attachment(instance, "", "", world, lambda sim: sim)
        _add_python_plugin(parts, hung, rank, builder, diagnostics)
    return parts


def add_python_plugins(
    parts: Mapping[str, SensorsAndPlugins],
    made: Iterable[object],
    world: SceneWorld,
    builder: SpecBuilder,
    diagnostics: Diagnostics,
) -> None:
    """Adds plugins made in Python to the parts of what they hang on."""
    for hung in attach_plugins(made, world, diagnostics):
        _add_python_plugin(parts[hung.top], hung, 1, builder, diagnostics)


def _add_python_plugin(
    parts: SensorsAndPlugins, hung: Attachment, rank: int, builder: SpecBuilder, diagnostics: Diagnostics
) -> None:
    from simkit.runtime.engine.entity_structure import FROM_PYTHON

    plugin = hung.plugin
    plugin.hand_over(diagnostics, hung.scoped)
    plugin._order = (FROM_PYTHON, rank)
    _prepare_plugin(plugin, hung.scene, plugin.params, builder, diagnostics)
    parts.plugins.append((plugin, hung.parent))


def _make_sensor(scene: SceneSensor, diagnostics: Diagnostics) -> Sensor | None:
    kinds = sensor_kinds()
    if scene.kind not in kinds:
        if report_unsimulated(scene, diagnostics):
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
    parts: SensorsAndPlugins,
    one: _PluginSite,
    place: _DocumentPosition,
    builder: SpecBuilder,
    diagnostics: Diagnostics,
    plugin_paths: Sequence[Path],
) -> None:
    from simkit.runtime.engine.entity_structure import FROM_FILE

    plugin, scene = one.plugin, one.scene
    cls = find_plugin(plugin, plugin_paths, diagnostics, one.kind)
    if cls is None:
        return
    if cls.drives and isinstance(scene, SceneModel) and scene.static:
        message = f"plugin {plugin.name!r} drives joints of {scene.scoped!r}, which is static; it is left out"
        diagnostics.warning("SK-PLUGIN-010", message, plugin.where, "nothing moves in a static model")
        return
    instance = _make_plugin(cls, plugin)
    instance.source = plugin
    instance._order = (FROM_FILE, place)
    instance.plugin_paths = tuple(plugin_paths)
    faults = diagnostics.error_count
    _prepare_plugin(instance, scene, plugin.params, builder, diagnostics)
    if diagnostics.error_count == faults:  # a faulty one would only say more of the same when it is loaded
        parts.plugins.append((instance, one.parent))


def _make_plugin(cls: type[Plugin], plugin: ScenePlugin) -> Plugin:
    """An instance of a plugin's class."""
    from simkit.runtime.engine.plugin_faults import call_plugin

    try:
        made: Plugin = call_plugin(plugin, "__init__", cls)
    except Exception as error:  # noqa: BLE001 - a plugin may raise anything; it is met when it would be loaded
        made = cls.__new__(cls)
        made._failed = "__init__", error
    return made


def _prepare_plugin(
    instance: Plugin, scene: SceneEntity, params: Params, builder: SpecBuilder, diagnostics: Diagnostics
) -> None:
    """Lets a plugin prepare the spec, and notes which servos and motors it adds."""
    from simkit.runtime.engine.plugin_faults import call_plugin

    if instance._failed is not None or not instance.has_hook("prepare"):
        return
    before = {id(ref) for record in builder.records.values() for ref in record.actuators}
    try:
        call_plugin(instance, "prepare", instance.prepare, scene, params, builder)
    except SimkitError:
        raise
    except Exception as error:
        if diagnostics.has_errors:
            raise  # what was left out for its own fault may be missed here
        instance._failed = "prepare", error  # met when it would be loaded, there is no simulation yet
    after = [ref for record in builder.records.values() for ref in record.actuators]
    instance._actuators = tuple(ref for ref in after if id(ref) not in before)


def report_unread(parts: Iterable[SensorsAndPlugins]) -> None:
    """Warns about each parameter that its plugin or sensor did not read; a plugin that was not loaded read nothing."""
    for part in parts:
        for sensor in part.sensors:
            sensor.scene.params.report_unread("SK-PARAM-003", f"sensor {sensor.scoped!r}")
        for plugin, _ in part.plugins:
            if hasattr(plugin, "sim"):
                plugin.report_unread()


def plugins_of_every_world(world: SceneWorld) -> tuple[tuple[Plugin, ...], tuple[Plugin, ...]]:
    """Plugins that a world has by itself: those that run before the file's own, and those that run after them."""
    from simkit.plugins.actors import ActorMover
    from simkit.plugins.world.world_services import WorldServices

    actors = (ActorMover(),) if world.actors else ()
    return (ClockPublisher(), StaticTransforms(), *actors), (WorldStats(), WorldServices(), ClassicServices())


def add_actor_models(
    world: SceneWorld, find_file: Callable[[str, Path | None], Path | None], diagnostics: Diagnostics
) -> SceneWorld:
    """The world with a model for every actor in it; what is wrong with an actor is reported."""
    if not world.actors:
        return world
    from simkit.plugins.actors.actor_model import with_actors

    return with_actors(world, find_file, diagnostics)
