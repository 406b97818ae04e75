"""Topics within the process. Readings go out at once; commands queue and come in between two steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

from simkit import msgs
from simkit.diagnostics import Diagnostics, name_hint
from simkit.errors import MessageError, SimkitError
from simkit.runtime.communication.command_queue import CommandQueue
from simkit.runtime.communication.journal import Journal
from simkit.runtime.communication.publisher import ExternalPublisher, Listener, Publisher, TopicSides
from simkit.runtime.communication.subscription import (
    Callback,
    CallbackPolicy,
    LazyMessage,
    Message,
    StreamSubscription,
    Subscription,
    TopicReaders,
)
from simkit.runtime.communication.topic_conflicts import find_conflict
from simkit.runtime.communication.topic_failures import TopicFailures
from simkit.runtime.engine.plugin_faults import is_guarded


def absolute_name(topic: str) -> str:
    """The topic with its leading slash."""
    return topic if topic.startswith("/") else "/" + topic


Endpoints = list[Any]
"""Publishers of a topic, or its listeners."""


class TopicBus:
    """All topics of a simulation.

    Args:
        reports: where it tells what happens to messages while running.
        now: gives the simulated time [s].

    Attributes:
        inbox: commands that wait for the next step.
        refuses_clashes: whether an end of another type than the topic's is refused when it is opened; while plugins are
            being loaded all are looked at together.
        revision: another number after every change of who reads or publishes what.
        aside: topics that nobody takes unasked: recorders and counters leave them out unless they are named.
        unlisted: those of them that are only listed while somebody reads them.
        failures: what becomes of callbacks that raise, and of messages that are too many.
        journal: hears of what comes in from outside; None where nobody does.
    """

    def __init__(self, reports: Diagnostics | None = None, now: Callable[[], float] = lambda: 0.0) -> None:
        self.failures = TopicFailures(Diagnostics() if reports is None else reports, now)
        self._readers: dict[str, TopicReaders] = {}
        self._publishers: dict[str, list[Publisher]] = {}
        self._listeners: dict[str, list[Listener]] = {}
        self._watchers: list[Callable[[str, str], None]] = []
        self.owner: object = None
        self.inbox = CommandQueue(self.failures.report_dropped)
        self.refuses_clashes = False
        self.revision = 0
        self.aside: set[str] = set()
        self.unlisted: set[str] = set()
        self.journal: Journal | None = None
        self._on_change: dict[str, Callable[[], None]] = {}

    # ------------------------------------------------------------------ ends

    def passing(self, door: str, **words: object) -> AbstractContextManager[Any]:
        """A context of what is done by somebody who may be outside; a journal, if there is one, hears of it."""
        return nullcontext() if self.journal is None else self.journal.passing(door, words)

    @contextmanager
    def owned_by(self, owner: object) -> Iterator[None]:
        """Whatever opens a topic within belongs to `owner` and is silenced with it."""
        before, self.owner = self.owner, owner
        try:
            yield
        finally:
            self.owner = before

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> Publisher:
        """Opens a topic for publishing.

        Args:
            topic: absolute, or taken as such.
            type_name: ROS 2 type, such as `sensor_msgs/msg/Imu`.
            latched: a later subscriber gets the last message (transient local).
        """
        topic = absolute_name(topic)
        self.gather(topic)
        self.revision += 1
        kind = Publisher if self.owner is not None else ExternalPublisher
        sides = TopicSides(self._readers_of(topic), self._publishers.setdefault(topic, []))
        publisher = kind(self, sides, topic, type_name, latched, self.owner)
        self._check_type(topic, publisher)
        sides.publishers.append(publisher)
        self._announce(topic, type_name)
        if self.owner is None:
            with self.passing("advertise", publisher=publisher):
                pass
        return publisher

    def listen(self, topic: str, types: Sequence[str], callback: Callback, *, depth: int | None = None) -> Listener:
        """Opens a topic for commands.

        Args:
            topic: absolute, or taken as such.
            types: what is taken; the first is the one listed.
            callback: called with each message between two steps.
            depth: how many messages of the topic wait for one step at most, the oldest being dropped of more; the most
                that any of its listeners asks for.
        """
        topic = absolute_name(topic)
        if depth is not None:
            self.inbox.depths[topic] = max(1, depth, self.inbox.depths.get(topic, 0))
        self.gather(topic)
        self.revision += 1
        listener = Listener(topic, types, callback, self.owner)
        self._check_type(topic, listener)
        self._listeners.setdefault(topic, []).append(listener)
        self._readers_of(topic).feeds = True
        self._announce(topic, types[0])
        self._report_change(topic)
        return listener

    def subscribe(
        self, topic: str, callback: Callback | None = None, keep: int | None = None, on_error: CallbackPolicy = "stop"
    ) -> Subscription:
        """Receives a topic, whether its publisher exists yet or not.

        Args:
            topic: absolute, or taken as such.
            callback: called with each message.
            keep: how many messages are kept, the newest; a million where nothing is said.
            on_error: what becomes of a callback that raises: "stop" stops the run with a SubscriberError, "drop" closes
                the subscription with a warning, and the run goes on.
        """
        if on_error not in ("stop", "drop"):
            raise ValueError(f"on_error is 'stop' or 'drop', got {on_error!r}")
        subscription = Subscription(self, absolute_name(topic), callback, keep, on_error)
        if self.journal is not None and callback is not None and not is_guarded(callback):
            self.journal.hears(subscription.topic, subscription)
        return self._add_reader(subscription)

    def tap(self, topic: str, callback: Callback, *, takes_later: bool = False) -> Subscription:
        """Receives a topic without keeping its messages.

        Args:
            topic: absolute, or taken as such.
            callback: called with each message.
            takes_later: whether it may be called with a `LazyMessage` instead, which it keeps as long as it needs.
        """
        return self._add_reader(StreamSubscription(self, absolute_name(topic), callback, takes_later))

    def close(self, end: Publisher | Listener) -> None:
        """Takes a publisher or a listener away for good."""
        self.gather(end.topic)
        if isinstance(end, ExternalPublisher):
            with self.passing("close", publisher=end):
                pass
        self.revision += 1
        table: Mapping[str, Endpoints] = self._publishers if isinstance(end, Publisher) else self._listeners
        if end in table.get(end.topic, []):
            table[end.topic].remove(end)
        self._readers_of(end.topic).feeds = bool(self._listeners.get(end.topic))
        self._report_change(end.topic)
        self._tidy(end.topic)

    def set_active(self, owners: Sequence[object]) -> None:
        """Leaves only the ends of these owners (and those without one) in use."""
        living = {id(o) for o in owners}
        tables: tuple[Mapping[str, Endpoints], ...] = (self._publishers, self._listeners)
        for ends in (ends for table in tables for ends in table.values()):
            for end in ends:
                end.active = end.owner is None or id(end.owner) in living

    def forget(self, owners: Sequence[object]) -> None:
        """Takes every end of these owners away for good."""
        gone = {id(owner) for owner in owners}
        tables: tuple[Mapping[str, Endpoints], ...] = (self._publishers, self._listeners)
        for end in [end for table in tables for ends in table.values() for end in ends if id(end.owner) in gone]:
            self.close(end)

    def endpoints(self, topic: str | None = None) -> Iterator[tuple[str, Publisher | Listener, tuple[str, ...], str]]:
        """Topic, end, its types and what it does ("publishes" or "takes"), of one topic or of all."""
        for name in dict.fromkeys((*self._publishers, *self._listeners)) if topic is None else (topic,):
            for publisher in self._publishers.get(name, ()):
                yield name, publisher, (publisher.type_name,), "publishes"
            for listener in self._listeners.get(name, ()):
                yield name, listener, listener.types, "takes"

    def _check_type(self, topic: str, end: Publisher | Listener) -> None:
        if self.refuses_clashes and end.owner is not None:
            clash = find_conflict(self.endpoints(topic), topic, end)
            if clash:
                raise MessageError(clash)

    # ------------------------------------------------------------------ what there is

    def topics(self) -> dict[str, str]:
        """Topic -> ROS type name, of what is published and what is listened to, sorted."""
        return {t: kind for t, kind in self.all_topics().items() if t not in self.unlisted or self.wanted(t)}

    def all_topics(self) -> dict[str, str]:
        """The same with those that are not listed."""
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
        return bool(self._readers_of(absolute_name(topic)).readers)

    def on_topic(self, callback: Callable[[str, str], None]) -> None:
        """Calls `callback(topic, type_name)` for every topic there is and will be."""
        self._watchers.append(callback)
        for topic, type_name in self.all_topics().items():
            callback(topic, type_name)

    def on_readers_change(self, topic: str, callback: Callable[[], None]) -> None:
        """Calls back whenever the readers of a topic have changed."""
        self._on_change[topic] = callback

    def subscriptions(self) -> list[Subscription]:
        """All that are open."""
        return [reader for readers in self._readers.values() for reader in readers.readers]

    def _report_change(self, topic: str) -> None:
        if topic in self._on_change:
            self._on_change[topic]()

    # ------------------------------------------------------------------ messages

    def settle(self) -> None:
        """Makes every message that waits to be looked at, before what it is made from changes."""
        for publishers in self._publishers.values():
            for publisher in publishers:
                if publisher.pending is not None:
                    publisher.pending()
        for readers in self._readers.values():
            for reader in readers.readers:
                reader.settle()

    def settle_topic(self, topic: str) -> None:
        """The same of one topic."""
        self.gather(topic)
        for reader in self._readers_of(topic).readers:
            reader.settle()

    def gather(self, topic: str) -> None:
        """Lets the publishers of a topic hand over what they have put off."""
        for publisher in self._publishers.get(topic, ()):
            if publisher.pending is not None:
                publisher.pending()

    def publish(self, topic: str, message: Message) -> None:
        """A message from outside the loop: subscribers see it now, command inputs before the next step.

        Raises:
            MessageError: nobody could say what type a dict is to have, or it fits none.
        """
        topic = absolute_name(topic)
        types = [t for li in self._listeners.get(topic, ()) if li.active for t in li.types]
        types += [p.type_name for p in self._publishers.get(topic, ()) if p.active]
        if isinstance(message, Mapping):
            if not types:
                raise MessageError(f"no topic {topic!r}; {name_hint(topic, self.topics())}")
            message = msgs.from_dict(list(dict.fromkeys(types)), dict(message))
        elif types and msgs.type_name(message) not in types:
            raise MessageError(f"{topic!r} takes {' or '.join(dict.fromkeys(types))}, got {msgs.type_name(message)}")
        with self.passing("publish", topic=topic, message=message):
            self.gather(topic)
            readers = self._readers_of(topic)
            for receive in readers.receivers:
                receive(message)
            if readers.feeds:
                self.inbox.put(topic, message)

    def enqueue(self, call: Callable[[], None]) -> None:
        """Has something done between two steps, in its turn among the queued commands."""
        self.inbox.put("", call)

    def deliver_inputs(self) -> None:
        """Hands queued commands to their inputs, in the order of arrival.

        Raises:
            PluginError: a plugin raised; what came after waits for the next step.
        """
        inbox = self.inbox
        entries, generation, done = inbox.drain(), inbox.generation, 0
        try:
            for topic, message in entries:
                done += 1
                if topic:
                    self._deliver_input(topic, message)
                else:
                    message()
                if inbox.generation != generation:  # who was called went back to another time
                    return
        except BaseException:
            if inbox.generation == generation:
                inbox.put_back(entries[done:])
            raise

    def _deliver_input(self, topic: str, message: Message) -> None:
        for listener in tuple(self._listeners.get(topic, ())):
            if listener.active and msgs.type_name(message) in listener.types:
                try:
                    listener.callback(message)
                except SimkitError:
                    raise
                except Exception as error:
                    raise self.failures.input_error(listener, error) from error

    @property
    def dropped(self) -> dict[str, int]:
        """Topic -> how many messages to its inputs were dropped, since too many came for one step."""
        return dict(self.inbox.dropped)

    def _readers_of(self, topic: str) -> TopicReaders:
        found = self._readers.get(topic)
        if found is None:
            found = self._readers[topic] = TopicReaders()
        return found

    def _add_reader(self, subscription: Subscription) -> Subscription:
        topic = subscription.topic
        self.gather(topic)
        self.revision += 1
        readers = self._readers_of(topic)
        readers.readers.append(subscription)
        readers.count()
        for publisher in self._publishers.get(topic, ()):
            if publisher.latched and publisher.active and publisher.last is not None:
                if type(publisher.last) is LazyMessage:
                    publisher.last = publisher.last.get()
                subscription.receive(publisher.last)
        self._report_change(topic)
        return subscription

    def unsubscribe(self, subscription: Subscription) -> None:
        readers = self._readers_of(subscription.topic)
        if subscription in readers.readers:
            self.gather(subscription.topic)
            self.revision += 1
            readers.readers.remove(subscription)
            readers.count()
            self._report_change(subscription.topic)
            self._tidy(subscription.topic)

    def _tidy(self, topic: str) -> None:
        """Forgets a topic that has no end any more: others come, with other names, for as long as a run goes on."""
        if not (self._publishers.get(topic) or self._listeners.get(topic) or self._readers_of(topic).readers):
            for table in (self._publishers, self._listeners, self._readers):
                table.pop(topic, None)

    def _announce(self, topic: str, type_name: str) -> None:
        for watcher in self._watchers:
            watcher(topic, type_name)
