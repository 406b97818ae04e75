"""`simkit golden`: what a scenario gave once, kept and compared with what it gives now."""

from __future__ import annotations

import sys
from contextlib import nullcontext, redirect_stdout
from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.console import guarded, out, print_diagnostics, say
from simkit.cli.options import (
    Base,
    CmdVel,
    Force,
    Json,
    Overrides,
    PackagePaths,
    ParamsFiles,
    PluginPaths,
    ResourcePaths,
    Script,
    Seed,
    Spawned,
    XacroArgs,
    source,
)

golden = typer.Typer(help="Golden runs: sensor outputs kept, and compared with today's.", no_args_is_help=True)


@golden.callback()
def _group() -> None:
    """Golden runs: sensor outputs kept, and compared with today's."""


@golden.command()
@guarded
def record(
    world: Annotated[
        str, typer.Argument(help="A scenario (.yaml, .py), a world, or a bare name.", metavar="WORLD|SCENARIO")
    ],
    out_: Annotated[Path, typer.Option("--out", "-o", help="The folder that it goes into.", metavar="DIR")],
    duration: Annotated[
        float | None, typer.Option(help="Simulated seconds; 10 where nothing says it.", metavar="S", min=0)
    ] = None,
    seed: Seed = None,
    topic: Annotated[
        list[str], typer.Option(help="Keeps only topics of this pattern; repeatable.", metavar="PATTERN")
    ] = [],
    skip: Annotated[
        list[str], typer.Option(help="Keeps all but topics of this pattern; repeatable.", metavar="PATTERN")
    ] = [],
    set_: Overrides = [],
    spawn: Spawned = [],
    params_file: ParamsFiles = [],
    cmd_vel: CmdVel = None,
    script: Script = None,
    resource_path: ResourcePaths = [],
    package_path: PackagePaths = [],
    plugin_path: PluginPaths = [],
    xacro_arg: XacroArgs = [],
    base: Base = "auto",
    force: Force = False,
) -> int:
    """Runs a scenario and keeps what it gives as a golden run."""
    from simkit.cli.goldens.recording import keep
    from simkit.cli.running.asked import Asked

    asked = Asked(
        world, duration, seed, tuple(topic), tuple(skip), tuple(set_), tuple(spawn), tuple(params_file),
        cmd_vel=cmd_vel, script=script, plugin_paths=tuple(plugin_path),
        source=source(resource_path, package_path, xacro_arg, base),
    )  # fmt: skip
    found = keep(asked, out_, force=force)
    if found.simulation is not None:
        print_diagnostics(found.simulation.diagnostics, verbose=False)
        found.simulation.close()
    messages = sum(len(stream.times_ns) for stream in found.streams.values())
    size = sum(path.stat().st_size for path in out_.iterdir())
    out().print(f"{out_}: {len(found.streams)} topics, {messages} messages, {size / 1000:.1f} kB")
    for result in found.checks:
        if not result.passed:
            say(f"warning: the scenario's own check does not hold: {result.check.title}: {result.message}")
    return 0


@golden.command()
@guarded
def check(
    folders: Annotated[
        list[Path], typer.Argument(help="Golden runs, or folders that hold some.", metavar="DIR...", show_default=False)
    ],
    bless: Annotated[
        str | None,
        typer.Option(help="Makes what differs golden, and keeps why that is right.", metavar="REASON"),
    ] = None,
    bless_other_renderer: Annotated[
        bool, typer.Option("--bless-other-renderer", help="Also where pictures were drawn by another renderer.")
    ] = False,
    html: Annotated[
        Path | None, typer.Option(help="Writes the report as one page with plots and pictures.", metavar="OUT.html")
    ] = None,
    junit: Annotated[Path | None, typer.Option(help="Writes JUnit XML.", metavar="OUT.xml")] = None,
    jobs: Annotated[int, typer.Option("--jobs", "-n", help="So many at once.", metavar="N", min=1)] = 1,
    causes: Annotated[bool, typer.Option("--causes/--no-causes", help="Looks for where differences come from.")] = True,
    budget: Annotated[
        float, typer.Option(help="Wall time that this may take for one of them.", metavar="S", min=0)
    ] = 60.0,
    json_: Json = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Says nothing of what passes.")] = False,
) -> int:
    """Runs golden runs again and compares; says what differs first, and why. Exit code 5 where something does."""
    from simkit.cli.goldens.checking import Wanted, check_all
    from simkit.cli.goldens.telling import tell
    from simkit.sinks.whole_file import check_whole

    check_whole(html)
    check_whole(junit)
    wanted = Wanted(bless, bless_other_renderer, causes, budget)
    with redirect_stdout(sys.stderr) if json_ else nullcontext():  # what a plugin prints is no JSON
        results = check_all(folders, wanted, jobs)
    return tell(results, blessed=bless is not None, html=html, junit=junit, as_json=json_, quiet=quiet)
