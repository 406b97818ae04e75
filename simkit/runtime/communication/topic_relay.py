"""Relays: the messages of one topic are published on another one, as a bridge between Gazebo and ROS does."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any, Final, Protocol

from simkit.msgs.topic_names import absolute_name
from simkit.msgs.type_conversions import TYPES_WITH_FRAMES, Conversion, conversion, with_ros_frames
from simkit.runtime.communication.publisher import Listener, Publisher
from simkit.runtime.communication.subscription import NO_MESSAGE, Callback, LazyMessage, Settle, Subscription

if TYPE_CHECKING:
    from simkit.msgs import Message

NO_SOURCE: Final = "no source"
"""Result of `TopicRelay.fault` while the source has no publisher."""


class RelayingBus(Protocol):
    """Interface of the topic bus that a relay needs."""

    @property
    def relays(self) -> list[Any]:
        """Open relays."""

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> Publisher:
        """Open a topic for publishing."""

    def listen(self, topic: str, types: Sequence[str], callback: Callback) -> Listener:
        """Open a topic for commands."""

    def tap(self, topic: str, callback: Callback, *, takes_later: bool = False, settle: Settle = None) -> Subscription:
        """Receive a topic without keeping its messages."""

    def owned_by(self, owner: object, *, renames: bool = True) -> AbstractContextManager[None]:
        """Make `owner` the owner of all interfaces that are opened within the context."""

    def passing(self, operation: str, **arguments: object) -> AbstractContextManager[Any]:
        """Return the context manager in which an operation runs."""

    def on_readers_change(self, topic: str, callback: Callable[[], None]) -> Callable[[], None]:
        """Call a function whenever the subscriptions of a topic have changed; return a function that ends this."""

    def endpoints(self, topic: str | None = None) -> Iterator[tuple[str, Publisher | Listener, tuple[str, ...], str]]:
        """Yield tuples of topic, publisher or listener, ROS types, and "publishes" or "takes"."""

    def readers(self, topic: str) -> list[Subscription]:
        """Return the open subscriptions of a topic."""

    def types_of(self, topic: str) -> list[str]:
        """Return the types of a topic."""

    def latched(self) -> frozenset[str]:
        """Return the topics whose last message is kept for later subscribers."""

    def settle_topic(self, topic: str) -> None:
        """Make every message of one topic that is not made yet."""

    def deliver_now(self, topic: str, message: Message) -> None:
        """Pass a command to its inputs at once."""


class TopicRelay:
    """Relay of one direction. It takes the messages of its source only while its target has subscribers.

    A message of the same type is passed on as it is, also before it is made. A relay does not take back what another
    relay has taken from its target, so two relays make a connection of both directions.

    Args:
        bus: topic bus.
        now_ns: function that returns the simulated time [ns].
        source: topic of the messages.
        target: topic on which they are published.
        type_name: ROS 2 type of the target.

    Attributes:
        source, target: absolute names of the topics.
        type_name: ROS 2 type of the target.
        count: number of messages that the relay has passed on.
        publisher: publisher on the target.
        tap: subscription of the source; None while nobody needs the messages.
        is_passing: True while it passes on a message.

    Raises:
        MessageError: the target has another type.
    """

    def __init__(self, bus: RelayingBus, now_ns: Callable[[], int], source: str, target: str, type_name: str) -> None:
        self._bus, self._now_ns = bus, now_ns
        self.source, self.target, self.type_name = absolute_name(source), absolute_name(target), type_name
        self.count = 0
        self._is_open, self.is_passing, self._is_settling = True, False, False
        self.tap: Subscription | None = None
        self._source_type = ""
        self._convert: Conversion | None = None
        latched = bool({self.source, self.target} & bus.latched())
        # its messages are no external inputs, so a journal does not record them
        with bus.owned_by(self, renames=False):
            self.publisher: Publisher = bus.advertise(self.target, type_name, latched=latched)
        self.publisher.disown()
        bus.relays.append(self)
        self._stop_looking = bus.on_readers_change(self.target, self._look)
        self._look()

    def fault(self) -> str:
        """Return the types of the source if the relay can convert none of them, else nothing; `NO_SOURCE` before it."""
        own = [relay.publisher for relay in self._bus.relays if isinstance(relay, TopicRelay)]
        types = [kinds[0] for _, end, kinds, _ in self._bus.endpoints(self.source) if end.active and end not in own]
        if not types:
            return NO_SOURCE
        can_convert = any(conversion(name, self.type_name) is not None for name in types)
        return "" if can_convert else " or ".join(dict.fromkeys(types))

    def _look(self) -> None:
        """Subscribe to the source while the target has subscribers other than relays back to the source."""
        is_wanted = self._is_open and (
            self.publisher.latched or bool(input_types(self._bus, self.target)) or self._has_readers()
        )
        if is_wanted and self.tap is None:
            self.tap = self._bus.tap(self.source, self._receive, takes_later=True, settle=self._settle)
        elif not is_wanted and self.tap is not None:
            tap, self.tap = self.tap, None
            tap.close()

    def _has_readers(self) -> bool:
        back = [relay._receive for relay in self._opposite() if isinstance(relay, TopicRelay)]
        return any(reader.callback not in back for reader in self._bus.readers(self.target))

    def _opposite(self) -> list[TopicRelay | InputRelay]:
        return [each for each in self._bus.relays if (each.source, each.target) == (self.target, self.source)]

    def _receive(self, message: Message | LazyMessage) -> None:
        if self.is_passing or any(relay.is_passing for relay in self._opposite()):
            return
        self.is_passing = True
        try:
            self._pass_on(message)
        finally:
            self.is_passing = False

    def _pass_on(self, message: Message | LazyMessage) -> None:
        is_unchanged = self.type_name not in TYPES_WITH_FRAMES and self._has_type_of_source()
        if isinstance(message, LazyMessage) and is_unchanged and not self.publisher.is_live:
            self.count += 1
            self.publisher.publish_packed(message)
            return
        made = message.get() if isinstance(message, LazyMessage) else message
        if made is NO_MESSAGE:
            return
        kind = made.__msgtype__
        if kind != self._source_type:
            self._source_type, self._convert = kind, conversion(kind, self.type_name)
        if self._convert is not None:
            self.count += 1
            self._publish(with_ros_frames(self._convert(made, self._now_ns())))

    def _publish(self, message: Message) -> None:
        """Publish a message, but not to the command input of a relay back to the source."""
        if any(isinstance(relay, InputRelay) for relay in self._opposite()):
            for reader in self._bus.readers(self.target):
                reader.receive(message)
        else:
            self.publisher.publish(message)

    def _has_type_of_source(self) -> bool:
        return set(self._bus.types_of(self.source)) <= {self.type_name}

    def _settle(self) -> None:
        if not self._is_settling:  # two relays of both directions would settle each other without end
            self._is_settling = True
            try:
                self._bus.settle_topic(self.target)
            finally:
                self._is_settling = False

    def close(self) -> None:
        """End the relay."""
        if not self._is_open:
            return
        self._is_open = False
        with self._bus.passing("close", endpoint=self):
            self._stop_looking()
            self._bus.relays.remove(self)
            self._look()
            self.publisher.close()

    def __repr__(self) -> str:
        return f"<TopicRelay {self.source!r} -> {self.target!r} {self.type_name}>"


class InputRelay:
    """Relay to the command inputs of a topic. Its source is a command input, so it is listed and can be driven.

    Source and target may be the same topic: its inputs then take a further type, such as `TwistStamped` for `Twist`.

    Args:
        bus: topic bus.
        now_ns: function that returns the simulated time [ns].
        source: topic of the commands.
        target: topic with the command inputs; a plugin may open them later.
        type_name: ROS 2 type of the source.

    Attributes:
        source, target: absolute names of the topics.
        type_name: ROS 2 type of the source.
        count: number of messages that the relay has passed on.
        listener: command input of the source.
        is_passing: True while it passes on a message.
    """

    def __init__(self, bus: RelayingBus, now_ns: Callable[[], int], source: str, target: str, type_name: str) -> None:
        self._bus, self._now_ns = bus, now_ns
        self.source, self.target, self.type_name = absolute_name(source), absolute_name(target), type_name
        self.count, self._is_open, self.is_passing = 0, True, False
        self.listener: Listener = bus.listen(self.source, (type_name,), self._take)
        bus.relays.append(self)

    def _take(self, message: Message) -> None:
        types = [name for name in input_types(self._bus, self.target) if conversion(self.type_name, name) is not None]
        convert = conversion(self.type_name, types[0]) if types else None
        if convert is None:
            return
        self.count += 1
        self.is_passing = True
        try:
            command = convert(message, self._now_ns())
            if self.source != self.target:
                for reader in self._bus.readers(self.target):
                    reader.receive(command)
            self._bus.deliver_now(self.target, command)
        finally:
            self.is_passing = False

    def close(self) -> None:
        """End the relay."""
        if self._is_open:
            self._is_open = False
            with self._bus.passing("close", endpoint=self):
                self._bus.relays.remove(self)
                self.listener.close()

    def __repr__(self) -> str:
        return f"<InputRelay {self.source!r} -> {self.target!r} {self.type_name}>"


def input_types(bus: RelayingBus, topic: str) -> list[str]:
    """Return the types of the command inputs of a topic, without those of relays."""
    own = [relay.listener for relay in bus.relays if isinstance(relay, InputRelay)]
    ends = bus.endpoints(topic)
    return [name for _, end, types, kind in ends if end.active and kind == "takes" and end not in own for name in types]
