"""`simkit plot`: fields of topics over time, of worlds and bags, as SVG or PNG."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.options import Base, Json, PackagePaths, PluginPaths, ResourcePaths, XacroArgs, source
from simkit.cli.talking.plot_options import Against, End, Output, Start, Title
from simkit.cli.talking.plotted import Run, Wish, divided
from simkit.cli.talking.plotted import plot as draw
from simkit.cli.talking.printed import quiet


@quiet
def plot(
    words: Annotated[
        list[str],
        typer.Argument(
            help="A world, scenario or bag, or several; then fields: /odom.pose.pose.position.x, /scan.ranges[0].",
            metavar="WORLD-or-BAG... FIELD...",
            show_default=False,
        ),
    ],
    output: Output = Path("plot.svg"),
    against: Against = None,
    start: Start = None,
    end: End = None,
    title: Title = "",
    duration: Annotated[
        float | None,
        typer.Option(help="Simulated seconds that a world is run for; 10 where not given.", metavar="S", min=0),
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of all noise.", metavar="N", min=0)] = None,
    set_: Annotated[
        list[str],
        typer.Option("--set", help="Changes one value: scoped::name.element=VALUE; repeatable.", metavar="PATH=VALUE"),
    ] = [],
    cmd_vel: Annotated[
        str | None, typer.Option(help="Sends one velocity: m/s forward, rad/s to the left.", metavar="V,W")
    ] = None,
    script: Annotated[Path | None, typer.Option(help="Commands over time.", metavar="FILE.yaml")] = None,
    resource_path: ResourcePaths = [],
    package_path: PackagePaths = [],
    plugin_path: PluginPaths = [],
    xacro_arg: XacroArgs = [],
    base: Base = "auto",
    json_: Json = False,
) -> int:
    """Draws fields of topics over time: of bags, and of worlds that are run for it."""
    sources, fields = divided(words)
    given = source(resource_path, package_path, xacro_arg, base)
    run = Run(duration, seed, tuple(set_), cmd_vel, script, tuple(plugin_path), dict(given))
    return draw(sources, fields, Wish(output, against, start, end, title, run), json_=json_)
