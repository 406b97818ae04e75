"""View of a recorded run: the values that the stream had last, for the checks of the judge.

A value in the stream is `=` and its bytes, or `?` and the reason why it is unknown.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, TypeVar, cast

import numpy as np
import numpy.typing as npt

from simkit import Joint, Pose, Simulation, msgs
from simkit.extend import Vector
from simkit.msgs import Message
from simkit.run_spec import JsonMapping
from simkit.testing.conditions.syntax_tree import Span, UndecidedValue
from simkit.testing.conditions.topic_listeners import LatestMessage, MessageCounter
from simkit.testing.conditions.world_view import Contacts, Entity, History, WorldView
from simkit_verification.testing.grading.run_stream import DamagedStreamError

_Value = TypeVar("_Value")
Key = tuple[str, ...]
JointValue = float | npt.NDArray[np.float64]
"""Number of a joint with one degree of freedom, or its numbers."""
JOINT_VALUES: Final = ("position", "velocity", "effort", "lower", "upper")
_POSE, _TWIST, _CONTACTS = struct.Struct("<7d"), struct.Struct("<6d"), struct.Struct("<Id")
_MOST_TEXT: Final = 4096  # bytes of a description
_SCALAR: Final = 255  # count of numbers of a value that is one number and no list


def known(read: Callable[[], bytes]) -> bytes:
    """Return the bytes of a value, or the reason why it is unknown."""
    try:
        return b"=" + read()
    except UndecidedValue as reason:
        return b"?" + str(reason).encode()[:_MOST_TEXT]


def value_bytes(content: bytes) -> bytes:
    """Return the bytes of a known value.

    Raises:
        UndecidedValue: The value is unknown.
        DamagedStreamError: The content is no value.
    """
    if content[:1] == b"=":
        return content[1:]
    if content[:1] == b"?":
        raise UndecidedValue(_decoded_text(content[1:]))
    raise DamagedStreamError("a value is invalid")


def encode_pose(pose: Pose) -> bytes:
    """Encode a pose."""
    return _POSE.pack(*pose.position.tolist(), *pose.quaternion.tolist())


def decode_pose(content: bytes) -> Pose:
    """Decode a pose."""
    numbers = _numbers(_POSE, content)
    return Pose(tuple(numbers[:3]), tuple(numbers[3:]))


def encode_twist(twist: tuple[Vector, Vector]) -> bytes:
    """Encode the linear and the angular velocity."""
    return _TWIST.pack(*twist[0].tolist(), *twist[1].tolist())


def decode_twist(content: bytes) -> tuple[Vector, Vector]:
    """Decode the linear and the angular velocity."""
    numbers = _numbers(_TWIST, content)
    return np.array(numbers[:3]), np.array(numbers[3:])


def encode_joint(joint: Joint) -> bytes:
    """Encode position, velocity, effort and limits of a joint."""
    out = bytearray()
    for name in JOINT_VALUES:
        value = np.asarray(getattr(joint, name), dtype="<f8")
        out.append(_SCALAR if value.ndim == 0 else value.size)
        out += value.tobytes()
    return bytes(out)


def decode_joint(content: bytes) -> dict[str, JointValue]:
    """Decode position, velocity, effort and limits of a joint."""
    values: dict[str, JointValue] = {}
    at = 0
    for name in JOINT_VALUES:
        count = content[at] if at < len(content) else 0
        size = 8 * (1 if count == _SCALAR else count)
        numbers = np.frombuffer(content[at + 1 : at + 1 + size], "<f8").astype(np.float64)
        values[name] = float(numbers[0]) if count == _SCALAR and len(numbers) else numbers
        at += 1 + size
    if at != len(content):
        raise DamagedStreamError("a value is invalid")
    return values


def encode_contacts(contacts: Contacts) -> bytes:
    """Encode number, force and description of contacts."""
    count = len(contacts.now())
    if not count:
        return _CONTACTS.pack(0, 0.0)
    text: bytes = contacts.describe().encode()
    return _CONTACTS.pack(count, contacts.force()) + text[:_MOST_TEXT]


def decode_contacts(content: bytes) -> tuple[int, float, str]:
    """Decode number, force and description of contacts."""
    count, force = _numbers(_CONTACTS, content[: _CONTACTS.size])
    return int(count), force, _decoded_text(content[_CONTACTS.size :])


def encode_message(message: Message) -> bytes:
    """Encode a message with its type."""
    content: bytes = msgs.type_name(message).encode() + b"\0" + msgs.serialize(message)
    return content


def decode_message(content: bytes) -> Message:
    """Decode a message."""
    name, _, data = content.partition(b"\0")
    try:
        return msgs.deserialize(data, _decoded_text(name))
    except Exception as error:  # noqa: BLE001 (the decoder raises many kinds for invalid bytes)
        raise DamagedStreamError(f"a message is invalid: {type(error).__name__}") from None


def _numbers(form: struct.Struct, content: bytes) -> tuple[float, ...]:
    if len(content) != form.size:
        raise DamagedStreamError("a value is invalid")
    return form.unpack(content)


def _decoded_text(content: bytes) -> str:
    return content.decode("utf-8", "replace")


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
    def from_json(cls, stored: JsonMapping) -> RecordedNames:
        """Check and convert the JSON of a frame.

        Raises:
            DamagedStreamError: A value has another type.
        """
        try:
            return cls(
                models=frozenset(map(_text, stored["model"])),
                links=frozenset(map(_text, stored["link"])),
                joints={_text(name): int(dof) for name, dof in stored["joint"].items()},
                collisions=frozenset(map(_text, stored["collision"])),
                topics={_text(topic): _text(kind) for topic, kind in stored["topics"].items()},
                foreign=tuple(map(_text, stored["foreign"])),
                timestep=float(stored["timestep"]),
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

    def value(self, key: Key, decode: Callable[[bytes], _Value]) -> _Value:
        """Return the present value of a source.

        Raises:
            UndecidedValue: The value is unknown, or was not recorded.
        """
        if key not in self._decoded:
            content = self._values.get(key)
            if content is None:
                raise UndecidedValue(f"{key[-1]} was not recorded")
            self._decoded[key] = decode(value_bytes(content))
        return cast(_Value, self._decoded[key])

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
        entity: Entity = self._find(("model", "link"), name, source, span)
        return entity

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
        return self._view.value(("pose", self.name), decode_pose)

    def twist(self) -> tuple[Vector, Vector]:
        return self._view.value(("twist", self.name), decode_twist)


class RecordedJoint:
    """Joint of the recorded run; it has the attributes that expressions read.

    Attributes:
        scoped: Scoped name.
        dof: Number of degrees of freedom.
    """

    def __init__(self, view: RecordedView, scoped: str, dof: int) -> None:
        self.scoped, self.dof, self._view = scoped, dof, view

    def __getattr__(self, name: str) -> JointValue:
        if name not in JOINT_VALUES:
            raise AttributeError(name)
        return self._view.value(("joint", self.scoped), decode_joint)[name]


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
        return self._view.value(self._key, decode_contacts)


class RecordedMessage(LatestMessage):
    """Newest message of a topic of the recorded run."""

    def __init__(self, view: RecordedView, topic: str) -> None:
        self.topic, self._view = topic, view

    def latest(self) -> object:
        return self._view.value(("latest", self.topic), decode_message)


class RecordedCounter(MessageCounter):
    """Number and times of the messages on a topic of the recorded run."""

    def __init__(self, topic: str) -> None:
        self.topic = topic
