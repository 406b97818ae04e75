"""View of a recorded run: the values that the stream had last, for the checks of the judge."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, field
from typing import Any, cast

from simkit.pose import Pose, Vector
from simkit.runtime import Joint, Simulation
from simkit.testing.conditions.syntax_tree import Span, UndecidedValue
from simkit.testing.conditions.topic_listeners import LatestMessage, MessageCounter
from simkit.testing.conditions.world_view import Contacts, Entity, History, WorldView
from simkit.testing.grading import recorded_values as values
from simkit.testing.grading.run_stream import DamagedStreamError

Key = tuple[str, ...]


@dataclass
class RecordedClock:
    """Time of the recorded run."""

    tick: int = 0
    time_ns: int = 0
    time: float = 0.0
    timestep: float = 0.0


@dataclass
class RecordedNames:
    """Names of the entities and topics of the recorded world."""

    models: frozenset[str] = frozenset()
    links: frozenset[str] = frozenset()
    joints: Mapping[str, int] = field(default_factory=dict)
    collisions: frozenset[str] = frozenset()
    topics: Mapping[str, str] = field(default_factory=dict)
    foreign: tuple[str, ...] = ()
    timestep: float = 0.0

    @classmethod
    def from_json(cls, found: Mapping[str, Any]) -> RecordedNames:
        """Check and convert the JSON of a frame.

        Raises:
            DamagedStreamError: A value has another type.
        """
        try:
            return cls(
                models=frozenset(map(_text, found["model"])),
                links=frozenset(map(_text, found["link"])),
                joints={_text(name): int(dof) for name, dof in found["joint"].items()},
                collisions=frozenset(map(_text, found["collision"])),
                topics={_text(topic): _text(kind) for topic, kind in found["topics"].items()},
                foreign=tuple(map(_text, found["foreign"])),
                timestep=float(found["timestep"]),
            )
        except (KeyError, TypeError, ValueError, AttributeError):
            raise DamagedStreamError("the names of the world are invalid") from None


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError
    return value


class RecordedView(WorldView):
    """View of a recorded run, from which a judge evaluates the checks of an exercise.

    Attributes:
        clock: Time of the recorded run.
    """

    def __init__(self) -> None:
        super().__init__(cast(Simulation, None), "wait")
        self.clock: RecordedClock = RecordedClock()
        self.rates: dict[str, float | None] = {}
        self._values: dict[Key, bytes] = {}
        self._decoded: dict[Key, object] = {}
        self._names = RecordedNames()
        self._name_count = 0

    # ------------------------------------------------------------------ the stream

    def set_names(self, names: RecordedNames) -> None:
        """Take the names of the world."""
        self._names, self._name_count = names, self._name_count + 1
        self.clock.timestep = names.timestep

    def set_value(self, key: Key, content: bytes) -> None:
        """Take the new value of a source."""
        self._values[key] = content
        self._decoded.pop(key, None)

    def value(self, key: Key, decode: Callable[[bytes], Any]) -> Any:
        """Return the present value of a source.

        Raises:
            UndecidedValue: The value is unknown, or was not recorded.
        """
        found = self._decoded.get(key)
        if found is None:
            content = self._values.get(key)
            if content is None:
                raise UndecidedValue(f"{key[-1]} was not recorded")
            found = self._decoded[key] = decode(values.value_bytes(content))
        return found

    def count_message(self, topic: str) -> None:
        """Count a message of a topic."""
        counter = self._counters.get(topic)
        if counter is not None:
            counter.take(self.clock.time_ns)

    def observe(self, topic: str, rate: float | None = None) -> None:
        """Add the present state to the values of the whole run that observe a topic, a rate, or every step."""
        for history in self._histories:
            if history.topic == topic and (topic or history.rate == rate):
                history.observe()

    def add_history(self, history: History) -> None:
        self._histories.append(history)
        history.observe()

    # ------------------------------------------------------------------ names in the expressions

    @property
    def _tables(self) -> Mapping[str, Mapping[str, Any]]:
        names = self._names
        return {
            "model": {name: RecordedEntity(self, name) for name in names.models},
            "link": {name: RecordedEntity(self, name) for name in names.links},
            "joint": {name: RecordedJoint(self, name, dof) for name, dof in names.joints.items()},
        }

    def _collision_names(self) -> Container[str]:
        return self._names.collisions

    def entity(self, name: str, source: str, span: Span, *, moves: bool = False) -> Entity:
        found: Entity = self._find(("model", "link"), name, source, span)
        return found

    def current_joint(self, joint: Joint) -> Joint:
        return joint

    def existence(self, name: str) -> Callable[[], bool]:
        return lambda: bool(self.value(("exists", name), lambda content: content == b"\1"))

    def contacts(self, first: str, second: str | None = None) -> Contacts:
        return RecordedContacts(self, ("contacts", first) if second is None else ("contacts", first, second))

    def all_topics(self) -> dict[str, str]:
        return dict(sorted(self._names.topics.items()))

    @property
    def topics_revision(self) -> int:
        return self._name_count

    def configured_rate(self, topic: str) -> float | None:
        return self.rates.get(topic)

    def latest_message(self, topic: str) -> LatestMessage:
        return self._latest_messages.setdefault(topic, RecordedMessage(self, topic))

    def message_counter(self, topic: str) -> MessageCounter:
        return self._counters.setdefault(topic, RecordedCounter(topic))


class RecordedEntity(Entity):
    """Model or link of the recorded run."""

    def __init__(self, view: RecordedView, name: str) -> None:
        self.name = self.scoped = name
        self._view = view

    def pose(self) -> Pose:
        found: Pose = self._view.value(("pose", self.name), values.decode_pose)
        return found

    def twist(self) -> tuple[Vector, Vector]:
        found: tuple[Vector, Vector] = self._view.value(("twist", self.name), values.decode_twist)
        return found


class RecordedJoint:
    """Joint of the recorded run; it has the attributes that expressions read.

    Attributes:
        scoped: Scoped name.
        dof: Number of degrees of freedom.
    """

    def __init__(self, view: RecordedView, scoped: str, dof: int) -> None:
        self.scoped, self.dof, self._view = scoped, dof, view

    def __getattr__(self, name: str) -> Any:
        if name not in values.JOINT_VALUES:
            raise AttributeError(name)
        return self._view.value(("joint", self.scoped), values.decode_joint)[name]


class RecordedContacts:
    """Contacts of the recorded run."""

    def __init__(self, view: RecordedView, key: Key) -> None:
        self._view, self._key = view, key

    def now(self) -> range:
        """Return a sequence with as many items as there are contacts."""
        return range(self._read()[0])

    def force(self) -> float:
        """Return the sum of the normal forces [N]."""
        return self._read()[1]

    def describe(self) -> str:
        """Return the links that touch; empty without contacts."""
        return self._read()[2]

    def _read(self) -> tuple[int, float, str]:
        found: tuple[int, float, str] = self._view.value(self._key, values.decode_contacts)
        return found


class RecordedMessage(LatestMessage):
    """Newest message of a topic of the recorded run."""

    def __init__(self, view: RecordedView, topic: str) -> None:
        self.topic, self._view = topic, view

    def latest(self) -> object:
        return self._view.value(("latest", self.topic), values.decode_message)


class RecordedCounter(MessageCounter):
    """Number and times of the messages on a topic of the recorded run."""

    def __init__(self, topic: str) -> None:
        self.topic = topic
