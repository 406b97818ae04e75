"""Command `simkit certify`: verify that a run gives the same bits in different environments."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

from simkit.cli.run_options import load_options, scenario_spec
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_to_report, report_errors_and_json
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import print_status, stdout_console
from simkit.writers.atomic_output import check_writable, write_atomically

_DIFFERENT = 5
_DEFAULT_DURATION = 5.0  # [s] for a world without a scenario


@report_errors_and_json
def certify(
    world: options.Scenario,
    duration: Annotated[float | None, option("Simulated seconds; default: the scenario's, else 5.", "S", min=0)] = None,
    seed: options.Seed = None,
    runs: Annotated[int, option("Number of runs, each in a fresh process.", "N")] = 6,
    jobs: Annotated[int, option("Number of parallel processes.", "N", "--jobs", "-j", min=1)] = 1,
    wall_timeout: Annotated[
        float | None,
        option("Wall time limit of each run; default: ten times the first run's, at least 60.", "S", min=0.1),
    ] = None,
    topic: Annotated[list[str], option("Compare only topics that match this pattern; repeatable.", "PATTERN")] = [],
    skip: Annotated[list[str], option("Leave out topics that match this pattern; repeatable.", "PATTERN")] = [],
    cmd_vel: options.CmdVel = None,
    script: options.Script = None,
    set_: options.Overrides = [],
    spawn: options.Spawns = [],
    model_world: options.ModelWorld = None,
    params_file: options.ParamsFiles = [],
    resource_path: options.ResourcePaths = [],
    package_path: options.PackagePaths = [],
    plugin_path: options.PluginPaths = [],
    allow_code: options.AllowCode = False,
    xacro_arg: options.XacroArgs = [],
    base: options.Base = "auto",
    renderer: options.Renderer = None,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
    output: Annotated[Path | None, option("Certificate to write, as JSON.", "FILE.json", "--out", "-o")] = None,
) -> int:
    """Verify that a run is bit-identical in different environments."""
    from simkit.testing.certify import certificate
    from simkit.testing.certify import certify as certify_scenario
    from simkit.testing.scenarios.scenario_run import open_scenario, resolve_commands

    check_writable(output)
    scenario = scenario_spec(
        world, load_options(resource_path, package_path, xacro_arg, base, plugin_path, params_file, renderer=renderer),
        allow_code=allow_code, duration=duration, seed=seed, topics=topic, skip=skip, overrides=set_, spawn=spawn,
        cmd_vel=cmd_vel, model_world=model_world, script=script, usual_duration=_DEFAULT_DURATION,
    )  # fmt: skip
    if scenario.velocity is not None or scenario.script is not None:
        with open_scenario(scenario) as sim:
            scenario = resolve_commands(scenario, sim.communication.bus.topics())
    stdout_console().print(certificate.table_header())
    report = certify_scenario(
        scenario,
        runs=runs,
        jobs=jobs,
        wall_timeout=scenario.wall_timeout if wall_timeout is None else wall_timeout,
        on_row=lambda row: stdout_console().print(certificate.table_row(row)),
    )
    for line in certificate.conclusion_text(report):
        stdout_console().print(line)
    code = 0 if report.passed else _DIFFERENT
    data = {**report.to_dict(), "diagnostics": [], "exit_code": code}  # the file has the keys of the report, too
    add_to_report(**data)
    if output is not None:
        write_atomically(output, (json.dumps(data, indent=1) + "\n").encode())
        print_status(f"wrote {output}")
    return code
