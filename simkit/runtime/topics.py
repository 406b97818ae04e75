"""Topics within the process. Readings go out at once; commands queue and come in between two steps."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError

Callback = Callable[[Any], None]


def absolute(topic: str) -> str:
    """The topic with its leading slash."""
    return topic if topic.startswith("/") else "/" + topic


class Later:
    """A message that is made when somebody looks at it."""

    __slots__ = ("_make", "_message")

    def __init__(self, make: Callable[[], Any]) -> None:
        self._make: Callable[[], Any] | None = make
        self._message: Any = None

    def get(self) -> Any:
        if self._make is not None:
            self._message, self._make = self._make(), None
        return self._message


class Subscription:
    """What arrives on a topic.

    Attributes:
        messages: what arrived since the subscription (the last `keep` where given).
    """

    def __init__(self, bus: TopicBus, topic: str, callback: Callback | None, keep: int | None) -> None:
        self._bus, self.topic, self._callback = bus, topic, callback
        self._messages: deque[Any] = deque(maxlen=keep)

    @property
    def messages(self) -> list[Any]:
        return [m.get() if type(m) is Later else m for m in self._messages]

    @property
    def latest(self) -> Any | None:
        """The newest message, or None before the first."""
        if not self._messages:
            return None
        newest = self._messages[-1]
        return newest.get() if type(newest) is Later else newest

    def close(self) -> None:
        """Stops receiving; what was received stays."""
        self._bus._unsubscribe(self)

    def _receive(self, message: Any) -> None:
        self._messages.append(message)
        if self._callback is not None:
            self._callback(message)

    def __deepcopy__(self, memo: dict[int, Any]) -> Subscription:
        return self


class _Stream(Subscription):
    """A subscription that only calls back and keeps nothing (a recorder's)."""

    def _receive(self, message: Any) -> None:
        assert self._callback is not None
        self._callback(message)


class Publisher:
    """One end of a topic; `wanted` says whether somebody reads now."""

    __slots__ = ("_bus", "_last", "_readers", "active", "latched", "owner", "topic", "type_name")

    def __init__(self, bus: TopicBus, topic: str, type_name: str, latched: bool, owner: object) -> None:
        self._bus, self.topic, self.type_name, self.latched, self.owner = bus, topic, type_name, latched, owner
        self._readers = bus._readers.setdefault(topic, [])
        self._last: Any = None
        self.active = True

    @property
    def wanted(self) -> bool:
        return bool(self._readers) or self.latched or self.topic in self._bus._listeners

    def publish(self, message: Any) -> None:
        """Hands the message to every subscriber, now, and to command inputs before the next step."""
        if self.latched:
            self._last = message
        self._bus._deliver(self.topic, message)

    def publish_later(self, make: Callable[[], Any]) -> None:
        """Publishes what `make()` gives, made at once only where somebody is called back with it."""
        readers = self._readers
        waits = not (self.latched or self.topic in self._bus._listeners)
        for reader in readers:
            waits = waits and reader._callback is None
        if not waits:
            self.publish(make())
            return
        later = Later(make)
        for reader in readers:
            reader._messages.append(later)

    def __deepcopy__(self, memo: dict[int, Any]) -> Publisher:
        return self


class Listener:
    """A command input: its callback runs between two steps."""

    __slots__ = ("active", "callback", "owner", "topic", "types")

    def __init__(self, topic: str, types: Sequence[str], callback: Callback, owner: object) -> None:
        self.topic, self.types, self.callback, self.owner = topic, tuple(types), callback, owner
        self.active = True

    def __deepcopy__(self, memo: dict[int, Any]) -> Listener:
        return self


class TopicBus:
    """All topics of a simulation."""

    def __init__(self) -> None:
        self._readers: dict[str, list[Subscription]] = {}
        self._publishers: dict[str, list[Publisher]] = {}
        self._listeners: dict[str, list[Listener]] = {}
        self._watchers: list[Callable[[str, str], None]] = []
        self._owner: object = None
        self.inbox: deque[tuple[str, Any]] = deque()

    # ------------------------------------------------------------------ ends

    @contextmanager
    def owned_by(self, owner: object) -> Iterator[None]:
        """Whatever opens a topic within belongs to `owner` and is silenced with it."""
        before, self._owner = self._owner, owner
        try:
            yield
        finally:
            self._owner = before

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> Publisher:
        """Opens a topic for publishing.

        Args:
            topic: absolute, or taken as such.
            type_name: ROS 2 type, such as `sensor_msgs/msg/Imu`.
            latched: a later subscriber gets the last message (transient local).
        """
        topic = absolute(topic)
        publisher = Publisher(self, topic, type_name, latched, self._owner)
        self._publishers.setdefault(topic, []).append(publisher)
        self._announce(topic, type_name)
        return publisher

    def listen(self, topic: str, types: Sequence[str], callback: Callback) -> Listener:
        """Opens a topic for commands; the first of `types` is the one listed."""
        topic = absolute(topic)
        listener = Listener(topic, types, callback, self._owner)
        self._listeners.setdefault(topic, []).append(listener)
        self._announce(topic, types[0])
        return listener

    def subscribe(self, topic: str, callback: Callback | None = None, keep: int | None = None) -> Subscription:
        """Receives a topic, whether its publisher exists yet or not."""
        return self._add_reader(Subscription(self, absolute(topic), callback, keep))

    def tap(self, topic: str, callback: Callback) -> Subscription:
        """Receives a topic without keeping its messages."""
        return self._add_reader(_Stream(self, absolute(topic), callback, 0))

    def close(self, end: Publisher | Listener) -> None:
        """Takes a publisher or a listener away for good."""
        table: Mapping[str, list[Any]] = self._publishers if isinstance(end, Publisher) else self._listeners
        if end in table.get(end.topic, []):
            table[end.topic].remove(end)

    def set_active(self, owners: Sequence[object]) -> None:
        """Leaves only the ends of these owners (and those without one) in use."""
        living = {id(o) for o in owners}
        tables: tuple[Mapping[str, list[Any]], ...] = (self._publishers, self._listeners)
        for ends in (ends for table in tables for ends in table.values()):
            for end in ends:
                end.active = end.owner is None or id(end.owner) in living

    # ------------------------------------------------------------------ what there is

    def topics(self) -> dict[str, str]:
        """Topic -> ROS type name, of what is published and what is listened to, sorted."""
        found: dict[str, str] = {}
        for topic, publishers in self._publishers.items():
            for p in publishers:
                if p.active:
                    found.setdefault(topic, p.type_name)
        for topic, listeners in self._listeners.items():
            for li in listeners:
                if li.active:
                    found.setdefault(topic, li.types[0])
        return dict(sorted(found.items()))

    def latched(self) -> frozenset[str]:
        """Topics whose last message is kept for later subscribers."""
        return frozenset(t for t, publishers in self._publishers.items() for p in publishers if p.latched and p.active)

    def wanted(self, topic: str) -> bool:
        """Whether somebody subscribes to a topic."""
        return bool(self._readers.get(absolute(topic)))

    def on_topic(self, callback: Callable[[str, str], None]) -> None:
        """Calls `callback(topic, type_name)` for every topic there is and will be."""
        self._watchers.append(callback)
        for topic, type_name in self.topics().items():
            callback(topic, type_name)

    # ------------------------------------------------------------------ messages

    def settle(self) -> None:
        """Makes every message that waits to be looked at, before what it is made from changes."""
        for readers in self._readers.values():
            for reader in readers:
                reader.messages  # noqa: B018

    def publish(self, topic: str, message: Any) -> None:
        """A message from outside the loop: subscribers see it now, command inputs before the next step.

        Raises:
            MessageError: nobody could say what type a dict is to have, or it fits none.
        """
        topic = absolute(topic)
        types = [t for li in self._listeners.get(topic, ()) if li.active for t in li.types]
        types += [p.type_name for p in self._publishers.get(topic, ()) if p.active]
        if isinstance(message, Mapping):
            if not types:
                raise MessageError(f"no topic {topic!r}; {did_you_mean(topic, self.topics()) or self._listed()}")
            message = msgs.from_dict(list(dict.fromkeys(types)), dict(message))
        elif types and msgs.type_name(message) not in types:
            raise MessageError(f"{topic!r} takes {' or '.join(dict.fromkeys(types))}, got {msgs.type_name(message)}")
        self._deliver(topic, message)

    def deliver_inputs(self) -> None:
        """Hands queued commands to their inputs, in the order of arrival."""
        for _ in range(len(self.inbox)):
            topic, message = self.inbox.popleft()
            for listener in self._listeners.get(topic, ()):
                if listener.active and msgs.type_name(message) in listener.types:
                    listener.callback(message)

    def _listed(self) -> str:
        return "there is " + (", ".join(self.topics()) or "none")

    def _deliver(self, topic: str, message: Any) -> None:
        for subscription in tuple(self._readers.get(topic, ())):
            subscription._receive(message)
        if topic in self._listeners:
            self.inbox.append((topic, message))

    def _add_reader(self, subscription: Subscription) -> Subscription:
        self._readers.setdefault(subscription.topic, []).append(subscription)
        for publisher in self._publishers.get(subscription.topic, ()):
            if publisher.latched and publisher.active and publisher._last is not None:
                subscription._receive(publisher._last)
        return subscription

    def _unsubscribe(self, subscription: Subscription) -> None:
        readers = self._readers.get(subscription.topic, [])
        if subscription in readers:
            readers.remove(subscription)

    def _announce(self, topic: str, type_name: str) -> None:
        for watcher in self._watchers:
            watcher(topic, type_name)
