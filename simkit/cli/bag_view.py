"""Show a bag in a browser, or write it as one HTML file."""

from __future__ import annotations

import time
from contextlib import ExitStack
from pathlib import Path

from simkit.cli.run_loop import Interrupts
from simkit.cli.terminal import page_options
from simkit.cli.terminal.output import print_line, print_status
from simkit.run_spec import LoadOptions
from simkit.writers.atomic_output import check_writable, write_atomically

_POLL = 0.05  # [s] of wall time between two looks at Ctrl-C


def show_bag(
    path: Path, world: str | None, loading: LoadOptions, page: page_options.PageOptions, html: Path | None
) -> int:
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
    from simkit.bridges.view.bag_panels import BagPanels
    from simkit.bridges.view.bag_recording import MARKER, make_recording
    from simkit.bridges.view.html_file import html_file
    from simkit.bridges.view.scene_packet import make_scene_packet
    from simkit.build import load
    from simkit.recording.bags.reader import open_bag_to_read

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
            write_atomically(html, html_file(f"{path.name} – simkit", scene, recording, panels.file_packet()).encode())
            print_line(f"wrote {html} ({html.stat().st_size / 1e6:.2f} MB)")
            return 0
        interrupts = stack.enter_context(Interrupts())
        view = page_options.open_page(sim, page, stack, recording, panels.streams)
        while not interrupts.exit_code:
            view.update()
            time.sleep(_POLL)
    return interrupts.exit_code
