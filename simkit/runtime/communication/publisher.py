"""Publishers of a topic, and listeners that receive its messages as commands."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, Generic, NamedTuple, Protocol

from simkit import msgs
from simkit.in_process import InProcess
from simkit.msgs import Message
from simkit.msgs.message_arguments import checked_message
from simkit.msgs.message_types import M
from simkit.number_text import counted
from simkit.runtime.communication.journal import JournalKeeper
from simkit.runtime.communication.subscription import Callback, LazyMessage, PendingWork

if TYPE_CHECKING:
    from simkit.runtime.communication.command_queue import CommandQueue
    from simkit.runtime.communication.subscription import TopicReaders
    from simkit.runtime.engine.scheduler import Timetable

ROSOUT: Final = "/rosout"
KEPT_LOG_MESSAGES: Final = 1000
"""Number of messages of each publisher of `/rosout` for later subscribers, as with ROS 2's QoS of the topic."""

Check = Callable[[], None]
"""Function that raises a SimkitError if an owner cannot make its messages on this machine."""


Tally = tuple[int, int, "Timetable | None"]
"""Number of messages since t = 0 of a publisher whose messages follow from the time alone, time [ns] of the newest,
and the ticks of the messages (None for every step). With no reader, it is the number that a reader would receive."""


class PublishingBus(JournalKeeper, Protocol):
    """Interface of the topic bus that a publisher needs."""

    inbox: CommandQueue

    def count_inputs(self, topic: str) -> int:
        """Return the number of command inputs of a topic."""

    def close(self, end: Publisher | Listener) -> None:
        """Remove a publisher or a listener permanently."""


class TopicSides(NamedTuple):
    """Present readers and publishers of a topic."""

    readers: TopicReaders
    publishers: list[Publisher]


class Publisher(InProcess, Generic[M]):
    """Publisher of a topic; `wanted` is true while the topic has subscribers.

    The type parameter is the class of the messages.

    Attributes:
        last: last message of a latched topic.
        history: messages for later subscribers of a latched topic, instead of the last one; None for the last one.
        pending: function that publishes the deferred messages of the owner; None if nothing is ever deferred.
        check: function that is called for every new reader; None if the owner can always make its messages.
        present: function that returns the message of the present state, for a reader that cannot wait for the next one;
            None if the owner has no such function. It changes nothing.
        tally: function that returns the number of messages, also while nobody reads them, or None if the messages
            must be received to be counted; None if the owner has no such function.
        node: name of the node of a program that publishes here; empty for any other publisher.
    """

    _internal_names = frozenset(
        (
            *("check", "disown", "history", "is_live", "is_only_streamed", "keep_history", "last", "owner"),
            *("patience", "pending", "present", "publish_later", "publish_packed", "send_kept", "tally"),
            "wanted",
        )
    )

    __slots__ = (
        "_bus",
        "_publishers",
        "_readers",
        "active",
        "check",
        "history",
        "last",
        "latched",
        "node",
        "owner",
        "pending",
        "present",
        "tally",
        "topic",
        "type_name",
    )

    def __init__(
        self,
        bus: PublishingBus,
        sides: TopicSides,
        topic: str,
        type_name: str,
        latched: bool,
        owner: object,
        check: Check | None = None,
        pending: Callable[[], None] | None = None,
    ) -> None:
        self._bus, self.topic, self.type_name, self.latched, self.owner = bus, topic, type_name, latched, owner
        self._readers, self._publishers = sides
        self.check, self.pending = check, pending
        self.last: Message = None
        self.history: deque[Message] | None = None
        self.active, self.node = True, ""
        self.present: Callable[[], Message] | None = None
        self.tally: Callable[[], Tally | None] | None = None

    @property
    def wanted(self) -> bool:
        readers = self._readers
        return bool(readers.readers) or self.latched or readers.feeds

    @property
    def subscribers(self) -> int:
        """Number of subscriptions and command inputs of the topic."""
        readers = self._readers
        active = len([reader for reader in readers.readers if reader.active])
        return active + (self._bus.count_inputs(self.topic) if readers.feeds else 0)

    def disown(self) -> None:
        """Belong to the simulation itself instead of a plugin, whose removal would disable the topic."""
        self.owner = None

    def keep_history(self, count: int) -> deque[Message]:
        """Keep the newest messages for later subscribers, instead of the last one; return the container."""
        self.history = deque(maxlen=count)
        return self.history

    def close(self) -> None:
        """Close the publisher permanently."""
        self._bus.close(self)

    @property
    def is_live(self) -> bool:
        """True if each message is used at once: by a callback, by a command input, or because the topic is latched."""
        readers = self._readers
        return readers.is_called or readers.feeds or self.latched

    @property
    def is_only_streamed(self) -> bool:
        """True if every subscription passes on each message, and none keeps messages."""
        return self._readers.is_streamed and not self._readers.keeps

    @property
    def patience(self) -> float:
        """Number of newest messages that the subscribers keep; 0 if the owner must publish each message at once.

        The owner may defer its messages if the number is not 0. Deferred messages older than this number are not
        needed. The number is 0 for a topic with a callback, a recorder, a counter, a command input or several
        publishers, and for a latched topic.
        """
        readers = self._readers
        if self.is_live or readers.is_streamed or len(self._publishers) > 1:
            return 0
        return readers.keeps

    def publish(self, message: M | Mapping[str, Any]) -> None:
        """Pass a message to every subscriber now, and to command inputs before the next step.

        Args:
            message: message of the topic's type, or a dict of its fields.

        Raises:
            MessageError: the dict does not fit the topic's type.
        """
        if type(message) is dict:
            message = msgs.make(self.type_name, **message)
        if self.latched:
            self.last = message
        readers = self._readers
        for receive in readers.receivers:
            receive(message)
        if readers.feeds:
            self._bus.inbox.put(self.topic, message)

    def publish_later(
        self, make: Callable[[], Message], work: PendingWork | None = None, *, can_wait: bool = True
    ) -> LazyMessage | None:
        """Publish the message that `make()` returns; `make` is called when the message is read.

        If a subscriber has a callback, the message is made at once. On a latched topic without subscribers, the message
        is made when the first subscriber reads it.

        Args:
            make: function that returns the message.
            work: work on another thread that `make` waits for.
            can_wait: False if `make` keeps so much memory that a recorder should call it at once.

        Returns:
            Placeholder of the message; None if the message was made at once.
        """
        if self.latched and not self._readers.readers and not self._readers.feeds:
            later = self.last = LazyMessage(make, work=work)
            return later
        if self.is_live:
            self.publish(make())
            return None
        later = LazyMessage(make, self._readers.looks_at_all, work, can_wait)
        for receive in self._readers.receivers:
            receive(later)
        return later

    def publish_packed(self, later: LazyMessage) -> None:
        """Pass on a message that nobody uses at once; see `LazyMessage.can_wait` and `is_live`."""
        for receive in self._readers.receivers:
            receive(later)

    def send_kept(self, receive: Callable[[Message], object], *, makes: bool = True) -> None:
        """Pass the last message of a latched topic, or its history, to a new subscriber.

        Args:
            receive: function that receives a message.
            makes: False for a subscriber that makes each message when it reads the message.
        """
        if self.history is None and isinstance(self.last, LazyMessage):
            if not makes:
                receive(self.last)
                return
            self.last = self.last.get()
        messages = (self.last,) if self.history is None else tuple(self.history)
        for message in messages:
            if message is not None:
                receive(message.get() if isinstance(message, LazyMessage) else message)

    def __repr__(self) -> str:
        heard = counted(self.subscribers, "subscriber")
        return f"<Publisher {self.topic!r} {self.type_name}, {heard}>"


