"""Command `simkit plot`: plot fields of topics over time, from worlds, scenarios and bags, as SVG or PNG."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

from simkit.cli.plot_sources import PlotRequest, draw_chart, split_sources_and_fields
from simkit.cli.run_options import NONE_GIVEN, GivenOptions, scenario_spec, with_run_options
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.json_report import report_errors
from simkit.cli.terminal.options import argument
from simkit.cli.terminal.output import without_interrupt_message


@report_errors
@without_interrupt_message
@with_run_options(
    *("file", "world", "run"),
    usual={"duration": "the scenario's, else 10"},
    without={
        "name": "--title names the chart",
        "topics": "the fields name the topics",
        "skip": "the fields name the topics",
        "checks": "a chart tells nothing about conditions",
        "session": "nobody follows the run of a chart",
    },
)
def plot(
    arguments: Annotated[
        list[str],
        argument(
            "One or more worlds, scenarios or bags, then fields and expressions: /odom.pose.pose.position.x, "
            "/scan.ranges[0], \"distance('a', 'b')\".",
            "WORLD-or-BAG... FIELD...",
            completion.sources_and_fields,
        ),
    ],
    output: options.ChartFile = Path("plot.svg"),
    against: options.Against = None,
    start: options.Start = None,
    end: options.End = None,
    title: options.Title = "",
    given: GivenOptions = NONE_GIVEN,
    allow_code: options.AllowCode = False,
    json_: options.Json = False,
) -> None:
    """Plot fields of topics, and expressions as in conditions, over time."""
    sources, fields = split_sources_and_fields(arguments)
    run = partial(scenario_spec, given=given, allow_code=allow_code)
    draw_chart(sources, fields, PlotRequest(output, against, start, end, title, run), json_=json_)
