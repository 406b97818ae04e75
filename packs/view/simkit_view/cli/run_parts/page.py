"""Run part `--web`: show the run in a browser, and options of the page that `simkit view` shares."""

from __future__ import annotations

import atexit
import html
import os
import re
import sys
import tempfile
import threading
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar, Final

import typer

from simkit.cli.run_part import fill_in_value
from simkit.cli.terminal.output import print_message
from simkit.extend import OpenRun, RunPart, add_to_report, option

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit_view.view.live_view import LiveView
    from simkit_view.view.streams import StreamMaker

_PORT: Final = re.compile(r"\d+")
_MOST_PORT: Final = 65535
_LOOPBACK: Final = "127.0.0.1"
_REDIRECT_LIFE: Final = 60.0  # [s] for which the file that leads a browser to the page exists

_WEB_HELP = "Show the run in a browser, on this port of this machine; default: a free one."
_HOST_HELP = "Address of this machine that other machines reach, for --web; whoever has the page's address may drive."
Host = Annotated[str | None, option(_HOST_HELP, "HOST")]
NoOpen = Annotated[bool, option("Print the address of the page and open no browser.", None, "--no-open")]


@dataclass(frozen=True)
class PageOptions:
    """Options of the live view.

    Attributes:
        port: port; 0 for a free one.
        host: address to bind to.
        opens: True to open a browser where there is a desktop.
    """

    port: int
    host: str
    opens: bool

    @classmethod
    def of(cls, port: int | None, host: str | None, *, no_open: bool) -> PageOptions:
        """Return the options of a command line; without a port any free one, without a host this machine alone."""
        return cls(port or 0, host or _LOOPBACK, not no_open)


@dataclass
class WebPage(RunPart):
    """Live view, from the start of the run or as soon as another process asks for it."""

    place: ClassVar[int] = 90

    web: Annotated[int | None, option(_WEB_HELP, "[PORT]", min=0, max=_MOST_PORT)] = None
    host: Host = None
    no_open: NoOpen = False
    page: PageOptions | None = field(init=False, default=None)
    view: LiveView | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        """Read the options of the page, which need --web."""
        if self.web is not None:
            self.page = PageOptions.of(self.web, self.host, no_open=self.no_open)
        elif self.host is not None or self.no_open:
            name = "--no-open" if self.host is None else "--host"
            raise typer.BadParameter("the option needs --web", param_hint=name)

    @classmethod
    def complete_words(cls, words: list[str]) -> list[str]:
        """Give --web without a port any free port."""
        return fill_in_value(words, "--web", "0", _PORT.fullmatch)

    @property
    def is_watched(self) -> bool:
        """True with a page."""
        return self.page is not None

    @contextmanager
    def around_loop(self, run: OpenRun) -> Iterator[None]:
        """Open the page, now or later.

        Raises:
            InputError: SK-WEB-006 the address cannot be used.
        """
        with ExitStack() as stack:
            if self.page is not None:
                view = open_page(run.sim, self.page, stack)
                self._show(run, view)
                run.status_lines.append(view.address)
                if self.page.opens and view.is_local:
                    open_in_browser(view.address)
            if run.loop.server is not None:
                run.loop.server.open_view = lambda: self._address(run, stack)
            yield

    def _show(self, run: OpenRun, view: LiveView) -> None:
        """Update a live view between slices, and send the commands of its pages at their ticks."""
        self.view = view
        run.loop.resumers.insert(0, "the page")
        run.loop.pollers.append(view.update)
        run.loop.senders.append(view.driving)
        run.loop.slice_limits.append(view.slices)

    def _address(self, run: OpenRun, stack: ExitStack) -> str:
        """Return the address of the run's page, which is opened for this machine if the run has none yet."""
        if self.view is None:
            from simkit_view.view.live_view import LiveView

            self._show(run, stack.enter_context(LiveView(run.sim)))
        assert self.view is not None
        return self.view.address


def open_page(
    sim: Simulation,
    options: PageOptions,
    stack: ExitStack,
    recording: bytes = b"",
    streams: Mapping[str, StreamMaker] | None = None,
) -> LiveView:
    """Start the live view, with a warning if other machines reach it; the stack closes the view.

    Args:
        sim: simulation to show.
        options: options of the page.
        stack: stack that closes the view.
        recording: packet of a recording that the page plays; empty for none.
        streams: makers of the recording's streams.

    Raises:
        InputError: SK-WEB-006 the address cannot be used.
    """
    from simkit_view.view.live_view import LiveView

    view = stack.enter_context(LiveView(sim, options.host, options.port, recording=recording, streams=streams))
    if not view.is_local:
        text = "other machines reach the page; whoever has its address may drive, spawn, reset and call services"
        print_message(f"warning SK-WEB-007: {text}; without --host only this machine reaches it")
    return view


def show_address(address: str, *, opens: bool) -> None:
    """Print the address of a page alone on a line, and open it in a browser where there is a desktop."""
    add_to_report(address=address)
    if sys.stdout is not None:
        sys.stdout.write(f"{address}\n")
        sys.stdout.flush()
    if opens:
        open_in_browser(address)


def _has_desktop() -> bool:
    """Check whether a browser window can open."""
    return sys.platform in ("win32", "darwin") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def open_in_browser(address: str) -> None:
    """Open a page in a browser if this machine has a desktop, by a file that only this user can read.

    Every user of the machine can read the arguments of a program, so the address with its token must not be one. The
    file is removed soon.
    """
    if not _has_desktop():
        return
    import webbrowser

    text = f'<!doctype html><meta http-equiv="refresh" content="0; url={html.escape(address)}"><title>simkit</title>'
    with tempfile.NamedTemporaryFile("w", prefix="simkit-", suffix=".html", delete=False) as file:  # its mode is 0600
        file.write(text)
    path = Path(file.name)

    def remove() -> None:
        with suppress(OSError):
            path.unlink()

    atexit.register(remove)
    timer = threading.Timer(_REDIRECT_LIFE, remove)
    timer.daemon = True
    timer.start()
    with suppress(webbrowser.Error):
        webbrowser.open(path.as_uri())
