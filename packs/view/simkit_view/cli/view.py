"""Show a world, a robot, a running simulation or a bag in a browser."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from typer import Option

from simkit import progress
from simkit.cli.plot_sources import is_bag
from simkit.cli.run import execute
from simkit.cli.run_loop import Interrupts
from simkit.cli.run_options import NONE_GIVEN
from simkit.cli.run_part import run_parts
from simkit.cli.terminal import completion
from simkit.cli.terminal.output import print_line, print_status
from simkit.extend import GivenOptions, add_to_report, argument, option, report_errors, with_run_options
from simkit.run_spec import LoadOptions
from simkit.writers.atomic_output import check_writable, write_atomically
from simkit_view.cli.run_parts.page import Host, NoOpen, PageOptions, open_page, show_address

_POLL = 0.05  # [s] of wall time between two looks at Ctrl-C
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
    host: Host = None,
    no_open: NoOpen = False,
    given: GivenOptions = NONE_GIVEN,
    html: Annotated[Path | None, option("HTML file to write instead: a bag that plays without simkit.", "OUT")] = None,
    verbose: Annotated[bool, Option("--verbose", "-v", help="Show every note instead of their number.")] = False,
    json_: Annotated[bool, Option("--json", help="Print JSON.")] = False,  # noqa: ARG001 (`report_errors` reads it)
) -> int:
    """Show a world, a robot, a running simulation or a bag in a browser.

    A world and a robot are paused; a robot has a slider for each joint.
    """
    page = PageOptions.of(port, host, no_open=no_open)
    server: dict[str, object] = {"--port": port, "--host": host}
    if html is not None:
        _refuse({**server, "--no-open": no_open}, "no page is served with --html; open the file")
    if is_bag(Path(target)) or html is not None:
        loading = given.load_options()
        others = dict.fromkeys(given.names(excluded=("model_world", *loading)), True)
        _refuse(others, "a bag plays as it was recorded; --world WORLD names its world")
        return _show_bag(Path(target), given.values.get("model_world"), loading, page, html)
    if not Path(target).exists() and target in _running():
        text = f"{target} runs already; start it with these options, such as `simkit run WORLD --web PORT`"
        _refuse(server | dict.fromkeys(given.names(), True), text)
        print_status(f"note: the page shows {target}, which runs already; `simkit run WORLD --web` starts another run")
        return _show_running(target, page)
    spec = replace(given.run_spec(target, duration=math.inf), pace=1.0, paused=True)
    parts = run_parts(web=page.port, host=host, no_open=no_open)
    return execute(spec, parts, verbose=verbose, quiet=True)


def _refuse(options: Mapping[str, object], reason: str) -> None:
    """Raise a usage error if options are given that would have no effect."""
    names = [name for name, value in options.items() if value not in (None, False, [], "")]
    if names:
        raise typer.BadParameter(f"{', '.join(names)} would have no effect: {reason}", param_hint=names[0])


def _running() -> set[str]:
    """Return the names of the running simulations."""
    from simkit.bridges.live.discovery import simulations

    return {simulation.name for simulation in simulations()}


def _show_running(name: str, page: PageOptions) -> int:
    """Open the page of a running simulation, until the simulation ends or until Ctrl-C."""
    from simkit.live import LiveClosed, connect

    with connect(name) as client, Interrupts() as interrupts:
        show_address(client.ask("view"), opens=page.opens)
        try:
            while not interrupts.exit_code:
                client.spin(0.2)
        except LiveClosed:
            return 0
    return interrupts.exit_code


def _show_bag(path: Path, world: str | None, loading: LoadOptions, page: PageOptions, html: Path | None) -> int:
    """Serve a page that plays a bag until Ctrl-C, or write it to an HTML file; return the exit code.

    Args:
        path: bag.
        world: world of the bag; None if it is unknown, then a mark shows the robot.
        loading: load options of the world.
        page: options of the page.
        html: file to write; None for a page.

    Raises:
        InputError: the bag cannot be read, or the file cannot be written.
        LoadError: the world has errors.
    """
    from simkit import load
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit_view.view.bag_panels import BagPanels
    from simkit_view.view.bag_recording import MARKER, make_recording
    from simkit_view.view.html_file import html_file
    from simkit_view.view.scene_packet import make_scene_packet

    if html is not None:
        check_writable(html)
    with ExitStack() as stack:
        bag = stack.enter_context(open_bag_to_read(path))
        if world is None:
            print_status("note: a bag does not name its world; --world WORLD shows the robot and its surroundings")
        sim = stack.enter_context(load(MARKER.format(name="bag")) if world is None else load(world, **loading))
        recording, panels = make_recording(sim, bag), BagPanels(bag, sim)
        if html is not None:
            scene = make_scene_packet(sim, 1, {"seed": sim.seed, "recording": True})
            with progress.task(f"writing {html.name}"):
                page_text = html_file(f"{path.name} – simkit", scene, recording, panels.file_packet())
                write_atomically(html, page_text.encode())
            add_to_report(html=str(html), bytes=html.stat().st_size)
            print_line(f"wrote {html} ({html.stat().st_size / 1e6:.2f} MB)")
            return 0
        interrupts = stack.enter_context(Interrupts())
        view = open_page(sim, page, stack, recording, panels.streams)
        show_address(view.address, opens=page.opens and view.is_local)
        while not interrupts.exit_code:
            view.update()
            time.sleep(_POLL)
    return interrupts.exit_code
