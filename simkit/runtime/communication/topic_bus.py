"""Topics within the process: messages go to subscribers at once, and to command inputs between two steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from itertools import chain
from typing import TYPE_CHECKING, Any

from simkit import msgs
from simkit.argument_checks import check_function, checked_integer, wrong_value
from simkit.diagnostics import Diagnostics, name_hint
from simkit.errors import MessageError, SimkitError
from simkit.msgs import Message
from simkit.msgs.message_arguments import checked_message
from simkit.msgs.topic_names import absolute_name
from simkit.runtime.communication.command_queue import CommandQueue
from simkit.runtime.communication.journal import Journal
from simkit.runtime.communication.name_remapping import NameRemapping
from simkit.runtime.communication.publisher import Check, ExternalPublisher, Listener, Publisher, Tally, TopicSides
from simkit.runtime.communication.subscription import (
    MAX_KEPT_MESSAGES,
    Callback,
    CallbackPolicy,
    Settle,
    StreamSubscription,
    Subscription,
    TopicFailures,
    TopicReaders,
)
from simkit.runtime.communication.topic_conflicts import find_conflict
from simkit.runtime.engine.plugin_faults import is_guarded

if TYPE_CHECKING:
    from simkit.runtime.communication.topic_relay import InputRelay, TopicRelay

Endpoints = list[Any]
"""Publishers of a topic, or its listeners."""


class TopicBus:
    """All topics of a simulation.

    Args:
        reports: collection for diagnostics about messages during the run.
        now: function that returns the simulated time [s].
        remapping: other names for the topics, services and actions of plugins and sensors.

    Attributes:
        remapping: other names for the topics, services and actions of plugins and sensors.
        inbox: commands that wait for the next step.
        refuses_clashes: raise an error when a publisher or listener of another type than the topic's is opened. While
            plugins are being loaded, one pass checks all of them together instead.
        revision: counter that changes with every change of readers and publishers.
        aside: topics that recorders and counters ignore unless the user names them.
        unlisted: topics of `aside` that are only listed while they have subscribers.
        failures: handling of callbacks that raise, and of too many messages.
        journal: recorder of external inputs; None without one.
        relays: open relays.
    """

    def __init__(
        self,
        reports: Diagnostics | None = None,
        now: Callable[[], float] = lambda: 0.0,
        remapping: NameRemapping | None = None,
    ) -> None:
        self.failures = TopicFailures(Diagnostics() if reports is None else reports, now)
        self._readers: dict[str, TopicReaders] = {}
        self._publishers: dict[str, list[Publisher]] = {}
        self._listeners: dict[str, list[Listener]] = {}
        self._watchers: list[Callable[[str, str], None]] = []
        self.owner: object = None
        self.remapping = NameRemapping() if remapping is None else remapping
        self._renames = False  # True while a plugin or a sensor opens interfaces
        self.inbox = CommandQueue(self.failures.report_dropped)
        self.refuses_clashes, self.revision = False, 0
        self.aside: set[str] = set()
        self.unlisted: set[str] = set()
        self.journal: Journal | None = None
        self._on_change: dict[str, list[Callable[[], None]]] = {}
        self.relays: list[TopicRelay | InputRelay] = []

    # ------------------------------------------------------------------ publishers, listeners, subscriptions

    def passing(self, operation: str, **arguments: object) -> AbstractContextManager[Any]:
        """Return the context manager in which an operation runs; an active journal records external operations."""
        return nullcontext() if self.journal is None else self.journal.passing(operation, arguments)

    @contextmanager
    def owned_by(self, owner: object, *, renames: bool = True) -> Iterator[None]:
        """Make `owner` the owner of all interfaces that are opened within the context.

        The interfaces are disabled together with their owner.

        Args:
            owner: plugin, sensor, or another object.
            renames: False for an owner that is no part of the world; `remapping` does not change its names.
        """
        before = self.owner, self._renames
        self.owner, self._renames = owner, renames
        try:
            yield
        finally:
            self.owner, self._renames = before

    def name_of(self, name: str) -> str:
        """Return the absolute name of a topic, service or action that is opened now; plugins and sensors get new names.

        Args:
            name: name; a missing leading slash is added.
        """
        name = absolute_name(name)
        return self.remapping.use(name) if self._renames else name

    @contextmanager
    def clashes_allowed(self) -> Iterator[None]:
        """Allow other types than the topic's within the context, because one pass checks all of them afterwards."""
        self.refuses_clashes = False
        try:
            yield
        finally:
            self.refuses_clashes = True

    def advertise(
        self,
        topic: str,
        type_name: str,
        *,
        latched: bool = False,
        check: Check | None = None,
        pending: Callable[[], None] | None = None,
    ) -> Publisher:
        """Open a topic for publishing.

        Args:
            topic: name of the topic; a missing leading slash is added.
            type_name: ROS 2 type, such as `sensor_msgs/msg/Imu`.
            latched: send the last message to a later subscriber (transient local).
            check: function that raises a SimkitError if the messages cannot be made; called for every reader.
            pending: function that publishes the deferred messages of the owner.
        """
        topic = self.name_of(topic)
        self.gather(topic)
        self.revision += 1
        kind = Publisher if self.owner is not None else ExternalPublisher
        sides = TopicSides(self._readers_of(topic), self._publishers.setdefault(topic, []))
        publisher = kind(self, sides, topic, type_name, latched, self.owner, check, pending)
        self._check_type(topic, publisher)
        if check is not None and (sides.readers.readers or sides.readers.feeds):
            check()
        sides.publishers.append(publisher)
        self._announce(topic, type_name)
        if self.owner is None:
            with self.passing("advertise", publisher=publisher):
                pass
        return publisher

    def listen(self, topic: str, types: Sequence[str], callback: Callback, *, depth: int | None = None) -> Listener:
        """Open a topic for commands.

        Args:
            topic: name of the topic; a missing leading slash is added.
            types: accepted types; `topics` lists the first one.
            callback: function that receives each message between two steps.
            depth: largest number of messages of the topic that wait for one step; the oldest are dropped. The largest
                depth of the topic's listeners counts.
        """
        topic = self.name_of(topic)
        if depth is not None:
            self.inbox.depths[topic] = max(1, depth, self.inbox.depths.get(topic, 0))
        self.check_available(topic)
        self.gather(topic)
        self.revision += 1
        listener = Listener(self, topic, types, callback, self.owner)
        self._check_type(topic, listener)
        self._listeners.setdefault(topic, []).append(listener)
        self._readers_of(topic).feeds = True
        self._announce(topic, types[0])
        self._report_change(topic)
        return listener

    def subscribe(
        self, topic: str, callback: Callback | None = None, keep: int | None = None, on_error: CallbackPolicy = "stop"
    ) -> Subscription:
        """Receive a topic; its publisher may be opened later.

        Args:
            topic: name of the topic; a missing leading slash is added.
            callback: function that receives each message.
            keep: number of newest messages to keep; None for a million.
            on_error: policy for a callback that raises: "stop" stops the run with a SubscriberError, "drop" closes the
                subscription with a warning, and the run continues.
        """
        if not isinstance(on_error, str) or on_error not in ("stop", "drop"):
            raise wrong_value("on_error", "'stop' or 'drop'", on_error)
        if callback is not None:
            check_function(callback, "callback")
        if keep is not None:
            keep = checked_integer(keep, "keep", 0, MAX_KEPT_MESSAGES)
        subscription = Subscription(self, self.name_of(topic), callback, keep, on_error)
        if self.journal is not None and callback is not None and not is_guarded(callback):
            self.journal.hears(subscription.topic, subscription)
        return self._add_reader(subscription)

    def tap(self, topic: str, callback: Callback, *, takes_later: bool = False, settle: Settle = None) -> Subscription:
        """Receive a topic (a missing leading slash is added) without keeping its messages.

        Args:
            topic: name of the topic.
            callback: function that receives each message.
            takes_later: True if the callback accepts a `LazyMessage` instead of a message; it may store it.
            settle: function that makes the stored messages; called before their source data change.
        """
        return self._add_reader(StreamSubscription(self, self.name_of(topic), callback, takes_later, settle))

    def close(self, end: Publisher | Listener) -> None:
        """Remove a publisher or a listener permanently."""
        self.gather(end.topic)
        if end.owner is None:
            with self.passing("close", endpoint=end):
                pass
        self.revision += 1
        table: Any = self._publishers if isinstance(end, Publisher) else self._listeners
        if end in table.get(end.topic, []):
            table[end.topic].remove(end)
        self._readers_of(end.topic).feeds = bool(self._listeners.get(end.topic))
        self._report_change(end.topic)
        self._tidy(end.topic)

    def set_active(self, owners: Sequence[object]) -> None:
        """Enable what these owners publish and receive, and everything without an owner; disable the others."""
        living = {id(o) for o in owners}
        for end in self._all_ends():
            end.active = end.owner is None or id(end.owner) in living
        for subscription in self._owned_subscriptions():
            is_active = id(subscription.owner) in living
            if subscription.active != is_active:
                subscription.active = is_active
                self._readers_of(subscription.topic).count()

    def forget(self, owners: Sequence[object]) -> None:
        """Remove every publisher, listener and subscription of these owners permanently."""
        removed = {id(owner) for owner in owners}
        for end in [end for end in self._all_ends() if id(end.owner) in removed]:
            self.close(end)
        for subscription in self._owned_subscriptions():
            if id(subscription.owner) in removed:
                self.unsubscribe(subscription)

    def _owned_subscriptions(self) -> list[Subscription]:
        return [reader for readers in self._readers.values() for reader in readers.readers if reader.owner is not None]

    def _all_ends(self) -> Endpoints:
        ends: Endpoints = [*self._publishers.values(), *self._listeners.values()]
        return [end for group in ends for end in group]

    def listeners(self) -> Iterator[Listener]:
        """Yield all command inputs."""
        return chain.from_iterable(self._listeners.values())

    def endpoints(self, topic: str | None = None) -> Iterator[tuple[str, Publisher | Listener, tuple[str, ...], str]]:
        """Yield tuples of topic, publisher or listener, ROS types, and "publishes" or "takes".

        Args:
            topic: absolute name of one topic; None for all topics.
        """
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
        if isinstance(end, Publisher):
            for reader in self._readers_of(topic).readers:
                if reader.expected not in ("", end.type_name) and reader.active:
                    text = f"topic {topic!r} has a subscription of type {reader.expected}, got {end.type_name}"
                    raise MessageError(text)

    # ------------------------------------------------------------------ lists

    def types_of(self, topic: str) -> list[str]:
        """Return the types of a topic: those of its command inputs first, then those of its publishers."""
        types = [t for li in self._listeners.get(topic, ()) if li.active for t in li.types]
        return [*types, *(p.type_name for p in self._publishers.get(topic, ()) if p.active)]

    def count_inputs(self, topic: str) -> int:
        """Return the number of command inputs of a topic."""
        return sum(li.active for li in self._listeners.get(topic, ()))

    def idle_topics(self) -> frozenset[str]:
        """Return the topics whose owners all ignore messages at present, such as those of an inactive controller."""
        return frozenset(
            topic
            for topic, listeners in self._listeners.items()
            if (active := [listener for listener in listeners if listener.active])
            and all(listener.is_ready is not None and not listener.is_ready() for listener in active)
        )

    def topics(self) -> dict[str, str]:
        """Return the types by topic, sorted, except unlisted topics and topics that only have subscriptions."""
        return {t: kind for t, kind in self.all_topics().items() if t not in self.unlisted or self.wanted(t)}

    def all_topics(self) -> dict[str, str]:
        """Return the ROS type names of all topics, including unlisted ones."""
        type_by_topic: dict[str, str] = {}
        for topic, end, types, _ in self.endpoints():
            if end.active:
                type_by_topic.setdefault(topic, types[0])
        return dict(sorted(type_by_topic.items()))

    def latched(self) -> frozenset[str]:
        """Return the topics whose last message is kept for later subscribers."""
        return frozenset(t for t, publishers in self._publishers.items() for p in publishers if p.latched and p.active)

    def check_available(self, topic: str) -> bool:
        """Raise the error of a publisher that cannot draw its messages; return True if a publisher draws messages."""
        checks = [p.check for p in self._publishers.get(topic, ()) if p.active and p.check is not None]
        for check in checks:
            check()
        return bool(checks)

    def tally_of(self, topic: str) -> Callable[[], Tally | None] | None:
        """Return the `tally` of the only publisher of a topic; None for several publishers."""
        publishers = self._publishers.get(topic, ())
        return publishers[0].tally if len(publishers) == 1 else None

    def wanted(self, topic: str) -> bool:
        """Check whether a topic has subscribers."""
        return bool(self._readers_of(absolute_name(topic)).readers)

    def on_topic(self, callback: Callable[[str, str], None]) -> None:
        """Call `callback(topic, type_name)` for every present and future topic.

        The call is repeated for each further publisher or command input of the topic, and for a message from outside on
        a topic whose own messages follow from the time alone.
        """
        self._watchers.append(callback)
        for topic, type_name in self.all_topics().items():
            callback(topic, type_name)

    def on_readers_change(self, topic: str, callback: Callable[[], None]) -> Callable[[], None]:
        """Call a function whenever the subscriptions of a topic have changed; return a function that ends this."""
        callbacks = self._on_change.setdefault(topic, [])
        if callback not in callbacks:  # a plugin of a model that is spawned again registers the same function
            callbacks.append(callback)

        def stop() -> None:
            if callback in callbacks:
                callbacks.remove(callback)

        return stop

    def readers(self, topic: str) -> list[Subscription]:
        """Return the open subscriptions of a topic."""
        return list(self._readers_of(absolute_name(topic)).readers)

    def subscriptions(self) -> list[Subscription]:
        """Return all open subscriptions."""
        return [reader for readers in self._readers.values() for reader in readers.readers]

    def _report_change(self, topic: str) -> None:
        for callback in tuple(self._on_change.get(topic, ())):
            callback()

    # ------------------------------------------------------------------ messages

    def settle(self) -> None:
        """Make every message that is not made yet, before its source data change."""
        for publishers in self._publishers.values():
            for publisher in publishers:
                if publisher.pending is not None:
                    publisher.pending()
        for readers in self._readers.values():
            for reader in readers.readers:
                reader.settle()

    def settle_topic(self, topic: str) -> None:
        """Make every message of one topic that is not made yet."""
        self.gather(topic)
        for reader in self._readers_of(topic).readers:
            reader.settle()

    def gather(self, topic: str) -> None:
        """Publish the deferred messages of a topic."""
        for publisher in self._publishers.get(topic, ()):
            if publisher.pending is not None:
                publisher.pending()

    def message_for(self, topic: str, message: Message) -> Message:
        """Return a message for a topic; a dict is converted to a type of the topic.

        Raises:
            MessageError: the type of a dict is unknown, or the dict fits no type.
        """
        topic = absolute_name(topic)
        types = self.types_of(topic)
        if not types and isinstance(message, Mapping):
            raise MessageError(f"no topic {topic!r}; {name_hint(topic, self.topics())}")
        return checked_message(message, types, repr(topic))

    def publish(self, topic: str, message: Message) -> None:
        """Publish a message from outside the loop: to subscribers now, to command inputs before the next step.

        Raises:
            MessageError: the type of a dict is unknown, or the dict fits no type.
        """
        topic = absolute_name(topic)
        message = self.message_for(topic, message)
        with self.passing("publish", topic=topic, message=message):
            self.gather(topic)
            if self.tally_of(topic) is not None:
                self._announce(topic, self.types_of(topic)[0])
            readers = self._readers_of(topic)
            for receive in readers.receivers:
                receive(message)
            if readers.feeds:
                self.inbox.put(topic, message)

    def enqueue(self, call: Callable[[], None]) -> None:
        """Call a function between two steps, after the commands that are already queued."""
        self.inbox.put("", call)

    def deliver_inputs(self) -> None:
        """Pass queued commands to their inputs, in the order of arrival.

        Raises:
            PluginError: a plugin raised; the remaining commands wait for the next step.
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
                if inbox.generation != generation:  # the callback restored another state
                    return
        except BaseException:
            if inbox.generation == generation:
                inbox.put_back(entries[done:])
            raise

    def deliver_now(self, topic: str, message: Message) -> None:
        """Pass a command to its inputs at once, for a callback that gets commands between two steps itself."""
        self._deliver_input(topic, message)

    def _deliver_input(self, topic: str, message: Message) -> None:
        for listener in tuple(self._listeners.get(topic, ())):
            if listener.active and msgs.type_name(message) in listener.types:
                listener.last = message
                try:
                    listener.callback(message)
                except SimkitError:
                    raise
                except Exception as error:
                    raise self.failures.input_error(topic, listener.owner, listener.callback, error) from error

    @property
    def dropped(self) -> dict[str, int]:
        """Number of dropped command messages by topic. Messages are dropped if too many arrive for one step."""
        return dict(self.inbox.dropped)

    def _readers_of(self, topic: str) -> TopicReaders:
        readers = self._readers.get(topic)
        if readers is None:
            readers = self._readers[topic] = TopicReaders()
        return readers

    def _add_reader(self, subscription: Subscription) -> Subscription:
        topic = subscription.topic
        self.check_available(topic)
        self.gather(topic)
        self.revision += 1
        readers = self._readers_of(topic)
        readers.readers.append(subscription)
        readers.count()
        for publisher in self._publishers.get(topic, ()):
            if publisher.latched and publisher.active:
                publisher.send_kept(subscription.receive, makes=subscription.is_called)
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
        """Remove a topic without publishers, listeners and subscriptions.

        A long run with changing topic names would otherwise need ever more memory.
        """
        if not (self._publishers.get(topic) or self._listeners.get(topic) or self._readers_of(topic).readers):
            for table in (self._publishers, self._listeners, self._readers):
                table.pop(topic, None)

    def _announce(self, topic: str, type_name: str) -> None:
        for watcher in self._watchers:
            watcher(topic, type_name)


class MessagesBySubscription(dict[Subscription, Message]):
    """Newest message of each subscription. A pickled snapshot contains none, because it has no subscriptions."""

    def __reduce__(self) -> tuple[type[MessagesBySubscription], tuple[()]]:
        return MessagesBySubscription, ()


class LatestMessages:
    """Newest messages of all subscriptions of a bus, so that `Subscription.latest` belongs to the restored state.

    Args:
        bus: topic bus.
    """

    def __init__(self, bus: TopicBus) -> None:
        self._bus = bus

    def _subscriptions(self) -> list[Subscription]:
        return [subscription for subscription in self._bus.subscriptions() if subscription.keeps]

    def get_state(self) -> MessagesBySubscription:
        """Return the newest messages for a snapshot."""
        return MessagesBySubscription((subscription, subscription.latest) for subscription in self._subscriptions())

    def set_state(self, state: MessagesBySubscription) -> None:
        """Restore the newest messages.

        A subscription that is newer than the snapshot gets what a new subscription would get: the message that a
        latched topic keeps, or none.
        """
        for subscription in self._subscriptions():
            self._bus.gather(subscription.topic)  # deferred messages belong to the state of before
            subscription.restore_latest(
                state[subscription] if subscription in state else self._kept(subscription.topic)
            )

    def _kept(self, topic: str) -> Message:
        """Return the message that a latched topic keeps for a new subscription, or None."""
        messages: list[Message] = [None]
        for _, end, _, _ in self._bus.endpoints(topic):
            if isinstance(end, Publisher) and end.active and end.latched:
                end.send_kept(messages.append)
        return messages[-1]
