"""Take down the messages of a running simulation: taps on its topics, and the order of pictures that are drawn late."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Generic, TypeVar

from simkit.msgs.message_types import Message
from simkit.runtime.communication.subscription import NO_MESSAGE, LazyMessage

if TYPE_CHECKING:
    from simkit.runtime import Simulation, Subscription

Receiver = Callable[[Message | LazyMessage], None]
"""Is called with each message of a topic, which may be a `LazyMessage`."""
_Label = TypeVar("_Label")


class TopicTaps:
    """Taps on the topics of a simulation, those that are advertised later included.

    Bags, reference runs, bundles and certificates all listen through it. A tap makes a sensor measure, and changes no
    bit of what it measures.

    Args:
        sim: the simulation.
        receiver_of: is asked once for each topic and its type; returns what gets its messages, or None for none.
    """

    def __init__(self, sim: Simulation, receiver_of: Callable[[str, str], Receiver | None]) -> None:
        self._sim, self._receiver_of = sim, receiver_of
        self._taps: dict[str, Subscription] = {}
        self._is_open = False

    def open(self) -> None:
        """Begin to listen."""
        self._is_open = True
        self._sim.communication.bus.on_topic(self._add)

    def close(self) -> None:
        """Listen no more; does nothing the second time."""
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
            self._taps[topic] = self._sim.communication.bus.tap(topic, receiver, takes_later=True)


class MessageQueue(Generic[_Label]):
    """Delivers messages in the order in which they were published, although some pictures are still being drawn.

    Args:
        deliver: is called with the label of a message, and the message.
        freeze: copies a message that has to wait, for its publisher may write to it; every message is delivered as it
            returns it. Without it nothing but pictures waits: whatever follows one has it drawn at once.
    """

    def __init__(
        self, deliver: Callable[[_Label, Message], None], freeze: Callable[[Message], Message] | None = None
    ) -> None:
        self._deliver, self._freeze = deliver, freeze
        self._waiting: deque[tuple[_Label, Message | LazyMessage]] = deque()

    def add(self, label: _Label, message: Message | LazyMessage) -> None:
        """Deliver a message that was published now, or have it wait behind those before it."""
        is_lazy = type(message) is LazyMessage
        if self._waiting or (is_lazy and not message.is_ready):
            if is_lazy or self._freeze is not None:
                self._waiting.append((label, message if is_lazy or self._freeze is None else self._freeze(message)))
                self.deliver_ready()
                return
            self.deliver_all()
        self._resolve(label, message)

    def deliver_ready(self) -> None:
        """Deliver what is there by now, in order."""
        waiting = self._waiting
        while waiting and (type(waiting[0][1]) is not LazyMessage or waiting[0][1].is_ready):
            self._deliver_first()

    def deliver_all(self) -> None:
        """Deliver everything; pictures are drawn now."""
        while self._waiting:
            self._deliver_first()

    def __len__(self) -> int:
        return len(self._waiting)

    def drop_oldest(self) -> None:
        """Drop the message that has waited longest."""
        self._waiting.popleft()

    def clear(self) -> None:
        """Drop what waits."""
        self._waiting.clear()

    def _deliver_first(self) -> None:
        label, message = self._waiting.popleft()
        if type(message) is LazyMessage:
            self._resolve(label, message)
        else:  # frozen already
            self._deliver(label, message)

    def _resolve(self, label: _Label, message: Message | LazyMessage) -> None:
        made = message.get() if type(message) is LazyMessage else message
        if made is not NO_MESSAGE:
            self._deliver(label, made if self._freeze is None else self._freeze(made))
