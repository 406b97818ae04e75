"""Topics within the process. Readings go out at once; commands queue and come in between two steps."""

from __future__ import annotations

import math
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


NOTHING = object()
"""What is given instead of a message that cannot be made."""


class Later:
    """A message that is made when somebody looks at it.

    Attributes:
        is_awaited: whether it will be looked at for all that is known: a reader keeps every message, or records it.
        work: what is being done on another thread that the message waits for; None where there is no such thing.
    """

    __slots__ = ("_make", "_message", "is_awaited", "work")

    def __init__(self, make: Callable[[], Any], is_awaited: bool = False, work: Any = None) -> None:
        self.is_awaited, self.work = is_awaited, work
        self._make: Callable[[], Any] | None = make
        self._message: Any = None

    @property
    def is_ready(self) -> bool:
        """Whether `get` gives the message without waiting for another thread."""
        return self.work is None or self.work.is_done

    def get(self) -> Any:
        """The message; NOTHING where it turned out that there is none."""
        make = self._make
        if make is not None:
            # in this order, since two threads may ask at the same time: both are given the same message
            self._message = make()
            self._make = self.work = None
        return self._message


class Audience:
    """Who hears a topic.

    Attributes:
        readers: the subscriptions.
        receivers: what takes a message, one for each of them.
        is_called: whether one of them is called back with each message, and not only keeps it.
        looks_at_all: whether one of them will look at every message for all that is known.
        feeds: whether command inputs hear the topic.
    """

    __slots__ = ("feeds", "is_called", "looks_at_all", "readers", "receivers")

    def __init__(self) -> None:
        self.readers: list[Subscription] = []
        self.receivers: tuple[Callback, ...] = ()
        self.is_called = self.looks_at_all = self.feeds = False

    def count(self) -> None:
        """After a change of the readers."""
        self.receivers = tuple(reader.receive for reader in self.readers)
        self.is_called = any(reader.is_called for reader in self.readers)
        self.looks_at_all = any(type(reader) is _Stream or reader.keeps == math.inf for reader in self.readers)

    @property
    def keeps(self) -> float:
        """The most messages that one of the readers keeps; infinite where one keeps all."""
        return max((reader.keeps for reader in self.readers), default=0)


class Subscription:
    """What arrives on a topic.

    Attributes:
        messages: what arrived since the subscription (the last `keep` where given).
        receive: takes a message.
        is_called: whether it has a callback.
        keeps: the most messages that it keeps.
    """

    def __init__(self, bus: TopicBus, topic: str, callback: Callback | None, keep: int | None) -> None:
        self._bus, self.topic, self._callback = bus, topic, callback
        self._messages: deque[Any] = deque(maxlen=keep)
        self.is_called, self.keeps = callback is not None, math.inf if keep is None else keep
        self.receive: Callback = self._messages.append if callback is None else self._keep_and_call

    @property
    def messages(self) -> list[Any]:
        self._bus.gather(self.topic)
        found = [m.get() if type(m) is Later else m for m in self._messages]
        return [m for m in found if m is not NOTHING]

    @property
    def latest(self) -> Any | None:
        """The newest message, or None before the first."""
        self._bus.gather(self.topic)
        if not self._messages:
            return None
        newest = self._messages[-1]
        if type(newest) is Later:
            newest = newest.get()
        if newest is NOTHING:  # as if it had not been sent
            self._messages.pop()
            return self.latest
        return newest

    def close(self) -> None:
        """Stops receiving; what was received stays."""
        self._bus._unsubscribe(self)

    def _keep_and_call(self, message: Any) -> None:
        assert self._callback is not None
        self._messages.append(message)
        self._callback(message)

    def __deepcopy__(self, memo: dict[int, Any]) -> Subscription:
        return self


class _Stream(Subscription):
    """A subscription that only calls back and keeps nothing (a recorder's)."""

    def __init__(self, bus: TopicBus, topic: str, callback: Callback, takes_later: bool) -> None:
        super().__init__(bus, topic, callback, 0)
        self.receive = callback
        self.is_called = not takes_later


