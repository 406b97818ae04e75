"""Taps on the topics of a running simulation, and a queue that keeps messages in order while images are rendered."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from simkit import msgs
from simkit.errors import SimkitError
from simkit.msgs.message_types import Message
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage, Settle

if TYPE_CHECKING:
    from simkit.runtime import Simulation, Subscription

Receiver = Callable[[Message | LazyMessage], None]
"""Callback for each message of a topic, which may be a `LazyMessage`."""
_Source = TypeVar("_Source")
Deliver = Callable[[list[_Source], list[int], list[Any]], None]
_MOST_DEFERRED = 1 << 15  # queued messages at which those are delivered that are serialised together


def is_available(sim: Simulation, topic: str) -> bool:
    """Check whether the messages of a topic can be made on this machine; images need a renderer."""
    try:
        sim.communication.bus.check_available(topic)
    except SimkitError:
        return False
    return True


class TopicTaps:
    """Taps on the topics of a simulation, including topics that are advertised later.

    Bags, reference runs, bundles and certificates all use these taps. A tap makes a sensor measure, but changes no bit
    of the measurement.

    Args:
        sim: simulation to observe.
        receiver_of: function that returns the callback for a topic and type, or None for no tap; called once per topic.
        settle: function that makes all messages that the callbacks have stored; see `TopicBus.tap`.
    """

    def __init__(
        self, sim: Simulation, receiver_of: Callable[[str, str], Receiver | None], settle: Settle = None
    ) -> None:
        self._sim, self._receiver_of, self._settle = sim, receiver_of, settle
        self._taps: dict[str, Subscription] = {}
        self._is_open = False

    def open(self) -> None:
        """Open the taps."""
        self._is_open = True
        self._sim.communication.bus.on_topic(self._add)

    def close(self) -> None:
        """Close the taps. A second call does nothing."""
        self._is_open = False
        for tap in self._taps.values():
            tap.close()
        self._taps.clear()

    def __contains__(self, topic: str) -> bool:
        return topic in self._taps

    def _add(self, topic: str, type_name: str) -> None:
        if not self._is_open or topic in self._taps:
            return
        receiver = self._receiver_of(topic, type_name)
        if receiver is not None:
            bus = self._sim.communication.bus
            self._taps[topic] = bus.tap(topic, receiver, takes_later=True, settle=self._settle)


def serialised(message: Message | LazyMessage) -> object:
    """Return the type and CDR of a message; NO_MESSAGE if the message cannot be made."""
    if isinstance(message, LazyMessage):
        return message.serialised()
    return msgs.type_name(message), msgs.serialize(message)


class MessageQueue(Generic[_Source]):
    """Queue that delivers messages in the order of their publication while some images are still being rendered.

    The queue has no tuple for each message, because Python's garbage collector then walks through all of them: with 30
    robots, a third of the time of a recording.

    Args:
        deliver: callback with the sources of messages, their ticks or times, and the messages; a frozen message is two
            items, type and CDR.
        freeze: `serialised`, or a function like it. The publisher may change a message while it is queued, so every
            message is delivered in this form. A message with `can_wait` is queued until `deliver_ready`, because many
            at a time are serialised faster. Without `freeze` only images are queued: a message after an image
            then waits until the image is rendered.
    """

    def __init__(
        self, deliver: Deliver[_Source], freeze: Callable[[Message | LazyMessage], object] | None = None
    ) -> None:
        self._deliver, self._freeze, self._resolve = deliver, freeze, freeze or _made
        self._waiting: deque[Any] = deque()  # source, tick and message in turn

    def add(self, source: _Source, tick: int, message: Message | LazyMessage) -> None:
        """Deliver a message that was just published, or queue the message if an image before it is not rendered yet."""
        freeze, waiting = self._freeze, self._waiting
        is_lazy = isinstance(message, LazyMessage)
        if is_lazy and freeze is not None and message.can_wait:
            waiting += source, tick, message
            if len(waiting) > 3 * _MOST_DEFERRED:
                self.deliver_ready()
            return
        is_pending = is_lazy and not message.is_ready
        if not (waiting or is_pending):
            self._deliver_one(source, tick, self._resolve(message))
            return
        if freeze is not None and not is_pending:
            message = freeze(message)
            if message is NO_MESSAGE:
                return
        elif not is_lazy:
            self.deliver_all()
            self._deliver_one(source, tick, message)
            return
        waiting += source, tick, message
        first = waiting[2]
        if is_pending or not (isinstance(first, LazyMessage) and first.can_wait):
            self.deliver_ready()

    def deliver_ready(self) -> None:
        """Deliver the messages that are ready, in order."""
        self._deliver_queued(waits=False)

    def deliver_all(self) -> None:
        """Deliver all messages; wait for the rendering of images."""
        self._deliver_queued(waits=True)

    def _deliver_one(self, source: _Source, tick: int, message: Message) -> None:
        if message is not NO_MESSAGE:
            self._deliver([source], [tick], [message] if self._freeze is None else [*message])

    def _deliver_queued(self, waits: bool) -> None:
        waiting, resolve, take = self._waiting, self._resolve, self._waiting.popleft
        sources: list[_Source] = []
        ticks: list[int] = []
        delivered: list[Any] = []
        keep = delivered.append if self._freeze is None else delivered.extend
        try:
            while waiting:
                message = waiting[2]
                is_lazy = isinstance(message, LazyMessage)
                if is_lazy and not (waits or message.can_wait or message.is_ready):
                    break
                source, tick, _ = take(), take(), take()
                if is_lazy:  # else it is already frozen
                    message = resolve(message)
                    if message is NO_MESSAGE:
                        continue
                keep(message)
                sources.append(source)
                ticks.append(tick)
        finally:
            if sources:
                self._deliver(sources, ticks, delivered)

    def __len__(self) -> int:
        return len(self._waiting) // 3

    def drop_oldest(self) -> None:
        """Drop the oldest message."""
        for _ in range(3):
            self._waiting.popleft()

    def clear(self) -> None:
        """Drop all queued messages."""
        self._waiting.clear()


def _made(message: Message | LazyMessage) -> Message:
    return message.get() if isinstance(message, LazyMessage) else message