class ExternalPublisher(Publisher[M]):
    """Publisher that belongs to no plugin or sensor; its messages are external inputs."""

    __slots__ = ()

    def __init__(
        self,
        bus: PublishingBus,
        sides: TopicSides,
        topic: str,
        type_name: str,
        latched: bool,
        owner: object,
        check: Check | None = None,
        pending: Callable[[], None] | None = None,
    ) -> None:
        super().__init__(bus, sides, topic, type_name, latched, owner, check, pending)
        if latched and topic == ROSOUT:
            self.keep_history(KEPT_LOG_MESSAGES)

    def publish(self, message: M | Mapping[str, Any]) -> None:
        """Publish a message, or a dict of its fields, and record it in the journal.

        Raises:
            MessageError: the message does not fit the topic's type.
        """
        message = checked_message(message, (self.type_name,), repr(self.topic))
        if self.history is not None:
            self.history.append(message)
        journal = self._bus.journal
        if journal is None:
            super().publish(message)
            return
        with journal.passing("send", {"publisher": self, "message": message}):
            super().publish(message)

    def publish_later(
        self, make: Callable[[], Message], work: PendingWork | None = None, *, can_wait: bool = True
    ) -> LazyMessage | None:
        """Publish the message that `make()` returns. If a journal is active, the message is made at once."""
        if self._bus.journal is None:
            return super().publish_later(make, work, can_wait=can_wait)
        self.publish(make())
        return None


class Listener(InProcess):
    """Command input; its callback is called between two steps.

    Attributes:
        last: last message, for the explanation of a divergence; None before the first one.
        is_ready: function that returns False while the owner ignores messages, for example an inactive controller; None
            if the owner always uses them.
    """

    _internal_names = frozenset({"is_ready", "last", "owner"})

    __slots__ = ("_bus", "active", "callback", "is_ready", "last", "owner", "topic", "types")

    def __init__(self, bus: PublishingBus, topic: str, types: Sequence[str], callback: Callback, owner: object) -> None:
        self._bus, self.topic, self.types, self.callback, self.owner = bus, topic, tuple(types), callback, owner
        self.active = True
        self.last: Message | None = None
        self.is_ready: Callable[[], bool] | None = None

    def close(self) -> None:
        """Close the command input permanently."""
        self._bus.close(self)

    def __repr__(self) -> str:
        return f"<Listener {self.topic!r} {' or '.join(self.types)}>"
