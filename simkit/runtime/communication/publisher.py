"""The ends of a topic within the process: who publishes on it, and which inputs take commands from it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

from simkit import msgs
from simkit.runtime.communication.journal import JournalKeeper
from simkit.runtime.communication.subscription import Callback, LazyMessage, Message, PendingWork

if TYPE_CHECKING:
    from simkit.runtime.communication.command_queue import CommandQueue
    from simkit.runtime.communication.subscription import TopicReaders


class PublishingBus(JournalKeeper, Protocol):
    """What a publisher asks of the topic bus."""

    inbox: CommandQueue


class TopicSides(NamedTuple):
    """Readers and publishers of a topic, as they are at any time."""

    readers: TopicReaders
    publishers: list[Publisher]


class Publisher:
    """One end of a topic; `wanted` says whether somebody reads now.

    Attributes:
        last: the last message of a latched topic.
        pending: publishes what its owner has put off, before anybody looks; None where nothing is ever put off.
    """

    __slots__ = (
        "_bus",
        "_publishers",
        "_readers",
        "active",
        "last",
        "latched",
        "owner",
        "pending",
        "topic",
        "type_name",
    )

    def __init__(
        self, bus: PublishingBus, sides: TopicSides, topic: str, type_name: str, latched: bool, owner: object
    ) -> None:
        self._bus, self.topic, self.type_name, self.latched, self.owner = bus, topic, type_name, latched, owner
        self._readers, self._publishers = sides
        self.last: Message = None
        self.active = True
        self.pending: Callable[[], None] | None = None

    @property
    def wanted(self) -> bool:
        readers = self._readers
        return bool(readers.readers) or self.latched or readers.feeds

    @property
    def is_live(self) -> bool:
        """Whether somebody does something with each message at once."""
        readers = self._readers
        return readers.is_called or readers.feeds or self.latched

    @property
    def patience(self) -> float:
        """How many of the newest messages anybody will look at; 0 where nothing may be put off.

        That is where somebody is called back or counts what comes, and where others publish on the same topic.
        """
        readers = self._readers
        if self.is_live or readers.is_streamed or len(self._publishers) > 1:
            return 0
        return readers.keeps

    def publish(self, message: Message) -> None:
        """Hands a message to every subscriber, now, and to command inputs before the next step.

        Args:
            message: of the topic's type, or a dict of its fields.

        Raises:
            MessageError: a dict does not fit the topic's type.
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

    def publish_later(self, make: Callable[[], Message], work: PendingWork | None = None) -> LazyMessage | None:
        """Publishes what `make()` gives, made at once only where somebody is called back with it.

        On a latched topic that nobody reads it is made for the first one who does.

        Args:
            make: gives the message.
            work: what is being done on another thread that `make` waits for.

        Returns:
            What was handed out instead of the message; None where it was made.
        """
        if self.latched and not self._readers.readers and not self._readers.feeds:
            later = self.last = LazyMessage(make, work=work)
            return later
        if self.is_live:
            self.publish(make())
            return None
        later = LazyMessage(make, self._readers.looks_at_all, work)
        for receive in self._readers.receivers:
            receive(later)
        return later

    def __deepcopy__(self, memo: dict[int, object]) -> Publisher:
        return self


class ExternalPublisher(Publisher):
    """One that belongs to no plugin and no sensor: what it publishes comes in from outside."""

    __slots__ = ()

    def publish(self, message: Message) -> None:
        """As every publisher does; a journal hears of it."""
        journal = self._bus.journal
        if journal is None:
            super().publish(message)
            return
        if type(message) is dict:
            message = msgs.make(self.type_name, **message)
        with journal.passing("send", {"publisher": self, "message": message}):
            super().publish(message)

    def publish_later(self, make: Callable[[], Message], work: PendingWork | None = None) -> LazyMessage | None:
        """Publishes what `make()` gives; a journal has to have it now."""
        if self._bus.journal is None:
            return super().publish_later(make, work)
        self.publish(make())
        return None


class Listener:
    """A command input: its callback runs between two steps."""

    __slots__ = ("active", "callback", "owner", "topic", "types")

    def __init__(self, topic: str, types: Sequence[str], callback: Callback, owner: object) -> None:
        self.topic, self.types, self.callback, self.owner = topic, tuple(types), callback, owner
        self.active = True

    def __deepcopy__(self, memo: dict[int, object]) -> Listener:
        return self
