"""Command `simkit view`: show a world, a robot, a running simulation or a bag in a browser."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

from typer import Option

from simkit.cli.plot_sources import is_bag
from simkit.cli.run import execute
from simkit.cli.run_loop import Interrupts
from simkit.cli.run_options import RunDisplay, load_options
from simkit.cli.terminal import completion, options, page_options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import report_errors
from simkit.run_spec import GROUND, RunSpec

_PORT_HELP = "Port of the page on this machine; default: a free one."
Target = Annotated[
    str, argument("World or robot, name of a running simulation, or bag.", "WORLD|SIM|BAG|ROBOT", completion.worlds)
]
Port = Annotated[int, option(_PORT_HELP, "PORT", min=0, max=65535)]


@report_errors
def view(
    target: Target,
    port: Port = 0,
    host: page_options.Host = None,
    no_open: page_options.NoOpen = False,
    set_: options.Overrides = [],
    spawn: options.Spawns = [],
    model_world: options.ModelWorld = None,
    resource_path: options.ResourcePaths = [],
    package_path: options.PackagePaths = [],
    plugin_path: options.PluginPaths = [],
    xacro_arg: options.XacroArgs = [],
    base: options.Base = "auto",
    html: Annotated[Path | None, option("HTML file to write instead: a bag that plays without simkit.", "OUT")] = None,
    verbose: Annotated[bool, Option("--verbose", "-v", help="Show every note instead of their number.")] = False,
) -> int:
    """Show a world, a robot, a running simulation or a bag in a browser.

    A world and a robot are paused; a robot has a slider for each joint.
    """
    page = page_options.PageOptions(port, host or "127.0.0.1", not no_open)
    if is_bag(Path(target)) or html is not None:
        from simkit.cli.bag_view import show_bag

        loading = load_options(resource_path, package_path, xacro_arg, base, plugin_path)
        return show_bag(Path(target), model_world, loading, page, html)
    if not Path(target).exists() and target in _running():
        return _show_running(target, page)
    loading = load_options(resource_path, package_path, xacro_arg, base, plugin_path)
    spec = RunSpec(
        target,
        duration=math.inf,
        overrides=tuple(set_),
        spawn=tuple(spawn),
        model_world=model_world or GROUND,
        options=loading,
        pace=1.0,
        paused=True,
    )
    return execute(spec, RunDisplay(quiet=True, verbose=verbose, page=page))


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
