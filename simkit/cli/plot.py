"""Command `simkit plot`: plot fields of topics over time, from worlds, scenarios and bags, as SVG or PNG."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

from simkit.cli.plot_sources import PlotRequest, draw_chart, split_sources_and_fields
from simkit.cli.run_options import load_options, scenario_spec
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import report_errors_quietly


@report_errors_quietly
def plot(
    arguments: Annotated[
        list[str],
        argument(
            "One or more worlds, scenarios or bags, then fields: /odom.pose.pose.position.x, /scan.ranges[0].",
            "WORLD-or-BAG... FIELD...",
            completion.scenarios,
        ),
    ],
    output: options.ChartFile = Path("plot.svg"),
    against: options.Against = None,
    start: options.Start = None,
    end: options.End = None,
    title: options.Title = "",
    duration: Annotated[float | None, option("Simulated seconds to run a world; default: 10.", "S", min=0)] = None,
    seed: options.Seed = None,
    set_: options.Overrides = [],
    model_world: options.ModelWorld = None,
    cmd_vel: options.CmdVel = None,
    script: options.Script = None,
    resource_path: options.ResourcePaths = [],
    package_path: options.PackagePaths = [],
    plugin_path: options.PluginPaths = [],
    allow_code: options.AllowCode = False,
    xacro_arg: options.XacroArgs = [],
    base: options.Base = "auto",
    renderer: options.Renderer = None,
    json_: options.Json = False,
) -> None:
    """Plot fields of bags, worlds and scenarios over time."""
    sources, fields = split_sources_and_fields(arguments)
    loading = load_options(resource_path, package_path, xacro_arg, base, plugin_path, renderer=renderer)
    run = partial(
        scenario_spec,
        options=loading,
        allow_code=allow_code,
        duration=duration,
        seed=seed,
        overrides=set_,
        cmd_vel=cmd_vel,
        script=script,
        model_world=model_world,
    )
    draw_chart(sources, fields, PlotRequest(output, against, start, end, title, run), json_=json_)
