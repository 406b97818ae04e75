"""Logger of a client, which prints as a ROS node does and whose messages also go to `/rosout` of the simulation."""

from __future__ import annotations

import logging
import sys
from contextlib import suppress
from typing import Final

from simkit.bridges.live.protocol import LiveError
from simkit.bridges.live.server_link import ServerLink

_LABELS: Final = {logging.WARNING: "WARN", logging.CRITICAL: "FATAL"}


class LiveLogger(logging.Logger):
    """Logger of a client; `setLevel("DEBUG")` also prints and publishes messages of the level DEBUG.

    Args:
        link: connection to the simulation.
        number: number of the publisher of `/rosout` on the connection.
        node: name of the client.
    """

    def __init__(self, link: ServerLink, number: int, node: str) -> None:
        super().__init__(node.strip("/").replace("/", "."), logging.INFO)
        self._link, self._number = link, number

    def isEnabledFor(self, level: int) -> bool:  # noqa: N802 - overrides logging.Logger, whose cache `setLevel` keeps
        """Check whether a message of this level is printed and published."""
        return not self.disabled and level >= self.level

    def handle(self, record: logging.LogRecord) -> None:
        """Print a message on standard error, and send it to the simulation."""
        text = record.getMessage()
        if record.exc_info:
            text = f"{text}\n{logging.Formatter().formatException(record.exc_info)}"
        label = _LABELS.get(record.levelno, record.levelname)
        sys.stderr.write(f"[{label}] [{record.created:.9f}] [{self.name}]: {text}\n")
        if not self._link.is_closed:
            place = {"file": record.pathname, "function": record.funcName or "", "line": record.lineno}
            words = {"number": self._number, "level": record.levelno, "text": text, **place}
            with suppress(LiveError):  # the simulation has ended
                self._link.post("log", words)
