"""Topics within the process. Readings go out at once; commands queue and come in between two steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from simkit import msgs
from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.errors import InputError, MessageError, PluginError, SimkitError, SimulationDiverged, SubscriberError
from simkit.runtime.communication.command_queue import QUEUE_DEPTH, CommandQueue
from simkit.runtime.communication.journal import Journal
from simkit.runtime.communication.publisher import ExternalPublisher, Listener, Publisher
from simkit.runtime.communication.subscription import (
    MAX_KEPT_MESSAGES,
    NO_MESSAGE,
    Callback,
    CallbackErrorPolicy,
    LazyMessage,
    StreamSubscription,
    Subscription,
    TopicReaders,
    callback_name,
)
from simkit.runtime.communication.topic_conflicts import find_conflict
from simkit.runtime.engine.plugin_faults import is_guarded

__all__ = [
    "NO_MESSAGE",
    "Callback",
    "CallbackErrorPolicy",
    "LazyMessage",
    "Listener",
    "Publisher",
    "Subscription",
    "TopicBus",
    "absolute_name",
]


def absolute_name(topic: str) -> str:
    """The topic with its leading slash."""
    return topic if topic.startswith("/") else "/" + topic


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
        journal: hears of what comes in from outside; None where nobody does.
    """

    def __init__(self, reports: Diagnostics | None = None, now: Callable[[], float] = lambda: 0.0) -> None:
        self._reports, self._now = Diagnostics() if reports is None else reports, now
        self._audiences: dict[str, TopicReaders] = {}
        self._publishers: dict[str, list[Publisher]] = {}
        self._listeners: dict[str, list[Listener]] = {}
        self._watchers: list[Callable[[str, str], None]] = []
        self._owner: object = None
        self.inbox = CommandQueue(self._report_dropped)
        self.refuses_clashes = False
        self.revision = 0
        self.aside: set[str] = set()
        self.unlisted: set[str] = set()
        self.journal: Journal | None = None
        self._on_audience: dict[str, Callable[[], None]] = {}

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
        topic = absolute_name(topic)
        self.gather(topic)
        self.revision += 1
        kind = Publisher if self._owner is not None else ExternalPublisher
        publisher = kind(self, topic, type_name, latched, self._owner)
        self._check_type(topic, publisher)
        self._publishers.setdefault(topic, []).append(publisher)
        self._announce(topic, type_name)
        if self.journal is not None and self._owner is None:
            with self.journal.passing("advertise", {"publisher": publisher}):
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
        listener = Listener(topic, types, callback, self._owner)
        self._check_type(topic, listener)
        self._listeners.setdefault(topic, []).append(listener)
        self._audience(topic).feeds = True
        self._announce(topic, types[0])
        self._tell_audience(topic)
        return listener

    def subscribe(
        self,
        topic: str,
        callback: Callback | None = None,
        keep: int | None = None,
        on_error: CallbackErrorPolicy = "stop",
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
        if self.journal is not None and isinstance(end, ExternalPublisher):
            with self.journal.passing("close", {"publisher": end}):
                pass
        self.revision += 1
        table: Mapping[str, list[Any]] = self._publishers if isinstance(end, Publisher) else self._listeners
        if end in table.get(end.topic, []):
            table[end.topic].remove(end)
        self._audience(end.topic).feeds = bool(self._listeners.get(end.topic))
        self._tell_audience(end.topic)
        self._tidy(end.topic)

    def set_active(self, owners: Sequence[object]) -> None:
        """Leaves only the ends of these owners (and those without one) in use."""
        living = {id(o) for o in owners}
        tables: tuple[Mapping[str, list[Any]], ...] = (self._publishers, self._listeners)
        for ends in (ends for table in tables for ends in table.values()):
            for end in ends:
                end.active = end.owner is None or id(end.owner) in living

    def forget(self, owners: Sequence[object]) -> None:
        """Takes every end of these owners away for good."""
        gone = {id(owner) for owner in owners}
        tables: tuple[Mapping[str, list[Any]], ...] = (self._publishers, self._listeners)
        for end in [end for table in tables for ends in table.values() for end in ends if id(end.owner) in gone]:
            self.close(end)

    def ends(self, topic: str | None = None) -> Iterator[tuple[str, Publisher | Listener, tuple[str, ...], str]]:
        """Topic, end, its types and what it does ("publishes" or "takes"), of one topic or of all."""
        for name in dict.fromkeys((*self._publishers, *self._listeners)) if topic is None else (topic,):
            for publisher in self._publishers.get(name, ()):
                yield name, publisher, (publisher.type_name,), "publishes"
            for listener in self._listeners.get(name, ()):
                yield name, listener, listener.types, "takes"

    def _check_type(self, topic: str, end: Publisher | Listener) -> None:
        if self.refuses_clashes and end.owner is not None:
            clash = find_conflict(self, topic, end)
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
        return bool(self._audience(absolute_name(topic)).readers)

    def on_topic(self, callback: Callable[[str, str], None]) -> None:
        """Calls `callback(topic, type_name)` for every topic there is and will be."""
        self._watchers.append(callback)
        for topic, type_name in self.all_topics().items():
            callback(topic, type_name)

    def on_audience(self, topic: str, callback: Callable[[], None]) -> None:
        """Calls back whenever who hears a topic has changed."""
        self._on_audience[topic] = callback

    def _tell_audience(self, topic: str) -> None:
        if topic in self._on_audience:
            self._on_audience[topic]()

    # ------------------------------------------------------------------ messages

    def settle(self) -> None:
        """Makes every message that waits to be looked at, before what it is made from changes."""
        for publishers in self._publishers.values():
            for publisher in publishers:
                if publisher.pending is not None:
                    publisher.pending()
        for audience in self._audiences.values():
            for reader in audience.readers:
                reader.settle()

    def settle_topic(self, topic: str) -> None:
        """The same of one topic."""
        self.gather(topic)
        for reader in self._audience(topic).readers:
            reader.settle()

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
        topic = absolute_name(topic)
        types = [t for li in self._listeners.get(topic, ()) if li.active for t in li.types]
        types += [p.type_name for p in self._publishers.get(topic, ()) if p.active]
        if isinstance(message, Mapping):
            if not types:
                raise MessageError(f"no topic {topic!r}; {did_you_mean(topic, self.topics()) or self._listed()}")
            message = msgs.from_dict(list(dict.fromkeys(types)), dict(message))
        elif types and msgs.type_name(message) not in types:
            raise MessageError(f"{topic!r} takes {' or '.join(dict.fromkeys(types))}, got {msgs.type_name(message)}")
        if self.journal is None:
            self._deliver(topic, message)
        else:
            with self.journal.passing("publish", {"topic": topic, "message": message}):
                self._deliver(topic, message)

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

    def _deliver_input(self, topic: str, message: Any) -> None:
        for listener in tuple(self._listeners.get(topic, ())):
            if listener.active and msgs.type_name(message) in listener.types:
                try:
                    listener.callback(message)
                except SimkitError:
                    raise
                except Exception as error:
                    raise self._input_error(listener, error) from error

    # ------------------------------------------------------------------ what goes wrong

    @property
    def dropped(self) -> dict[str, int]:
        """Topic -> how many messages to its inputs were dropped, since too many came for one step."""
        return dict(self.inbox.dropped)

    def subscriber_failed(self, subscription: Subscription, error: Exception) -> None:
        """What becomes of a subscriber that raised, called while that is being handled."""
        if isinstance(error, (PluginError, SimulationDiverged)) or is_guarded(subscription.callback):
            raise error
        topic, name = subscription.topic, callback_name(subscription.callback)
        if subscription.on_error == "stop":
            if isinstance(error, SimkitError) and not isinstance(error, InputError):
                raise error  # else who publishes would be blamed for it
            raise SubscriberError(topic, name, self._now(), repr(error)) from error
        subscription.close()
        message = f"subscriber {name} of {topic!r} raised at t={self._now():.6g} s and hears no more: {error!r}"
        self._reports.warning("SK-TOPIC-003", message)

    def report_full(self, topic: str) -> None:
        """Tells that a subscription which keeps all has had more messages than it can keep."""
        message = f"a subscription to {topic!r} is full: of more than {MAX_KEPT_MESSAGES} messages the newest are there"
        self._reports.warning("SK-TOPIC-005", message, hint="subscribe with keep=, or close it once it is not needed")

    def _report_dropped(self, topic: str) -> None:
        depth = self.inbox.depths.get(topic, QUEUE_DEPTH)
        message = f"more than {depth} messages on {topic!r} came for one step: the oldest are dropped from now on"
        self._reports.warning("SK-TOPIC-004", message, hint="send less often; sim.bus.dropped counts them")

    def _input_error(self, listener: Listener, error: Exception) -> SimkitError:
        owner, what = listener.owner, f"its callback for {listener.topic!r}"
        if hasattr(owner, "where"):
            return PluginError(str(getattr(owner, "name", owner)), what, self._now(), str(owner.where), repr(error))
        return SubscriberError(listener.topic, callback_name(listener.callback), self._now(), repr(error))

    def _listed(self) -> str:
        return "there is " + (", ".join(self.topics()) or "none")

    def _deliver(self, topic: str, message: Any) -> None:
        self.gather(topic)
        audience = self._audience(topic)
        for receive in audience.receivers:
            receive(message)
        if audience.feeds:
            self.inbox.put(topic, message)

    def _audience(self, topic: str) -> TopicReaders:
        found = self._audiences.get(topic)
        if found is None:
            found = self._audiences[topic] = TopicReaders()
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
                if type(publisher._last) is LazyMessage:
                    publisher._last = publisher._last.get()
                subscription.receive(publisher._last)
        self._tell_audience(topic)
        return subscription

    def _unsubscribe(self, subscription: Subscription) -> None:
        audience = self._audience(subscription.topic)
        if subscription in audience.readers:
            self.gather(subscription.topic)
            self.revision += 1
            audience.readers.remove(subscription)
            audience.count()
            self._tell_audience(subscription.topic)
            self._tidy(subscription.topic)

    def _tidy(self, topic: str) -> None:
        """Forgets a topic that has no end any more: others come, with other names, for as long as a run goes on."""
        if not (self._publishers.get(topic) or self._listeners.get(topic) or self._audience(topic).readers):
            for table in (self._publishers, self._listeners, self._audiences):
                table.pop(topic, None)

    def _announce(self, topic: str, type_name: str) -> None:
        for watcher in self._watchers:
            watcher(topic, type_name)
