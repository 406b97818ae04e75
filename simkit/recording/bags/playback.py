"""Play the commands of a bag back at their ticks, into the recorded world or another one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, MessageError
from simkit.msgs.message_text import message_to_dict
from simkit.msgs.message_types import Message
from simkit.recording.bags.reader import BagMessage, open_bag_to_read
from simkit.runtime.communication.topic_bus import absolute_name

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_TWIST, _STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
_NS: Final = 1e-9
_ROUNDING: Final = 1e-6  # steps by which a time may miss its tick


class Playback:
    """Sends messages of a bag at the first tick at or after their time; a context manager.

    A message that simkit recorded is sent at the tick at which it was: the run repeats bit for bit, where nothing else
    is other. Times that ROS recorded by the calendar are counted from the bag's beginning.

    Args:
        sim: the simulation.
        path: the bag.
        topics: `TOPIC`, or `OLD:=NEW` for what is to come on another one; when empty, every topic that the world takes
            and does not publish itself.

    Attributes:
        names: topics of the bag that are played -> where they go.
        notes: what is done otherwise than recorded, in words.
        sent: how many messages were sent.

    Raises:
        InputError: SK-CLI-030 the bag or the world has no such topic; SK-CLI-035 the bag cannot be read; SK-BAG-015 a
            topic takes no such messages; SK-BAG-016 the world takes nothing of the bag.
    """

    def __init__(self, sim: Simulation, path: Path, topics: Sequence[str] = ()) -> None:
        self._sim = sim
        self._bag = open_bag_to_read(path)
        try:
            self.notes: list[str] = [f"{path}: {self._bag.broken}"] if self._bag.broken else []
            self._input_types = self._world_inputs()
            self.names = self._requested_topics(topics) if topics else self._playable_topics()
            self.sent = 0
            self._sent_types: dict[tuple[str, str], str] = {}
            for topic in self._bag.topics:
                if topic.name in self.names:
                    self._sent_types[topic.name, topic.type_name] = self._matching_input_type(
                        topic.name, topic.type_name
                    )
        except BaseException:
            self._bag.close()
            raise
        self._first_tick = sim.tick
        self._origin = self._bag.time_origin
        self._messages: Iterator[BagMessage] = self._bag.messages(list(self.names))
        self._next = next(self._messages, None)

    def __enter__(self) -> Playback:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Sends no more, and closes the bag."""
        self._next = None
        self._bag.close()

    @property
    def duration(self) -> float:
        """Time from the start to the bag's last message, played or not [s]."""
        return self._bag.duration

    @property
    def next_tick(self) -> int | None:
        """The tick at which something is to be sent next; None when all is sent."""
        if self._next is None:
            return None
        steps = (self._next.time_ns - self._origin) * _NS / self._sim.timestep
        return self._first_tick + max(0, math.ceil(steps - _ROUNDING))

    def send_due(self) -> None:
        """Sends what is due at the present tick.

        Raises:
            InputError: SK-BAG-015 a message does not fit its topic; SK-CLI-035 the bag breaks off; SK-CLI-036 a message
                is not of its type.
        """
        while self._next is not None and (tick := self.next_tick) is not None and tick <= self._sim.tick:
            message = self._next
            self._next = next(self._messages, None)
            topic = self.names[message.topic]
            try:
                self._sim.publish(topic, self._message_to_send(message))
            except MessageError as error:
                text = f"SK-BAG-015 {self._bag.path}: {message.topic} at {message.time_ns * _NS:.9g} s: {error}"
                raise InputError(text, "SK-BAG-015") from None
            self.sent += 1

    # ------------------------------------------------------------------ which topics

    def _world_inputs(self) -> dict[str, tuple[str, ...]]:
        """Topics that something in the world takes -> the types."""
        found: dict[str, tuple[str, ...]] = {}
        for topic, end, types, what in self._sim.communication.bus.endpoints():
            if what == "takes" and end.active:
                found[topic] = (*found.get(topic, ()), *types)
        return found

    def _playable_topics(self) -> dict[str, str]:
        own = {
            topic
            for topic, end, _, what in self._sim.communication.bus.endpoints()
            if what == "publishes" and end.active
        }
        there = dict.fromkeys(topic.name for topic in self._bag.topics)
        found = {topic: topic for topic in there if topic in self._input_types and topic not in own}
        if not found:
            takes = ", ".join(sorted(self._input_types.keys() - own)) or "nothing"
            text = f"the world takes nothing of {self._bag.path}: it takes {takes}"
            hint = "--play-topic OLD:=NEW (play_topics of a scenario) says what goes where"
            raise InputError(f"SK-BAG-016 {text}\n    help: {hint}", "SK-BAG-016")
        return found

    def _requested_topics(self, topics: Sequence[str]) -> dict[str, str]:
        there = {topic.name for topic in self._bag.topics}
        found = {}
        for text in topics:
            old, sign, new = text.partition(":=")
            if not old or (sign and not new):
                raise InputError(
                    f"SK-CLI-018 a topic to play: found {text!r}, allowed is TOPIC or OLD:=NEW", "SK-CLI-018"
                )
            old = absolute_name(old)
            new = absolute_name(new) if sign else old
            for name, names, where in (
                (old, there, str(self._bag.path)),
                (new, set(self._input_types), "the world's inputs"),
            ):
                if name not in names:
                    hint = did_you_mean(name, names) or "there is " + (", ".join(sorted(names)) or "none")
                    raise InputError(f"SK-CLI-030 no topic {name!r} in {where}; {hint}", "SK-CLI-030")
            found[old] = new
        return found

    # ------------------------------------------------------------------ as what

    def _matching_input_type(self, topic: str, type_name: str) -> str:
        """The type as which messages are sent: their own; a velocity is given or loses its header where it has to."""
        new = self.names[topic]
        types = self._input_types[new]
        name = _has_all_fields(type_name)
        if name in types:
            return name
        other = {_TWIST: _STAMPED, _STAMPED: _TWIST}.get(name)
        if other in types and other is not None:
            self.notes.append(f"{topic}: {new} takes {other}, so the velocities of the {name} are sent as that")
            return other
        allowed = " or ".join(dict.fromkeys(types))
        text = f"{self._bag.path}: {topic} is {type_name}, but {new} takes {allowed}"
        raise InputError(f"SK-BAG-015 {text}", "SK-BAG-015")

    def _message_to_send(self, message: BagMessage) -> Message:
        """The message as one of simkit's own types."""
        wanted = self._sent_types[message.topic, message.type_name]
        found = self._bag.decode(message)
        own = _has_all_fields(message.type_name)
        if type(found) is not msgs.type_of(own):  # of the bag's own definition
            found = msgs.make(own, **message_to_dict(found, store=self._bag.store_of(message.type_name)))
        if own == wanted:
            return found
        if wanted == _TWIST:
            return found.twist
        return msgs.type_of(_STAMPED)(msgs.header(self._sim.time_ns, ""), found)


def _has_all_fields(type_name: str) -> str:
    try:
        return msgs.full_name(type_name)
    except MessageError:
        return type_name
