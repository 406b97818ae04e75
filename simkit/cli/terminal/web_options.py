"""Options of the servers for Foxglove and rosbridge."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Annotated, Final

from simkit.cli.terminal.options import option

if TYPE_CHECKING:
    from simkit.bridges.web.web_process import WebOptions

NAMES: Final = ("--foxglove", "--rosbridge")
ADDRESS: Final = re.compile(r"([^\s/:]+:|\[[0-9A-Fa-f:]+\]:)?\d+")
"""Value of an option, which a word after it must match."""

_FOXGLOVE_HELP = "Serve Foxglove on this port; default: 8765 of this machine."
_ROSBRIDGE_HELP = "Serve clients of rosbridge on this port; default: 9090 of this machine."
Foxglove = Annotated[str | None, option(_FOXGLOVE_HELP, "[[HOST:]PORT]")]
Rosbridge = Annotated[str | None, option(_ROSBRIDGE_HELP, "[[HOST:]PORT]")]


def web_options(**addresses: str | None) -> tuple[WebOptions, ...]:
    """Return the options of the servers that have an address; an empty address is the default.

    Raises:
        InputError: SK-WEB-003 an address is invalid.
    """
    if all(address is None for address in addresses.values()):
        return ()
    from simkit.bridges.web.web_process import WebOptions

    return tuple(WebOptions.parse(kind, address) for kind, address in addresses.items() if address is not None)
