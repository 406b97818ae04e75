"""Creation of the sensors and plugins of a scene, and of the plugins that every world has.

Unknown kinds are reported. If a file has errors, `find_more_problems` searches for further problems.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit import progress
from simkit.diagnostics import Diagnostics, did_you_mean, follows_from
from simkit.errors import LoadError, RenderError, SimkitError
from simkit.packs import left_out_names, missing_pack_text
from simkit.plugins.adapters import FileFinder, entity_plugins
from simkit.plugins.classic.server_services import ClassicServices, has_classic_plugins
from simkit.plugins.discovery.find_plugin_class import complete_sensor, find_plugin
from simkit.plugins.discovery.left_out import LeftOutParts
from simkit.plugins.discovery.python_plugins import Attachment, ParentGetter, SceneEntity, attach_plugins, handle_getter
from simkit.plugins.discovery.user_plugins import find_user_plugin
from simkit.plugins.drives.robot_transforms import StaticTransforms
from simkit.plugins.plugin_folders import split_python_name
from simkit.plugins.world.clock_and_statistics import ClockPublisher, WorldStats
from simkit.plugins.world.simulation_interfaces import SimulationInterfaces
from simkit.scene import Scene, SceneJoint, SceneLink, SceneModel, ScenePlugin, SceneSensor, SceneVisual, SceneWorld
from simkit.sensors import sensor_kinds
from simkit.sensors.presets.preset_defaults import add_preset_defaults
from simkit.sensors.unsimulated_kinds import report_sensors_without_model, report_unsimulated

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.plugins.base import ParentKind, Plugin
    from simkit.runtime import SensorsAndPlugins
    from simkit.runtime.engine.entity_structure import PluginEntry
    from simkit.sensors.base import Sensor


@dataclass(frozen=True)
class _PluginSite:
    """Plugin of a file and its parent: kind, scene object, scoped name of the model, and function for the handle."""

    plugin: ScenePlugin
    kind: ParentKind
    scene: SceneEntity
    model: str
    parent: ParentGetter


_DocumentPosition = tuple[tuple[bool, int], ...]
"""Position in a document, as a sequence of positions: in the world, in the model, in the nested model."""


def _model_positions(model: SceneModel) -> dict[str, tuple[_DocumentPosition, str | None]]:
    """Return the document position and the file of a model and of its nested models, by scoped name."""
    positions: dict[str, tuple[_DocumentPosition, str | None]] = {}

    def enter(model: SceneModel, outer: _DocumentPosition, file: str | None) -> None:
        # an <include> may contain plugins: they are in the outer file, and follow the plugins of the model's own file
        position = (*outer, (bool(outer) and model.where.file == file, model.where.serial))
        positions[model.scoped] = position, model.where.file
        for nested in model.models:
            enter(nested, position, model.where.file)

    enter(model, (), None)
    return positions


def _document_order(
    site: _PluginSite, positions: Mapping[str, tuple[_DocumentPosition, str | None]]
) -> _DocumentPosition:
    where = site.plugin.where
    position, file = positions.get(site.model) or next(iter(positions.values()))
    return (*position, (where.file == file, where.serial))


class InstanceMaker:
    """Factory of the sensors and plugins of one world.

    Args:
        builder: builder of the MuJoCo spec, to which sensors and plugins add elements.
        diagnostics: collector of the problems.
        plugin_paths: folders whose modules the user allows.
        left_out: sensors and plugins that are not made, because they had errors; None for none.
    """

    def __init__(
        self,
        builder: SpecBuilder,
        diagnostics: Diagnostics,
        plugin_paths: Sequence[Path],
        left_out: LeftOutParts | None = None,
    ) -> None:
        self._builder, self._diagnostics, self._plugin_paths = builder, diagnostics, plugin_paths
        self._left_out = left_out or LeftOutParts()

    def all_parts(self, world: SceneWorld, plugins: Iterable[object] = ()) -> dict[str, SensorsAndPlugins]:
        """Return the sensors and plugins by name of the model; those of the world have the name "".

        Args:
            world: world with the models.
            plugins: further plugins, created in Python.
        """
        parts: dict[str, SensorsAndPlugins] = {}
        with progress.task("creating sensors and plugins", len(world.models)) as task:
            for model in world.models:
                parts[model.name] = self.model_parts(model)
                task.advance(model.name)
        parts[""] = self.world_parts(world)
        for attachment in attach_plugins(plugins, world, self._diagnostics):
            self._add_python_plugin(parts[attachment.top], attachment, 1)
        return parts

    def model_parts(self, model: SceneModel) -> SensorsAndPlugins:
        """Return the sensors and plugins of a model, in document order."""
        from simkit.runtime import SensorsAndPlugins

        parts, diagnostics = SensorsAndPlugins(), self._diagnostics
        sites: list[_PluginSite] = []
        positions = _model_positions(model)
        for named in model.all_sensors():
            if named in self._left_out:
                continue
            faults = diagnostics.error_count
            with diagnostics.blame(named):
                scene = complete_sensor(add_preset_defaults(named, diagnostics))
                sensor = self._make_sensor(scene)
                if sensor is None:
                    continue
                if diagnostics.error_count == faults:
                    sensor.build_with_artefacts(self._builder)
            if diagnostics.error_count == faults:
                parts.sensors.append(sensor)
            owner = scene.parent.rpartition("::")[0]
            sites += [
                _PluginSite(p, "sensor", scene, owner, handle_getter("sensor", scene.scoped)) for p in scene.plugins
            ]
        for nested in model.all_models():
            owners: list[SceneLink | SceneJoint] = [*nested.links, *nested.joints]
            below = [plugin for owner in owners for plugin in owner.plugins]
            parent = handle_getter("model", nested.scoped)
            sites += [_PluginSite(p, "model", nested, nested.scoped, parent) for p in (*below, *nested.plugins)]
            for visual in (v for link in nested.links for v in link.visuals if v.plugins):
                parent = handle_getter("visual", visual.scoped)
                sites += [_PluginSite(p, "visual", visual, nested.scoped, parent) for p in visual.plugins]
        for site in sorted(sites, key=lambda site: _document_order(site, positions)):
            self._add_plugin(parts, site, _document_order(site, positions))
        return parts

    def world_parts(self, world: SceneWorld) -> SensorsAndPlugins:
        """Return the plugins of the world: those in the file, and those that every world has."""
        from simkit.runtime import SensorsAndPlugins

        parts = SensorsAndPlugins()
        report_sensors_without_model(world, self._diagnostics)
        for plugin in world.plugins:
            site = _PluginSite(plugin, "world", world, "", lambda sim: sim)
            self._add_plugin(parts, site, ((False, plugin.where.serial),))
        first, last = plugins_of_every_world(world)
        for rank, instance in (*((0, plugin) for plugin in first), *((2, plugin) for plugin in last)):
            attachment = Attachment(instance, "", "", world, lambda sim: sim)
            self._add_python_plugin(parts, attachment, rank)
        return parts

    def _add_python_plugin(self, parts: SensorsAndPlugins, attachment: Attachment, rank: int) -> None:
        from simkit.runtime.engine.entity_structure import FROM_PYTHON, PluginEntry

        plugin = attachment.plugin
        plugin.hand_over(self._diagnostics, attachment.scoped)
        entry = PluginEntry(plugin, attachment.parent, (FROM_PYTHON, rank))
        parts.plugins.append(self._prepared(entry, attachment.scene))

    def _make_sensor(self, scene: SceneSensor) -> Sensor | None:
        kinds, diagnostics = sensor_kinds(), self._diagnostics
        if scene.kind not in kinds:
            if report_unsimulated(scene, diagnostics):
                return None
            if fault := kinds.fault(scene.kind):
                message = f"sensor {scene.scoped!r}: kind {scene.kind!r} is left out, because its package is broken"
                diagnostics.warning("SK-SENSOR-001", f"{message}: {fault}", scene.where)
                return None
            message = f"sensor {scene.scoped!r}: kind {scene.kind!r} is not simulated"
            near = did_you_mean(scene.kind, kinds)
            hint = f"{near or 'kinds: ' + ', '.join(kinds) + ';'} or install the pack that has it"
            pack = left_out_names("kinds").get(scene.kind)
            if pack is not None:
                needs, hint = missing_pack_text(pack)
                message = f"sensor {scene.scoped!r}: kind {scene.kind!r} {needs}"
            diagnostics.warning("SK-SENSOR-001", message, scene.where, hint)
            return None
        cls, parent_kind = kinds[scene.kind], "joint" if scene.on_joint else "link"
        if parent_kind not in cls.belongs_to:
            allowed_kinds = " or a ".join(cls.belongs_to)
            message = f"sensor {scene.scoped!r}: {scene.kind} belongs to a {allowed_kinds}, not to a {parent_kind}"
            hint = f"move it from the {parent_kind} {scene.parent!r} into a <{cls.belongs_to[0]}>"
            diagnostics.warning("SK-SENSOR-024", f"{message}; it is ignored, as in Gazebo", scene.where, hint)
            return None
        return cls(scene, diagnostics)

    def _add_plugin(self, parts: SensorsAndPlugins, site: _PluginSite, position: _DocumentPosition) -> None:
        from simkit.runtime.engine.entity_structure import FROM_FILE, PluginEntry

        plugin, scene, diagnostics = site.plugin, site.scene, self._diagnostics
        if plugin in self._left_out:
            return
        cls = find_plugin(plugin, self._plugin_paths, diagnostics, site.kind)
        if cls is None:
            return
        if cls.drives and isinstance(scene, SceneModel) and scene.static:
            message = f"plugin {plugin.name!r} is ignored: it drives joints of {scene.scoped!r}, which is static"
            diagnostics.warning("SK-PLUGIN-010", message, plugin.where, "remove <static>true</static> or the plugin")
            return
        self._left_out.describe(plugin, cls)
        faults = diagnostics.error_count
        with diagnostics.blame(plugin):
            instance, failure = _make_plugin(cls, plugin)
            instance.take_source(plugin, self._plugin_paths)
            entry = self._prepared(PluginEntry(instance, site.parent, (FROM_FILE, position), failure=failure), scene)
        if diagnostics.error_count == faults:  # `load` would report the same errors again
            parts.plugins.append(entry)

    def _prepared(self, entry: PluginEntry, scene: SceneEntity) -> PluginEntry:
        """Call a plugin's `prepare`; return its entry with the servos and motors that `prepare` added."""
        from simkit.runtime.engine.plugin_faults import call_plugin

        instance, failure = entry.plugin, entry.failure
        if failure is not None or not instance.has_hook("prepare"):
            return entry
        builder = self._builder
        before = {ref for record in builder.records.values() for ref in record.actuators}
        shared = len(builder.shared_servos)
        try:
            call_plugin(instance, "prepare", instance.prepare, scene, instance.params, builder)
        except SimkitError:
            raise
        except Exception as error:
            if self._diagnostics.has_errors:
                raise  # the cause may be an entity that was dropped because of an earlier error
            failure = "prepare", error  # handled at load time, because no simulation exists yet
        after = [ref for record in builder.records.values() for ref in record.actuators]
        added = [ref for ref in after if ref not in before]
        return replace(entry, actuators=(*added, *builder.shared_servos[shared:]), failure=failure)


