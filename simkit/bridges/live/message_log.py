"""Logs of published messages, one for each topic, in which each subscription of a client has a position.

A message is stored once, however many subscriptions its topic has. A client that reads nothing therefore costs nothing
for each message: its subscription loses the messages that the log no longer contains. Messages of other topics displace
none of them, unless all logs together are too large. Then the largest log loses messages.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, Protocol

MOST_BYTES: Final = 32 << 20
"""Memory of the queued messages of one topic [bytes]; a single message may be larger."""
MOST_TOTAL: Final = 256 << 20
"""Memory of the queued messages of all topics [bytes]."""
MOST_DEPTH: Final = 100_000
"""Largest number of queued messages for one subscription."""
_ENTRY_BYTES: Final = 200  # [bytes] of memory of a message besides its data
_FIRST_TRIM: Final = 1 << 20  # [bytes] in a log above which it is searched for messages that nobody needs any more


class LogClient(Protocol):
    """Protocol of the connection that subscriptions belong to.

    Attributes:
        is_stuck: True while the client reads nothing.
    """

    @property
    def is_stuck(self) -> bool:
        """True while the client reads nothing."""
        ...

    def activate(self, subscribed: ClientSubscription) -> None:
        """Queue a subscription that has new messages."""
        ...


Entry = tuple[int, int, str, bytes, LogClient | None]
"""Position in the order of publication over all topics, time [ns], type, CDR, and the bridge that published it."""


class LogMemory:
    """Memory that all logs of a server share.

    Attributes:
        total: size of all logs [bytes].
        count: number of messages so far.
        logs: all logs.
        publishing: bridge whose message is being published; the bridge does not receive this message.
    """

    def __init__(self) -> None:
        self.total = self.count = 0
        self.logs: dict[MessageLog, None] = {}
        self.publishing: LogClient | None = None

    def shrink(self) -> None:
        """Halve the largest log until all logs together are small enough. Halving keeps the search for it rare."""
        while self.total > MOST_TOTAL:
            largest = max(self.logs, key=lambda log: log.size)
            largest.drop_to(largest.size // 2)


class MessageLog:
    """Newest messages of a topic, at most as many as its deepest subscription may have queued.

    Attributes:
        entries: messages by their number in the log, from `begin` to `end` - 1.
        size: memory of the messages [bytes].
    """

    def __init__(self, memory: LogMemory) -> None:
        self._memory = memory
        self.entries: dict[int, Entry] = {}
        self.begin = self.end = self.size = 0
        self._readers: dict[ClientSubscription, None] = {}
        self._idle: dict[ClientSubscription, None] = {}  # subscriptions that have taken all messages
        self._depth, self._trim_size = 1, _FIRST_TRIM

    def add(self, reader: ClientSubscription, *, is_first: bool = False) -> None:
        """Add a subscription, which receives the messages from now on.

        Args:
            reader: subscription.
            is_first: True for the messages that a latched topic kept; another subscription sends them.
        """
        reader.log, reader.position = self, self.end
        self._readers[reader] = self._memory.logs[self] = None
        if not is_first:
            self._idle[reader] = None
        self._depth = max(self._depth, reader.depth)

    def remove(self, reader: ClientSubscription) -> None:
        """Remove a subscription. The log of the last one is emptied."""
        self._readers.pop(reader, None)
        self._idle.pop(reader, None)
        self._trim_size = 0  # the subscription may have been the one that needed the oldest messages
        if not self._readers:
            self.drop_to(0)
            self._memory.logs.pop(self, None)

    @property
    def has_readers(self) -> bool:
        return bool(self._readers)

    @property
    def is_read(self) -> bool:
        """True if a client with a subscription still reads."""
        return any(not reader.peer.is_stuck for reader in self._readers)

    def append(self, time_ns: int, type_name: str, data: bytes) -> None:
        """Add a message, and drop the oldest messages above the limits."""
        memory = self._memory
        memory.count += 1
        self.entries[self.end] = memory.count, time_ns, type_name, data, memory.publishing
        self.end += 1
        size = len(data) + _ENTRY_BYTES
        self.size += size
        memory.total += size
        if self._idle:
            idle, self._idle = self._idle, {}
            for reader in idle:
                reader.peer.activate(reader)
        if len(self.entries) > self._depth:
            self._drop_oldest()
        if self.size > self._trim_size:
            self._trim()
        while self.size > MOST_BYTES and len(self.entries) > 1:
            self._drop_oldest()
        if memory.total > MOST_TOTAL:
            memory.shrink()

    def count_lost(self) -> None:
        """Count a message that was dropped before it reached the log."""
        for reader in self._readers:
            reader.lost_before += 1

    def rest(self, reader: ClientSubscription) -> None:
        """Wait for the next message of a subscription that has taken all messages."""
        self._idle[reader] = None
        if len(self._idle) >= len(self._readers):
            self.drop_to(0)

    def drop_to(self, size: int) -> None:
        """Drop the oldest messages until the log has at most this size [bytes]."""
        if not size:
            self._memory.total -= self.size
            self.entries.clear()
            self.begin, self.size = self.end, 0
        while self.size > size:
            self._drop_oldest()

    def _drop_oldest(self) -> None:
        size = len(self.entries.pop(self.begin)[3]) + _ENTRY_BYTES
        self.begin += 1
        self.size -= size
        self._memory.total -= size

    def _trim(self) -> None:
        """Remove the messages that every subscription has taken. The next search is at twice the remaining size."""
        needed = min((reader.position for reader in self._readers), default=self.end)
        while self.begin < min(needed, self.end):
            self._drop_oldest()
        self._trim_size = max(_FIRST_TRIM, 2 * self.size)


class ClientSubscription:
    """Subscription of a client.

    Attributes:
        number: number that the client chose for the subscription.
        depth: highest number of queued messages.
        log: messages of the topic.
        position: number in the log of the next message for the client.
        credit: bytes that the subscription may still send in its turn.
        lost_before: number of dropped messages before `position`.
        first: subscription with the messages that a latched topic kept; they are sent before those of `log`.
    """

    __slots__ = ("credit", "depth", "first", "log", "lost_before", "number", "peer", "position", "topic")

    def __init__(self, peer: LogClient, number: int, topic: str, depth: int) -> None:
        self.peer, self.number, self.topic = peer, number, topic
        self.depth = max(1, min(depth, MOST_DEPTH))
        self.position = self.credit = self.lost_before = 0
        self.log: MessageLog | None = None
        self.first: ClientSubscription | None = None

    @property
    def lost(self) -> int:
        """Number of dropped messages."""
        self._skip_dropped()
        return self.lost_before + (self.first.lost if self.first is not None else 0)

    def take_entries(self) -> Iterator[Entry]:
        """Yield the queued messages, the oldest first. A message is removed when the next one is requested."""
        if self.first is not None:
            yield from self.first.take_entries()
            self._forget_first()
        log, peer = self.log, self.peer
        if log is None:
            return
        self._skip_dropped()
        while self.position < log.end:
            entry = log.entries[self.position]
            if entry[4] is not peer:
                yield entry
            self.position += 1

    def rest(self) -> None:
        """Wait for the next message, after all have been taken."""
        self.credit = 0
        if self.log is not None:
            self.log.rest(self)

    def close(self) -> None:
        """Release the queued messages."""
        self._forget_first()
        if self.log is not None:
            self._skip_dropped()
            self.log.remove(self)
            self.log = None

    def _forget_first(self) -> None:
        if self.first is not None:
            self.lost_before += self.first.lost
            self.first.close()
            self.first = None

    def _skip_dropped(self) -> None:
        """Go to the oldest message that is still available, and count those before it as dropped."""
        if self.log is not None:
            oldest = max(self.log.begin, self.log.end - self.depth)
            if self.position < oldest:
                self.lost_before += oldest - self.position
                self.position = oldest
