"""Publishers and subscriptions of programs, over the topics of the simulation."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

from simkit_nodes.qos import Policy, Qos
from simkit_nodes.simulation_topics import OutsidePublisher, read_message

if TYPE_CHECKING:
    from simkit.msgs import Message
    from simkit_nodes.graph import GraphNode

EventKind = Literal["matched", "unmatched", "incompatible_qos", "incompatible_type", "deadline"]
OnEvent = Callable[[EventKind, Policy | None], None]
"""Function that receives an event of a publisher or a subscription, and the policy that does not fit."""


@dataclass(frozen=True)
class Received:
    """Message in the queue of a subscription.

    Attributes:
        message: message of simkit, or one that is made when it is read.
        publisher: publisher of a program; None for one of the simulation.
        number: number of the message of its publisher: 1, 2, …
        source_ns: time at which the message was published [ns].
        received_ns: time at which the subscription received the message [ns].
    """

    message: Any
    publisher: GraphPublisher | None
    number: int
    source_ns: int
    received_ns: int


class GraphPublisher:
    """Publisher of a program; see `GraphNode.advertise`.

    Attributes:
        node: node that has opened it.
        topic: absolute name of the topic.
        type_name: ROS 2 type of its messages.
        qos: quality of service.
        is_open: False after `close`.
        is_discovered: True when other programs know it.
        gid: 16 numbers that distinguish it from all others.
    """

    def __init__(self, node: GraphNode, topic: str, type_name: str, qos: Qos, on_event: OnEvent | None) -> None:
        self.node, self.topic, self.type_name, self.qos = node, topic, type_name, qos
        self._graph, self._on_event = node.graph, on_event
        self.gid = self._graph.new_gid()
        self.is_open, self.is_discovered = True, False
        self.subscriptions: list[GraphSubscription] = []
        self._history: deque[Received] | None = deque(maxlen=qos.depth) if qos.is_transient_local else None
        self._outside: OutsidePublisher | None = None
        self._published = 0

    @property
    def matched(self) -> int:
        """Number of subscriptions to which messages go."""
        return len(self.subscriptions) + (0 if self._outside is None else self._outside.subscribers)

    @property
    def kept(self) -> list[Received]:
        """Messages for later subscriptions, the oldest first."""
        return [] if self._history is None else list(self._history)

    def publish(self, message: Message) -> None:
        """Publish a message of simkit; a closed publisher does nothing."""
        if not self.is_open:
            return
        self._published += 1
        if self._history is not None or self.subscriptions:
            now = self._graph.now_ns()
            received = Received(message, self, self._published, now, now)
            if self._history is not None:
                self._history.append(received)
            for subscription in tuple(self.subscriptions):
                subscription.receive(received)
        if self._outside is not None:
            self._graph.send_outside(self._outside, message)
        self._await_deadline()

    def discover(self) -> None:
        """Open the topic of the simulation, at the end of the discovery."""
        self._outside = self._graph.outside.advertise(
            self.node.name, self.topic, self.type_name, is_latched=self.qos.is_transient_local
        )
        if self._outside is None:
            self.tell("incompatible_type")
        else:
            for received in self.kept:
                self._graph.send_outside(self._outside, received.message)
        self._await_deadline()

    def _await_deadline(self) -> None:
        """Begin to wait for the next message; the first one has no deadline."""
        if self.qos.deadline_ns is not None and self._published:
            check = partial(self._check_deadline, self._published)
            self._graph.call_at(self._graph.now_ns() + self.qos.deadline_ns, check)

    def _check_deadline(self, published: int) -> None:
        if self.is_open and published == self._published:
            self.tell("deadline")
            self._await_deadline()

    def tell(self, kind: EventKind, policy: Policy | None = None) -> None:
        """Report an event to the program."""
        if self._on_event is not None:
            self._on_event(kind, policy)

    def close(self) -> None:
        """Close the publisher."""
        if self.is_open:
            self.is_open = False
            self._graph.remove_publisher(self)
            if self._outside is not None:
                self._outside.close()


class GraphSubscription:
    """Subscription of a program; see `GraphNode.subscribe`.

    Attributes:
        node: node that has opened it.
        topic: absolute name of the topic.
        type_name: ROS 2 type of its messages.
        qos: quality of service.
        is_open: False after `close`.
        is_discovered: True when other programs know it.
        gid: 16 numbers that distinguish it from all others.
        accepts: function that decides whether a message of the simulation is put into the queue, before it is made;
            None for all.
    """

    accepts: Callable[[], bool] | None = None

    def __init__(
        self,
        node: GraphNode,
        topic: str,
        type_name: str,
        qos: Qos,
        on_event: OnEvent | None,
        on_message: Callable[[], None] | None,
    ) -> None:
        self.node, self.topic, self.type_name, self.qos = node, topic, type_name, qos
        self._graph, self._on_event = node.graph, on_event
        self._on_message = on_message or self._graph.wake
        self.gid = self._graph.new_gid()
        self.is_open, self.is_discovered = True, False
        self.publishers: list[GraphPublisher] = []
        self._queue: deque[Received] = deque(maxlen=qos.depth)
        self._close_tap: Callable[[], None] | None = None
        self._count, self._last_due = 0, 0

    @property
    def matched(self) -> int:
        """Number of publishers from which messages come."""
        outside = self._graph.outside.publishers(self.topic) if self._close_tap is not None else ()
        return len(self.publishers) + len(outside)

    @property
    def has_message(self) -> bool:
        """True if a message waits."""
        queue = self._queue
        while queue and self._is_expired(queue[0]):
            queue.popleft()
        return bool(queue)

    def _is_expired(self, received: Received) -> bool:
        lifespan = self.qos.lifespan_ns  # as Fast DDS, which does not look at that of the publisher
        return lifespan is not None and self._graph.now_ns() - received.source_ns > lifespan

    def take(self) -> tuple[Message, Received] | None:
        """Return the oldest message that waits, and what is known about it; None without a message."""
        while self.has_message:
            received = self._queue.popleft()
            message = read_message(received.message, self.type_name)
            if message is not None:
                return message, received
        return None

    def wake_always(self) -> None:
        """Call `Host.wake` after each message, for a wait without an executor."""
        self._on_message = self._graph.wake

    def receive(self, received: Received) -> None:
        """Put a message into the queue, at once or after the latency of the program."""
        if self.accepts is not None and received.publisher is None and not self.accepts():
            return
        self._count += 1
        now = received.received_ns
        due = max(self._last_due, now + self._graph.latency_ns(self, self._count))
        if due > now:
            self._last_due = due
            received = Received(received.message, received.publisher, received.number, received.source_ns, due)
            self._graph.call_at(due, partial(self._put, received))
        else:
            self._put(received)

    def follow_jump(self, duration_ns: int) -> None:
        """Move the time at which the last message was due, after simulated time has jumped by a duration [ns]."""
        self._last_due += duration_ns

    def _put(self, received: Received) -> None:
        if self.is_open:
            self._queue.append(received)
            self._on_message()
            self._await_deadline()

    def discover(self) -> None:
        """Receive the topic of the simulation, at the end of the discovery."""
        self._close_tap = self._graph.outside.tap(
            self.node.name,
            self.topic,
            self.type_name,
            self._receive_outside,
            self._settle,
            takes_latched=self.qos.is_transient_local,
        )
        types = [end.type_name for end in self._graph.outside.publishers(self.topic)]
        if types and self.type_name not in types:
            self.tell("incompatible_type")
        self._await_deadline()

    def _settle(self) -> None:
        """Make the messages in the queue that are not made yet."""
        for received in self._queue:
            read_message(received.message, self.type_name)

    def _receive_outside(self, message: object) -> None:
        if message is self._graph.sent:  # a message of a program has come directly
            return
        is_earlier = self._close_tap is None  # the last message of a latched topic
        if is_earlier and not (self.qos.is_transient_local and self._graph.is_of_simulation(self.topic, message)):
            return
        now = self._graph.now_ns()
        self.receive(Received(message, None, 0, now, now))

    def _await_deadline(self) -> None:
        """Begin to wait for the next message; the first one has no deadline."""
        if self.qos.deadline_ns is not None and self._count:
            check = partial(self._check_deadline, self._count)
            self._graph.call_at(self._graph.now_ns() + self.qos.deadline_ns, check)

    def _check_deadline(self, count: int) -> None:
        if self.is_open and count == self._count:
            self.tell("deadline")
            self._await_deadline()

    def tell(self, kind: EventKind, policy: Policy | None = None) -> None:
        """Report an event to the program."""
        if self._on_event is not None:
            self._on_event(kind, policy)

    def close(self) -> None:
        """Close the subscription."""
        if self.is_open:
            self.is_open = False
            self._graph.remove_subscription(self)
            if self._close_tap is not None:
                self._close_tap()
