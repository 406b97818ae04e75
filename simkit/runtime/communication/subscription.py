"""Subscriptions of a topic and the messages that they keep."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, Generic, Literal, Protocol

from simkit import msgs
from simkit.errors import (
    InputError,
    PluginError,
    SimkitError,
    SimulationDiverged,
    SubscriberError,
    callback_name,
    cause_text,
)
from simkit.in_process import InProcess
from simkit.msgs import Message
from simkit.msgs.cdr_template import PACKERS
from simkit.msgs.data_frames import DataFrame, to_dataframe
from simkit.msgs.message_types import M
from simkit.number_text import counted
from simkit.runtime.communication.journal import JournalKeeper
from simkit.runtime.engine.plugin_faults import is_guarded

if TYPE_CHECKING:
    from simkit.diagnostics import Diagnostics


Callback = Callable[[Message], object]
CallbackPolicy = Literal["stop", "drop"]
Settle = Callable[[], None] | None
"""Function that makes the messages that a reader has stored; None if it stores none."""

MAX_KEPT_MESSAGES: Final = 1_000_000
"""Number of newest messages that a subscription without `keep` keeps."""

NO_MESSAGE = object()
"""Result of `LazyMessage.get` if the message cannot be made."""


class PendingWork(Protocol):
    """Work of another thread."""

    @property
    def is_done(self) -> bool:
        """True if the result is available."""


class LazyMessage:
    """Message that is made when it is read.

    Attributes:
        is_awaited: True if a reader keeps or records every message, so that the message will be read.
        work: work on another thread that must end before the message can be made; None if there is none.
        can_wait: True if the source data are so small that many messages may be kept. A reader of bytes should then
            serialise many messages at a time, which is several times faster than one at a time between two steps.
    """

    __slots__ = ("_make", "_message", "can_wait", "is_awaited", "work")

    def __init__(
        self,
        make: Callable[[], Message],
        is_awaited: bool = False,
        work: PendingWork | None = None,
        can_wait: bool = True,
    ) -> None:
        self.is_awaited, self.work, self.can_wait = is_awaited, work, can_wait and work is None
        self._make: Callable[[], Message] | None = make
        self._message: Message = None

    @property
    def is_ready(self) -> bool:
        """True if `get` returns the message without waiting for another thread."""
        return self.work is None or self.work.is_done

    def get(self) -> Message:
        """Return the message; NO_MESSAGE if it cannot be made."""
        make = self._make
        if make is not None:
            # in this order, because two threads may read at the same time: both get a message
            self._message = make()
            self._make = self.work = None
        return self._message

    def serialised(self) -> object:
        """Return the message's type and CDR; NO_MESSAGE if it cannot be made."""
        make = self._make
        pack = PACKERS.get(getattr(make, "func", None))
        if pack is not None:
            return pack(*make.args, **make.keywords)  # type: ignore[union-attr]  # a `functools.partial`
        message = self.get()
        return message if message is NO_MESSAGE else (msgs.type_name(message), msgs.serialize(message))


class SubscribingBus(JournalKeeper, Protocol):
    """Interface of the topic bus that a subscription needs."""

    @property
    def failures(self) -> TopicFailures:
        """Handling of a failed subscription."""

    def gather(self, topic: str) -> None:
        """Publish the deferred messages of a topic."""

    def unsubscribe(self, subscription: Subscription) -> None:
        """Remove a subscription."""


class TopicReaders:
    """Subscriptions and command inputs of a topic.

    Attributes:
        readers: subscriptions.
        receivers: functions that receive a message, one for each subscription.
        is_called: True if a subscription calls a function with each message.
        looks_at_all: True if a subscription keeps or records every message.
        is_streamed: True if a subscription receives each message when it is published, even if it is not made yet.
        feeds: True if the topic has command inputs.
    """

    __slots__ = ("feeds", "is_called", "is_streamed", "looks_at_all", "readers", "receivers")

    def __init__(self) -> None:
        self.readers: list[Subscription] = []
        self.receivers: tuple[Callback, ...] = ()
        self.is_called = self.is_streamed = self.looks_at_all = self.feeds = False

    def count(self) -> None:
        """Update the attributes after a change of the subscriptions."""
        active = [reader for reader in self.readers if reader.active]
        self.receivers = tuple(reader.receive for reader in active)
        self.is_called = any(reader.is_called for reader in active)
        self.is_streamed = any(type(reader) is StreamSubscription for reader in active)
        self.looks_at_all = self.is_streamed or any(reader.keeps == math.inf for reader in active)

    @property
    def keeps(self) -> float:
        """Largest number of messages that a subscription keeps; infinite if one keeps all."""
        return max((reader.keeps for reader in self.readers), default=0)