class Publisher:
    """One end of a topic; `wanted` says whether somebody reads now.

    Attributes:
        pending: publishes what its owner has put off, before anybody looks; None where nothing is ever put off.
    """

    __slots__ = ("_audience", "_bus", "_last", "active", "latched", "owner", "pending", "topic", "type_name")

    def __init__(self, bus: TopicBus, topic: str, type_name: str, latched: bool, owner: object) -> None:
        self._bus, self.topic, self.type_name, self.latched, self.owner = bus, topic, type_name, latched, owner
        self._audience = bus._audience(topic)
        self._last: Any = None
        self.active = True
        self.pending: Callable[[], None] | None = None

    @property
    def wanted(self) -> bool:
        audience = self._audience
        return bool(audience.readers) or self.latched or audience.feeds

    @property
    def is_live(self) -> bool:
        """Whether somebody does something with each message at once."""
        audience = self._audience
        return audience.is_called or audience.feeds or self.latched

    @property
    def patience(self) -> float:
        """How many of the newest messages anybody will look at; 0 where nothing may be put off.

        That is where somebody is called back, and where others publish on the same topic.
        """
        return 0 if self.is_live or len(self._bus._publishers[self.topic]) > 1 else self._audience.keeps

    def publish(self, message: Any) -> None:
        """Hands the message to every subscriber, now, and to command inputs before the next step."""
        if self.latched:
            self._last = message
        audience = self._audience
        for receive in audience.receivers:
            receive(message)
        if audience.feeds:
            self._bus.inbox.append((self.topic, message))

    def publish_later(self, make: Callable[[], Any], work: Any = None) -> Later | None:
        """Publishes what `make()` gives, made at once only where somebody is called back with it.

        Args:
            make: gives the message.
            work: what is being done on another thread that `make` waits for.

        Returns:
            What was handed out instead of the message; None where it was made.
        """
        if self.is_live:
            self.publish(make())
            return None
        later = Later(make, self._audience.looks_at_all, work)
        for receive in self._audience.receivers:
            receive(later)
        return later

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
    """All topics of a simulation.

    Attributes:
        inbox: commands that wait for the next step.
        revision: another number after every change of who reads or publishes what.
    """

    def __init__(self) -> None:
        self._audiences: dict[str, Audience] = {}
        self._publishers: dict[str, list[Publisher]] = {}
        self._listeners: dict[str, list[Listener]] = {}
        self._watchers: list[Callable[[str, str], None]] = []
        self._owner: object = None
        self.inbox: deque[tuple[str, Any]] = deque()
        self.revision = 0

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
        self.gather(topic)
        self.revision += 1
        publisher = Publisher(self, topic, type_name, latched, self._owner)
        self._publishers.setdefault(topic, []).append(publisher)
        self._announce(topic, type_name)
        return publisher

    def listen(self, topic: str, types: Sequence[str], callback: Callback) -> Listener:
        """Opens a topic for commands; the first of `types` is the one listed."""
        topic = absolute(topic)
        self.gather(topic)
        self.revision += 1
        listener = Listener(topic, types, callback, self._owner)
        self._listeners.setdefault(topic, []).append(listener)
        self._audience(topic).feeds = True
        self._announce(topic, types[0])
        return listener

    def subscribe(self, topic: str, callback: Callback | None = None, keep: int | None = None) -> Subscription:
        """Receives a topic, whether its publisher exists yet or not."""
        return self._add_reader(Subscription(self, absolute(topic), callback, keep))

    def tap(self, topic: str, callback: Callback, *, takes_later: bool = False) -> Subscription:
        """Receives a topic without keeping its messages.

        Args:
            topic: absolute, or taken as such.
            callback: called with each message.
            takes_later: whether it may be called with a `Later` instead, which it keeps as long as it needs.
        """
        return self._add_reader(_Stream(self, absolute(topic), callback, takes_later))

    def close(self, end: Publisher | Listener) -> None:
        """Takes a publisher or a listener away for good."""
        self.gather(end.topic)
        self.revision += 1
        table: Mapping[str, list[Any]] = self._publishers if isinstance(end, Publisher) else self._listeners
        if end in table.get(end.topic, []):
            table[end.topic].remove(end)
        self._audience(end.topic).feeds = bool(self._listeners.get(end.topic))

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
        return bool(self._audience(absolute(topic)).readers)

    def on_topic(self, callback: Callable[[str, str], None]) -> None:
        """Calls `callback(topic, type_name)` for every topic there is and will be."""
        self._watchers.append(callback)
        for topic, type_name in self.topics().items():
            callback(topic, type_name)

    # ------------------------------------------------------------------ messages

    def settle(self) -> None:
        """Makes every message that waits to be looked at, before what it is made from changes."""
        for publishers in self._publishers.values():
            for publisher in publishers:
                if publisher.pending is not None:
                    publisher.pending()
        for audience in self._audiences.values():
            for reader in audience.readers:
                reader.messages  # noqa: B018

    def gather(self, topic: str) -> None:
        """Lets the publishers of a topic hand over what they have put off."""
        for publisher in self._publishers.get(topic, ()):
            if publisher.pending is not None:
                publisher.pending()

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

    def enqueue(self, call: Callable[[], None]) -> None:
        """Has something done between two steps, in its turn among the queued commands."""
        self.inbox.append(("", call))

    def deliver_inputs(self) -> None:
        """Hands queued commands to their inputs, in the order of arrival."""
        for _ in range(len(self.inbox)):
            topic, message = self.inbox.popleft()
            if not topic:
                message()
                continue
            for listener in self._listeners.get(topic, ()):
                if listener.active and msgs.type_name(message) in listener.types:
                    listener.callback(message)

    def _listed(self) -> str:
        return "there is " + (", ".join(self.topics()) or "none")

    def _deliver(self, topic: str, message: Any) -> None:
        self.gather(topic)
        audience = self._audience(topic)
        for receive in audience.receivers:
            receive(message)
        if audience.feeds:
            self.inbox.append((topic, message))

    def _audience(self, topic: str) -> Audience:
        found = self._audiences.get(topic)
        if found is None:
            found = self._audiences[topic] = Audience()
        return found

    def _add_reader(self, subscription: Subscription) -> Subscription:
        topic = subscription.topic
        self.gather(topic)
        self.revision += 1
        audience = self._audience(topic)
        audience.readers.append(subscription)
        audience.count()
        for publisher in self._publishers.get(topic, ()):
            if publisher.latched and publisher.active and publisher._last is not None:
                subscription.receive(publisher._last)
        return subscription

    def _unsubscribe(self, subscription: Subscription) -> None:
        audience = self._audience(subscription.topic)
        if subscription in audience.readers:
            self.gather(subscription.topic)
            self.revision += 1
            audience.readers.remove(subscription)
            audience.count()

    def _announce(self, topic: str, type_name: str) -> None:
        for watcher in self._watchers:
            watcher(topic, type_name)
