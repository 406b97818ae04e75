"""View of a world for expressions: models, links and joints by name, and the messages of topics."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Container, Iterable, Mapping, Sequence
from typing import Any, Literal, Protocol

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.float_sum import float_sum
from simkit.msgs.topic_names import absolute_name
from simkit.pose import Pose, Vector
from simkit.runtime import Joint, Link, Model, Simulation
from simkit.runtime.contact.collision_contacts import collision_table
from simkit.testing.conditions.contact_query import ContactQuery
from simkit.testing.conditions.syntax_tree import REMOVED_CODE, Span, UndecidedValue, expression_error
from simkit.testing.conditions.topic_listeners import LatestMessage, MessageCounter, TopicListener

_MAX_LISTED = 12  # maximum number of names in an error message


class RunClock(Protocol):
    """Time of a run; a simulation is one.

    Attributes:
        tick: Number of the step.
        time: Simulated time [s].
        time_ns: Simulated time [ns].
        timestep: Time step [s].
    """

    @property
    def tick(self) -> int: ...
    @property
    def time(self) -> float: ...
    @property
    def time_ns(self) -> int: ...
    @property
    def timestep(self) -> float: ...


class Contacts(Protocol):
    """Contacts of one or two entities; `ContactQuery` reads them from a simulation."""

    def now(self) -> Sequence[object]:
        """Return the present contacts."""

    def force(self) -> float:
        """Return the sum of the normal forces [N]."""

    def describe(self) -> str:
        """Return the links that touch; empty without contacts."""


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

    def __init__(self, sim: Simulation, handle: Model | Link) -> None:
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

    def _twist(self, handle: Model | Link) -> tuple[Vector, Vector]:
        if isinstance(handle, Link):
            both = handle.spatial_velocity()
            return both[3:], both[:3]
        origin = handle.pose.position
        carrier = self._sim.contents.handles.tables["link"].get(handle.scene.canonical_link)
        if carrier is None:
            return np.zeros(3), np.zeros(3)
        both = carrier.spatial_velocity()
        angular = both[:3]
        # velocity of the model's origin, which is rigidly connected to the canonical link
        x, y, z = (origin - carrier.pose.position).tolist()
        a, b, c = angular.tolist()
        return both[3:] + np.array((b * z - c * y, c * x - a * z, a * y - b * x)), angular

    def _find_replacement(self, error: InputError) -> Model | Link:
        """Return the new entity that has the name of the removed one.

        Raises:
            UndecidedValue: No entity has the name.
        """
        if error.code != REMOVED_CODE:
            raise error
        replacement: Model | Link | None = self._sim.contents.handles.tables[self._kind].get(self.name)
        if replacement is None:
            raise UndecidedValue(f"{self.name} was removed") from None
        self.handle = replacement
        return replacement


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

    Attributes:
        clock: Time of the run.
    """

    def __init__(self, sim: Simulation, absent: Literal["error", "wait"] = "error") -> None:
        self.sim, self.absent = sim, absent
        self.clock: RunClock = sim
        self._latest_messages: dict[str, LatestMessage] = {}
        self._counters: dict[str, MessageCounter] = {}
        self._histories: list[History] = []
        self._history_ends: list[Callable[[], None]] = []
        self._is_open = False

    # ------------------------------------------------------------------ names

    def entity(self, name: str, source: str, span: Span, *, moves: bool = False) -> Entity:
        """Return a model or link by its scoped name, or by its short name if that is unique.

        Args:
            name: Name of the model or link.
            source: Text of the expression.
            span: Position of the name in the expression.
            moves: True if the expression may read the velocity too.

        Raises:
            InputError: SK-COND-005 no entity or several entities have the name; the message suggests the closest.
        """
        return Entity(self.sim, self._find(("model", "link"), name, source, span))

    def joint(self, name: str, source: str, span: Span) -> Joint:
        """Return a joint by its scoped name, or by its short name if that is unique."""
        handle: Joint = self._find(("joint",), name, source, span)
        return handle

    def current_joint(self, joint: Joint) -> Joint:
        """Return the joint that has the name of a joint now, or the same joint if it was removed."""
        present: Joint = self._tables["joint"].get(joint.scoped, joint)
        return present

    def existence(self, name: str) -> Callable[[], bool]:
        """Return a function that checks whether a model or link of a name exists."""
        return lambda: any(name in self._tables[kind] for kind in ("model", "link"))

    def contacts(self, first: str, second: str | None = None) -> Contacts:
        """Return the contacts of one or two models, links or collisions by their scoped names."""
        return ContactQuery(self.sim, first, second)

    @property
    def _tables(self) -> Mapping[str, Mapping[str, Any]]:
        """Models, links and joints by kind and scoped name."""
        return self.sim.contents.handles.tables

    def _collision_names(self) -> Container[str]:
        return collision_table(self.sim.engine.structure.compiled).names

    def scoped_name(self, name: str, source: str, span: Span) -> str:
        """Return the scoped name of a model, a link or a collision."""
        if name in self._collision_names():
            return name
        scoped: str = self._find(("model", "link"), name, source, span).scoped
        return scoped

    def _find(self, kinds: tuple[str, ...], name: str, source: str, span: Span) -> Any:
        tables = self._tables
        for kind in kinds:
            if name in tables[kind]:
                return tables[kind][name]
        everything: dict[str, object] = {k: v for kind in reversed(kinds) for k, v in tables[kind].items()}
        matching = [key for key in everything if key.rpartition("::")[2] == name]
        if len(matching) == 1:
            return everything[matching[0]]
        what = " or ".join(kinds)
        if matching:
            message = f"{len(matching)} entities have the name {name!r}: {_list_names(matching)}"
            raise expression_error("SK-COND-005", message, source, span, "write the scoped name")
        short = [key.rpartition("::")[2] for key in everything]
        near = did_you_mean(name, [*everything, *short])
        message = f"the world has no {what} {name!r}"
        raise expression_error("SK-COND-005", message, source, span, near or _available_text(everything))

    # ------------------------------------------------------------------ topics

    def all_topics(self) -> dict[str, str]:
        """Return the types of all topics."""
        return self.sim.communication.bus.all_topics()

    @property
    def topics_revision(self) -> int:
        """Counter that changes with the topics."""
        return self.sim.communication.bus.revision

    def configured_rate(self, topic: str) -> float | None:
        """Return the sum of the configured rates of a topic's publishers [Hz]; None if a rate is unknown."""
        return configured_rate(self.sim, topic)

    def topic(self, name: str, source: str, span: Span) -> tuple[str, str]:
        """Return the absolute name and the type of a topic.

        Raises:
            InputError: SK-COND-006 the topic does not exist; the message suggests the closest.
            AbsentTopic: The topic does not exist yet, and the view waits for it.
        """
        topic = absolute_name(name)
        topics = self.all_topics()
        if topic in topics:
            return topic, topics[topic]
        near = did_you_mean(topic, topics)
        if self.absent == "wait":
            self.latest_message(topic), self.message_counter(topic)  # subscribe now, so that no message is missed
            raise AbsentTopic(topic, near)
        message = f"there is no topic {topic!r}"
        raise expression_error("SK-COND-006", message, source, span, near or _available_text(topics))

    @property
    def topics_read(self) -> Collection[str]:
        """Topics whose newest messages expressions read."""
        return self._latest_messages

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

    def present_messages(self) -> dict[str, object]:
        """Return the newest message of each topic that expressions read, without topics that have none."""
        found: dict[str, object] = {}
        for topic, listener in self._latest_messages.items():
            with contextlib.suppress(UndecidedValue):
                found[topic] = listener.latest()
        return found

    def restore_messages(self, messages: Mapping[str, object]) -> None:
        """Return to the messages of `present_messages`, after a snapshot of the same time was restored."""
        for topic, listener in self._latest_messages.items():
            listener.restore(messages.get(topic))

    @property
    def accumulates(self) -> bool:
        """True if expressions count messages, or use values of the whole run, which no snapshot contains."""
        return bool(self._counters or self._histories)

    def close(self) -> None:
        """End all subscriptions and observations."""
        for listener in self._listeners():
            listener.close()
        self._is_open = False
        for end in self._history_ends:
            end()
        self._history_ends.clear()

    def _listeners(self) -> list[TopicListener]:
        return [*self._latest_messages.values(), *self._counters.values()]


