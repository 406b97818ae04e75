"""Command `simkit view`: show a world, a robot, a running simulation or a bag in a browser."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from typer import Option

from simkit.cli.plot_sources import is_bag
from simkit.cli.run import execute
from simkit.cli.run_display import RunDisplay
from simkit.cli.run_loop import Interrupts
from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.terminal import completion, page_options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import report_errors

_PORT_HELP = "Port of the page on this machine; default: a free one."
Target = Annotated[
    str, argument("World or robot, name of a running simulation, or bag.", "WORLD|SIM|BAG|ROBOT", completion.worlds)
]
Port = Annotated[int | None, option(_PORT_HELP, "PORT", min=0, max=65535)]


@report_errors
@with_run_options(
    *("file", "world", "run"),
    usual={"duration": "until Ctrl-C"},
    without={
        "topics": "nothing is recorded",
        "skip": "nothing is recorded",
        "session": "the page starts the run, at the speed of real time",
    },
)
def view(
    target: Target,
    port: Port = None,
    host: page_options.Host = None,
    no_open: page_options.NoOpen = False,
    given: GivenOptions = NONE_GIVEN,
    html: Annotated[Path | None, option("HTML file to write instead: a bag that plays without simkit.", "OUT")] = None,
    verbose: Annotated[bool, Option("--verbose", "-v", help="Show every note instead of their number.")] = False,
) -> int:
    """Show a world, a robot, a running simulation or a bag in a browser.

    A world and a robot are paused; a robot has a slider for each joint.
    """
    page = page_options.PageOptions(port or 0, host or "127.0.0.1", not no_open)
    server: dict[str, object] = {"--port": port, "--host": host}
    if html is not None:
        _refuse({**server, "--no-open": no_open}, "no page is served with --html; open the file")
    if is_bag(Path(target)) or html is not None:
        loading = given.load_options()
        others = dict.fromkeys(given.names(excluded=("model_world", *loading)), True)
        _refuse(others, "a bag plays as it was recorded; --world WORLD names its world")
        from simkit.cli.bag_view import show_bag

        return show_bag(Path(target), given.values.get("model_world"), loading, page, html)
    if not Path(target).exists() and target in _running():
        text = f"{target} runs already; start it with these options, such as `simkit run WORLD --web PORT`"
        _refuse(server | dict.fromkeys(given.names(), True), text)
        return _show_running(target, page)
    spec = replace(given.run_spec(target, duration=math.inf), pace=1.0, paused=True)
    return execute(spec, RunDisplay(quiet=True, verbose=verbose, page=page))


def _refuse(given: Mapping[str, object], reason: str) -> None:
    """Raise a usage error if options are given that would have no effect."""
    names = [name for name, value in given.items() if value not in (None, False, [], "")]
    if names:
        raise typer.BadParameter(f"{', '.join(names)} would have no effect: {reason}", param_hint=names[0])


def _running() -> set[str]:
    """Return the names of the running simulations."""
    from simkit.bridges.live.discovery import simulations

    return {found.name for found in simulations()}


def _show_running(name: str, page: page_options.PageOptions) -> int:
    """Open the page of a running simulation, until the simulation ends or until Ctrl-C."""
    from simkit.live import LiveClosed, connect

    with connect(name) as client, Interrupts() as interrupts:
        page_options.show_address(client.ask("view"), opens=page.opens)
        try:
            while not interrupts.exit_code:
                client.spin(0.2)
        except LiveClosed:
            return 0
    return interrupts.exit_code
