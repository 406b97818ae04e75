"""Feeds of topics for the clients that subscribe to them. Every message is serialised once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.bridges.live.connection import ClientSubscription
from simkit.errors import MessageError
from simkit.msgs.message_types import Message
from simkit.recording.message_taps import MessageQueue, serialised
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage

if TYPE_CHECKING:
    from simkit.runtime.communication.subscription import Subscription
    from simkit.runtime.simulation import Simulation

_MOST_WAITING = 100  # largest number of messages of a topic that wait until an image is rendered


class TopicFeed:
    """Feed of one topic to all clients that subscribe to the topic."""

    def __init__(self, sim: Simulation, topic: str) -> None:
        self._sim, self.topic = sim, topic
        self._readers: list[ClientSubscription] = []
        # a message is serialised at once, even if it waits for an image, because its publisher may change it later
        self._queue = MessageQueue(self._deliver, _serialise_valid)
        self._tap: Subscription | None = None

    def add(self, reader: ClientSubscription) -> None:
        """Add a subscription. Only the new subscription receives the last message of a latched topic."""
        if self._tap is None:
            self._sim.communication.bus.check_available(self.topic)
            self._readers.append(reader)
            settle = self._queue.deliver_ready
            self._tap = self._sim.communication.bus.tap(self.topic, self._take, takes_later=True, settle=settle)
            return
        if self.topic in self._sim.communication.bus.latched():
            only = TopicFeed(self._sim, self.topic)
            only.add(reader)
            only.remove(reader)
        self._readers.append(reader)

    def remove(self, reader: ClientSubscription) -> None:
        """Remove a subscription."""
        if reader in self._readers:
            self._readers.remove(reader)
        if not self._readers and self._tap is not None:
            self._tap.close()
            self._tap = None
            self._queue.clear()

    @property
    def has_readers(self) -> bool:
        return bool(self._readers)

    def deliver_ready(self) -> None:
        """Deliver the messages that are ready, in order."""
        self._queue.deliver_ready()

    def _take(self, message: Message | LazyMessage) -> None:
        """Queue a message that was just published."""
        self._queue.add(self._sim.time_ns, message)
        if not isinstance(message, LazyMessage) or len(self._queue) > _MOST_WAITING:
            self._queue.deliver_ready()  # a bridge's own message does not go back to the bridge
        if len(self._queue) > _MOST_WAITING:
            self._queue.drop_oldest()
            for reader in self._readers:
                reader.lost += 1

    def _deliver(self, time_ns: int, content: tuple[str, bytes]) -> None:
        for reader in self._readers:
            if not reader.peer.is_publishing:
                reader.peer.queue_message(reader, time_ns, *content)


def _serialise_valid(message: object) -> object:
    """Return type and CDR of a message; `NO_MESSAGE` if it cannot be serialised: the feed drops an invalid message."""
    try:
        return serialised(message)
    except MessageError:
        return NO_MESSAGE


class TopicFeeds:
    """Feeds of all topics that clients subscribe to."""

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._feeds: dict[str, TopicFeed] = {}

    def add(self, reader: ClientSubscription) -> None:
        """Add a subscription to a topic."""
        feed = self._feeds.get(reader.topic)
        if feed is None:
            feed = TopicFeed(self._sim, reader.topic)
        feed.add(reader)
        self._feeds[reader.topic] = feed

    def remove(self, reader: ClientSubscription) -> None:
        """Remove a subscription."""
        feed = self._feeds.get(reader.topic)
        if feed is not None:
            feed.remove(reader)
            if not feed.has_readers:
                del self._feeds[reader.topic]

    def deliver_ready(self) -> None:
        """Deliver the messages that were not ready when they were published."""
        for feed in self._feeds.values():
            feed.deliver_ready()