def _list_names(names: Iterable[str]) -> str:
    names = list(names)
    rest = f" and {len(names) - _MAX_LISTED} more" if len(names) > _MAX_LISTED else ""
    return ", ".join(names[:_MAX_LISTED]) + rest


def _available_text(names: Iterable[str]) -> str:
    listed = _list_names(names)
    return f"available: {listed}" if listed else "the world has none"


def configured_rate(sim: Simulation, topic: str) -> float | None:
    """Return the sum of the configured rates of a topic's publishers [Hz]; None if a rate is unknown."""
    owners: list[object] = [sensor for sensor in sim.engine.structure.all_sensors() if topic in sensor.topics.values()]
    if not owners:
        for _, end, _, what in sim.communication.bus.endpoints(topic):
            if what == "publishes" and end.active:
                owners.append(None if getattr(end, "latched", False) else end.owner)
    rates = [_publisher_rate(owner, sim.timestep) for owner in owners]
    return float_sum(rate for rate in rates if rate is not None) if rates and None not in rates else None


def _publisher_rate(owner: object, timestep: float) -> float | None:
    """Return the rate of a sensor or of a plugin's hook `after_step` [Hz]; None if it is unknown.

    A sensor with an update rate of 0 publishes after every step.
    """
    rate = getattr(owner, "update_rate", None)
    if isinstance(rate, (int, float)) and hasattr(owner, "scoped") and hasattr(owner, "sample"):
        return min(float(rate), 1.0 / timestep) if rate > 0 else 1.0 / timestep
    rate = getattr(owner, "after_step_rate", None)
    return float(rate) if isinstance(rate, (int, float)) and rate > 1e-3 else None
