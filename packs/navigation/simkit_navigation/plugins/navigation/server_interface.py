"""Interface of a server for the objects that do a part of its work."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from simkit import Publisher, Simulation, Subscription
    from simkit.msgs import Message
    from simkit.topic_logger import TopicLogger


class Node(Protocol):
    """Plugin of a server.

    Attributes:
        sim: simulation.
        log: logger of the plugin.
    """

    sim: Simulation
    log: TopicLogger

    def receive(self, topic: str, type_name: str, parameter: str, callback: Callable[[Message], None]) -> Subscription:
        """Receive the messages of a type on a topic; see `ServerPlugin.receive`."""

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> Publisher:
        """Open a publisher; see `Plugin.advertise`."""

    def offer(self, name: str, type_name: str, callback: Callable[[Any], object]) -> None:
        """Offer a service; see `Plugin.offer`."""
