"""Make run specifications from the options of a command, and hold what a terminal shows of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

from simkit.cli.terminal.options import source_arguments
from simkit.cli.terminal.teleop import KEY_TIMEOUT
from simkit.run_spec import LoadOptions, PluginErrorPolicy, RunSpec


@dataclass(frozen=True)
class RunDisplay:
    """What a terminal shows of a run, who drives it there, and which files tell of it.

    Attributes:
        view: whether a viewer is opened.
        picture: file for a picture of the scene at the end.
        teleop: topic that the keyboard sends velocities to; empty for the only one there is, None for no keyboard.
        key_timeout: simulated time without a key after which driving stops [s].
        verbose: whether every note is shown.
        quiet: whether the table of topics is left out.
        watch: whether plugins whose files are edited are reloaded.
        junit: file for the results, for a CI.
        bundles: folder for a bundle of a run that fails.
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
) -> LoadOptions:
    """Return the options of a command that say how a world is loaded; those that were not given are not in it."""
    given = {
        **source_arguments(resource_paths, package_paths, xacro_args, base),
        "plugin_paths": tuple(plugin_paths),
        "params_files": tuple(params_files),
        "on_error": on_error,
        "strict": strict,
    }
    return cast(LoadOptions, {name: value for name, value in given.items() if value and value != "auto"})


def scenario_spec(
    world: str,
    options: LoadOptions,
    *,
    duration: float | None = None,
    seed: int | None = None,
    topics: Sequence[str] = (),
    skip: Sequence[str] = (),
    overrides: Sequence[str] = (),
    spawn: Sequence[str] = (),
    cmd_vel: str | None = None,
    script: Path | None = None,
    usual_duration: float = 10.0,
) -> RunSpec:
    """Return the run of a world, or of a scenario file with the options of a command over it.

    Args:
        world: a world, or the file of a scenario.
        options: how the world is loaded.
        duration: simulated time [s]; None for the scenario's.
        seed: of all noise; None for the scenario's.
        topics: patterns of topics, in place of the scenario's.
        skip, overrides, spawn: in addition to the scenario's.
        cmd_vel, script: commands in addition to the scenario's.
        usual_duration: of a world that no scenario gives a length [s].

    Raises:
        LoadError: the file of the scenario has errors.
    """
    from simkit.testing.scenarios.scenario_file import is_scenario_file, read_scenario

    if "<" not in world and is_scenario_file(world):
        found = read_scenario(world)
    else:
        found = RunSpec(world, duration=usual_duration)
    return replace(
        found,
        duration=found.duration if duration is None else duration,
        seed=found.seed if seed is None else seed,
        topics=tuple(topics) or found.topics,
        skip=(*found.skip, *skip),
        overrides=(*found.overrides, *overrides),
        spawn=(*found.spawn, *spawn),
        options={**found.options, **options},
        velocity=found.velocity if cmd_vel is None else cmd_vel,
        script=script or found.script,
    )
