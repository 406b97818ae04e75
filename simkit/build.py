"""Load a file and build a running simulation from it. Only this module imports every package."""

from __future__ import annotations

import os
from collections.abc import Callable, Container, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from simkit import progress
from simkit.argument_checks import check_folders
from simkit.diagnostics import Diagnostics, Where
from simkit.errors import LoadError, PluginError, RenderError
from simkit.garbage_collection import no_collection
from simkit.loaders import Resolver, load_scene
from simkit.loaders.load_arguments import check_load_arguments, check_source, check_source_arguments
from simkit.loaders.model_world import add_model_world
from simkit.loaders.resources.world_interfaces import read_interfaces
from simkit.loaders.spawned_models import SpawnEntry, add_spawned_models, client_models
from simkit.memory_error import memory_errors
from simkit.mujoco_import import import_mujoco
from simkit.plugins.adapters import with_entity_models
from simkit.plugins.discovery.find_plugin_class import complete_sensor
from simkit.plugins.discovery.left_out import LeftOutParts
from simkit.plugins.discovery.make_instances import (
    InstanceMaker,
    find_more_problems,
    make_all_parts,
    report_python_plugins,
    report_unavailable_sensors,
    report_unread,
)
from simkit.plugins.gz.sensors import with_sensors_colours
from simkit.plugins.joints.hold_joints import HoldJoints
from simkit.pose import Pose
from simkit.run_spec import (
    EMPTY_SPACE,
    JsonObject,
    LoadArguments,
    LoadOptions,
    NamedValues,
    PackagePaths,
    PluginErrorPolicy,
    RendererName,
    RunSpec,
    named_values,
)
from simkit.scene import Mesh, Scene, SceneModel, SceneSensor, SceneWorld
from simkit.scene.overrides import Overrides, apply_overrides, check_used, override_texts, xacro_overrides
from simkit.sensors import sensor_kinds
from simkit.sensors.cameras.rendering.render_thread import usable_cores
from simkit.sensors.presets.preset_defaults import add_preset_defaults
from simkit.sensors.realism import read_realism
from simkit.writers.inspect_description import describe_scene

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.compiler.mjcf_parser import MjcfParser
    from simkit.loaders.meshes.mesh_part import MeshPart
    from simkit.plugins.run_parameter_files import ParameterFileArgument, RunParameterFile
    from simkit.runtime import SensorsAndPlugins, Simulation, WorldStructure
    from simkit.runtime.world_source import WorldSource

Source = str | os.PathLike[str]


