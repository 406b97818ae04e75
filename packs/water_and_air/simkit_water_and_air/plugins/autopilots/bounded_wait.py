"""Waits for sockets that end: at a time limit, or as soon as the user asks the run to stop."""

from __future__ import annotations

import os
import selectors
import socket
import time
from collections.abc import Sequence
from typing import Final

from simkit import Params
from simkit.extend import Options, number
from simkit.interrupts import stop_requests

ADDRESS_VARIABLE: Final = "SIMKIT_AUTOPILOT_ADDRESS"
"""Environment variable with the address at which simkit listens for autopilots."""

LOOPBACK: Final = "127.0.0.1"

# `select` fails in a process with more than 1024 open files; Windows has nothing else
_Selector: Final = getattr(selectors, "PollSelector", selectors.SelectSelector)
_SLICE: Final = 0.1  # [s] between two looks whether the user has asked for a stop


class ConnectionOptions(Options):
    """Options of simkit for the connection to an autopilot; elements of the namespace `simkit`."""

    peer_timeout: float = number(
        5.0, "s", minimum=0.0, maximum=3600.0, description="longest wait for an autopilot in lock-step, in wall time"
    )
    connection_wait: float = number(
        0.0, "s", minimum=0.0, maximum=3600.0, description="longest wait for the first packet, in wall time"
    )


class WaitLimit:
    """Limit of a wait.

    Args:
        seconds: longest wait in wall time [s].
        stops_before: number of requests to stop a run when the connection was made; a later request ends the wait.

    Attributes:
        is_stopped: True if the user asked the run to stop.
    """

    def __init__(self, seconds: float, stops_before: int) -> None:
        self._end = time.monotonic() + seconds
        self._stops_before = stops_before
        self.is_stopped = False

    def wait(self, sockets: Sequence[socket.socket]) -> list[socket.socket]:
        """Wait until a socket has data, and return the sockets with data; empty at the end of the wait."""
        while True:
            self.is_stopped = stop_requests() != self._stops_before
            left = 0.0 if self.is_stopped else self._end - time.monotonic()
            ready = _with_data(sockets, max(0.0, min(left, _SLICE)))
            if ready or left <= _SLICE:
                return ready

    @property
    def is_over(self) -> bool:
        """True at the end of the wait."""
        return self.is_stopped or time.monotonic() >= self._end


def _with_data(sockets: Sequence[socket.socket], seconds: float) -> list[socket.socket]:
    with _Selector() as selector:
        for connection in sockets:
            selector.register(connection, selectors.EVENT_READ, connection)
        return [key.data for key, _ in selector.select(seconds)]


def listen_address(written: str, params: Params, element: str) -> str:
    """Return the address at which to listen: loopback, or the one that the user sets in the environment.

    A file from a stranger must not open a port to other machines, so an address in a file has no effect.

    Args:
        written: address in the file.
        params: parameters of the plugin.
        element: name of the element with the address.
    """
    chosen = os.environ.get(ADDRESS_VARIABLE, "").strip()
    if chosen:
        return chosen
    if written.strip() not in ("", "localhost", "INADDR_ANY") and not written.strip().startswith("127."):
        message = f"<{element}>{written}</{element}> has no effect: simkit listens at {LOOPBACK}"
        hint = f"to listen at another address, set the environment variable {ADDRESS_VARIABLE}"
        params.child_or_self(element).warning("SK-PILOT-001", message, hint)
    return LOOPBACK
