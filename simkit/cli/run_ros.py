"""Bridge to ROS 2 of a run: its start, and its check between slices."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING

from simkit.cli.run_loop import Interrupts, RunLoop
from simkit.cli.run_options import RunDisplay
from simkit.cli.terminal.output import print_status
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.bridges.ros.bridge_process import RosBridge


def open_bridge(display: RunDisplay) -> AbstractContextManager[RosBridge | None]:
    """Return the bridge to ROS 2 that the options request. It is not started, but its Python is found before the run.

    Raises:
        InputError: SK-ROS-001 there is no Python with rclpy.
    """
    if display.ros is None:
        return nullcontext()
    from simkit.bridges.ros.bridge_process import RosBridge

    return RosBridge(display.ros, print_status)


def start_bridge(
    bridge: RosBridge | None, loop: RunLoop, interrupts: Interrupts, watchers: list[Callable[[], object]]
) -> None:
    """Start the bridge to ROS 2 and serve it until everything is open, so that ROS receives the first messages.

    Raises:
        InputError: SK-ROS-002 the bridge cannot start.
    """
    if bridge is None:
        return
    server = loop.server
    if server is None:
        raise InputError("SK-ROS-002 the bridge to ROS 2 needs local sockets, which this system lacks", "SK-ROS-002")
    bridge.start(server.path, server.poll, lambda: bool(interrupts.exit_code))
    watchers.append(bridge.check)
