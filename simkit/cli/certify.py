"""The command `simkit certify`: show that a run gives the same bits in other surroundings."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

from simkit.cli.run_options import load_options, scenario_spec
from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import print_json, print_status, report_errors, stdout_console
from simkit.writers.atomic_output import check_writable, write_atomically

_DIFFERENT = 5
_SECONDS = 5.0  # of a world that no scenario gives a length


@report_errors
def certify(
    world: Annotated[str, argument("A world, or a scenario (.yaml, .py).", "WORLD|SCENARIO")],
    duration: Annotated[
        float | None, option("Simulated seconds; the scenario's, or 5, where not given.", "S", min=0)
    ] = None,
    seed: options.Seed = None,
    runs: Annotated[int, option("How many runs, each in a fresh process.", "N")] = 6,
    jobs: Annotated[int, option("Processes at a time.", "N", "--jobs", "-j", min=1)] = 1,
    wall_timeout: Annotated[
        float | None,
        option("Wall time of each run; ten times the first one's, at least 60, where not given.", "S", min=0.1),
    ] = None,
    topic: Annotated[list[str], option("Compares only topics of this pattern; repeatable.", "PATTERN")] = [],
    skip: Annotated[list[str], option("Compares all but topics of this pattern; repeatable.", "PATTERN")] = [],
    cmd_vel: options.CmdVel = None,
    script: options.Script = None,
    set_: options.Overrides = [],
    spawn: options.Spawns = [],
    params_file: options.ParamsFiles = [],
    resource_path: options.ResourcePaths = [],
    package_path: options.PackagePaths = [],
    plugin_path: options.PluginPaths = [],
    xacro_arg: options.XacroArgs = [],
    base: options.Base = "auto",
    json_: options.Json = False,
    output: Annotated[Path | None, option("Writes the certificate, as JSON.", "FILE.json", "--out", "-o")] = None,
) -> int:
    """Runs a world in fresh processes with other surroundings, and shows that the bits are the same."""
    from simkit.testing.certify import certificate
    from simkit.testing.certify import certify as certify_scenario
    from simkit.testing.scenarios.scenario_run import open_scenario, resolve_commands

    check_writable(output)
    scenario = scenario_spec(
        world, load_options(resource_path, package_path, xacro_arg, base, plugin_path, params_file),
        duration=duration, seed=seed, topics=topic, skip=skip, overrides=set_, spawn=spawn, cmd_vel=cmd_vel,
        script=script, usual_duration=_SECONDS,
    )  # fmt: skip
    if scenario.velocity is not None or scenario.script is not None:
        with open_scenario(scenario) as sim:
            scenario = resolve_commands(scenario, sim.topics())
    if not json_:
        stdout_console().print(certificate.table_header())
    made = certify_scenario(
        scenario,
        runs=runs,
        jobs=jobs,
        wall_timeout=scenario.wall_timeout if wall_timeout is None else wall_timeout,
        told=None if json_ else lambda row: stdout_console().print(certificate.table_row(row)),
    )
    if json_:
        print_json(made.to_dict())
    else:
        for line in certificate.conclusion_text(made):
            stdout_console().print(line)
    if output is not None:
        write_atomically(output, (json.dumps(made.to_dict(), indent=1) + "\n").encode())
        print_status(f"wrote {output}")
    return 0 if made.passed else _DIFFERENT
