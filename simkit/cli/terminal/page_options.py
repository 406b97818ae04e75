"""Options of the live view in a browser, and its opening."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Final, Protocol

import typer
from typer import Option

from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import print_status

if TYPE_CHECKING:
    from simkit.bridges.view.live_view import LiveView
    from simkit.bridges.view.streams import StreamMaker
    from simkit.runtime import Simulation

PORT: Final = re.compile(r"\d+")
"""Value of `--web`, which a word after it must match."""
_MOST_PORT: Final = 65535
_LOOPBACK: Final = "127.0.0.1"

_WEB_HELP = "Show the run in a browser, on this port of this machine; default: a free one."
_HOST_HELP = "Address of this machine that other machines reach, for --web; whoever has the page's address may drive."
Web = Annotated[int | None, option(_WEB_HELP, "[PORT]", min=0, max=_MOST_PORT)]
Host = Annotated[str | None, option(_HOST_HELP, "HOST")]
NoOpen = Annotated[bool, Option("--no-open", help="Print the address of the page and open no browser.")]


class ViewLoop(Protocol):
    """Protocol of the loop of a run.

    Attributes:
        view: live view of the run; None without one.
    """

    view: Any

    def show(self, view: LiveView) -> None:
        """Update a live view between slices."""


@dataclass(frozen=True)
class PageOptions:
    """Options of the live view.

    Attributes:
        port: port; 0 for a free one.
        host: address to bind to.
        opens: True to open a browser where there is a desktop.
    """

    port: int = 0
    host: str = _LOOPBACK
    opens: bool = True


def page_options(port: int | None, host: str | None, *, no_open: bool) -> PageOptions | None:
    """Return the options of the page; None without `--web`."""
    if port is None:
        if host is not None or no_open:
            raise typer.BadParameter("the option needs --web", param_hint="--host" if host is not None else "--no-open")
        return None
    return PageOptions(port, host or _LOOPBACK, not no_open)


def open_page(
    sim: Simulation,
    options: PageOptions,
    stack: ExitStack,
    recording: bytes = b"",
    streams: Mapping[str, StreamMaker] | None = None,
) -> LiveView:
    """Start the live view, print its address alone on a line, and open a browser; the stack closes the view.

    Args:
        sim: simulation to show.
        options: options of the page.
        stack: stack that closes the view.
        recording: packet of a recording that the page plays; empty for none.
        streams: makers of the recording's streams.

    Raises:
        InputError: SK-WEB-006 the address cannot be used.
    """
    from simkit.bridges.view.live_view import LiveView

    view = stack.enter_context(LiveView(sim, options.host, options.port, recording=recording, streams=streams))
    show_address(view.address, opens=options.opens and view.is_local)
    if not view.is_local:
        text = "other machines reach the page; whoever has its address may drive, spawn, reset and call services"
        print_status(f"warning SK-WEB-007: {text}; without --host only this machine reaches it")
    return view


def open_later(loop: ViewLoop, sim: Simulation, stack: ExitStack) -> str:
    """Return the address of the run's page, which is opened for this machine if the run has none yet."""
    if loop.view is None:
        from simkit.bridges.view.live_view import LiveView

        loop.show(stack.enter_context(LiveView(sim)))
    return str(loop.view.address)


def show_address(address: str, *, opens: bool) -> None:
    """Print the address of a page alone on a line, and open it in a browser where there is a desktop."""
    if sys.stdout is not None:
        sys.stdout.write(f"{address}\n")
        sys.stdout.flush()
    if opens and _has_desktop():
        from simkit.cli.terminal.browser import open_browser

        open_browser(address)


def _has_desktop() -> bool:
    """Check whether a browser window can open."""
    return sys.platform in ("win32", "darwin") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