@memory_errors()
@no_collection()
def load(
    source: Source,
    *,
    seed: int = 0,
    resource_paths: Sequence[Source] = (),
    plugin_paths: Sequence[Source] = (),
    plugins: Sequence[object] = (),
    base: str = "auto",
    xacro_args: NamedValues | None = None,
    strict: bool = False,
    overrides: Overrides = (),
    sleep: bool = True,
    package_paths: PackagePaths | None = None,
    render_thread: bool | None = None,
    on_error: PluginErrorPolicy | None = None,
    spawn: Sequence[SpawnEntry] = (),
    model_world: str = EMPTY_SPACE,
    params_files: ParameterFileArgument | Sequence[ParameterFileArgument] = (),
    change_world: Callable[[SceneWorld], SceneWorld] | None = None,
    interfaces: Sequence[Source] = (),
    renderer: RendererName | None = None,
    remap: NamedValues | None = None,
    start_controllers: bool = True,
    hold_joints: bool = False,
    realism: Source | None = None,
) -> Simulation:
    """Load a world or a single model and return a simulation that is ready to step.

    Args:
        source: path, bare name of a world or model that is shipped with simkit, or XML text.
        seed: seed of every random stream.
        resource_paths: additional folders for `model://`, `package://` and relative URIs.
        plugin_paths: folders whose Python plugins a file may name.
        plugins: plugins made in Python. Each item is an instance, `MyPlugin(gain=2)`, or a pair of the scoped name of
            its parent and the instance, `("robot::arm", MyPlugin())`. Without a parent, a plugin is attached to the
            world, or to the only model, sensor or visual. A class or module with Gazebo's hooks is also accepted.
        base: base of a single model: "fixed", "floating", or "auto" (floating unless a joint connects it to the world).
        xacro_args: arguments for xacro files.
        strict: treat warnings as errors, and cameras without a renderer.
        overrides: `PATH=VALUE` texts as for `--set`, or values by path.
        sleep: leave bodies at rest out of the physics until something reaches them; see `docs/physics.md`.
        package_paths: folders of ROS packages by name, for `package://` and `$(find ...)`; or a list of workspaces.
        render_thread: draw camera images on a second thread, with the same bits. Default: with two cores or more.
        on_error: policy for a plugin that raises: "stop" ends the run with a PluginError, "disable" continues without
            the plugin. With None, the file (`<simkit:on_error>`) or the plugin's class decides; the default is "stop".
        spawn: models to add while the world is loaded: `"MODEL:x,y,yaw[:name[:namespace]]"` texts or `SpawnedModel`
            objects. MODEL is a file or a bare name. Each stands on what is below it, unless a height is given:
            `"MODEL:x,y,z,yaw"`. Unlike models of `Simulation.spawn`, these models are still present after a reset.
        model_world: world of a bare model, in which the model stands on what is below it: "ground" for level ground and
            a sun, a file, or the bare name of a world. "none" is empty space.
        params_files: parameter files for the control plugins of all models, in the layout of ROS 1 or ROS 2.
            `"MODEL=FILE"` limits a file to one model. Models that are spawned later read these files too. Their values
            have priority over the files that the plugins name.
        change_world: function that receives the resolved world, with all options applied, and returns the one to build.
        interfaces: folders with definitions of messages, services and actions; see `docs/own_messages.md`.
        renderer: renderer of images: "gl", "software", or "auto", which is OpenGL if it can be opened, else software.
            With None, the file (`<simkit:renderer>`) decides; the default is "auto".
        remap: other names for topics, services and actions of the world: `OLD:=NEW` texts, or new names by old ones.
            They count for plugins and sensors; scripts and nodes use the new names.
        start_controllers: start the controllers of robots with ros2_control when they are loaded. With False, they
            wait for spawners, as in ROS.
        hold_joints: hold each joint that no plugin drives at its initial position, with the effort limit of the joint.
        realism: errors of all sensors: "ideal" for none, "datasheet" for those of the real devices, the name of a set,
            or a YAML file; see `docs/realism.md`. With None, the files decide.

    Returns:
        Simulation at t = 0.

    Raises:
        LoadError: the input has errors; the exception lists all of them.
        PluginError: a plugin raised while it was loaded.
        RenderError: the renderer "gl" is requested, but OpenGL cannot be opened.
    """
    check_source_arguments(
        source, resource_paths=resource_paths, xacro_args=xacro_args, package_paths=package_paths, base=base
    )
    overrides = override_texts(overrides)
    seed = check_load_arguments(
        seed=seed, plugin_paths=plugin_paths, plugins=plugins, strict=strict, overrides=overrides, sleep=sleep,
        on_error=on_error, spawn=spawn, params_files=params_files, change_world=change_world, model_world=model_world,
        interfaces=interfaces, renderer=renderer, remap=remap, start_controllers=start_controllers,
        hold_joints=hold_joints, realism=realism,
    )  # fmt: skip
    import_mujoco()
    options: LoadOptions = {
        "resource_paths": tuple(resource_paths), "plugin_paths": tuple(plugin_paths), "base": base,
        "xacro_args": named_values(xacro_args, "xacro_args"), "package_paths": package_paths or {},
        "params_files": params_files, "strict": strict, "sleep": sleep, "render_thread": render_thread,
        "on_error": on_error, "interfaces": tuple(interfaces), "renderer": renderer,
        "remap": named_values(remap, "--remap") or (), "start_controllers": start_controllers,
        "hold_joints": hold_joints, "realism": None if realism is None else os.fspath(realism),
    }  # fmt: skip
    run = RunSpec(
        os.fspath(source), seed=seed, overrides=tuple(overrides), spawn=tuple(spawn), plugins=tuple(plugins),
        model_world=model_world, options=options, folder=Path.cwd(), change_world=change_world,
    )  # fmt: skip
    diagnostics = Diagnostics()
    reader = _WorldReader(source, run, spawn, diagnostics)
    diagnostics.can_leave_out = reader.left_out.allows
    world = reader.resolve(overrides, diagnostics)
    parameter_files = reader.parameter_files(diagnostics)
    if diagnostics.has_errors:
        find_more_problems(world, diagnostics, reader.plugin_folders, reader.find_file, reader.left_out)
        reader.left_out.take(diagnostics)
    diagnostics.raise_if_errors()
    from simkit.runtime import Simulation
    from simkit.runtime.communication.name_remapping import NameRemapping

    remapping = NameRemapping(named_values(remap, "--remap"))
    while True:
        try:
            structure = _compiled_structure(world, parameter_files, reader, diagnostics)
            with progress.task("loading plugins"):
                simulation = Simulation(
                    world, structure, diagnostics, seed, reader.world_source(), on_error=on_error, run_spec=run,
                    render_thread=usable_cores() > 1 if render_thread is None else render_thread, remapping=remapping,
                )  # fmt: skip
            break
        except LoadError:
            if not reader.left_out.take(diagnostics):  # else the world is built again without what has errors
                diagnostics.raise_if_errors(strict)
                raise
    try:
        simulation.communication.report_remapping(diagnostics)
        _report_first_state(simulation, diagnostics)
        _report_unused(structure, diagnostics, strict=strict)
    except BaseException:
        simulation.close()
        raise
    return simulation


