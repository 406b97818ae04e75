"""A world as expressions read it: models, links and joints by name, and the messages of topics."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Any, Literal

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.pose import Pose, Vector
from simkit.runtime import Joint, Simulation, Subscription
from simkit.runtime.communication.topic_bus import absolute_name
from simkit.runtime.contact.collision_contacts import collision_table
from simkit.testing.conditions.syntax_tree import REMOVED_CODE, Span, UndecidedValue, expression_error


class _TopicListener(ABC):
    """Listens to a topic between `open` and `close`.

    Args:
        sim: the simulation.
        topic: absolute.
    """

    def __init__(self, sim: Simulation, topic: str) -> None:
        self.topic, self._sim = topic, sim
        self._subscription: Subscription | None = None

    @abstractmethod
    def _subscribe(self) -> Subscription:
        """Begin to listen."""

    def open(self) -> None:
        """Listens from now on."""
        if self._subscription is None:
            self._subscription = self._subscribe()

    def close(self) -> None:
        """Listens no more; what came so far stays."""
        if self._subscription is not None:
            self._subscription.close()


class LatestMessage(_TopicListener):
    """The newest message of a topic; it is made only when somebody looks."""

    def _subscribe(self) -> Subscription:
        return self._sim.communication.bus.subscribe(self.topic, keep=1)

    def latest(self) -> object:
        """The newest message.

        Raises:
            Undecided: none has come.
        """
        message = self._subscription.latest if self._subscription is not None else None
        if message is None:
            raise UndecidedValue(f"no message has come on {self.topic}")
        return message


class MessageCounter(_TopicListener):
    """How many messages come on a topic, and when; the messages are not looked at.

    Attributes:
        count: messages since it was opened, or since time went back.
        first, last: simulated times [ns] of the first and the newest of them.
    """

    count = first = last = 0

    def _subscribe(self) -> Subscription:
        return self._sim.communication.bus.tap(self.topic, self._take, takes_later=True)

    def rate(self) -> float | None:
        """Messages per simulated second from the first to the newest [Hz]; None before two at different times."""
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


_MAX_LISTED = 12  # names that are listed where none is near


class AbsentTopic(Exception):
    """A topic that nobody publishes yet."""

    def __init__(self, topic: str, hint: str) -> None:
        super().__init__(f"nobody publishes on {topic}" + (f"; {hint}" if hint else ""))
        self.topic = topic


class Entity:
    """A model or a link: the one that has its name now, also where another came in the place of one removed.

    Args:
        handle: of the simulation.
    """

    def __init__(self, sim: Simulation, handle: Any) -> None:
        self.handle, self.name = handle, handle.scoped
        self._sim = sim
        self._kind = "link" if hasattr(handle, "linear_velocity") else "model"

    def pose(self) -> Pose:
        """In the world."""
        pose: Pose
        try:
            pose = self.handle.pose
        except InputError as error:
            pose = self._again(error).pose
        return pose

    def twist(self) -> tuple[Vector, Vector]:
        """Velocity of its origin [m/s] and of turning [rad/s], world axes."""
        try:
            return self._twist(self.handle)
        except InputError as error:
            return self._twist(self._again(error))

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
        # of the model's origin, which the canonical link carries along
        x, y, z = (origin - carrier.pose.position).tolist()
        a, b, c = angular.tolist()
        return both[3:] + np.array((b * z - c * y, c * x - a * z, a * y - b * x)), angular

    def _again(self, error: InputError) -> Any:
        """What has the name now.

        Raises:
            Undecided: nothing.
        """
        if error.code != REMOVED_CODE:
            raise error
        found = self._sim.contents.handles.tables[self._kind].get(self.name)
        if found is None:
            raise UndecidedValue(f"{self.name} was removed") from None
        self.handle = found
        return found


class WorldView:
    """What expressions read of a simulation.

    Args:
        sim: the simulation.
        absent: what a topic is that nobody publishes yet: an "error", or one to wait for ("wait").
    """

    def __init__(self, sim: Simulation, absent: Literal["error", "wait"] = "error") -> None:
        self.sim, self.absent = sim, absent
        self._feeds: dict[str, LatestMessage] = {}
        self._tallies: dict[str, MessageCounter] = {}
        self._is_open = False

    # ------------------------------------------------------------------ names

    def thing(self, name: str, source: str, span: Span) -> Entity:
        """A model or a link by its scoped name, or by its own where only one has it.

        Raises:
            InputError: SK-COND-005 there is none, or several; names the closest.
        """
        return Entity(self.sim, self._find(("model", "link"), name, source, span))

    def joint(self, name: str, source: str, span: Span) -> Joint:
        """A joint, likewise."""
        found: Joint = self._find(("joint",), name, source, span)
        return found

    def scoped(self, name: str, source: str, span: Span) -> str:
        """The scoped name of a model, a link, or a collision."""

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
            message = f"{len(own)} of the world are called {name!r}: {_list_names(own)}"
            raise expression_error("SK-COND-005", message, source, span, "write the whole name")
        short = [key.rpartition("::")[2] for key in everything]
        near = did_you_mean(name, [*everything, *short])
        message = f"the world has no {what} {name!r}"
        raise expression_error("SK-COND-005", message, source, span, near or _require_present(everything))

    # ------------------------------------------------------------------ topics

    def topic(self, name: str, source: str, span: Span) -> tuple[str, str]:
        """A topic with its type.

        Raises:
            InputError: SK-COND-006 there is no such topic; names the closest.
            AbsentTopic: there is none yet, and it is waited for.
        """
        topic = absolute_name(name)
        topics = self.sim.communication.bus.all_topics()
        if topic in topics:
            return topic, topics[topic]
        near = did_you_mean(topic, topics)
        if self.absent == "wait":
            self.feed(topic), self.tally(topic)  # whatever it will be asked for, nothing is missed
            raise AbsentTopic(topic, near)
        message = f"there is no topic {topic!r}"
        raise expression_error("SK-COND-006", message, source, span, near or _require_present(topics))

    def feed(self, topic: str) -> LatestMessage:
        """The newest message of a topic."""
        feed = self._feeds.setdefault(topic, LatestMessage(self.sim, topic))
        if self._is_open:
            feed.open()
        return feed

    def tally(self, topic: str) -> MessageCounter:
        """The count of a topic's messages."""
        tally = self._tallies.setdefault(topic, MessageCounter(self.sim, topic))
        if self._is_open:
            tally.open()
        return tally

    def open(self) -> None:
        """Begins to listen."""
        self._is_open = True
        for listener in self._listeners():
            listener.open()

    def close(self) -> None:
        """Listens no more."""
        for listener in self._listeners():
            listener.close()

    def _listeners(self) -> list[_TopicListener]:
        return [*self._feeds.values(), *self._tallies.values()]


def _list_names(names: Iterable[str]) -> str:
    names = list(names)
    rest = f" and {len(names) - _MAX_LISTED} more" if len(names) > _MAX_LISTED else ""
    return ", ".join(names[:_MAX_LISTED]) + rest


def _require_present(names: Iterable[str]) -> str:
    listed = _list_names(names)
    return f"there is {listed}" if listed else "there is none"
