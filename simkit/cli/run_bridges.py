"""Bridges of a run: their start, and their check between slices."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

from simkit.cli.run_display import RunDisplay
from simkit.cli.run_loop import Interrupts, RunLoop
from simkit.cli.terminal.output import print_status

if TYPE_CHECKING:
    from simkit.bridges.bridge_process import BridgeProcess


@contextmanager
def open_bridges(display: RunDisplay) -> Iterator[list[BridgeProcess]]:
    """Yield the bridges that the options request, and end them. They are checked before the run, but not started.

    Raises:
        InputError: SK-ROS-001 there is no Python with rclpy; SK-WEB-001 a package for a server is missing.
    """
    found: list[BridgeProcess] = []
    if display.ros is not None:
        from simkit.bridges.ros.bridge_process import RosBridge

        found.append(RosBridge(display.ros, print_status))
    if display.web_servers:
        from simkit.bridges.web.web_process import WebBridge

        found += [WebBridge(options, print_status) for options in display.web_servers]
    with ExitStack() as stack:
        yield [stack.enter_context(bridge) for bridge in found]


def start_bridges(
    bridges: Sequence[BridgeProcess], loop: RunLoop, interrupts: Interrupts, watchers: list[Callable[[], object]]
) -> None:
    """Start the bridges and serve them until everything is open, so that they receive the first messages.

    Raises:
        InputError: SK-ROS-002 or SK-WEB-002 a bridge cannot start.
    """
    server = loop.server
    for bridge in bridges:
        if server is None:
            raise bridge.start_error("it needs local sockets, which this system lacks")
        bridge.start(server.path, server.poll, lambda: bool(interrupts.exit_code))
        watchers.append(bridge.check)