class Subscription(InProcess, Generic[M]):
    """Received messages of a topic; the type parameter is the class of the messages.

    Attributes:
        messages: messages received so far: the last `keep` of them, or the last million if `keep` is None.
        receive: function that receives a message.
        callback: function that is called with each message, or None.
        on_error: policy for a callback that raises: "stop" stops the run, "drop" closes the subscription.
        is_called: True if there is a callback.
        keeps: largest number of messages that the subscription keeps.
        node: name of the node of a program that subscribes; empty for any other subscription.
        type_name: ROS 2 type of the program's messages; empty for any other subscription.
        owner: plugin that subscribes; None for any other subscription.
        expected: ROS 2 type that the topic must have; empty for any type.
        active: False while the owner is removed or disabled; nothing is received then.
    """

    _internal_names = frozenset({"expected", "is_called", "keeps", "owner", "receive", "restore_latest", "settle"})

    node = type_name = expected = ""
    owner: object = None
    active = True

    def __init__(
        self, bus: SubscribingBus, topic: str, callback: Callback | None, keep: int | None, on_error: CallbackPolicy
    ) -> None:
        self._bus, self.topic, self.callback, self.on_error = bus, topic, callback, on_error
        self._messages: deque[Message] = deque(maxlen=MAX_KEPT_MESSAGES if keep is None else keep)
        self.is_called, self.keeps = callback is not None, math.inf if keep is None else keep
        self._restored: tuple[LazyMessage | None, Message] = (None, None)
        self.receive: Callback = self._messages.append if callback is None else self._keep_and_call

    @property
    def messages(self) -> list[M]:
        self._bus.gather(self.topic)
        if len(self._messages) == MAX_KEPT_MESSAGES and self.keeps == math.inf:
            self._bus.failures.report_full(self.topic)
        messages = [m.get() if isinstance(m, LazyMessage) else m for m in self._messages]
        return [m for m in messages if m is not NO_MESSAGE]

    @property
    def latest(self) -> M | Any:  # `Any` stands for None, so that a type checker asks for no check
        """Newest message, or None before the first. A reset or a restore returns it to that of the restored state."""
        self._bus.gather(self.topic)
        last, restored = self._restored
        if not self._messages or self._messages[-1] is last:
            return restored
        newest = self._messages[-1]
        if isinstance(newest, LazyMessage):
            newest = newest.get()
        if newest is NO_MESSAGE:  # treated as not sent
            self._messages.pop()
            return self.latest
        return newest

    def restore_latest(self, message: Message) -> None:
        """Set the newest message of a restored state, or None; `messages` stays complete."""
        last = None
        if self._messages:
            # the program may publish the same message object again, so the last one so far gets an object of its own
            before = self._messages.pop()
            last = LazyMessage(before.get if isinstance(before, LazyMessage) else lambda: before)
            self._messages.append(last)
        self._restored = last, message

    def to_dataframe(self) -> DataFrame:
        """Return the messages as a pandas DataFrame, one row for each; see `simkit.to_dataframe`."""
        return to_dataframe(self.messages)

    def settle(self) -> None:
        """Make every message that is not made yet."""
        for message in self._messages:
            if isinstance(message, LazyMessage):
                message.get()

    def close(self) -> None:
        """Stop receiving messages; the messages received so far stay available."""
        self._bus.unsubscribe(self)

    def _keep_and_call(self, message: Message) -> None:
        self._messages.append(message)
        journal = self._bus.journal
        try:
            if journal is None:
                self.callback(message)  # type: ignore[misc]  # only used with a callback
            else:
                with journal.called_back(self):
                    self.callback(message)  # type: ignore[misc]  # as above
        except Exception as error:  # noqa: BLE001 - user code may raise anything
            self._bus.failures.subscriber_failed(self, error)

    def __repr__(self) -> str:
        self._bus.gather(self.topic)
        count = len(self._messages)
        return f"<{type(self).__name__} {self.topic!r}, {counted(count, 'message')}>"


class StreamSubscription(Subscription):
    """Subscription that calls a function with each message and keeps no message, for recorders."""

    def __init__(self, bus: SubscribingBus, topic: str, callback: Callback, takes_later: bool, settle: Settle) -> None:
        super().__init__(bus, topic, callback, 0, "stop")
        self.receive = callback
        self.is_called = not takes_later
        if settle is not None:
            self.settle = settle  # type: ignore[method-assign]


class TopicFailures:
    """Errors and warnings of the topics of a simulation.

    Args:
        reports: collection for the warnings.
        now: function that returns the simulated time [s].

    Attributes:
        now: function that returns the simulated time [s].
    """

    def __init__(self, reports: Diagnostics, now: Callable[[], float]) -> None:
        self._reports, self.now = reports, now

    def subscriber_failed(self, subscription: Subscription, error: Exception) -> None:
        """Stop the run or close the subscription, as its policy requires. Call this inside the `except` block."""
        if isinstance(error, (PluginError, SimulationDiverged)) or is_guarded(subscription.callback):
            raise error
        topic, name = subscription.topic, callback_name(subscription.callback)
        if subscription.on_error == "stop":
            if isinstance(error, SimkitError) and not isinstance(error, InputError):
                raise error  # unchanged, so that the publishing plugin is not blamed
            raise SubscriberError(topic, name, self.now(), cause_text(error)) from error
        subscription.close()
        message = f"subscriber {name} of {topic!r} raised at t={self.now():.6g} s and is closed: {error!r}"
        self._reports.warning("SK-TOPIC-003", message)

    def input_error(self, topic: str, owner: object, callback: Callback, error: Exception) -> SimkitError:
        """Return the error for a command input whose callback raised."""
        if hasattr(owner, "where"):
            name, hook = str(getattr(owner, "name", owner)), f"its callback for {topic!r}"
            return PluginError(name, hook, self.now(), str(owner.where), cause_text(error))
        return SubscriberError(topic, callback_name(callback), self.now(), cause_text(error))

    def report_full(self, topic: str) -> None:
        """Warn that a subscription without `keep` has received more messages than it can keep."""
        message = f"a subscription to {topic!r} is full: only the newest {MAX_KEPT_MESSAGES} messages are kept"
        self._reports.warning("SK-TOPIC-005", message, hint="subscribe with keep=, or close the subscription after use")

    def report_dropped(self, topic: str, depth: int) -> None:
        """Warn that a plugin's input received more messages for one step than its queue can keep."""
        message = (
            f"more than {counted(depth, 'message')} on {topic!r} came for one step: the oldest are dropped from now on"
        )
        hint = "send less often; sim.communication.bus.dropped counts them"
        self._reports.warning("SK-TOPIC-004", message, hint=hint)
