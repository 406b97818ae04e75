"""Run part `--foxglove` and `--rosbridge`: serve the run to clients of Foxglove and rosbridge."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, ClassVar, Final

from simkit import RunSpec
from simkit.cli.run_part import fill_in_value
from simkit.cli.run_verdict import RunVerdict
from simkit.cli.terminal.output import print_message
from simkit.extend import OpenRun, RunPart, option

if TYPE_CHECKING:
    from simkit_view.web.web_process import WebBridge, WebOptions

_ADDRESS: Final = re.compile(r"([^\s/:]+:|\[[0-9A-Fa-f:]+\]:)?\d+")

_FOXGLOVE_HELP = "Serve Foxglove on this port; default: 8765 of this machine."
_ROSBRIDGE_HELP = "Serve clients of rosbridge on this port; default: 9090 of this machine."


@dataclass
class WebServers(RunPart):
    """Servers that are clients of the run, each in a process of its own."""

    place: ClassVar[int] = 80

    foxglove: Annotated[str | None, option(_FOXGLOVE_HELP, "[[HOST:]PORT]")] = None
    rosbridge: Annotated[str | None, option(_ROSBRIDGE_HELP, "[[HOST:]PORT]")] = None
    servers: list[WebOptions] = field(init=False, default_factory=list)
    bridges: list[WebBridge] = field(init=False, default_factory=list)

    def __post_init__(self) -> None:
        """Read the addresses; an empty address is the default.

        Raises:
            InputError: SK-WEB-003 an address is invalid.
        """
        for kind, address in (("foxglove", self.foxglove), ("rosbridge", self.rosbridge)):
            if address is not None:
                from simkit_view.web.web_process import WebOptions

                self.servers.append(WebOptions.parse(kind, address))

    @classmethod
    def complete_words(cls, words: list[str]) -> list[str]:
        """Give an option without an address the default address."""
        for name in ("--foxglove", "--rosbridge"):
            words = fill_in_value(words, name, "", _ADDRESS.fullmatch)
        return words

    @contextmanager
    def around_run(self, spec: RunSpec, verdict: RunVerdict) -> Iterator[None]:
        """Check the servers, which are not started yet, and end them after the run.

        Raises:
            InputError: SK-WEB-001 a package for a server is missing.
        """
        with ExitStack() as stack:
            for options in self.servers:
                from simkit_view.web.web_process import WebBridge

                self.bridges.append(stack.enter_context(WebBridge(options, print_message)))
            yield

    @contextmanager
    def around_loop(self, run: OpenRun) -> Iterator[None]:
        """Start the servers.

        Raises:
            InputError: SK-WEB-002 a server cannot start.
        """
        for bridge in self.bridges:
            run.start_bridge(bridge)
        yield
