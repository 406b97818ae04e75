"""View of a world for expressions: models, links and joints by name, and the messages of topics."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from typing import Any, Literal, Protocol

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.msgs.topic_names import absolute_name
from simkit.pose import Pose, Vector
from simkit.runtime import Joint, Simulation, Subscription
from simkit.runtime.contact.collision_contacts import collision_table
from simkit.testing.conditions.syntax_tree import REMOVED_CODE, Span, UndecidedValue, expression_error


class _TopicListener(ABC):
    """Subscriber of a topic between the calls of `open` and `close`.

    Args:
        sim: Simulation.
        topic: Absolute name of the topic.
    """

    def __init__(self, sim: Simulation, topic: str) -> None:
        self.topic, self._sim = topic, sim
        self._subscription: Subscription | None = None

    @abstractmethod
    def _subscribe(self) -> Subscription:
        """Subscribe to the topic."""

    def open(self) -> None:
        """Subscribe, if there is no subscription yet."""
        if self._subscription is None:
            self._subscription = self._subscribe()

    def close(self) -> None:
        """End the subscription; received data remain."""
        if self._subscription is not None:
            self._subscription.close()


class LatestMessage(_TopicListener):
    """Newest message of a topic; a lazy message is created only when it is read."""

    def _subscribe(self) -> Subscription:
        return self._sim.communication.bus.subscribe(self.topic, keep=1)

    def latest(self) -> object:
        """Return the newest message.

        Raises:
            UndecidedValue: No message was received.
        """
        message = self._subscription.latest if self._subscription is not None else None
        if message is None:
            raise UndecidedValue(f"no message received on {self.topic}")
        return message


class MessageCounter(_TopicListener):
    """Number and times of the messages on a topic; the content of the messages is not read.

    Attributes:
        count: Number of messages since `open` or since the last reset of the simulation.
        first, last: Simulated times of the first and the newest message [ns].
    """

    count = first = last = 0

    def _subscribe(self) -> Subscription:
        return self._sim.communication.bus.tap(self.topic, self._take, takes_later=True)

    def rate(self) -> float | None:
        """Return the rate from the first to the newest message [Hz]; None if no two messages have different times."""
        if self.count < 2 or self.last <= self.first:
            return None
        return (self.count - 1) * 1e9 / (self.last - self.first)

    def _take(self, _: object) -> None:
        now = self._sim.time_ns
        if now < self.last:  # the simulation was reset
            self.count = 0
        if not self.count:
            self.first = now
        self.last = now
        self.count += 1


_MAX_LISTED = 12  # maximum number of names in an error message


class AbsentTopic(Exception):
    """Topic without a publisher."""

    def __init__(self, topic: str, hint: str) -> None:
        super().__init__(f"no publisher on {topic}" + (f"; {hint}" if hint else ""))
        self.topic = topic


class Entity:
    """Model or link by name; if the entity was removed, a new entity with the same name is used.

    Args:
        sim: Simulation.
        handle: Handle of the model or link.
    """

    def __init__(self, sim: Simulation, handle: Any) -> None:
        self.handle, self.name = handle, handle.scoped
        self._sim = sim
        self._kind = "link" if hasattr(handle, "linear_velocity") else "model"

    def pose(self) -> Pose:
        """Return the pose in the world frame."""
        pose: Pose
        try:
            pose = self.handle.pose
        except InputError as error:
            pose = self._find_replacement(error).pose
        return pose

    def twist(self) -> tuple[Vector, Vector]:
        """Return the linear velocity of the origin [m/s] and the angular velocity [rad/s] in world axes."""
        try:
            return self._twist(self.handle)
        except InputError as error:
            return self._twist(self._find_replacement(error))

    def _twist(self, handle: Any) -> tuple[Vector, Vector]:
        if self._kind == "link":
            both = handle._velocity()
            return both[3:], both[:3]
        origin = handle.pose.position
        carrier = self._sim.contents.handles.tables["link"].get(handle.scene.canonical_link)
        if carrier is None:
            return np.zeros(3), np.zeros(3)
        both = carrier._velocity()
        angular = both[:3]
        # velocity of the model's origin, which is rigidly connected to the canonical link
        x, y, z = (origin - carrier.pose.position).tolist()
        a, b, c = angular.tolist()
        return both[3:] + np.array((b * z - c * y, c * x - a * z, a * y - b * x)), angular

    def _find_replacement(self, error: InputError) -> Any:
        """Return the new entity that has the name of the removed one.

        Raises:
            UndecidedValue: No entity has the name.
        """
        if error.code != REMOVED_CODE:
            raise error
        found = self._sim.contents.handles.tables[self._kind].get(self.name)
        if found is None:
            raise UndecidedValue(f"{self.name} was removed") from None
        self.handle = found
        return found


class History(Protocol):
    """Value of the whole run so far.

    Attributes:
        topic: topic whose messages are observed; empty for observations at `rate`.
        rate: rate of the observations [Hz]; None for every step.
    """

    topic: str
    rate: float | None

    def observe(self) -> None:
        """Add the present state."""


class WorldView:
    """View of a simulation for expressions.

    Args:
        sim: Simulation.
        absent: Behaviour for a topic without a publisher: raise an "error", or "wait" for a publisher.
    """

    def __init__(self, sim: Simulation, absent: Literal["error", "wait"] = "error") -> None:
        self.sim, self.absent = sim, absent
        self._latest_messages: dict[str, LatestMessage] = {}
        self._counters: dict[str, MessageCounter] = {}
        self._histories: list[History] = []
        self._history_ends: list[Callable[[], None]] = []
        self._is_open = False

    # ------------------------------------------------------------------ names

    def entity(self, name: str, source: str, span: Span) -> Entity:
        """Return a model or link by its scoped name, or by its short name if that is unique.

        Raises:
            InputError: SK-COND-005 no entity or several entities have the name; the message suggests the closest.
        """
        return Entity(self.sim, self._find(("model", "link"), name, source, span))

    def joint(self, name: str, source: str, span: Span) -> Joint:
        """Return a joint by its scoped name, or by its short name if that is unique."""
        found: Joint = self._find(("joint",), name, source, span)
        return found

    def scoped_name(self, name: str, source: str, span: Span) -> str:
        """Return the scoped name of a model, a link or a collision."""
        if name in collision_table(self.sim.engine.structure.compiled).names:
            return name
        found: str = self._find(("model", "link"), name, source, span).scoped
        return found

    def _find(self, kinds: tuple[str, ...], name: str, source: str, span: Span) -> Any:
        tables = self.sim.contents.handles.tables
        for kind in kinds:
            if name in tables[kind]:
                return tables[kind][name]
        everything: dict[str, object] = {k: v for kind in reversed(kinds) for k, v in tables[kind].items()}
        own = [key for key in everything if key.rpartition("::")[2] == name]
        if len(own) == 1:
            return everything[own[0]]
        what = " or ".join(kinds)
        if own:
            message = f"{len(own)} entities have the name {name!r}: {_list_names(own)}"
            raise expression_error("SK-COND-005", message, source, span, "write the scoped name")
        short = [key.rpartition("::")[2] for key in everything]
        near = did_you_mean(name, [*everything, *short])
        message = f"the world has no {what} {name!r}"
        raise expression_error("SK-COND-005", message, source, span, near or _available_text(everything))

    # ------------------------------------------------------------------ topics

    def topic(self, name: str, source: str, span: Span) -> tuple[str, str]:
        """Return the absolute name and the type of a topic.

        Raises:
            InputError: SK-COND-006 the topic does not exist; the message suggests the closest.
            AbsentTopic: The topic does not exist yet, and the view waits for it.
        """
        topic = absolute_name(name)
        topics = self.sim.communication.bus.all_topics()
        if topic in topics:
            return topic, topics[topic]
        near = did_you_mean(topic, topics)
        if self.absent == "wait":
            self.latest_message(topic), self.message_counter(topic)  # subscribe now, so that no message is missed
            raise AbsentTopic(topic, near)
        message = f"there is no topic {topic!r}"
        raise expression_error("SK-COND-006", message, source, span, near or _available_text(topics))

    def latest_message(self, topic: str) -> LatestMessage:
        """Return the object with the newest message of a topic."""
        feed = self._latest_messages.setdefault(topic, LatestMessage(self.sim, topic))
        if self._is_open:
            feed.open()
        return feed

    def message_counter(self, topic: str) -> MessageCounter:
        """Return the message counter of a topic."""
        counter = self._counters.setdefault(topic, MessageCounter(self.sim, topic))
        if self._is_open:
            counter.open()
        return counter

    def add_history(self, history: History) -> None:
        """Observe a value of the whole run between `open` and `close`."""
        self._histories.append(history)
        if self._is_open:
            self._open_history(history)

    def _open_history(self, history: History) -> None:
        """Observe the present state, and later states with the messages of a topic or at a rate."""
        history.observe()
        communication = self.sim.communication
        if history.topic:
            # the callback does not read the message, but the expression reads the newest one, which is already there
            self._history_ends.append(communication.bus.tap(history.topic, lambda _: history.observe()).close)
        else:
            self._history_ends.append(
                communication.on_demand.add(lambda: self._is_open, history.rate, lambda _: history.observe())
            )

    def open(self) -> None:
        """Subscribe to all topics of the expressions, and observe the values of the whole run."""
        self._is_open = True
        for listener in self._listeners():
            listener.open()
        for history in self._histories:
            self._open_history(history)

    @property
    def remembers(self) -> bool:
        """True if expressions use messages, or values of the whole run, that a reset of the simulation does not end."""
        return bool(self._latest_messages or self._counters or self._histories)

    def close(self) -> None:
        """End all subscriptions and observations."""
        for listener in self._listeners():
            listener.close()
        self._is_open = False
        for end in self._history_ends:
            end()
        self._history_ends.clear()

    def _listeners(self) -> list[_TopicListener]:
        return [*self._latest_messages.values(), *self._counters.values()]


def _list_names(names: Iterable[str]) -> str:
    names = list(names)
    rest = f" and {len(names) - _MAX_LISTED} more" if len(names) > _MAX_LISTED else ""
    return ", ".join(names[:_MAX_LISTED]) + rest


def _available_text(names: Iterable[str]) -> str:
    listed = _list_names(names)
    return f"available: {listed}" if listed else "the world has none"
