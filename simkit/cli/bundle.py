"""`simkit bundle`: a run in one file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from simkit.cli.console import guarded, out, print_diagnostics, say
from simkit.cli.options import (
    Base,
    Force,
    PackagePaths,
    ParamsFiles,
    PluginPaths,
    ResourcePaths,
    XacroArgs,
    source,
)


@guarded
def bundle(
    world: Annotated[
        str, typer.Argument(help="A world, a model, or the file of a scenario.", show_default=False, metavar="WORLD")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="The file to write.", metavar="FILE.zip")],
    duration: Annotated[
        float | None, typer.Option(help="Simulated seconds to run; 10, or the scenario's.", metavar="S", min=0)
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of all noise.", metavar="N", min=0)] = None,
    cmd_vel: Annotated[
        str | None, typer.Option(help="Sends one velocity: m/s forward, rad/s to the left.", metavar="V,W")
    ] = None,
    script: Annotated[Path | None, typer.Option(help="Commands over time.", metavar="FILE.yaml")] = None,
    set_: Annotated[
        list[str],
        typer.Option("--set", help="Changes one value: scoped::name.element=VALUE; repeatable.", metavar="PATH=VALUE"),
    ] = [],
    spawn: Annotated[
        list[str],
        typer.Option(help="Puts a model into the world, by name or file; repeatable.", metavar="MODEL:x,y,yaw[:name]"),
    ] = [],
    params_file: ParamsFiles = [],
    last: Annotated[float, typer.Option(help="Keeps the messages of so many last seconds.", metavar="S", min=0)] = 10.0,
    topic: Annotated[
        list[str],
        typer.Option(help="Keeps topics of this pattern although they are pictures; repeatable.", metavar="PATTERN"),
    ] = [],
    no_code: Annotated[bool, typer.Option("--no-code", help="Leaves the code of plugins out.")] = False,
    force: Force = False,
    resource_path: ResourcePaths = [],
    package_path: PackagePaths = [],
    plugin_path: PluginPaths = [],
    xacro_arg: XacroArgs = [],
    base: Base = "auto",
) -> int:
    """Runs a world or a scenario, and packs it into one file that repeats it anywhere.

    In it are the world and everything it names, the code of plugins, the seed, the versions, every command that came in
    with its tick, the messages of the last seconds, and the hashes at the end. `simkit replay` repeats the run.
    """
    from simkit.bundle import Keeper, write_bundle
    from simkit.bundle.keeping import failure_of, failure_of_checks
    from simkit.errors import InputError, SimkitError
    from simkit.scenario.run import open_scenario, run_scenario
    from simkit.writers.staging import check_file

    check_file(output, overwrite=force)
    options: dict[str, Any] = dict(source(resource_path, package_path, xacro_arg, base))
    options |= {"plugin_paths": tuple(plugin_path), "params_files": tuple(params_file)}
    scenario = _scenario(world, {key: value for key, value in options.items() if value and value != "auto"})
    scenario = replace(
        scenario,
        duration=scenario.duration if duration is None else duration,
        seed=scenario.seed if seed is None else seed,
        overrides=(*scenario.overrides, *set_),
        spawn=(*scenario.spawn, *spawn),
    )
    with open_scenario(scenario) as sim:
        print_diagnostics(sim.diagnostics, verbose=False)
        keeper = Keeper(sim, last, topic)
        scenario = _with_commands(scenario, sim, cmd_vel, script)
        failure = None
        try:
            ended = run_scenario(scenario, sim)
            failure = failure_of_checks(ended.results, was_given_up=ended.reason == "wall_timeout")
            if failure is not None:
                say(f"what did not hold, which is in the bundle: {failure.text}")
        except InputError:
            raise
        except SimkitError as error:
            failure = failure_of(error)
            say(f"the run failed, which is in the bundle: {error}")
        name = scenario.name or ("" if scenario.file is None else scenario.file.stem)
        write_bundle(keeper, output, failure, name=name, overwrite=force, with_code=not no_code)
        out().print(f"state {keeper.end().state}")
        size = output.stat().st_size
        out().print(f"{output}: {sim.time:g} s, {keeper.journal.count} commands, {size / 1000:.0f} kB")
    return 0


def _scenario(source: str, options: dict[str, Any]) -> Any:
    """What is to be run: a scenario's file, or a world for some seconds."""
    from simkit.scenario import Scenario
    from simkit.scenario.read import is_scenario_file, read_scenario

    if "<" not in source and is_scenario_file(source):
        scenario = read_scenario(source)
        return replace(scenario, options={**scenario.options, **options})
    return Scenario(source, options=options)


def _with_commands(scenario: Any, sim: Any, cmd_vel: str | None, script: Path | None) -> Any:
    """The scenario with the commands of the command line added."""
    from simkit.sinks.commands import script_items, steady_velocity

    added: list[dict[str, Any]] = []
    if cmd_vel is not None:
        steady = steady_velocity(cmd_vel, sim.topics())
        added.append({"at": steady.at, "topic": steady.topic, "message": steady.message, "where": steady.where})
    if script is not None:
        added += script_items(script)
    return replace(scenario, commands=(*scenario.commands, *added))
