"""The command `simkit bundle`: pack a run into one file that repeats it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.run_options import load_options, scenario_spec
from simkit.cli.terminal.output import print_diagnostics, print_status, report_errors, stdout_console
from simkit.cli.terminal.shared_options import (
    Base,
    CmdVel,
    Force,
    Overrides,
    PackagePaths,
    ParamsFiles,
    PluginPaths,
    ResourcePaths,
    Script,
    Seed,
    Spawns,
    XacroArgs,
    source_arguments,
)
from simkit.errors import InputError, SimkitError
from simkit.writers.atomic_output import check_file


@report_errors
def bundle(
    world: Annotated[
        str, typer.Argument(help="A world, a model, or the file of a scenario.", show_default=False, metavar="WORLD")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="The file to write.", metavar="FILE.zip")],
    duration: Annotated[
        float | None, typer.Option(help="Simulated seconds to run; 10, or the scenario's.", metavar="S", min=0)
    ] = None,
    seed: Seed = None,
    cmd_vel: CmdVel = None,
    script: Script = None,
    set_: Overrides = [],
    spawn: Spawns = [],
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
    from simkit.testing.bundles import BundleRecorder, write_bundle
    from simkit.testing.bundles.manifest import failure_from_checks, failure_from_error
    from simkit.testing.scenarios.scenario_run import open_scenario, resolve_commands, run_scenario

    check_file(output, overwrite=force)
    scenario = scenario_spec(
        world, load_options(source_arguments(resource_path, package_path, xacro_arg, base), plugin_path, params_file),
        duration=duration, seed=seed, overrides=set_, spawn=spawn, cmd_vel=cmd_vel, script=script,
    )  # fmt: skip
    with open_scenario(scenario) as sim:
        print_diagnostics(sim.diagnostics, verbose=False)
        keeper = BundleRecorder(sim, last, topic)
        scenario = resolve_commands(scenario, sim.topics())
        failure = None
        try:
            ended = run_scenario(scenario, sim)
            failure = failure_from_checks(ended.results, was_given_up=ended.reason == "wall_timeout")
            if failure is not None:
                print_status(f"what did not hold, which is in the bundle: {failure.text}")
        except InputError:
            raise
        except SimkitError as error:
            failure = failure_from_error(error)
            print_status(f"the run failed, which is in the bundle: {error}")
        name = scenario.name or ("" if scenario.file is None else scenario.file.stem)
        write_bundle(keeper, output, failure, name=name, overwrite=force, with_code=not no_code)
        stdout_console().print(f"state {keeper.end().state}")
        size = output.stat().st_size
        stdout_console().print(f"{output}: {sim.time:g} s, {keeper.journal.count} commands, {size / 1000:.0f} kB")
    return 0
