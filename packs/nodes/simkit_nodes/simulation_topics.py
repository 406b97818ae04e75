"""Topics of the simulation, as the graph of the programs uses them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from simkit import Publisher, Subscription, msgs
from simkit.errors import MessageError
from simkit.msgs.topic_names import absolute_name
from simkit.runtime.communication.node_names import node_of
from simkit.runtime.communication.publisher import Listener
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.msgs import Message


@dataclass(frozen=True)
class OutsideEndpoint:
    """Publisher or subscription that belongs to no program.

    Attributes:
        node: full name of its node.
        type_name: ROS 2 type; empty for a subscription that takes any type.
        is_latched: True if the publisher keeps its last message for later subscriptions.
    """

    node: str
    type_name: str
    is_latched: bool = False


class OutsidePublisher(Protocol):
    """Publisher on a topic of the simulation, for the messages of a program."""

    @property
    def subscribers(self) -> int:
        """Number of subscriptions outside the programs."""

    def publish(self, message: Message) -> None:
        """Publish a message of simkit."""

    def close(self) -> None:
        """Close the publisher."""


class OutsideTopics(Protocol):
    """Topics of a simulation, in this process or in another one."""

    def open_node(self, name: str) -> None:
        """Add a node to the node lists."""

    def close_node(self, name: str) -> None:
        """Remove a node from the node lists."""

    def advertise(self, node: str, topic: str, type_name: str, *, is_latched: bool) -> OutsidePublisher | None:
        """Open a topic for the messages of a program; return None if the topic has another type.

        Args:
            node: full name of the node.
            topic: absolute name of the topic.
            type_name: ROS 2 type.
            is_latched: True if later subscribers get the last messages.
        """

    def tap(
        self,
        node: str,
        topic: str,
        type_name: str,
        receive: Callable[[Message | LazyMessage], None],
        settle: Callable[[], None],
        *,
        takes_latched: bool,
    ) -> Callable[[], None]:
        """Receive a topic of the simulation; return the function that ends it.

        Args:
            node: full name of the node.
            topic: absolute name of the topic.
            type_name: ROS 2 type that the program expects.
            settle: function that makes the messages that wait for the program; called before their source data change.
            receive: function that receives each message, which `read_message` reads. If it is called before `tap`
                returns, the message is the last one of a latched topic.
            takes_latched: False if the last messages of a latched topic may be left out.
        """

    def topics(self) -> dict[str, str]:
        """Return the types by topic, without topics that nobody offers unless they have subscribers."""

    def publishers(self, topic: str) -> list[OutsideEndpoint]:
        """Return the publishers outside the programs on a topic."""

    def subscriptions(self, topic: str) -> list[OutsideEndpoint]:
        """Return the subscriptions outside the programs on a topic."""

    def nodes(self) -> list[str]:
        """Return the names of the nodes outside the programs."""


class BusPublisher:
    """Publisher on the topic bus for a publisher of a program.

    Args:
        topics: topic bus.
        publisher: publisher of the bus.
    """

    def __init__(self, topics: SimulationTopics, publisher: Publisher) -> None:
        self._topics, self._publisher = topics, publisher

    @property
    def subscribers(self) -> int:
        """Number of subscriptions of the simulation: plugins, scripts and recorders."""
        return self._publisher.subscribers - self._topics.count_taps(self._publisher.topic)

    def publish(self, message: Message) -> None:
        """Publish a message of simkit."""
        self._publisher.publish(message)

    def close(self) -> None:
        """Close the publisher."""
        self._topics.close_publisher(self._publisher)


class SimulationTopics:
    """Topic bus of a simulation.

    Args:
        sim: simulation.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._bus = sim.communication.bus
        self._taps: dict[str, list[Subscription]] = {}
        self._publishers: list[Publisher] = []

    def open_node(self, name: str) -> None:
        """Do nothing: the graph lists the nodes of programs."""

    def close_node(self, name: str) -> None:
        """Do nothing: the graph lists the nodes of programs."""

    def advertise(self, node: str, topic: str, type_name: str, *, is_latched: bool) -> BusPublisher | None:
        """Open a topic for the messages of a program; return None if the topic has another type."""
        try:
            publisher = self._sim.communication.advertise(topic, type_name, latched=is_latched)
        except MessageError as error:
            self._sim.engine.reports.warning("SK-NODE-010", f"a program publishes on {topic!r}, but {error}")
            return None
        publisher.node = node
        self._publishers.append(publisher)
        return BusPublisher(self, publisher)

    def close_publisher(self, publisher: Publisher) -> None:
        """Close a publisher of a program."""
        self._publishers.remove(publisher)
        publisher.close()

    def count_taps(self, topic: str) -> int:
        """Return the number of subscriptions of programs to a topic of the bus."""
        return len(self._taps.get(topic, ()))

    def tap(
        self,
        node: str,
        topic: str,
        type_name: str,
        receive: Callable[[Message | LazyMessage], None],
        settle: Callable[[], None],
        *,
        takes_latched: bool,
    ) -> Callable[[], None]:
        """Receive a topic of the simulation; return the function that ends it."""
        tap = self._bus.tap(topic, receive, takes_later=True, settle=settle)
        tap.node, tap.type_name = node, type_name
        taps = self._taps.setdefault(absolute_name(topic), [])
        taps.append(tap)

        def close() -> None:
            if tap in taps:
                taps.remove(tap)
                tap.close()

        return close

    def topics(self) -> dict[str, str]:
        """Return the types by topic, without topics that nobody offers unless they have subscribers."""
        return self._bus.topics()

    def publishers(self, topic: str) -> list[OutsideEndpoint]:
        """Return the publishers of plugins, sensors and scripts on a topic."""
        return [
            OutsideEndpoint(self._node_of(end), types[0], is_latched=end.latched)
            for _, end, types, _ in self._bus.endpoints(topic)
            if isinstance(end, Publisher) and end.active and end not in self._publishers
        ]

    def subscriptions(self, topic: str) -> list[OutsideEndpoint]:
        """Return the command inputs of plugins and the subscriptions of scripts on a topic."""
        inputs = [
            OutsideEndpoint(self._node_of(end), types[0])
            for _, end, types, _ in self._bus.endpoints(topic)
            if isinstance(end, Listener) and end.active
        ]
        taps = self._taps.get(topic, ())
        readers = [reader for reader in self._bus.subscriptions() if reader.topic == topic and reader not in taps]
        return inputs + [OutsideEndpoint("/script", "") for _ in readers]

    def nodes(self) -> list[str]:
        """Return the names of the nodes of plugins and sensors that publish or take topics."""
        names = [self._node_of(end) for _, end, _, _ in self._bus.endpoints() if end not in self._publishers]
        return list(dict.fromkeys(name for name in names if name))

    def _node_of(self, end: Publisher | Listener) -> str:
        return (node_of(end.owner) or "/simkit") if end.owner is not None else "/script"


def read_message(message: Message | LazyMessage, type_name: str) -> Message | None:
    """Return a received message; None if it cannot be made or has another type."""
    if isinstance(message, LazyMessage):
        message = message.get()
    if message is NO_MESSAGE or msgs.type_name(message) != type_name:
        return None
    return message