class _WorldReader:
    """Reader of the files of a run: of its world at the load, and of further models and overrides later.

    Args:
        source: path, bare name or text of the world.
        run: specification of the run.
        spawn: models to add to the world.
        diagnostics: collector of the problems.

    Attributes:
        run: specification of the run.
        plugin_folders: folders whose Python plugins a file may name.
        left_out: sensors and plugins of files that are left out, because they have errors.
    """

    def __init__(self, source: Source, run: RunSpec, spawn: Sequence[SpawnEntry], diagnostics: Diagnostics) -> None:
        options = run.options
        self._source, self.run = source, run
        self.left_out = LeftOutParts(strict=options["strict"])
        self.plugin_folders = [Path(folder) for folder in options["plugin_paths"]]
        self._resolver = Resolver(options["resource_paths"], package_paths=options["package_paths"])
        read_interfaces(options["interfaces"], source, self._resolver, diagnostics)
        self._xacro_overrides = xacro_overrides(run.overrides)
        arguments = named_values(options["xacro_args"], "xacro_args") | self._xacro_overrides
        self._scene = _scene(source, self._resolver, diagnostics, arguments, options["base"], spawn, run.model_world)
        choice = options["realism"]
        find = partial(self.find_file, folder=None)
        self._realism = None if choice is None else read_realism(choice, find, diagnostics)

    def find_file(self, uri: str, folder: Path | None) -> Path | None:
        """Return the file of a URI, relative to a folder; None for a missing one."""
        return self._resolver.search(uri, folder)[0]

    def resolve(self, overrides: Sequence[str], diagnostics: Diagnostics) -> SceneWorld:
        """Return the world of the file with overrides and all options of the run."""
        from simkit.compiler.standing_models import stand_models

        scene, change_world = _overridden(self._scene, overrides, diagnostics), self.run.change_world
        world = scene.world if self._realism is None else self._realism.world(scene.world, diagnostics)
        world = world if diagnostics.has_errors else stand_models(world, scene.standing, diagnostics)
        if not self.run.options["sleep"]:
            world = replace(world, physics=replace(world.physics, sleep=False))
        world = _with_renderer(world, self.run.options["renderer"])
        world = with_entity_models(world, self.find_file, diagnostics)
        return world if change_world is None or diagnostics.has_errors else change_world(world)

    def parameter_files(self, diagnostics: Diagnostics) -> tuple[RunParameterFile, ...]:
        """Return the parameter files of the run for its control plugins."""
        named = self.run.options["params_files"]
        if not named:
            return ()
        from simkit.plugins.run_parameter_files import read_run_parameter_files

        files = read_run_parameter_files(named, lambda uri: self.find_file(uri, None), diagnostics)
        self.left_out.add_user_files(str(item.file.path) for item in files)
        return files

    def world_source(self) -> WorldSource:
        """Return the functions that the simulation needs during the run."""
        from simkit.runtime.world_source import WorldSource

        list_models, check_source = client_models(self._resolver, self._source)
        return WorldSource(
            load_model=self._load_model, make_parts=self._make_parts,
            leave_out=self.left_out.take,
            write_sdf=_sdf_of, resolve_world=self.resolve, list_models=list_models, check_source=check_source,
            file_arguments=self._scene.arguments, xacro_overrides=self._xacro_overrides,
        )  # fmt: skip

    def _load_model(self, source: Source, diagnostics: Diagnostics, **options: Any) -> SceneModel:
        """Return a model to spawn, with the realism of the run."""
        model = _model_to_spawn(source, diagnostics, resolver=self._resolver, **options)
        return model if self._realism is None else self._realism.model(model, diagnostics)

    def _make_parts(self, model: SceneModel, builder: SpecBuilder, diagnostics: Diagnostics) -> SensorsAndPlugins:
        return InstanceMaker(builder, diagnostics, self.plugin_folders, self.left_out).model_parts(model)


