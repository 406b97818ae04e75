"""Feeds of topics for the clients that subscribe to them. Every message is serialised once."""

from __future__ import annotations

import contextlib
import time
from typing import TYPE_CHECKING, Any

from simkit import msgs
from simkit.bridges.live.message_log import MOST_DEPTH, ClientSubscription, LogMemory, MessageLog
from simkit.errors import MessageError
from simkit.msgs.message_types import Message
from simkit.recording.message_taps import MessageQueue
from simkit.runtime.communication.subscription import LazyMessage

if TYPE_CHECKING:
    from simkit.runtime.communication.subscription import Subscription
    from simkit.runtime.simulation import Simulation

_REVIEW_PERIOD = 0.5  # [s] of wall time between two searches for topics of images that nobody reads
_MOST_WAITING = 100  # largest number of messages of a topic that wait until an image is rendered


class TopicFeed:
    """Feed of one topic to all clients that subscribe to the topic.

    Args:
        sim: simulation of the topic.
        topic: name of the topic.
        memory: memory of the queued messages.
        common: queue of the messages of all topics that wait for no image. These messages keep their order, and many at
            a time are serialised faster.
    """

    def __init__(self, sim: Simulation, topic: str, memory: LogMemory, common: MessageQueue[TopicFeed]) -> None:
        self._sim, self.topic, self._memory, self._common = sim, topic, memory, common
        self.log, self._physics, self.time_of = MessageLog(memory), sim.engine.physics, sim.engine.clock.time_ns
        # a message is serialised at once, even if it waits for an image, because its publisher may change it later
        self._queue: MessageQueue[TopicFeed] = MessageQueue(_deliver, serialises=True, drops_invalid=True)
        self._tap: Subscription | None = None
        self._is_rendered = False  # True for images, whose rendering costs much more than anything else here

    def add(self, reader: ClientSubscription, *, takes_latched: bool = True) -> None:
        """Add a subscription.

        Args:
            reader: subscription.
            takes_latched: True if this subscription, and no other one, receives the last messages of a latched topic.
        """
        bus = self._sim.communication.bus
        if not self.has_readers:
            bus.check_available(self.topic)
            if takes_latched:
                self.log.add(reader)
            self._open_tap()
            if not takes_latched:
                self._common.deliver_ready()
                self.deliver_ready()
                self.log.drop_to(0)
        elif takes_latched and self.topic in bus.latched():
            self._add_latched(reader)
        if reader.log is None:
            self.log.add(reader)

    def _open_tap(self) -> None:
        settle = self._common.deliver_ready
        self._tap = self._sim.communication.bus.tap(self.topic, self._take, takes_later=True, settle=settle)

    def suspend_unread(self) -> None:
        """Render no images while all clients of the topic are stuck. Messages that are not made are not counted."""
        if not self._is_rendered or not self.has_readers:
            return
        is_read = self.log.is_read
        if is_read and self._tap is None:
            self._open_tap()
        elif not is_read and self._tap is not None:
            self._tap.close()
            self._tap = None

    def _add_latched(self, reader: ClientSubscription) -> None:
        """Queue the last messages of a latched topic for one subscription."""
        log = MessageLog(self._memory)
        first = ClientSubscription(reader.peer, reader.number, reader.topic, MOST_DEPTH)
        log.add(first, is_first=True)

        def keep(message: Message) -> None:
            with contextlib.suppress(MessageError):  # the feed drops an invalid message
                log.append(self._sim.time_ns, msgs.type_name(message), msgs.serialize(message))

        self._sim.communication.bus.tap(self.topic, keep).close()
        reader.first = first
        reader.peer.activate(reader)

    def remove(self, reader: ClientSubscription) -> None:
        """Remove a subscription."""
        reader.close()
        if not self.has_readers:
            if self._tap is not None:
                self._tap.close()
            self._tap = None
            self._queue.clear()

    @property
    def has_readers(self) -> bool:
        return self.log.has_readers

    def deliver_ready(self) -> None:
        """Deliver the messages that are ready, in order."""
        self._queue.deliver_ready()

    def _take(self, message: Message | LazyMessage) -> None:
        """Queue a message that was just published."""
        tick, is_lazy = self._physics.tick, isinstance(message, LazyMessage)
        if not self._queue and (not is_lazy or message.can_wait):
            self._common.add(self, tick, message)
            if not is_lazy:  # at once, because a bridge does not receive what it publishes at this moment
                self._common.deliver_ready()
            return
        if is_lazy and message.work is not None:
            self._is_rendered = True
        self._queue.add(self, tick, message)
        if len(self._queue) > _MOST_WAITING:
            self._queue.deliver_ready()
        if len(self._queue) > _MOST_WAITING:
            self._queue.drop_oldest()
            self.log.count_lost()


def _deliver(feeds: list[TopicFeed], ticks: list[int], contents: list[Any]) -> None:
    """Queue serialised messages, each a tuple of type and CDR, for all clients of their topics."""
    for feed, tick, (type_name, data) in zip(feeds, ticks, contents, strict=True):
        feed.log.append(feed.time_of(tick), type_name, data)


class TopicFeeds:
    """Feeds of all topics that clients subscribe to.

    Attributes:
        memory: memory of the queued messages.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim, self.memory = sim, LogMemory()
        self._feeds: dict[str, TopicFeed] = {}
        self._common: MessageQueue[TopicFeed] = MessageQueue(_deliver, serialises=True, drops_invalid=True)
        self._reviewed = 0.0

    def add(self, reader: ClientSubscription, *, takes_latched: bool = True) -> None:
        """Add a subscription to a topic; see `TopicFeed.add`."""
        feed = self._feeds.get(reader.topic)
        if feed is None:
            feed = TopicFeed(self._sim, reader.topic, self.memory, self._common)
        feed.add(reader, takes_latched=takes_latched)
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
        self._common.deliver_ready()
        now = time.monotonic()
        is_due = now - self._reviewed > _REVIEW_PERIOD
        self._reviewed = now if is_due else self._reviewed
        for feed in self._feeds.values():
            feed.deliver_ready()
            if is_due:
                feed.suspend_unread()
