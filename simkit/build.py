"""From a file to a running simulation: load, check, compile, bind. The only module that knows all rooms."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.engine import import_engine
from simkit.loaders import Resolver, load_scene
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import Scene, SceneJoint, SceneLink, SceneModel, ScenePlugin, SceneSensor, SceneWorld

if TYPE_CHECKING:
    from simkit.plugins.base import ParentKind, Plugin
    from simkit.runtime import Parts, Simulation

Source = str | os.PathLike[str]


def load(
    source: Source,
    *,
    seed: int = 0,
    resource_paths: Sequence[Source] = (),
    plugin_paths: Sequence[Source] = (),
    plugins: Sequence[Plugin] = (),
    base: str = "auto",
    xacro_args: Mapping[str, str] | None = None,
    strict: bool = False,
    overrides: Sequence[str] = (),
) -> Simulation:
    """Opens a world or a bare model and makes it ready to step.

    Args:
        source: a path, the bare name of a world or model that simkit brings, or XML text.
        seed: of every random stream.
        resource_paths: extra folders for `model://`, `package://` and relative URIs.
        plugin_paths: folders whose Python plugins a file may name.
        plugins: plugin instances made in Python; they hang on the world.
        base: for bare models: "fixed", "floating", or "auto" (floating unless joined to the world).
        xacro_args: arguments for xacro files.
        strict: warnings are errors.
        overrides: `PATH=VALUE` texts as for `--set`.

    Returns:
        The simulation at t = 0.

    Raises:
        LoadError: with every problem of the input.
        PluginError: a plugin raised while it was loaded.
    """
    import_engine()
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Simulation, Structure

    diagnostics = Diagnostics()
    resolver = Resolver([Path(p) for p in resource_paths])
    scene = _scene(source, resolver, diagnostics, xacro_args, base, overrides)
    world = scene.world
    allowed = [Path(p) for p in plugin_paths]
    if diagnostics.has_errors:
        _look_further(world, diagnostics, allowed)
    diagnostics.raise_if_errors()
    builder = SpecBuilder(world, diagnostics)
    parts: dict[str, Any] = {}
    for model in world.models:
        parts[model.name] = _parts_of_model(model, builder, diagnostics, allowed)
    parts[""] = _parts_of_world(world, builder, diagnostics, allowed, plugins)
    diagnostics.raise_if_errors(strict)
    compiled = builder.compile()
    diagnostics.raise_if_errors(strict)

    load_model = partial(_model_to_spawn, resolver=resolver)
    make_parts = partial(_parts_of_model, plugin_paths=allowed)
    structure = Structure(builder, compiled, {m.name: m for m in world.models}, frozenset(), parts)
    simulation = Simulation(world, structure, diagnostics, seed, load_model, make_parts)
    try:
        _report_unread(parts.values())
        diagnostics.raise_if_errors(strict)
    except BaseException:
        simulation.close()
        raise
    return simulation


def describe(
    source: Source, *, resource_paths: Sequence[Source] = (), xacro_args: Mapping[str, str] | None = None
) -> dict[str, Any]:
    """What a file means once resolved: the object that `simkit inspect --json` prints.

    Raises:
        LoadError: the file has errors.
    """
    from simkit.description import describe_scene

    diagnostics = Diagnostics()
    resolver = Resolver([Path(p) for p in resource_paths], missing_meshes=True)
    scene = _scene(source, resolver, diagnostics, xacro_args, "auto", ())
    diagnostics.raise_if_errors()
    return describe_scene(scene, diagnostics)


def check(
    source: Source, *, resource_paths: Sequence[Source] = (), plugin_paths: Sequence[Source] = ()
) -> Diagnostics:
    """Every problem of a file, also of compiling it and of loading its plugins; never raises for one."""
    from simkit.errors import LoadError, PluginError

    diagnostics = Diagnostics()
    try:
        with load(source, resource_paths=resource_paths, plugin_paths=plugin_paths) as simulation:
            diagnostics.extend(simulation.diagnostics)
    except LoadError as error:
        diagnostics.extend(error.diagnostics)
    except PluginError as error:
        diagnostics.error(error.code, str(error))
    return diagnostics


def render_view(simulation: Simulation, width: int, height: int, **view: Any) -> Any:
    """A picture of a simulation from anywhere; see `simkit.sensors.renderer.render_view`."""
    from simkit.sensors import renderer

    return renderer.render_view(simulation, width, height, **view)


def _scene(
    source: Source,
    resolver: Resolver,
    diagnostics: Diagnostics,
    xacro_args: Mapping[str, str] | None,
    base: str,
    overrides: Sequence[str],
) -> Scene:
    scene = load_scene(source, resolver=resolver, diagnostics=diagnostics, xacro_args=dict(xacro_args or {}), base=base)
    if overrides:
        from simkit.overrides import apply_overrides

        diagnostics.raise_if_errors()
        scene = apply_overrides(scene, overrides)
    return scene


def _look_further(world: SceneWorld, diagnostics: Diagnostics, plugin_paths: Sequence[Path]) -> None:
    """What the sensors and plugin names of a file with errors have to say, so that all of it comes in one pass."""
    from simkit.plugins import find_plugin

    for plugin in world.plugins:
        find_plugin(plugin, plugin_paths, diagnostics, "world")
    for model in world.models:
        for scene in model.all_sensors():
            _sensor(scene, diagnostics)
            for plugin in scene.plugins:
                find_plugin(plugin, plugin_paths, diagnostics, "sensor")
        for plugin in (plugin for nested in model.all_models() for plugin in nested.plugins):
            find_plugin(plugin, plugin_paths, diagnostics, "model")


def _model_to_spawn(
    source: Source, *, resolver: Resolver, name: str | None, pose: Pose | None, taken: set[str]
) -> tuple[SceneModel, Diagnostics]:
    diagnostics = Diagnostics()
    scene = load_scene(source, resolver=resolver, diagnostics=diagnostics, name=name, pose=pose)
    diagnostics.raise_if_errors()
    models = [scene.model] if scene.model else list(scene.world.models)
    if len(models) != 1 or models[0] is None:
        diagnostics.error("SK-LOAD-010", f"spawn takes one model, the source has {len(models)}")
    elif models[0].name in taken:
        diagnostics.error("SK-LOAD-011", f"there is a model {models[0].name!r} already", hint="give another name=")
    diagnostics.raise_if_errors()
    model = models[0]
    assert model is not None
    return model, diagnostics


def _parts_of_model(model: SceneModel, builder: Any, diagnostics: Diagnostics, plugin_paths: Sequence[Path]) -> Parts:
    """Sensors and plugins of a model, in document order: each sensor's own plugins first, then the models'."""
    from simkit.runtime import Parts

    parts = Parts()
    for scene in model.all_sensors():
        sensor = _sensor(scene, diagnostics)
        if sensor is None:
            continue
        sensor.build(builder)
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
    return parts


def _parts_of_world(
    world: SceneWorld, builder: Any, diagnostics: Diagnostics, plugin_paths: Sequence[Path], made: Sequence[Plugin]
) -> Parts:
    from simkit.plugins.clock import ClockPublisher
    from simkit.plugins.tf import StaticTransforms
    from simkit.runtime import Parts

    parts = Parts()
    for plugin in world.plugins:
        _add_plugin(parts, plugin, "world", world, builder, diagnostics, plugin_paths, lambda sim: sim)
    for instance in (ClockPublisher(), StaticTransforms(), *made):
        instance.source = None
        instance.prepare(world, Params("plugin"), builder)
        parts.plugins.append((instance, lambda sim: sim))
    return parts


def _sensor(scene: SceneSensor, diagnostics: Diagnostics) -> Any | None:
    from simkit.sensors import sensor_kinds

    kinds = sensor_kinds()
    if scene.kind not in kinds:
        hint = did_you_mean(scene.kind, kinds) or "kinds: " + ", ".join(kinds)
        message = f"sensor {scene.scoped!r}: kind {scene.kind!r} is not simulated"
        diagnostics.warning("SK-SENSOR-001", message, scene.where, hint)
        return None
    return kinds[scene.kind](scene, diagnostics)


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
    instance = cls()
    instance.source = plugin
    instance.prepare(scene, plugin.params, builder)
    parts.plugins.append((instance, parent))


def _sensor_parent(scoped: str) -> Callable[[Any], Any]:
    return lambda sim: sim.sensor(scoped)


def _model_parent(scoped: str) -> Callable[[Any], Any]:
    return lambda sim: sim.model(scoped)


def _report_unread(parts: Any) -> None:
    """Warns about each parameter that its plugin or sensor did not read."""
    for part in parts:
        for sensor in part.sensors:
            sensor.scene.params.report_unread("SK-PARAM-003", f"sensor {sensor.scoped!r}")
        for plugin, _ in part.plugins:
            if plugin.source is not None:
                plugin.params.report_unread("SK-PARAM-003", f"plugin {plugin.name!r}")
