"""Conversion of command-line options to run specifications, and the options for the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, cast

from simkit.bridges.teleop import KEY_TIMEOUT
from simkit.cli.terminal.given_interfaces import interface_folders
from simkit.cli.terminal.options import renderer_argument, source_arguments
from simkit.run_spec import FilePath, LoadOptions, PluginErrorPolicy, RunSpec

if TYPE_CHECKING:
    from simkit.bridges.ros.bridge_process import RosOptions
    from simkit.bridges.web.web_process import WebOptions
    from simkit.cli.terminal.page_options import PageOptions
    from simkit.recording.films.film import FilmOptions


@dataclass(frozen=True)
class RunDisplay:
    """Display, keyboard and report options of a run.

    Attributes:
        view: True to open a viewer window.
        picture: file for a picture of the scene at the end.
        film: options of a GIF or video of the run; None for none.
        teleop: topic for the keyboard's velocities; empty for the world's only velocity topic, None for no keyboard.
        key_timeout: simulated time without a key after which driving stops [s].
        verbose: True to print every note.
        quiet: True to print no table of topics.
        watch: True to reload plugins whose files change.
        junit: file for a JUnit XML report.
        bundles: folder for the bundle of a failed run.
        ros: options of the bridge to ROS 2; None for a run without ROS.
        web_servers: options of the servers for Foxglove and rosbridge.
        page: options of the live view in a browser; None for no view.
    """

    view: bool = False
    picture: Path | None = None
    teleop: str | None = None
    key_timeout: float = KEY_TIMEOUT
    verbose: bool = False
    quiet: bool = False
    watch: bool = False
    junit: Path | None = None
    bundles: Path | None = None
    ros: RosOptions | None = None
    web_servers: tuple[WebOptions, ...] = ()
    film: FilmOptions | None = None
    page: PageOptions | None = None


def load_options(
    resource_paths: Sequence[Path],
    package_paths: Sequence[str],
    xacro_args: Sequence[str],
    base: str,
    plugin_paths: Sequence[Path] = (),
    params_files: Sequence[str] = (),
    *,
    on_error: PluginErrorPolicy | None = None,
    strict: bool = False,
    renderer: str | None = None,
) -> LoadOptions:
    """Return the load options of a command, without the options that have their default value."""
    values = {
        **source_arguments(resource_paths, package_paths, xacro_args, base),
        "plugin_paths": tuple(plugin_paths),
        "interfaces": interface_folders(),
        "params_files": tuple(params_files),
        "on_error": on_error,
        "strict": strict,
    }
    given = {name: value for name, value in values.items() if value and value != "auto"}
    return cast(LoadOptions, {**given, **renderer_argument(renderer)})


def read_run(world: str, usual_duration: float = 10.0, folders: Sequence[FilePath] = ()) -> RunSpec:
    """Return the run specification of a world or scenario file, with the requests of the file for code.

    Args:
        world: world or scenario file.
        usual_duration: simulated time of a world without a scenario [s].
        folders: folders of the user in which a scenario may name files.

    Raises:
        LoadError: the scenario file has errors.
    """
    from simkit.testing.scenarios.scenario_file import is_scenario_file, read_scenario

    if "<" not in world and is_scenario_file(world):
        return read_scenario(world, folders)
    return RunSpec(world, duration=usual_duration)


def scenario_spec(
    world: str | RunSpec,
    options: LoadOptions,
    *,
    allow_code: bool = False,
    duration: float | None = None,
    seed: int | None = None,
    topics: Sequence[str] = (),
    skip: Sequence[str] = (),
    overrides: Sequence[str] = (),
    spawn: Sequence[str] = (),
    model_world: str | None = None,
    cmd_vel: str | None = None,
    script: Path | None = None,
    usual_duration: float = 10.0,
) -> RunSpec:
    """Return the run specification of a world, or of a scenario file with the options of a command.

    Args:
        world: world, scenario file, or its run specification.
        options: load options of the world. Its plugin folders allow the code in them.
        allow_code: allow all plugin folders that the scenario names.
        duration: simulated time [s]; None for the scenario's.
        seed: seed of all random streams; None for the scenario's.
        topics: topic patterns that replace the scenario's.
        skip: topic patterns to leave out, in addition to the scenario's.
        overrides: parameter overrides, in addition to the scenario's.
        spawn: models to spawn, in addition to the scenario's.
        model_world: world of a bare model; None for the scenario's.
        cmd_vel: constant velocity command; None for the scenario's.
        script: command script; None for the scenario's.
        usual_duration: simulated time of a world without a scenario [s].

    Raises:
        LoadError: the scenario file has errors, or SK-SCEN-008 it names code that is not allowed.
    """
    from simkit.testing.scenarios.code_permission import add_options

    folders = options.get("resource_paths", ())
    found = read_run(world, usual_duration, folders) if isinstance(world, str) else world
    own = found.options.get("resource_paths", ())
    if own and "resource_paths" in options:  # the option allows files; it does not replace the scenario's folders
        options = {**options, "resource_paths": (*options["resource_paths"], *own)}
    found = add_options(found, options, allow_code)
    return replace(
        found,
        duration=found.duration if duration is None else duration,
        seed=found.seed if seed is None else seed,
        topics=tuple(topics) or found.topics,
        skip=(*found.skip, *skip),
        overrides=(*found.overrides, *overrides),
        spawn=(*found.spawn, *spawn),
        model_world=model_world or found.model_world,
        velocity=found.velocity if cmd_vel is None else cmd_vel,
        script=script or found.script,
    )
