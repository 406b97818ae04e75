"""Topics of a simulation in another process, as the graph of a program uses them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from simkit import msgs
from simkit.bridges.simulation_link import SimulationLink
from simkit.runtime.communication.subscription import LazyMessage
from simkit_nodes.simulation_topics import OutsideEndpoint

if TYPE_CHECKING:
    from simkit.live import LiveError
    from simkit.msgs import Message

_DEPTH = 1000
"""Largest number of messages of a topic that wait in the simulation."""

JsonRow = dict[str, Any]


class LivePublisher:
    """Publisher of a program on a topic of the simulation.

    Args:
        topics: topics of the simulation.
        number: number of the publisher on the connection.
        topic: absolute name of the topic.
        is_latched: True if later subscribers get the last message.

    Attributes:
        last_data: last message as CDR, for a latched topic; empty before it.
    """

    def __init__(self, topics: LiveTopics, number: int, topic: str, *, is_latched: bool) -> None:
        self._topics, self._number, self._is_latched = topics, number, is_latched
        self.topic = topic
        self.last_data = b""
        self._is_open: bool | None = None  # None until the simulation has answered
        self._is_closed = False
        self._waiting: list[bytes] = []

    @property
    def subscribers(self) -> int:
        """Number of subscriptions outside the program."""
        return len(self._topics.subscriptions(self.topic))

    def publish(self, message: Message) -> None:
        """Publish a message of simkit."""
        if self._is_closed:
            return
        data = msgs.serialize(message)
        if self._is_latched:
            self.last_data = bytes(data)
        if self._is_open is None:
            self._waiting.append(data)
        elif self._is_open:
            self._topics.link.publish(self._number, data)

    def open(self, _: object, __: bytes) -> None:
        """Send the messages that were published before the simulation has answered."""
        self._is_open = True
        for data in self._waiting:
            self._topics.link.publish(self._number, data)
        self._waiting.clear()
        if self._is_closed:
            self._topics.link.unadvertise(self._number)

    def refuse(self, error: LiveError) -> None:
        """Report that the topic has another type; its messages are dropped."""
        self._is_open = False
        self._waiting.clear()
        self._topics.report(f"a program publishes on {self.topic!r}, but {error}")

    def close(self) -> None:
        """Close the publisher; before the simulation has answered, it is closed after the waiting messages."""
        self._topics.remove(self)
        if self._is_open and not self._is_closed:
            self._topics.link.unadvertise(self._number)
        self._is_closed = True


class LiveTopics:
    """Topics of a simulation in another process.

    Args:
        link: connection to the simulation.
        report: function that reports a problem to the user.

    Attributes:
        link: connection to the simulation.
        rows: topics of the simulation by name, as in the answer to the request `graph`.
        node_names: names of all nodes.
        own_nodes: names of the nodes of this process.
    """

    def __init__(self, link: SimulationLink, report: Callable[[str], None]) -> None:
        self.link, self.report = link, report
        self.rows: dict[str, JsonRow] = {}
        self.node_names: list[str] = []
        self.own_nodes: list[str] = []
        self._publishers: list[LivePublisher] = []

    def open_node(self, name: str) -> None:
        """Add a node to the node lists of the simulation."""
        self.own_nodes.append(name)
        self.link.ask("open_node", {"name": name})

    def close_node(self, name: str) -> None:
        """Remove a node from the node lists of the simulation."""
        self.own_nodes.remove(name)
        self.link.ask("close_node", {"name": name})

    def advertise(self, node: str, topic: str, type_name: str, *, is_latched: bool) -> LivePublisher:
        """Open a topic for the messages of a program."""
        number = self.link.next_number()
        publisher = LivePublisher(self, number, topic, is_latched=is_latched)
        self._publishers.append(publisher)
        args = {"number": number, "topic": topic, "type": type_name, "latched": is_latched, "node": node}
        self.link.ask("advertise", args, then=publisher.open, failed=publisher.refuse)
        return publisher

    def remove(self, publisher: LivePublisher) -> None:
        """Forget a publisher that was closed."""
        if publisher in self._publishers:
            self._publishers.remove(publisher)

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

        The simulation does not return a message to its sender, except the last one of a latched topic.
        """
        number = self.link.next_number()

        def take(_: int, type_name: str, data: bytes, __: int) -> None:
            if takes_latched and any(data == own.last_data for own in self._publishers if own.topic == topic):
                return
            receive(LazyMessage(partial(_decode, type_name, data)))

        self.link.subscriptions[number] = take
        args = {"number": number, "topic": topic, "depth": _DEPTH, "node": node, "skips_latched": not takes_latched}
        self.link.ask("subscribe", args, failed=lambda error: self.report(str(error)))
        return partial(self.link.unsubscribe, number)

    # ------------------------------------------------------------------ questions

    def update(self, graph: JsonRow) -> None:
        """Store the topics and nodes of the simulation."""
        self.rows = {row["name"]: row for row in graph["topics"]}
        self.node_names = graph["nodes"]

    def topics(self) -> dict[str, str]:
        """Return the types by topic."""
        return {name: (row["types"] or [""])[0] for name, row in self.rows.items()}

    def publishers(self, topic: str) -> list[OutsideEndpoint]:
        """Return the publishers of the simulation and of other processes on a topic."""
        return [
            OutsideEndpoint(end["node"], end["type"], is_latched=end["latched"])
            for end in self.rows.get(topic, {}).get("publishers", ())
            if end["node"] not in self.own_nodes
        ]

    def subscriptions(self, topic: str) -> list[OutsideEndpoint]:
        """Return the subscriptions of the simulation and of other processes on a topic."""
        return [
            OutsideEndpoint(end["node"], (end["types"] or [""])[0])
            for end in self.rows.get(topic, {}).get("subscribers", ())
            if end["node"] not in self.own_nodes
        ]

    def nodes(self) -> list[str]:
        """Return the names of all nodes of the simulation."""
        return self.node_names


def _decode(type_name: str, data: bytes) -> Message:
    return msgs.deserialize(data, type_name)