def _make_plugin(cls: type[Plugin], plugin: ScenePlugin) -> tuple[Plugin, tuple[str, Exception] | None]:
    """Return an instance of a plugin's class, and the failure of its `__init__`."""
    from simkit.runtime.engine.plugin_faults import call_plugin

    try:
        return call_plugin(plugin, "__init__", cls), None
    except Exception as error:  # noqa: BLE001 - a plugin may raise anything; handled at load time
        return cls.__new__(cls), ("__init__", error)


def report_unread(parts: Iterable[SensorsAndPlugins]) -> None:
    """Warn about each parameter that the sensor or the loaded plugin has not read."""
    for part in parts:
        for sensor in part.sensors:
            sensor.scene.params.report_unread("SK-PARAM-003", f"sensor {sensor.scoped!r}")
        for entry in part.plugins:
            if hasattr(entry.plugin, "sim"):
                entry.plugin.report_unread()


def report_python_plugins(scene: Scene, diagnostics: Diagnostics, plugin_paths: Sequence[Path]) -> None:
    """Report each Python plugin of a scene that is not found or cannot be imported; no plugin is created."""
    for plugin in _plugins_of(scene):
        if split_python_name(plugin.filename) is not None:
            find_user_plugin(plugin, plugin_paths, diagnostics)


