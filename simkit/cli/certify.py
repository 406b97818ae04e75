"""`simkit certify`: the same bits, whatever a run stands in."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from simkit.cli.console import guarded, out, say
from simkit.cli.options import (
    Base,
    Json,
    PackagePaths,
    ParamsFiles,
    PluginPaths,
    ResourcePaths,
    XacroArgs,
    source,
)

if TYPE_CHECKING:
    from simkit.scenario import Scenario

_DIFFERENT = 5
_SECONDS = 5.0  # of a world that no scenario gives a length


@guarded
def certify(
    world: Annotated[
        str, typer.Argument(help="A world, or a scenario (.yaml, .py).", metavar="WORLD|SCENARIO", show_default=False)
    ],
    duration: Annotated[
        float | None,
        typer.Option(help="Simulated seconds; the scenario's, or 5, where not given.", metavar="S", min=0),
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of all noise.", metavar="N", min=0)] = None,
    runs: Annotated[int, typer.Option(help="How many runs, each in a fresh process.", metavar="N")] = 6,
    jobs: Annotated[int, typer.Option("--jobs", "-j", help="Processes at a time.", metavar="N", min=1)] = 1,
    wall_timeout: Annotated[
        float | None,
        typer.Option(
            help="Wall time of each run; ten times the first one's, at least 60, where not given.", metavar="S", min=0.1
        ),
    ] = None,
    topic: Annotated[
        list[str], typer.Option(help="Compares only topics of this pattern; repeatable.", metavar="PATTERN")
    ] = [],
    skip: Annotated[
        list[str], typer.Option(help="Compares all but topics of this pattern; repeatable.", metavar="PATTERN")
    ] = [],
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
    resource_path: ResourcePaths = [],
    package_path: PackagePaths = [],
    plugin_path: PluginPaths = [],
    xacro_arg: XacroArgs = [],
    base: Base = "auto",
    json_: Json = False,
    output: Annotated[
        Path | None, typer.Option("--out", "-o", help="Writes the certificate, as JSON.", metavar="FILE.json")
    ] = None,
) -> int:
    """Runs a world in fresh processes with other surroundings, and shows that the bits are the same."""
    from simkit.certify import certify as certify_scenario
    from simkit.certify import text
    from simkit.cli.talking.printed import as_json
    from simkit.sinks.whole_file import write_whole

    how: dict[str, Any] = dict(source(resource_path, package_path, xacro_arg, base))
    how |= {"plugin_paths": tuple(plugin_path), "params_files": tuple(params_file)}
    scenario = _scenario(world, {name: value for name, value in how.items() if value and value != "auto"})
    scenario = replace(
        scenario,
        duration=scenario.duration if duration is None else duration,
        seed=scenario.seed if seed is None else seed,
        topics=tuple(topic) or scenario.topics,
        skip=(*scenario.skip, *skip),
        overrides=(*scenario.overrides, *set_),
        spawn=(*scenario.spawn, *spawn),
        commands=(*scenario.commands, *_commands(cmd_vel, script, scenario)),
    )
    if not json_:
        out().print(text.header())
    made = certify_scenario(
        scenario,
        runs=runs,
        jobs=jobs,
        wall_timeout=scenario.wall_timeout if wall_timeout is None else wall_timeout,
        told=None if json_ else lambda row: out().print(text.line(row)),
    )
    if json_:
        as_json(made.to_dict())
    else:
        for line in text.conclusion(made):
            out().print(line)
    if output is not None:
        write_whole(output, (json.dumps(made.to_dict(), indent=1) + "\n").encode())
        say(f"wrote {output}")
    return 0 if made.passed else _DIFFERENT


def _scenario(world: str, options: dict[str, Any]) -> Scenario:
    """The scenario of a file, or one that only runs a world."""
    from simkit.scenario import Scenario
    from simkit.scenario.read import is_scenario_file, read_scenario

    if is_scenario_file(world):
        scenario = read_scenario(world)
        return replace(scenario, options={**scenario.options, **options})
    return Scenario(world=world, duration=_SECONDS, options=options)


def _commands(cmd_vel: str | None, script: Path | None, scenario: Scenario) -> list[dict[str, Any]]:
    """Commands of the command line, as a scenario has them."""
    from simkit.sinks.commands import script_items, steady_velocity

    found: list[dict[str, Any]] = []
    if script is not None:
        found += script_items(script)
    if cmd_vel is not None:
        from simkit.scenario.run import open_scenario

        with open_scenario(scenario) as sim:
            command = steady_velocity(cmd_vel, sim.topics())
        found.append({"at": command.at, "topic": command.topic, "message": command.message, "where": command.where})
    return found