def _with_renderer(world: SceneWorld, name: RendererName | None) -> SceneWorld:
    """Return a world with the renderer that the user requests; None keeps the renderer of the file.

    Raises:
        RenderError: SK-RENDER-001 OpenGL is requested and cannot be opened. A file that requests OpenGL raises this
            error only when an image is read, because a run without images does not need it.
    """
    if name is None:
        return world
    if name == "gl":
        from simkit.sensors.cameras.rendering.gl_context import ensure_open

        ensure_open()
    return replace(world, renderer=name)


def _compiled_structure(
    world: SceneWorld, parameter_files: tuple[RunParameterFile, ...], reader: _WorldReader, diagnostics: Diagnostics
) -> WorldStructure:
    """Return the compiled model of a world with its sensors and plugins.

    Raises:
        LoadError: the world, a sensor or a plugin has errors.
    """
    from simkit.compiler import SpecBuilder
    from simkit.runtime import WorldStructure

    run, files_read = reader.run, [item.file.path for item in parameter_files]
    builder = SpecBuilder(
        world, diagnostics, find_file=reader.find_file, parameter_files=parameter_files, files_read=files_read
    )
    plugins = (*run.plugins, HoldJoints()) if run.options["hold_joints"] else run.plugins
    parts = make_all_parts(world, builder, diagnostics, reader.plugin_folders, plugins, reader.left_out)
    has_controls = parameter_files or any(model.controls for top in world.models for model in top.all_models())
    if has_controls and not diagnostics.has_errors:  # `parts` does not contain plugins whose parameters have errors
        from simkit.plugins.run_parameter_files import report_unused_control

        made = [entry.plugin for part in parts.values() for entry in part.plugins]
        report_unused_control(parameter_files, made, world, diagnostics)
    diagnostics.raise_if_errors(run.options["strict"])
    compiled = builder.compile()
    diagnostics.raise_if_errors(run.options["strict"])
    movable = frozenset(m.name for m in world.models if m.moved_by is not None)
    return WorldStructure(builder, compiled, {m.name: m for m in world.models}, movable, parts)