def _plugins_of(scene: Scene) -> Iterator[ScenePlugin]:
    for world in scene.worlds:
        yield from world.plugins
    for top in (*(model for world in scene.worlds for model in world.models), *filter(None, (scene.model,))):
        yield from (plugin for sensor in top.all_sensors() for plugin in sensor.plugins)
        for model in top.all_models():
            owners: tuple[Iterable[SceneLink | SceneJoint | SceneVisual], ...] = (model.links, model.joints)
            owners = (*owners, *(link.visuals for link in model.links))
            yield from (plugin for group in owners for owner in group for plugin in owner.plugins)
            yield from model.plugins


def report_unavailable_sensors(parts: Iterable[SensorsAndPlugins], diagnostics: Diagnostics) -> None:
    """Warn about each sensor that this machine cannot simulate: a camera without a renderer."""
    for sensor in (sensor for part in parts for sensor in part.sensors):
        try:
            sensor.check_available()
        except RenderError as error:
            diagnostics.warning(error.code, error.message, error.where)


def plugins_of_every_world(world: SceneWorld) -> tuple[tuple[Plugin, ...], tuple[Plugin, ...]]:
    """Return the plugins that every world has: first those that run before the file's plugins, then those after."""
    from simkit.plugins.world.world_services import WorldServices

    entities = (cls() for cls in entity_plugins(world))
    services: list[Plugin] = [SimulationInterfaces(), ClassicServices()]  # the first one owns the names of both
    is_classic = has_classic_plugins(world) if world.entity_services is None else world.entity_services == "classic"
    if is_classic:
        services.reverse()
    return (ClockPublisher(), StaticTransforms(), *entities), (WorldStats(), WorldServices(), *services)


