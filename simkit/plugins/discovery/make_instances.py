"""Make the sensors and plugins that a scene asks for; report those of unknown kinds, and add those of every world.

Of a world that has errors, find what else is wrong with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import Diagnostics, did_you_mean, follows_from
from simkit.errors import LoadError, SimkitError
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


class InstanceMaker:
    """Makes the instances of one world.

    Args:
        builder: what sensors and plugins add to.
        diagnostics: gets the problems.
        plugin_paths: folders whose Python the user allows.
    """

    def __init__(self, builder: SpecBuilder, diagnostics: Diagnostics, plugin_paths: Sequence[Path]) -> None:
        self._builder, self._diagnostics, self._plugin_paths = builder, diagnostics, plugin_paths

    def all_parts(self, world: SceneWorld, plugins: Iterable[object] = ()) -> dict[str, SensorsAndPlugins]:
        """The sensors and plugins of every model, of the world (under no name), and those made in Python."""
        parts = {model.name: self.model_parts(model) for model in world.models}
        parts[""] = self.world_parts(world)
        for hung in attach_plugins(plugins, world, self._diagnostics):
            self._add_python_plugin(parts[hung.top], hung, 1)
        return parts

    def model_parts(self, model: SceneModel) -> SensorsAndPlugins:
        """Sensors and plugins of a model, in document order."""
        from simkit.runtime import SensorsAndPlugins

        parts, diagnostics = SensorsAndPlugins(), self._diagnostics
        found: list[_PluginSite] = []
        places = _model_positions(model)
        for named in model.all_sensors():
            faults = diagnostics.error_count
            scene = add_preset_defaults(named, diagnostics)
            sensor = self._make_sensor(scene)
            if sensor is None:
                continue
            if diagnostics.error_count == faults:
                sensor.build(self._builder)
            if diagnostics.error_count == faults:
                parts.sensors.append(sensor)
            owner = scene.parent.rpartition("::")[0]
            found += [
                _PluginSite(p, "sensor", scene, owner, handle_getter("sensor", scene.scoped)) for p in scene.plugins
            ]
        for nested in model.all_models():
            owners: list[SceneLink | SceneJoint] = [*nested.links, *nested.joints]
            below = [plugin for owner in owners for plugin in owner.plugins]
            parent = handle_getter("model", nested.scoped)
            found += [_PluginSite(p, "model", nested, nested.scoped, parent) for p in (*below, *nested.plugins)]
            for visual in (v for link in nested.links for v in link.visuals if v.plugins):
                parent = handle_getter("visual", visual.scoped)
                found += [_PluginSite(p, "visual", visual, nested.scoped, parent) for p in visual.plugins]
        for one in sorted(found, key=lambda one: _document_order(one, places)):
            self._add_plugin(parts, one, _document_order(one, places))
        return parts

    def world_parts(self, world: SceneWorld) -> SensorsAndPlugins:
        """The file's own plugins of a world, and those of every world."""
        from simkit.runtime import SensorsAndPlugins

        parts = SensorsAndPlugins()
        report_sensors_without_model(world, self._diagnostics)
        for plugin in world.plugins:
            one = _PluginSite(plugin, "world", world, "", lambda sim: sim)
            self._add_plugin(parts, one, ((False, plugin.where.serial),))
        first, last = plugins_of_every_world(world)
        for rank, instance in (*((0, one) for one in first), *((2, one) for one in last)):
            hung = Attachment(instance, "", "", world, lambda sim: sim)
            self._add_python_plugin(parts, hung, rank)
        return parts

    def _add_python_plugin(self, parts: SensorsAndPlugins, hung: Attachment, rank: int) -> None:
        from simkit.runtime.engine.entity_structure import FROM_PYTHON

        plugin = hung.plugin
        plugin.hand_over(self._diagnostics, hung.scoped)
        plugin._order = (FROM_PYTHON, rank)
        self._prepare_plugin(plugin, hung.scene)
        parts.plugins.append((plugin, hung.parent))

    def _make_sensor(self, scene: SceneSensor) -> Sensor | None:
        kinds, diagnostics = sensor_kinds(), self._diagnostics
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

    def _add_plugin(self, parts: SensorsAndPlugins, one: _PluginSite, place: _DocumentPosition) -> None:
        from simkit.runtime.engine.entity_structure import FROM_FILE

        plugin, scene, diagnostics = one.plugin, one.scene, self._diagnostics
        cls = find_plugin(plugin, self._plugin_paths, diagnostics, one.kind)
        if cls is None:
            return
        if cls.drives and isinstance(scene, SceneModel) and scene.static:
            message = f"plugin {plugin.name!r} drives joints of {scene.scoped!r}, which is static; it is left out"
            diagnostics.warning("SK-PLUGIN-010", message, plugin.where, "nothing moves in a static model")
            return
        instance = _make_plugin(cls, plugin)
        instance.source = plugin
        instance._order = (FROM_FILE, place)
        instance.plugin_paths = tuple(self._plugin_paths)
        faults = diagnostics.error_count
        self._prepare_plugin(instance, scene)
        if diagnostics.error_count == faults:  # a faulty one would only say more of the same when it is loaded
            parts.plugins.append((instance, one.parent))

    def _prepare_plugin(self, instance: Plugin, scene: SceneEntity) -> None:
        """Lets a plugin prepare the spec, and notes which servos and motors it adds."""
        from simkit.runtime.engine.plugin_faults import call_plugin

        if instance._failed is not None or not instance.has_hook("prepare"):
            return
        builder = self._builder
        before = {id(ref) for record in builder.records.values() for ref in record.actuators}
        try:
            call_plugin(instance, "prepare", instance.prepare, scene, instance.params, builder)
        except SimkitError:
            raise
        except Exception as error:
            if self._diagnostics.has_errors:
                raise  # what was left out for its own fault may be missed here
            instance._failed = "prepare", error  # met when it would be loaded, there is no simulation yet
        after = [ref for record in builder.records.values() for ref in record.actuators]
        instance._actuators = tuple(ref for ref in after if id(ref) not in before)


