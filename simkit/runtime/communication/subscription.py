"""Who hears a topic, and what they keep of it."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from typing import Any, Final, Literal, Protocol

from simkit.runtime.communication.journal import JournalKeeper

Message = Any
"""A message: an instance of a class of `simkit.msgs`, which are made as definitions are read."""

Callback = Callable[[Message], object]
CallbackPolicy = Literal["stop", "drop"]

MAX_KEPT_MESSAGES: Final = 1_000_000
"""So many messages are kept by a subscription that says nothing of it; of more, the newest are."""

NO_MESSAGE = object()
"""What is given instead of a message that cannot be made."""


class PendingWork(Protocol):
    """Work of another thread."""

    @property
    def is_done(self) -> bool:
        """Whether its result is there."""


class LazyMessage:
    """A message that is made when somebody looks at it.

    Attributes:
        is_awaited: whether it will be looked at for all that is known: a reader keeps every message, or records it.
        work: what is being done on another thread that the message waits for; None where there is no such thing.
    """

    __slots__ = ("_make", "_message", "is_awaited", "work")

    def __init__(self, make: Callable[[], Message], is_awaited: bool = False, work: PendingWork | None = None) -> None:
        self.is_awaited, self.work = is_awaited, work
        self._make: Callable[[], Message] | None = make
        self._message: Message = None

    @property
    def is_ready(self) -> bool:
        """Whether `get` gives the message without waiting for another thread."""
        return self.work is None or self.work.is_done

    def get(self) -> Message:
        """The message; NOTHING where it turned out that there is none."""
        make = self._make
        if make is not None:
            # in this order, since two threads may ask at the same time: both are given the same message
            self._message = make()
            self._make = self.work = None
        return self._message


class SubscriptionFailures(Protocol):
    """What becomes of a subscription that fails."""

    def subscriber_failed(self, subscription: Subscription, error: Exception) -> None:
        """Called while an exception of its callback is being handled."""

    def report_full(self, topic: str) -> None:
        """Called when a subscription that keeps all has had more messages than it can keep."""


class SubscribingBus(JournalKeeper, Protocol):
    """What a subscription asks of the topic bus."""

    @property
    def failures(self) -> SubscriptionFailures:
        """What becomes of a subscription that fails."""

    def gather(self, topic: str) -> None:
        """Lets the publishers of a topic hand over what they have put off."""

    def unsubscribe(self, subscription: Subscription) -> None:
        """Takes a subscription away."""


class TopicReaders:
    """Who hears a topic.

    Attributes:
        readers: the subscriptions.
        receivers: what takes a message, one for each of them.
        is_called: whether one of them is called back with each message, and not only keeps it.
        looks_at_all: whether one of them will look at every message for all that is known.
        is_streamed: whether one of them takes each message as it comes, made or not.
        feeds: whether command inputs hear the topic.
    """

    __slots__ = ("feeds", "is_called", "is_streamed", "looks_at_all", "readers", "receivers")

    def __init__(self) -> None:
        self.readers: list[Subscription] = []
        self.receivers: tuple[Callback, ...] = ()
        self.is_called = self.is_streamed = self.looks_at_all = self.feeds = False

    def count(self) -> None:
        """After a change of the readers."""
        self.receivers = tuple(reader.receive for reader in self.readers)
        self.is_called = any(reader.is_called for reader in self.readers)
        self.is_streamed = any(type(reader) is StreamSubscription for reader in self.readers)
        self.looks_at_all = self.is_streamed or any(reader.keeps == math.inf for reader in self.readers)

    @property
    def keeps(self) -> float:
        """The most messages that one of the readers keeps; infinite where one keeps all."""
        return max((reader.keeps for reader in self.readers), default=0)


class Subscription:
    """What arrives on a topic.

    Attributes:
        messages: what arrived since the subscription: the last `keep`, or the last million where nothing is said.
        receive: takes a message.
        callback: called with each; None for nothing.
        on_error: what becomes of a callback that raises: "stop" stops the run, "drop" closes the subscription.
        is_called: whether it has a callback.
        keeps: the most messages that it keeps.
    """

    def __init__(
        self, bus: SubscribingBus, topic: str, callback: Callback | None, keep: int | None, on_error: CallbackPolicy
    ) -> None:
        self._bus, self.topic, self.callback, self.on_error = bus, topic, callback, on_error
        self._messages: deque[Message] = deque(maxlen=MAX_KEPT_MESSAGES if keep is None else keep)
        self.is_called, self.keeps = callback is not None, math.inf if keep is None else keep
        self.receive: Callback = self._messages.append if callback is None else self._keep_and_call

    @property
    def messages(self) -> list[Message]:
        self._bus.gather(self.topic)
        if len(self._messages) == MAX_KEPT_MESSAGES and self.keeps == math.inf:
            self._bus.failures.report_full(self.topic)
        found = [m.get() if type(m) is LazyMessage else m for m in self._messages]
        return [m for m in found if m is not NO_MESSAGE]

    @property
    def latest(self) -> Message:
        """The newest message, or None before the first."""
        self._bus.gather(self.topic)
        if not self._messages:
            return None
        newest = self._messages[-1]
        if type(newest) is LazyMessage:
            newest = newest.get()
        if newest is NO_MESSAGE:  # as if it had not been sent
            self._messages.pop()
            return self.latest
        return newest

    def settle(self) -> None:
        """Has every message made that is still to be made."""
        for message in self._messages:
            if type(message) is LazyMessage:
                message.get()

    def close(self) -> None:
        """Stops receiving; what was received stays."""
        self._bus.unsubscribe(self)

    def _keep_and_call(self, message: Message) -> None:
        self._messages.append(message)
        journal = self._bus.journal
        try:
            if journal is None:
                self.callback(message)  # type: ignore[misc]  # this is only used where there is one
            else:
                with journal.called_back(self):
                    self.callback(message)  # type: ignore[misc]  # as above
        except Exception as error:  # noqa: BLE001 - what a user wrote may raise anything
            self._bus.failures.subscriber_failed(self, error)

    def __deepcopy__(self, memo: dict[int, object]) -> Subscription:
        return self


class StreamSubscription(Subscription):
    """A subscription that only calls back and keeps nothing (a recorder's)."""

    def __init__(self, bus: SubscribingBus, topic: str, callback: Callback, takes_later: bool) -> None:
        super().__init__(bus, topic, callback, 0, "stop")
        self.receive = callback
        self.is_called = not takes_later


def callback_name(callback: Callback | None) -> str:
    """What a callback is called, and where it stands."""
    code = getattr(getattr(callback, "__func__", callback), "__code__", None)
    name = str(getattr(callback, "__qualname__", "") or type(callback).__name__)
    return f"{name!r} ({code.co_filename}:{code.co_firstlineno})" if code is not None else repr(name)
