"""Taps on the topics of a running simulation, and a queue that keeps messages in order while images are rendered."""

from __future__ import annotations

from collections.abc import Callable
from itertools import compress
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from simkit import msgs
from simkit.errors import MessageError, SimkitError
from simkit.msgs.message_types import Message
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage, Settle

if TYPE_CHECKING:
    from simkit.runtime import Simulation, Subscription

Receiver = Callable[[Message | LazyMessage], None]
"""Callback for each message of a topic, which may be a `LazyMessage`."""
_Source = TypeVar("_Source")
Deliver = Callable[[list[_Source], list[int], list[Any]], None]
_MOST_DEFERRED = 1 << 13  # queued messages at which those are delivered that are serialised together


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


class MessageQueue(Generic[_Source]):
    """Queue that delivers messages in the order of their publication while some images are still being rendered.

    The queue has no tuple for each message, because Python's garbage collector then walks through all of them: with 30
    robots, a third of the time of a recording.

    Args:
        deliver: callback with the sources of messages, their ticks or times, and the messages; a serialised message is
            a tuple of its type and CDR.
        serialises: True to deliver every message as type and CDR. The publisher may change a message while it is
            queued, so it is serialised at once. A message with `can_wait` is queued until `deliver_ready`, because
            many at a time are serialised faster. Without `serialises` only images are queued: a message after an image
            then waits until the image is rendered.
        drops_invalid: True to drop a message that cannot be serialised, instead of raising the MessageError.
    """

    def __init__(self, deliver: Deliver[_Source], *, serialises: bool = False, drops_invalid: bool = False) -> None:
        self._deliver, self._serialises, self._drops_invalid = deliver, serialises, drops_invalid
        self._waiting: list[Any] = []  # source, tick and message in turn
        self._has_pending = False  # True if a queued message may wait for another thread

    def add(self, source: _Source, tick: int, message: Message | LazyMessage) -> None:
        """Deliver a message that was just published, or queue the message if an image before it is not rendered yet."""
        waiting = self._waiting
        is_lazy = isinstance(message, LazyMessage)
        if is_lazy and self._serialises and message.can_wait:
            waiting += source, tick, message
            if len(waiting) > 3 * _MOST_DEFERRED:
                self.deliver_ready()
            return
        is_pending = is_lazy and not message.is_ready
        if not (is_pending or self._serialises or is_lazy) and waiting:
            self.deliver_all()
        if not is_pending:
            message = self._content(message)
            if message is NO_MESSAGE:
                return
            if not waiting:
                self._deliver([source], [tick], [message])
                return
        self._has_pending |= is_pending
        waiting += source, tick, message
        if self._has_pending:
            self.deliver_ready()

    def deliver_ready(self) -> None:
        """Deliver the messages that are ready, in order."""
        self._deliver_queued(waits=False)

    def deliver_all(self) -> None:
        """Deliver all messages; wait for the rendering of images."""
        self._deliver_queued(waits=True)

    def _content(self, message: Message | LazyMessage) -> object:
        """Return what is delivered of a message; NO_MESSAGE if it cannot be made."""
        is_lazy = isinstance(message, LazyMessage)
        if not self._serialises:
            return message.get() if is_lazy else message
        try:
            return message.serialised() if is_lazy else (msgs.type_name(message), msgs.serialize(message))
        except MessageError:
            if not self._drops_invalid:
                raise
            return NO_MESSAGE

    def _deliver_queued(self, waits: bool) -> None:
        waiting = self._waiting
        if not waiting:
            return
        queued, self._has_pending = waiting[:], self._has_pending and not waits
        if self._has_pending:
            end = next((i - 2 for i in range(2, len(queued), 3) if _is_pending(queued[i])), len(queued))
            self._has_pending, queued = end < len(queued), queued[:end]
        del waiting[: len(queued)]
        contents: list[Any] = []
        has_gaps, count = False, 0
        try:
            for message in queued[2::3]:
                count += 1
                content = self._content(message) if isinstance(message, LazyMessage) else message
                has_gaps |= content is NO_MESSAGE
                contents.append(content)
        finally:
            if queued[3 * count :]:  # after an error
                waiting[:0], self._has_pending = queued[3 * count :], True
            sources, ticks = queued[: 3 * len(contents) : 3], queued[1 : 3 * len(contents) : 3]
            if has_gaps:
                kept = [content is not NO_MESSAGE for content in contents]
                sources, ticks, contents = (list(compress(column, kept)) for column in (sources, ticks, contents))
            if contents:
                self._deliver(sources, ticks, contents)

    def __len__(self) -> int:
        return len(self._waiting) // 3

    def drop_oldest(self) -> None:
        """Drop the oldest message."""
        del self._waiting[:3]

    def clear(self) -> None:
        """Drop all queued messages."""
        self._waiting.clear()
        self._has_pending = False


def _is_pending(message: object) -> bool:
    """Check for a message that waits for another thread."""
    return isinstance(message, LazyMessage) and not (message.can_wait or message.is_ready)
