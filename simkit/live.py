"""Access to a running simulation from other processes of the same user.

from simkit.live import connect
with connect() as client:
    client.advertise("/cmd_vel").publish({"linear": {"x": 0.2}})
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.bridges.live.client import Client, connect
from simkit.bridges.live.client_handles import LiveGoal, LivePublisher, LiveSubscription, Received
from simkit.bridges.live.client_servers import LiveAction, LiveInput, LiveParameter, LiveServerGoal, LiveService
from simkit.bridges.live.discovery import RunningSim, simulations
from simkit.bridges.live.protocol import LiveClosed, LiveError

if TYPE_CHECKING:
    from simkit.bridges.live.server import Server

__all__ = [
    "Client",
    "LiveAction",
    "LiveClosed",
    "LiveError",
    "LiveGoal",
    "LiveInput",
    "LiveParameter",
    "LivePublisher",
    "LiveServerGoal",
    "LiveService",
    "LiveSubscription",
    "Received",
    "RunningSim",
    "Server",
    "connect",
    "simulations",
]


if not TYPE_CHECKING:  # hidden from type checkers, so that they report unknown names

    def __getattr__(name: str) -> object:
        if name == "Server":  # imported lazily: a client does not need the modules of a simulation
            from simkit.bridges.live.server import Server

            return Server
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