def _make_plugin(cls: type[Plugin], plugin: ScenePlugin) -> Plugin:
    """An instance of a plugin's class."""
    from simkit.runtime.engine.plugin_faults import call_plugin

    try:
        made: Plugin = call_plugin(plugin, "__init__", cls)
    except Exception as error:  # noqa: BLE001 - a plugin may raise anything; it is met when it would be loaded
        made = cls.__new__(cls)
        made._failed = "__init__", error
    return made


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


FileFinder = Callable[[str, Path | None], Path | None]

# what the engine says of a world that lacks its faulty parts
_ENGINE_CODES = frozenset(("SK-PHYS-023", "SK-PHYS-025", "SK-PHYS-028"))

_MAX_MODELS_SEARCHED = 5000
"""Models of a faulty world that are built to find more faults: the engine takes minutes for 20 000."""


def make_all_parts(
    world: SceneWorld,
    builder: SpecBuilder,
    diagnostics: Diagnostics,
    plugin_paths: Sequence[Path],
    plugins: Sequence[object],
) -> dict[str, SensorsAndPlugins]:
    """The sensors and plugins of every model, of the world (under no name), and those made in Python."""
    try:
        parts = InstanceMaker(builder, diagnostics, plugin_paths).all_parts(world, plugins)
    except Exception:
        # What was left out for its own fault (a joint without a direction) may be asked for here.
        diagnostics.raise_if_errors()
        raise
    if diagnostics.has_errors:
        _load_sound_parts(world, builder, parts, diagnostics)
    return parts


def find_more_problems(
    world: SceneWorld, diagnostics: Diagnostics, plugin_paths: Sequence[Path], find_file: FileFinder
) -> None:
    """What else is wrong with a file that has errors: it is built without its faulty parts, as far as that goes.

    So everything comes in one pass: meshes, inertias, and what plugins find in `prepare` and `load`. What only follows
    from an error that is said already (a plugin's joint that was left out because of its own fault) is dropped.
    """
    from simkit.compiler import SpecBuilder

    if len(world.models) > _MAX_MODELS_SEARCHED:
        return
    before = tuple(diagnostics)
    try:
        builder = SpecBuilder(world, diagnostics)
        builder.find_file = find_file
        parts = InstanceMaker(builder, diagnostics, plugin_paths).all_parts(world)
        _load_sound_parts(world, builder, parts, diagnostics)
    except Exception:  # noqa: BLE001 - on a file with errors anything may be missing; what was found by then counts
        pass
    diagnostics.drop(d for d in tuple(diagnostics)[len(before) :] if d.code in _ENGINE_CODES or follows_from(d, before))


def _load_sound_parts(
    world: SceneWorld, builder: SpecBuilder, parts: dict[str, SensorsAndPlugins], diagnostics: Diagnostics
) -> None:
    """What the sound parts of a faulty world say when they are compiled and loaded; nobody steps it."""
    from simkit.runtime import Simulation, WorldStructure

    before = tuple(diagnostics)
    with suppress(SimkitError, ValueError, KeyError, AttributeError, TypeError):
        compiled = builder.compile()
        structure = WorldStructure(builder, compiled, {m.name: m for m in world.models}, frozenset(), parts)
        with suppress(LoadError), Simulation(world, structure, diagnostics, 0, _unused_callback, _unused_callback):
            pass  # what is wrong with a plugin is said once all of them have been loaded
        report_unread(parts.values())
    diagnostics.drop(d for d in tuple(diagnostics)[len(before) :] if d.code in _ENGINE_CODES)


def _unused_callback(*_: object, **__: object) -> Any:
    """Stands for what a simulation that nobody steps never asks for."""