# engine diagnostics caused by missing parts, which are misleading for a file with errors
_ENGINE_CODES = frozenset(("SK-JOINT-010", "SK-JOINT-016", "SK-PHYS-023", "SK-PHYS-025", "SK-PHYS-028"))

_MAX_MODELS_SEARCHED = 5000
"""Limit of models for a search for further errors: the engine takes minutes for 20 000."""


def make_all_parts(
    world: SceneWorld,
    builder: SpecBuilder,
    diagnostics: Diagnostics,
    plugin_paths: Sequence[Path],
    plugins: Sequence[object],
    left_out: LeftOutParts | None = None,
) -> dict[str, SensorsAndPlugins]:
    """Return the sensors and plugins by name of the model; those of the world have the name "".

    Args:
        world: world with the models.
        builder: builder of the MuJoCo spec.
        diagnostics: collector of the problems.
        plugin_paths: folders whose modules the user allows.
        plugins: further plugins, created in Python.
        left_out: sensors and plugins that are not made; None for none.
    """
    try:
        parts = InstanceMaker(builder, diagnostics, plugin_paths, left_out).all_parts(world, plugins)
    except Exception:
        # the cause may be an entity dropped because of an earlier error, such as a joint without an axis
        diagnostics.raise_if_errors()
        raise
    is_retried = left_out is not None and not left_out.is_strict and diagnostics.has_only_blamed_errors
    if diagnostics.has_errors and not is_retried:
        _load_sound_parts(world, builder, parts, diagnostics)
    return parts


def find_more_problems(
    world: SceneWorld,
    diagnostics: Diagnostics,
    plugin_paths: Sequence[Path],
    find_file: FileFinder,
    left_out: LeftOutParts | None = None,
) -> None:
    """Find further problems of a file with errors: build the world without the faulty entities.

    The user therefore sees all problems at once: also those of meshes and inertias, and those found in `prepare` and
    `load`. A consequence of a reported error is not reported, such as a missing joint that was skipped because of its
    own error.
    """
    from simkit.compiler import SpecBuilder

    if len(world.models) > _MAX_MODELS_SEARCHED:
        return
    before = tuple(diagnostics)
    try:
        builder = SpecBuilder(world, diagnostics, find_file=find_file)
        parts = InstanceMaker(builder, diagnostics, plugin_paths, left_out).all_parts(world)
        _load_sound_parts(world, builder, parts, diagnostics)
    except Exception:  # noqa: BLE001 - anything may be missing in a file with errors; keep what was found so far
        pass
    diagnostics.drop(d for d in tuple(diagnostics)[len(before) :] if d.code in _ENGINE_CODES or follows_from(d, before))


def _load_sound_parts(
    world: SceneWorld, builder: SpecBuilder, parts: dict[str, SensorsAndPlugins], diagnostics: Diagnostics
) -> None:
    """Compile and load the valid entities of a world with errors, to collect their diagnostics; no step runs."""
    from simkit.runtime import Simulation, WorldStructure
    from simkit.runtime.world_source import WorldSource

    before = tuple(diagnostics)
    with suppress(SimkitError, ValueError, KeyError, AttributeError, TypeError):
        compiled = builder.compile()
        structure = WorldStructure(builder, compiled, {m.name: m for m in world.models}, frozenset(), parts)
        source = WorldSource(load_model=_unused_callback, make_parts=_unused_callback)
        with suppress(LoadError), Simulation(world, structure, diagnostics, 0, source):
            pass  # the constructor loads all plugins and reports their problems
        report_unread(parts.values())
    diagnostics.drop(d for d in tuple(diagnostics)[len(before) :] if d.code in _ENGINE_CODES)


def _unused_callback(*_: object, **__: object) -> Any:
    """Stand in for callbacks that are called only in a step; here no step runs."""