def _report_first_state(sim: Simulation, diagnostics: Diagnostics) -> None:
    """Report joints that start outside 0 and bodies that overlap, after plugins have set their initial positions."""
    from simkit.compiler.model_compilation import report_overlaps
    from simkit.compiler.start_positions import report_starts

    compiled = sim.engine.structure.compiled
    model, names = compiled.model, compiled.names
    report_starts(model, sim.engine.mj_data, names, diagnostics)
    report_overlaps(model, sim.engine.mj_data, names, diagnostics, sim.world.where)


def _report_unused(structure: WorldStructure, diagnostics: Diagnostics, *, strict: bool) -> None:
    """Report what the loaded world does not use: parameters, overrides and, if strict, sensors without a renderer."""
    report_unread(structure.parts.values())
    check_used(diagnostics)
    if strict:
        report_unavailable_sensors(structure.parts.values(), diagnostics)
    diagnostics.raise_if_errors(strict)


def describe(
    source: Source,
    *,
    resource_paths: Sequence[Source] = (),
    xacro_args: NamedValues | None = None,
    package_paths: PackagePaths | None = None,
    plugin_paths: Sequence[Source] = (),
    base: str = "auto",
) -> JsonObject:
    """Return the resolved content of a file as plain data, as `simkit inspect --json` prints it.

    The diagnostics in the result include Python plugins that are not found in `plugin_paths` or cannot be imported.
    The arguments are those of `load`.

    Raises:
        LoadError: the file has errors.
    """
    check_folders(plugin_paths, "plugin_paths")
    with memory_errors():
        scene, diagnostics = read_scene(
            source,
            missing_meshes=True,
            resource_paths=resource_paths,
            xacro_args=xacro_args,
            package_paths=package_paths,
            base=base,
        )
        report_python_plugins(scene, diagnostics, [Path(p) for p in plugin_paths])
        return describe_scene(scene, diagnostics, describe_sensor)


def describe_sensor(scene_sensor: SceneSensor, diagnostics: Diagnostics) -> tuple[SceneSensor, JsonObject | None]:
    """Return a sensor with the defaults of its preset, and its options as plain data.

    The options are None if this kind of sensor is not simulated.
    """
    sensor = complete_sensor(add_preset_defaults(scene_sensor, diagnostics))
    kind = sensor_kinds().get(sensor.kind)
    return sensor, None if kind is None else kind(sensor, diagnostics).describe()


def check(source: Source, **arguments: Unpack[LoadArguments]) -> Diagnostics:
    """Return every problem of a file, also of compiling it and of loading its plugins; the file raises no exception.

    Args:
        source: see `load`.
        arguments: further arguments of `load`.
    """
    return check_and_visit(source, lambda *_: None, **arguments)


def check_and_visit(
    source: Source, visit: Callable[[Simulation, Diagnostics], None], **arguments: Unpack[LoadArguments]
) -> Diagnostics:
    """Return every problem of a file like `check`, and call a function with the loaded simulation and the problems.

    Args:
        source: see `load`.
        visit: function for the simulation, which is closed afterwards; not called for a file with errors.
        arguments: further arguments of `load`.
    """
    from simkit.compiler.lint import lint_world

    diagnostics = Diagnostics()
    try:
        with load(source, **arguments) as simulation:
            diagnostics.extend(simulation.diagnostics)
            diagnostics.extend(lint_world(simulation.world, simulation.engine.compiled))
            visit(simulation, diagnostics)
    except LoadError as error:
        diagnostics.extend(error.diagnostics)
    except PluginError as error:
        diagnostics.error(error.code, str(error))
    except RenderError as error:  # a plugin subscribes to images; this is a problem of the machine, not of the file
        diagnostics.warning(error.code, error.message, error.where)
    return diagnostics


def _scene(
    source: Source,
    resolver: Resolver,
    diagnostics: Diagnostics,
    xacro_args: NamedValues | None,
    base: str,
    spawn: Sequence[SpawnEntry] = (),
    model_world: str = EMPTY_SPACE,
) -> Scene:
    def read(source: Source, diagnostics: Diagnostics, base: str = "auto") -> Scene:
        return load_scene(
            source, resolver=resolver, diagnostics=diagnostics, xacro_args=xacro_args, base=base,
            mesh_reader=_read_mesh, mjcf_parser=_mjcf_parser,
        )  # fmt: skip

    with progress.task("reading the world"):
        scene_in_file = read(source, diagnostics, base)
        scene = replace(
            add_model_world(scene_in_file, model_world, read, diagnostics), arguments=scene_in_file.arguments
        )
        if spawn:
            read_model = partial(_spawned_model, resolver=resolver)
            scene = add_spawned_models(scene, spawn, resolver, diagnostics, read_model, xacro_args)
    return scene


def _overridden(scene: Scene, overrides: Sequence[str], diagnostics: Diagnostics) -> Scene:
    """Return the scene with all overrides applied."""
    if overrides:
        diagnostics.raise_if_errors()
    of_scene = [text for text in overrides if text.startswith("scene.")]
    scene = apply_overrides(scene, [text for text in overrides if text not in of_scene])
    return apply_overrides(with_sensors_colours(scene), of_scene)


def _spawned_model(source: Source, diagnostics: Diagnostics, **options: Any) -> SceneModel | None:
    """Return a model for `spawn`; for a model with errors, record them and return None."""
    with suppress(LoadError):
        return _model_to_spawn(source, diagnostics, **options)
    return None


def _read_mesh(mesh: Mesh, diagnostics: Diagnostics, where: Where) -> Sequence[MeshPart]:
    """Read the triangles of a mesh for the loaders' automatic inertia."""
    from simkit.loaders.meshes.mesh_reader import load_mesh

    return load_mesh(mesh, diagnostics, where)


def _mjcf_parser() -> MjcfParser:
    """Return MuJoCo's own parser for the MJCF loader."""
    import_mujoco()
    from simkit.compiler.mjcf_parser import MjcfParser

    return MjcfParser()


def read_scene(
    source: Source,
    *,
    resource_paths: Sequence[Source] = (),
    xacro_args: NamedValues | None = None,
    package_paths: PackagePaths | None = None,
    base: str = "auto",
    missing_meshes: bool = False,
) -> tuple[Scene, Diagnostics]:
    """Return the resolved scene of a file and the diagnostics of reading the file; nothing is built yet.

    Raises:
        LoadError: the file has errors.
    """
    check_source_arguments(
        source, resource_paths=resource_paths, xacro_args=xacro_args, package_paths=package_paths, base=base
    )
    diagnostics = Diagnostics()
    resolver = Resolver(resource_paths, missing_meshes=missing_meshes, package_paths=package_paths)
    scene = _overridden(_scene(source, resolver, diagnostics, xacro_args, base), (), diagnostics)
    diagnostics.raise_if_errors()
    return scene, diagnostics


def _sdf_of(world: SceneWorld) -> str:
    """Return a world as SDF text with the original names of all files."""
    from simkit.writers.sdf_world import sdf_text

    return sdf_text(Scene(worlds=(world,)), Diagnostics())


def _model_to_spawn(
    source: Source,
    diagnostics: Diagnostics,
    *,
    resolver: Resolver,
    name: str | None = None,
    pose: Pose | None = None,
    taken: Container[str] = (),
    xacro_args: NamedValues | None = None,
) -> SceneModel:
    check_source(source)
    scene = load_scene(
        source, resolver=resolver, diagnostics=diagnostics, name=name, pose=pose, as_model=True,
        mesh_reader=_read_mesh, mjcf_parser=_mjcf_parser, xacro_args=xacro_args,
    )  # fmt: skip
    diagnostics.raise_if_errors()
    models = [scene.model] if scene.model else list(scene.world.models)
    if len(models) != 1:
        diagnostics.error("SK-LOAD-010", f"spawn needs one model, but the source has {len(models)}")
    elif models[0].name in taken:
        diagnostics.error("SK-LOAD-011", f"a model {models[0].name!r} exists already", hint="pass another name=")
    diagnostics.raise_if_errors()
    return models[0]
